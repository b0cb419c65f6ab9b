"""Frequency responses: closed forms, direct solves, sampled models, irregularities, loops, and measured ones."""

import dataclasses

import numpy as np
import pytest
from scipy.linalg import expm
from tests.linear.masses import chain, model, on_two_axles

from klingel.errors import InputError
from klingel.linear.margins import loop_gain, margins
from klingel.linear.measured import estimate, random_phases
from klingel.linear.model import LinearModel
from klingel.linear.response import Resolvent, frequency_response, irregularity, positions

F = np.geomspace(0.05, 40.0, 200)
JW = 2j * np.pi * F


def held(continuous: LinearModel, T: float) -> LinearModel:
    """The same with inputs held over T."""
    n, m = continuous.B.shape
    both = expm(np.block([[continuous.A, continuous.B], [np.zeros((m, n + m))]]) * T)
    names = {"states": [s.name for s in continuous.states], "inputs": [s.name for s in continuous.inputs]}
    outputs = [s.name for s in continuous.outputs]
    A, B = both[:n, :n], both[:n, n:]
    return model(A, B, continuous.C, continuous.D, **names, outputs=outputs, sample_time=T, x=continuous.x)


def test_one_mass_has_its_closed_form() -> None:
    found = frequency_response(chain([2.0], [800.0], [6.0]), "u0", "y0", F)
    np.testing.assert_allclose(found, 1.0 / (2.0 * JW**2 + 6.0 * JW + 800.0), rtol=1e-12)


def test_many_states_against_direct_solves() -> None:
    rng = np.random.default_rng(3)
    n = 75  # more than two blocks of the triangular solve
    A = rng.normal(size=(n, n)) * np.exp(3.0 * rng.normal(size=(n, 1))) * np.exp(3.0 * rng.normal(size=(1, n)))
    big = model(A, rng.normal(size=(n, 3)), rng.normal(size=(4, n)), rng.normal(size=(4, 3)))
    found = frequency_response(big, {"u0": 1.0, "u2": -0.5}, ["y3", {"y0": 2.0, "y1": 1j}], F)
    u = np.array([1.0, 0.0, -0.5])
    for i in range(0, len(F), 40):
        y = big.C @ np.linalg.solve(JW[i] * np.eye(n) - A, big.B @ u) + big.D @ u
        np.testing.assert_allclose(found[i], [y[3], 2.0 * y[0] + 1j * y[1]], rtol=1e-9)


def test_defective_eigenvalues_are_no_trouble() -> None:
    three = model(np.eye(3, k=1) - np.eye(3), np.eye(3)[:, 2:], np.eye(3)[:1], np.zeros((1, 1)))
    np.testing.assert_allclose(frequency_response(three, "u0", "y0", F), 1.0 / (JW + 1.0) ** 3, rtol=1e-12)


def test_right_sides_are_solved_in_portions(monkeypatch: pytest.MonkeyPatch) -> None:
    two = chain([1.0, 2.0], [50.0, 70.0], [0.3, 0.2])
    whole = frequency_response(two, "u0", "y1", F)
    monkeypatch.setattr("klingel.linear.response.COLUMNS", 7)
    np.testing.assert_allclose(frequency_response(two, "u0", "y1", F), whole, rtol=1e-9)


def test_a_sampled_model_answers_as_the_held_one() -> None:
    T = 2e-3
    continuous = chain([2.0], [800.0], [6.0])
    slow = F[F < 5.0]
    hold = np.sinc(slow * T) * np.exp(-1j * np.pi * slow * T)
    exact = frequency_response(continuous, "u0", "y0", slow) * hold
    np.testing.assert_allclose(frequency_response(held(continuous, T), "u0", "y0", slow), exact, rtol=1e-3)


@pytest.mark.parametrize(
    ("frequencies", "said"), [([-1.0], "no frequency"), ([np.nan], "no frequency"), ([300.0], "half the sample rate")]
)
def test_frequencies_that_a_model_does_not_have(frequencies: list[float], said: str) -> None:
    with pytest.raises(InputError, match=said):
        frequency_response(held(chain([1.0], [1.0], [1.0]), 2e-3), "u0", "y0", frequencies)


def test_frequency_of_an_undamped_mode_and_unknown_names() -> None:
    with pytest.raises(InputError, match="is an eigenvalue"):
        frequency_response(chain([1.0], [1.0], [0.0]), "u0", "y0", [0.5 / np.pi])
    with pytest.raises(InputError, match="did you mean 'y0'"):
        frequency_response(chain([1.0], [1.0], [0.1]), "u0", "y00", [1.0])


def beam() -> LinearModel:
    return on_two_axles(mass=4e4, inertia=2e6, stiffness=1e6, damping=4e4, half_base=9.0, speed=30.0)


def test_wheels_meet_the_irregularity_one_after_the_other() -> None:
    """z and pitch of a beam over a wave, with the path difference 18 m: closed form."""
    assert positions(beam()) == {"a.left": 0.0, "b.left": 18.0}
    found = frequency_response(beam(), irregularity(beam(), "vertical", F), ["z", "pitch"], F)
    leg = 1e6 + 4e4 * JW
    front, rear = 1.0, np.exp(-JW * 18.0 / 30.0)
    bounce = leg * (front + rear) / (4e4 * JW**2 + 2.0 * leg)
    pitch = -leg * 9.0 * (front - rear) / (2e6 * JW**2 + 2.0 * leg * 81.0)
    np.testing.assert_allclose(found, np.stack([bounce, pitch], axis=1), rtol=1e-9, atol=1e-12)


def test_a_sampled_model_meets_the_same_irregularity() -> None:
    """What a sampled model holds, the track does not: with the plant, its response is that of the plant."""
    sampled = dataclasses.replace(held(beam(), 5e-3), speed=30.0)
    weights = irregularity(sampled, "vertical", F)
    exact = frequency_response(beam(), weights, "z", F)
    np.testing.assert_allclose(frequency_response(sampled, weights, "z", F, plant=beam()), exact, rtol=1e-9)
    with pytest.raises(InputError, match="is not the continuous part"):
        frequency_response(sampled, weights, "z", F, plant=sampled)


def test_kinds_move_the_rails_as_defined() -> None:
    from klingel.track.irregularity import RAILS

    assert RAILS["crosslevel"]["rail_z"] == (-0.5, 0.5)  # positive lowers the right rail, z down, as cant does
    assert RAILS["crosslevel"]["rail_roll"] == (1.0 / 1.5, 1.0 / 1.5)
    assert RAILS["gauge"]["rail_y"] == (-0.5, 0.5)  # positive widens
    with pytest.raises(InputError, match="no irregularity"):
        irregularity(beam(), "twist", F)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"rail_y.* is not of this model"):
        frequency_response(beam(), irregularity(beam(), "alignment", F), "z", F)
    with pytest.raises(InputError, match="no irregularity among"):
        positions(chain([1.0], [1.0], [1.0]))
    with pytest.raises(InputError, match="neither left nor right"):
        irregularity(beam(), "vertical", F, behind={"middle": 0.0})


def test_loop_gain_from_the_closed_loop() -> None:
    """A motor 1/(s + 1) under integral control 2/s: the sum before the motor is u/(1 + L)."""
    A = np.array([[-1.0, 2.0], [-1.0, 0.0]])
    closed = model(A, np.array([[1.0], [0.0]]), np.array([[0.0, 2.0]]), np.ones((1, 1)))
    L = loop_gain(closed, "u0", "y0", F)
    np.testing.assert_allclose(L, 2.0 / (JW * (JW + 1.0)), rtol=1e-9)


def test_margins_of_a_loop_that_cannot_be_made_unstable() -> None:
    found = margins(2.0 / (JW * (JW + 1.0)), F)
    w = 2.0 * np.pi * found.phase_frequency
    assert w == pytest.approx(1.2496, rel=1e-3)
    assert found.phase == pytest.approx(np.pi / 2 - np.arctan(w), rel=1e-3)
    assert found.gain == np.inf
    assert found.distance <= 2.0 * np.sin(0.5 * found.phase)


def test_estimate_of_whole_periods_is_exact() -> None:
    """A linear system played two periods, the second settled: H1 is its response at every line, coherence 1."""
    T, n = 1e-2, 500
    sampled = held(chain([1.0], [400.0], [8.0]), T)
    u = random_phases(n, T, (1.0, 20.0), amplitude=0.5, courses=3, seed=1)
    assert u.std(axis=1) == pytest.approx(0.5)
    x, y = np.zeros(2), []
    for value in np.repeat(u, 4, axis=0).reshape(-1):
        y.append(sampled.C[0] @ x)
        x = sampled.A @ x + sampled.B[:, 0] * value
    settled = np.array(y).reshape(1, 3, 4, n)[:, :, 3]
    found = estimate("u0", ["y0"], u, settled, interval=T, band=(1.0, 20.0))
    assert len(found.frequencies) == 96
    np.testing.assert_allclose(
        found.response[:, 0], frequency_response(sampled, "u0", "y0", found.frequencies), rtol=1e-6
    )
    np.testing.assert_allclose(found.coherence, 1.0, atol=1e-9)


def test_resolvent_of_nothing() -> None:
    assert Resolvent.of(np.zeros((0, 0))).solve(JW, np.zeros((0, 2), dtype=complex)).shape == (0, len(F), 2)
