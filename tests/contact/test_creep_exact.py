"""creep_force("exact"): limits, symmetries, rows of CONTACT, arrays, options and refusals.
More rows of CONTACT are in validation/contact_creep; the derivation is in docs/theory/exact.md."""

import json
import math
from typing import Any

import numpy as np
import pytest

import klingel as kl
from klingel.contact import creep_force
from klingel.core import core
from klingel.errors import InputError
from klingel.lower import lower

STEEL: dict[str, Any] = {"shear_modulus": 8.2e10, "poisson": 0.28}
PATCH: dict[str, Any] = {"a": 6e-3, "b": 4e-3, "normal_force": 5e4, "friction": 0.3, **STEEL}
LIMIT = 1.5e4

CONTACT = (
    # a/b, xi, eta, phi [1/m]; Fx and Fy over mu N, Mz over mu N sqrt(ab): the program CONTACT
    # (github.com/eve70a/CONTACT, Apache-2.0), full theory, 40 x 40 elements, Hertzian, 80 kN, mu 0.3, a b = 36 mm2.
    (0.5, 0.0, 0.0013435358, 0.0, 0.0, -0.43613834, 0.093633205),
    (0.5, 0.00054440021, 0.0, 4.3084725, -0.019670494, -0.22872058, -0.6163222),
    (0.5, 0.0017420807, 0.0016122429, 0.71807875, -0.32357212, -0.67556861, -0.35816276),
    (1.0, 0.0014427864, 0.0, 0.0, -0.59941989, 0.0, 0.0),
    (1.0, 0.0, -0.0010971987, 0.22764361, 0.0, 0.18279385, -0.27054156),
    (1.0, 0.0015389721, 0.0013166384, 1.8211489, -0.1601775, -0.53730994, -0.43907472),
)


def test_rows_of_contact() -> None:
    rows = np.array(CONTACT)
    ratio, xi, eta, phi = rows[:, :4].T
    patch = {"a": 6e-3 * np.sqrt(ratio), "b": 6e-3 / np.sqrt(ratio), "normal_force": 8e4, "friction": 0.3, **STEEL}
    fx, fy, mz = creep_force("exact", xi=xi, eta=eta, phi=phi, elements=(40, 40), **patch)
    computed = np.column_stack((fx / 24e3, fy / 24e3, mz / (24e3 * 6e-3)))
    np.testing.assert_allclose(computed, rows[:, 4:], atol=4e-3)


@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
def test_little_creepage_gives_kalkers_coefficients(ratio: float) -> None:
    patch = {**PATCH, "a": 5e-3 * math.sqrt(ratio), "b": 5e-3 / math.sqrt(ratio)}
    little = np.diag([1e-8, 1e-8, 2e-6])

    def forces(law: Any, **options: Any) -> Any:
        fx, fy, _ = creep_force(law, xi=little[0], eta=little[1], phi=little[2], **options, **patch)
        return np.array([fx[0], fy[1], fy[2]])

    # The error falls with the size of the elements.
    limit = 2.0 * forces("exact", elements=(40, 40)) - forces("exact", elements=(20, 20))
    np.testing.assert_allclose(limit, forces("linear"), rtol=0.015)


@pytest.mark.parametrize("ratio", [0.05, 1.0, 20.0])
def test_full_sliding_is_against_the_creepage_and_reaches_the_limit(ratio: float) -> None:
    patch = {**PATCH, "a": 5e-3 * math.sqrt(ratio), "b": 5e-3 / math.sqrt(ratio)}
    fx, fy, _ = creep_force("exact", xi=0.6, eta=-0.8, phi=0.0, elements=(12, 12), **patch)
    assert (fx / LIMIT, fy / LIMIT) == pytest.approx((-0.6, 0.8), abs=2e-4)


def test_friction_bounds_and_mirrors() -> None:
    random = np.random.default_rng(7)
    xi, eta = random.choice([-1, 1], (2, 60)) * 10.0 ** random.uniform(-5, -1, (2, 60))
    phi, ratio = random.uniform(-20.0, 20.0, 60), 10.0 ** random.uniform(-1.3, 1.3, 60)
    patch = {**PATCH, "a": 5e-3 * np.sqrt(ratio), "b": 5e-3 / np.sqrt(ratio), "elements": (12, 12)}
    force = np.array(creep_force("exact", xi=xi, eta=eta, phi=phi, **patch))
    assert np.hypot(force[0], force[1]).max() <= LIMIT * (1 + 1e-6)
    mirrored = np.array(creep_force("exact", xi=xi, eta=-eta, phi=-phi, **patch))
    reversed_ = np.array(creep_force("exact", xi=-xi, eta=-eta, phi=-phi, **patch))
    scale = LIMIT * np.array([[1.0], [1.0], [5e-3]])
    np.testing.assert_allclose(mirrored / scale, force * [[1], [-1], [-1]] / scale, atol=1e-6)
    np.testing.assert_allclose(reversed_ / scale, -force / scale, atol=1e-6)


def test_arrays_hold_what_plain_numbers_give() -> None:
    xi, a = np.array([1e-4, 1e-3, 1e-2]), np.array([[6e-3], [3e-3]])
    forces = creep_force("exact", xi=xi, eta=-1e-3, phi=0.5, **{**PATCH, "a": a})
    assert all(values.shape == (2, 3) for values in forces)
    for i in range(2):
        for j in range(3):
            one = creep_force("exact", xi=float(xi[j]), eta=-1e-3, phi=0.5, **{**PATCH, "a": float(a[i, 0])})
            assert all(type(value) is float for value in one)
            assert one == tuple(values[i, j] for values in forces)
    assert creep_force("exact", xi=1e-3, eta=-1e-3, phi=0.5, elements=(40, 40), **PATCH) == tuple(
        values[0, 1] for values in forces
    )
    empty = creep_force("exact", xi=np.zeros(0), eta=0.0, phi=0.0, **PATCH)
    assert all(values.shape == (0,) for values in empty)
    assert creep_force("exact", xi=1e-3, eta=0.0, phi=0.0, **{**PATCH, "normal_force": 0.0}) == (0.0, 0.0, 0.0)


def test_falling_friction_is_that_of_the_slip_velocity() -> None:
    falls = 0.6 * math.exp(-0.5 * 20.0 * 0.05) + 0.4
    falling = creep_force("exact", xi=0.05, eta=0.0, phi=0.0, falling=(0.4, 0.5), speed=20.0, **PATCH)
    lower = creep_force("exact", xi=0.05, eta=0.0, phi=0.0, **{**PATCH, "friction": 0.3 * falls})
    assert falling == pytest.approx(lower, rel=1e-6, abs=1e-3)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"elements": (3, 16)}, "number of elements: 3 is outside 4 to 80"),
        ({"elements": (16, 81), "xi": [1e-3, 2e-3]}, "^number of elements: 81"),
        ({"blended": True}, "blended belongs to fastsim, the chosen law is exact"),
        ({"slope": (0.5, 0.1, 0.6)}, r"slope \(k0, alpha, beta\) belongs to fastsim"),
        ({"reduction": (0.3, 0.1)}, r"reduction \(kA, kS\) belongs to polach"),
        ({"poisson": 0.6}, "Poisson's ratio: 0.6"),
        ({"a": 0.5}, "^patch: ratio of the semi-axes a/b: 125 is outside 0.02 to 50"),
        ({"a": [[6e-3, 6e-3], [0.5, 6e-3]]}, r"^patch\[1, 0\]: ratio of the semi-axes a/b: 125 is outside 0.02 to 50"),
    ],
)
def test_bad_input_is_refused(changed: dict[str, Any], said: str) -> None:
    given = {"xi": 1e-3, "eta": 0.0, "phi": 0.0, **PATCH} | changed
    with pytest.raises(InputError, match=said):
        creep_force("exact", **given)


def test_a_simulation_refuses_it() -> None:
    vehicle, track = kl.library.vehicle("manchester_coach"), kl.Track.straight("300 m")
    with pytest.raises(InputError, match=r"creep_law = 'exact': takes milliseconds a contact, too slow.*fastsim"):
        kl.Scenario(vehicle, track, speed=30.0, creep_law="exact", duration=0.1)
    spec = lower(kl.Scenario(vehicle, track, speed=30.0, creep_law="fastsim", duration=0.1))
    spec["creep"]["law"] = "exact"
    with pytest.raises(
        core().CoreError,
        match="exact is not allowed; it takes milliseconds a contact, too slow for a simulation; choose",
    ):
        core().check(json.dumps(spec))
