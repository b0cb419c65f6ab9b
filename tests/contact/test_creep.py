"""creep_force by the simulator's laws: shapes, signs, limits, options and refusals; test_creep_exact.py has the other.
Their accuracy is in validation/contact_creep."""

import math
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from klingel.contact import creep_force
from klingel.contact.creep import CreepLaw
from klingel.core import core
from klingel.errors import InputError

STEEL: dict[str, Any] = {"shear_modulus": 8.2e10, "poisson": 0.28}
PATCH: dict[str, Any] = {"a": 6e-3, "b": 4e-3, "normal_force": 5e4, "friction": 0.3, **STEEL}
LAWS = ("linear", "shen_hedrick_elkins", "polach", "fastsim", "table")
LIMIT = 1.5e4


def test_python_and_core_know_the_same_laws() -> None:
    assert core().creep_laws() == [*LAWS, "exact"] == list(get_args(CreepLaw))


@pytest.mark.parametrize("law", LAWS)
def test_scalars_give_floats_and_arrays_are_broadcast(law: Any) -> None:
    xi, eta = np.array([1e-4, 1e-3, 1e-2]), np.array([[0.0], [-2e-3]])
    forces = creep_force(law, xi=xi, eta=eta, phi=0.1, **PATCH)
    assert all(values.shape == (2, 3) for values in forces)
    for i in range(2):
        for j in range(3):
            one = creep_force(law, xi=float(xi[j]), eta=float(eta[i, 0]), phi=0.1, **PATCH)
            assert all(type(value) is float for value in one)
            assert one == tuple(values[i, j] for values in forces)
    empty = creep_force(law, xi=np.zeros(0), eta=0.0, phi=0.0, **PATCH)
    assert all(values.shape == (0,) for values in empty)


@pytest.mark.parametrize("law", LAWS)
def test_positive_creepages_give_negative_forces(law: Any) -> None:
    fx, fy, mz = creep_force(law, xi=1e-4, eta=0.0, phi=0.0, **PATCH)
    assert fx < 0.0
    assert fy == 0.0
    assert abs(mz) < 1e-9
    assert creep_force(law, xi=0.0, eta=1e-4, phi=0.0, **PATCH)[1] < 0.0
    fx, fy, mz = creep_force(law, xi=0.0, eta=0.0, phi=0.1, **PATCH)
    assert fy < 0.0
    assert abs(fx) < 1e-9
    assert (mz < 0.0) == (law in ("linear", "fastsim", "table"))


def test_linear_law_is_kalkers() -> None:
    # a/b = 1 and nu = 0.25 is a row of table E.3: C11 4.12, C22 3.67, C23 1.47.
    patch = {**PATCH, "a": 5e-3, "b": 5e-3, "poisson": 0.25}
    scale = 8.2e10 * 25e-6
    assert creep_force("linear", xi=1e-5, eta=0.0, phi=0.0, **patch)[0] == pytest.approx(-4.12 * scale * 1e-5)
    assert creep_force("linear", xi=0.0, eta=1e-5, phi=0.0, **patch)[1] == pytest.approx(-3.67 * scale * 1e-5)
    _, fy, _ = creep_force("linear", xi=0.0, eta=0.0, phi=0.01, **patch)
    assert fy == pytest.approx(-1.47 * scale * 5e-3 * 0.01)
    assert creep_force("linear", xi=0.0, eta=2e-3, phi=0.0, **patch)[2] == pytest.approx(1.47 * scale * 5e-3 * 2e-3)


creepages = st.floats(-0.02, 0.02)


@settings(max_examples=60, deadline=None)
@given(creepages, creepages, st.floats(-5.0, 5.0), st.floats(1.0, 16.0), st.sampled_from(LAWS[1:]))
def test_friction_bounds_and_mirror(xi: float, eta: float, phi: float, ratio: float, law: Any) -> None:
    patch = {**PATCH, "a": 5e-3 * math.sqrt(ratio), "b": 5e-3 / math.sqrt(ratio)}
    fx, fy, mz = creep_force(law, xi=xi, eta=eta, phi=phi, **patch)
    assert math.hypot(fx, fy) <= LIMIT * (1 + 1e-9)
    assert creep_force(law, xi=xi, eta=-eta, phi=-phi, **patch) == (fx, -fy, -mz)


def test_fastsim_options() -> None:
    kalker = creep_force("fastsim", xi=2e-3, eta=-3e-3, phi=1.5, blended=False, **PATCH)
    blended = creep_force("fastsim", xi=2e-3, eta=-3e-3, phi=1.5, blended=True, **PATCH)
    assert blended != kalker
    assert creep_force("fastsim", xi=2e-3, eta=-3e-3, phi=1.5, **PATCH) == blended
    # One creepage alone has one flexibility, blended or not.
    for xi, eta, phi in ((1e-3, 0.0, 0.0), (0.0, 1e-3, 0.0), (0.0, 0.0, 1.0)):
        one = creep_force("fastsim", xi=xi, eta=eta, phi=phi, blended=True, **PATCH)
        assert one == pytest.approx(creep_force("fastsim", xi=xi, eta=eta, phi=phi, blended=False, **PATCH), rel=1e-9)
    # Blended, full sliding opposes the slip.
    fx, fy, _ = creep_force("fastsim", xi=0.03, eta=0.04, phi=0.0, blended=True, **PATCH)
    assert (fx / LIMIT, fy / LIMIT) == pytest.approx((-0.6, -0.8), abs=2e-3)
    coarse = creep_force("fastsim", xi=1e-3, eta=1e-3, phi=0.5, elements=(4, 4), **PATCH)
    assert coarse != creep_force("fastsim", xi=1e-3, eta=1e-3, phi=0.5, **PATCH)
    reduced = creep_force("fastsim", xi=1e-7, eta=0.0, phi=0.0, slope=(0.54, 0.02, 0.64), **PATCH)
    assert reduced[0] == pytest.approx(0.54 * creep_force("fastsim", xi=1e-7, eta=0.0, phi=0.0, **PATCH)[0], rel=1e-3)


def test_polach_reduction_lowers_the_slope_and_keeps_the_limit() -> None:
    full, wet = (
        creep_force("polach", xi=1e-7, eta=0.0, phi=0.0, **o, **PATCH)[0] for o in ({}, {"reduction": (0.3, 0.1)})
    )
    assert wet == pytest.approx(0.2 * full, rel=1e-3)
    assert creep_force("polach", xi=10.0, eta=0.0, phi=0.0, reduction=(0.3, 0.1), **PATCH)[0] == pytest.approx(
        -LIMIT, rel=2e-3
    )


@pytest.mark.parametrize("law", LAWS[1:])
def test_falling_friction_is_that_of_the_slip_velocity(law: Any) -> None:
    xi, speed = 0.05, 20.0
    falls = 0.6 * math.exp(-0.5 * speed * xi) + 0.4
    falling = creep_force(law, xi=xi, eta=0.0, phi=0.0, falling=(0.4, 0.5), speed=speed, **PATCH)
    assert falling == pytest.approx(
        creep_force(law, xi=xi, eta=0.0, phi=0.0, **{**PATCH, "friction": 0.3 * falls}), rel=1e-6
    )
    at_rest = creep_force(law, xi=xi, eta=0.0, phi=0.0, falling=(0.4, 0.5), speed=0.0, **PATCH)
    assert at_rest == pytest.approx(creep_force(law, xi=xi, eta=0.0, phi=0.0, **PATCH), rel=1e-9)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"law": "fastsin"}, "did you mean 'fastsim'"),
        ({"a": 0.0}, r"a = 0\.0: must be positive"),
        ({"b": [4e-3, -1.0]}, r"b\[1\] = -1\.0: must be positive"),
        ({"xi": math.nan}, "xi = 'nan': is not finite"),
        ({"law": "table", "phi": -1e160}, r"phi = -1e\+160: is beyond 1e\+12: no wheel has it; give SI units"),
        ({"phi": [[0.0, math.inf]]}, r"phi\[0, 1\] = 'inf'"),
        ({"normal_force": -1.0}, "normal_force = -1.0: must not be negative"),
        ({"friction": -0.1}, "friction"),
        ({"shear_modulus": 0.0}, "shear_modulus"),
        ({"shear_modulus": [8.2e10, 8e10]}, "call once for each material"),
        ({"poisson": 0.6}, "Poisson's ratio: 0.6"),
        ({"eta": "fast"}, "is no number"),
        ({"xi": [1e-3, 2e-3], "eta": [0.0, 0.0, 0.0]}, "shapes do not go together: xi .2,., eta .3,."),
        ({"elements": (0, 16)}, "number of FASTSIM elements: 0"),
        ({"elements": (16, 41)}, "number of FASTSIM elements: 41"),
        ({"elements": 16}, "no pair of whole numbers"),
        ({"law": "polach", "elements": (16, 16)}, "does not belong to polach"),
        ({"law": "polach", "blended": True}, "blended belongs to fastsim"),
        ({"reduction": (0.3, 0.1)}, r"reduction \(kA, kS\) belongs to polach"),
        ({"law": "polach", "reduction": (0.1, 0.3)}, "kS of the Polach law: 0.3"),
        ({"blended": 1}, "blended = 1: is no yes or no"),
        ({"slope": (0.5, 0.1)}, "no tuple of 3 numbers"),
        ({"falling": (0.4, 0.6)}, "speed: is missing"),
        ({"speed": 10.0}, "falling: is missing"),
        ({"falling": (1.4, 0.6), "speed": 10.0}, "A of the falling friction: 1.4"),
    ],
)
def test_bad_input_is_refused(changed: dict[str, Any], said: str) -> None:
    given = {"law": "fastsim", "xi": 1e-3, "eta": 0.0, "phi": 0.0, **PATCH} | changed
    with pytest.raises(InputError, match=said):
        creep_force(**given)


def test_every_problem_is_said_at_once() -> None:
    with pytest.raises(InputError) as raised:
        creep_force("fastsim", xi=math.nan, eta=0.0, phi=0.0, **{**PATCH, "a": -1.0, "normal_force": -5.0})
    assert {problem.key for problem in raised.value.problems} == {"xi", "a", "normal_force"}
