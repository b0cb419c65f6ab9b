"""Balanced truncation: the bound against the true error, states that stay, sampled models, Gramians."""

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_lyapunov
from tests.linear.masses import chain, model

from klingel.errors import InputError
from klingel.linear.model import LinearModel
from klingel.linear.reduce import ROUNDING, gramian_factor, hankel_values, reduced
from klingel.linear.response import frequency_response


def row(count: int = 12) -> LinearModel:
    return chain([1.0] * count, [1e3] * count, [1.0] * count).select(
        inputs=["u0", f"u{count - 1}"], outputs=["y0", "y6"]
    )


def with_integral(plant: LinearModel) -> LinearModel:
    """A third output: the integral of the first, which never decays."""
    n = len(plant.A)
    A = np.block([[plant.A, np.zeros((n, 1))], [plant.C[:1], np.zeros((1, 1))]])
    C = np.block([[plant.C, np.zeros((2, 1))], [np.zeros((1, n)), np.ones((1, 1))]])
    return model(A, np.vstack((plant.B, np.zeros((1, 2)))), C, np.zeros((3, 2)))


def held(plant: LinearModel, T: float) -> LinearModel:
    n, m = plant.B.shape
    both = expm(np.block([[plant.A, plant.B], [np.zeros((m, n + m))]]) * T)
    return model(both[:n, :n], both[:n, n:], plant.C, plant.D, sample_time=T)


def error_norm(a: LinearModel, b: LinearModel) -> float:
    """Largest singular value of the difference over a fine grid."""
    f = np.geomspace(1e-3, 0.49 / a.sample_time if a.sample_time else 60.0, 6000)
    outputs = ([s.name for s in a.outputs], [s.name for s in b.outputs])
    columns = [
        frequency_response(a, u.name, outputs[0], f) - frequency_response(b, v.name, outputs[1], f)
        for u, v in zip(a.inputs, b.inputs, strict=True)
    ]
    return float(np.linalg.svd(np.stack(columns, axis=-1), compute_uv=False).max())


@pytest.mark.parametrize("order", [4, 8, 14, 20])
@pytest.mark.parametrize("sample_time", [None, 5e-3])
def test_true_error_is_within_the_bound(order: int, sample_time: float | None) -> None:
    """And not far below it: for the last truncated value alone the error is at least that Hankel value."""
    whole = row() if sample_time is None else held(row(), sample_time)
    small, bound = reduced(whole, order)
    _, hankel = hankel_values(whole)
    error = error_norm(whole, small)
    assert len(small.A) == order
    assert hankel[order] * 0.99 <= error <= bound


def test_all_states_are_the_same_model() -> None:
    small, bound = reduced(row(), 24)
    assert bound == pytest.approx(ROUNDING * hankel_values(row())[1][0])
    assert error_norm(row(), small) < 0.1 * bound


@pytest.mark.parametrize("sample_time", [None, 5e-3])
def test_rounding_is_within_the_bound(sample_time: float | None) -> None:
    """Of sixty states the last ones are ten powers of ten below the first: what is left of the error is rounding."""
    whole = row(30) if sample_time is None else held(row(30), sample_time)
    for order in (56, 58, 59, 60):
        small, bound = reduced(whole, order)
        assert error_norm(whole, small) <= bound


@pytest.mark.parametrize("sample_time", [None, 5e-3])
def test_an_integrator_is_kept_exactly(sample_time: float | None) -> None:
    whole = with_integral(row()) if sample_time is None else held(with_integral(row()), sample_time)
    kept, _ = hankel_values(whole)
    assert kept == 1
    small, bound = reduced(whole, 9)
    assert [s.name for s in small.states][:2] == ["kept1", "balanced1"]
    assert error_norm(whole, small) <= bound  # of an infinite response, so the pole is the same
    with pytest.raises(InputError, match="from 1 "):
        reduced(whole, 0)


def test_an_unstable_mode_is_kept() -> None:
    unstable = chain([1.0, 1.0], [100.0, 400.0], [0.2, -0.5])
    poles = np.linalg.eigvals(unstable.A)
    small, bound = reduced(unstable, 3)
    grows = poles[poles.real > 0.0]
    assert len(grows) == 2
    np.testing.assert_allclose(sorted(np.linalg.eigvals(small.A)[:2].imag), sorted(grows.imag), rtol=1e-9)
    assert error_norm(unstable, small) <= bound


def test_scales_decide_what_matters() -> None:
    """An output in another unit: with its scale, the same reduction."""
    plant = row()
    milli = model(plant.A, plant.B, plant.C * [[1.0], [1e3]], plant.D)
    a, bound = reduced(plant, 8)
    b, same = reduced(milli, 8, scales={"y1": 1e3})
    assert same == pytest.approx(bound, rel=1e-9)
    f = np.geomspace(0.1, 10.0, 50)
    np.testing.assert_allclose(
        frequency_response(b, "u0", "y1", f), 1e3 * frequency_response(a, "u0", "y6", f), rtol=1e-6
    )
    with pytest.raises(InputError, match="no input or output"):
        reduced(plant, 8, scales={"y99": 1.0})
    with pytest.raises(InputError, match="must be positive"):
        reduced(plant, 8, scales={"y0": 0.0})


def test_gramian_factor_is_that_of_the_lyapunov_equation() -> None:
    rng = np.random.default_rng(2)
    A = rng.normal(size=(9, 9)) - 6.0 * np.eye(9)
    B = rng.normal(size=(9, 2))
    S = gramian_factor(A, B)
    np.testing.assert_allclose(S @ S.T, solve_continuous_lyapunov(A, -B @ B.T), rtol=1e-10, atol=1e-14)


def test_python_control_agrees_on_the_norm_of_the_error() -> None:
    control = pytest.importorskip("control")
    whole = row(8).select(inputs=["u0"], outputs=["y6"])
    small, bound = reduced(whole, 6)
    both = whole.to_control() - control.ss(small.A, small.B, small.C, small.D)
    norm = control.norm(both, "inf", method="scipy")
    assert error_norm(whole, small) == pytest.approx(norm, rel=1e-3)
    assert norm <= bound
