"""Sensitivities: derivatives of eigenvalues in closed form, of sampled models, errors that tell kinks."""

import numpy as np
import pytest
from scipy.linalg import expm
from tests.linear.masses import chain, model

from klingel.errors import InputError
from klingel.linear.sensitivity import derivative, eigenvalue_derivatives


def test_eigenvalue_of_one_mass() -> None:
    """m s^2 + c s + k = 0, so ds/dk = -1/(2 m s + c), ds/dc = -s/(2 m s + c)."""
    m, k, c = 2.0, 800.0, 6.0
    (s,), by_k = eigenvalue_derivatives(lambda p: chain([m], [p], [c]), k)
    assert s == pytest.approx((-c + 1j * np.sqrt(4.0 * m * k - c**2)) / (2.0 * m))
    assert by_k.value[0] == pytest.approx(-1.0 / (2.0 * m * s + c), rel=1e-8)
    _, by_c = eigenvalue_derivatives(lambda p: chain([m], [k], [p]), c)
    assert by_c.value[0] == pytest.approx(-s / (2.0 * m * s + c), rel=1e-8)
    _, by_m = eigenvalue_derivatives(lambda p: chain([p], [k], [c]), m)
    assert by_m.value[0] == pytest.approx(-(s**2) / (2.0 * m * s + c), rel=1e-7)
    for each in (by_k, by_c, by_m):
        assert each.error[0] < 1e-5 * abs(each.value[0])


def test_error_is_no_smaller_than_the_truth() -> None:
    for p, exact in ((2.0, np.cos(2.0)), (0.3, np.cos(0.3))):
        found = derivative(lambda x: np.array([np.sin(x)]), p)
        assert abs(found.value[0] - exact) <= found.error[0] + 1e-10  # and rounding over the step
        assert found.error[0] <= 1e-5 * abs(exact)


def test_a_kink_shows_in_the_error() -> None:
    found = derivative(lambda p: np.array([abs(p - 1.0005)]), 1.0)
    assert found.error[0] > 1e-3 or abs(found.value[0]) == pytest.approx(1.0)


def test_zero_has_no_relative_effect() -> None:
    with pytest.raises(InputError, match="no relative effect"):
        derivative(lambda p: np.array([p]), 0.0)


def test_several_eigenvalues_at_once_match_differences() -> None:
    def family(p: float):
        return chain([1.0, 2.0, 1.5], [100.0, p, 90.0], [0.5, 0.2, 0.3])

    poles = np.linalg.eigvals(family(120.0).A)
    found, slope = eigenvalue_derivatives(family, 120.0, poles[poles.imag > 0.0])
    assert len(found) == 3
    h = 1e-3
    near = [np.linalg.eigvals(family(120.0 + d).A) for d in (-h, h)]
    for s, ds in zip(found, slope.value, strict=True):
        low, high = (each[np.argmin(np.abs(each - s))] for each in near)
        assert ds == pytest.approx((high - low) / (2.0 * h), rel=1e-6)


def test_a_sampled_model_has_the_same_sensitivities() -> None:
    """ln z/T of the sampled mass is the continuous eigenvalue; the sample time itself does not move it."""

    def sampled(k: float, T: float = 0.01):
        plant = chain([2.0], [k], [6.0])
        return model(expm(plant.A * T), plant.B, plant.C, plant.D, sample_time=T)

    s, exact = eigenvalue_derivatives(lambda p: chain([2.0], [p], [6.0]), 800.0)
    z, found = eigenvalue_derivatives(sampled, 800.0)
    np.testing.assert_allclose(z, s, rtol=1e-10)
    np.testing.assert_allclose(found.value, exact.value, rtol=1e-7)
    _, by_time = eigenvalue_derivatives(lambda T: sampled(800.0, T), 0.01)
    assert abs(by_time.value[0]) * 0.01 < 1e-6 * abs(s[0])


def test_repeated_eigenvalues_are_refused() -> None:
    block = np.array([[0.0, 1.0], [-1.0, 0.0]])
    A = np.block([[block, np.eye(2)], [np.zeros((2, 2)), block]])
    with pytest.raises(InputError, match="repeated"):
        eigenvalue_derivatives(lambda p: model(p * A, np.zeros((4, 1)), np.zeros((1, 4)), np.zeros((1, 1))), 1.0)


def test_the_least_damped_oscillation_below_20_hz_is_looked_at() -> None:
    """Two masses beside each other: 5 Hz, damped by 5 %, and 50 Hz by 1 %."""

    def family(k: float, fast: float = 2.0 * np.pi * 50.0):
        slow, quick = chain([1.0], [k], [0.1 * np.sqrt(k)]), chain([1.0], [fast**2], [0.02 * fast])
        A = np.block([[slow.A, np.zeros((2, 2))], [np.zeros((2, 2)), quick.A]])
        return model(A, np.zeros((4, 1)), np.zeros((1, 4)), np.zeros((1, 1)))

    (s,), _ = eigenvalue_derivatives(family, (2.0 * np.pi * 5.0) ** 2)
    assert abs(s) == pytest.approx(2.0 * np.pi * 5.0)
    with pytest.raises(InputError, match="none of them oscillates below 20 Hz"):
        eigenvalue_derivatives(lambda k: family(k, 500.0), (2.0 * np.pi * 30.0) ** 2)
