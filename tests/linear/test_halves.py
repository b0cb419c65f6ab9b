"""Left and right halves: folding, parts that do not meet, and the transition over a sample made of them."""

from typing import Any

import numpy as np
import pytest
from scipy.linalg import block_diag, expm, matrix_balance

import klingel as kl
from klingel.linear.blocks import eigen, live, lives
from klingel.linear.halves import Halves, parts
from klingel.linear.model import LinearModel, Signal
from klingel.linear.statespace import held
from klingel.linear.steady import steady_states
from klingel.linear.sweep import Sweep
from klingel.lower import lower

from .synthetic import model_of

RNG = np.random.default_rng(5)


def test_folded_twice_is_as_it_was() -> None:
    names = ["a.left.z", "b.y", "a.right.z", "c_left", "leftover", "c_right", "d_left"]
    halves = Halves.of(names)
    assert (halves.left.tolist(), halves.right.tolist()) == ([0, 3], [2, 5])
    A = RNG.normal(size=(7, 7))
    assert halves.folded(halves.folded(A)) == pytest.approx(A)
    assert np.sort(np.linalg.eigvals(halves.folded(A))) == pytest.approx(np.sort(np.linalg.eigvals(A)))


def test_parts_are_those_that_do_not_meet() -> None:
    sizes, order = [4, 3, 1, 2], RNG.permutation(10)
    A = block_diag(*(RNG.normal(size=(n, n)) for n in sizes)) * 10.0 ** RNG.uniform(-3.0, 3.0, size=(10, 1))
    A = A[np.ix_(order, order)]
    found = parts(A)
    assert sorted(len(part.at) for part in found) == sorted(sizes)
    for at, balanced, scale in found:
        assert balanced * scale[:, None] / scale == pytest.approx(A[np.ix_(at, at)])
    first, second = (part.at[0] for part in found[:2])
    A[first, second] = 1e-3 * np.abs(A[first]).max()
    assert len(parts(A)) == len(sizes) - 1


def coach(seed: int) -> LinearModel:
    """The coach by hand, with inputs of very different sizes that act on anything."""
    spec = lower(kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("500 m"), speed=40.0))
    model = model_of(spec)
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(len(model.states), 5)) * [1.0, 1e-6, 1e6, 0.0, 1e3]
    return LinearModel(
        model.name, model.speed, model.states, tuple(Signal(f"u{i}", "") for i in range(5)), (), model.A, B,
        np.zeros((0, len(model.states))), np.zeros((0, 5)), model.x, np.zeros(5), np.zeros(0),
    )  # fmt: skip


@pytest.mark.parametrize("T", [1e-4, 1e-3, 1e-2])
def test_held_inputs_by_halves_are_those_of_the_whole(T: float) -> None:
    plant = coach(3)
    n, m = plant.B.shape
    # the exponential of the whole is as good only with balanced states and inputs of one size
    size = np.maximum(np.abs(plant.B).max(axis=0), 1.0)
    block = np.block([[plant.A, plant.B / size], [np.zeros((m, n + m))]])
    balanced, (scale, _) = matrix_balance(block, permute=False, separate=True)
    whole = expm(balanced * T)
    phi, gamma = held(plant, T)
    assert phi / scale[:n, None] * scale[:n] == pytest.approx(whole[:n, :n], abs=1e-11 * np.abs(whole[:n, :n]).max())
    for column in range(m):
        expected = whole[:n, n + column] * size[column]
        own = gamma[:, column] / scale[:n] * scale[n + column]
        assert own == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())
    assert not gamma[:, 3].any()


@pytest.mark.parametrize("control", [None, kl.control.IRWLike()])
def test_live_eigenvalues_are_those_of_the_whole(control: Any) -> None:
    vehicle = "mechatronic_irw" if control else "manchester_coach"
    scenario = kl.Scenario(kl.library.vehicle(vehicle), kl.Track.straight("1 km"), speed=40.0, control=control)
    model = Sweep()(scenario).model
    values, _, right = eigen(model)
    upper = lives(values, model.sample_time) & (values.imag >= 0.0)
    roots, shapes = live(model)
    assert roots == pytest.approx(values[upper])
    assert shapes == pytest.approx(right[:, upper])
    z = roots if model.sample_time is None else np.exp(roots * model.sample_time)
    left = np.abs(model.A @ shapes - shapes * z) / np.linalg.norm(shapes, axis=0) / (1.0 + np.abs(z))
    assert left.max() < 1e-8


def test_a_neighbour_on_straight_track_takes_one_jacobian() -> None:
    """Steps with the factors of the first one end the search, and where it ends is the same."""
    vehicle = kl.library.vehicle("mechatronic_irw")
    scenarios = [
        kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=v, control=kl.control.IRWLike()) for v in (44.0, 44.5)
    ]
    _, near = steady_states(scenarios)
    (alone,) = steady_states(scenarios[1:])
    assert near.iterations == 1
    assert near.values.to_numpy() == pytest.approx(alone.values.to_numpy(), rel=1e-8, abs=1e-8)
