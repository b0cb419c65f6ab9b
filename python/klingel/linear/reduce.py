"""Fewer states by balanced truncation, with a bound of the error; states that do not decay are kept exactly.
Square-root method on Cholesky factors of the Gramians, which are solved for directly, never squared."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, rq, schur, solve_sylvester, solve_triangular, svd

from klingel.errors import InputError
from klingel.linear.model import LinearModel, Signal

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

MARGINAL = 1e-4
"""Eigenvalues with a real part above minus this [1/s] do not decay in hours: integrators, the free arc length."""


ROUNDING = 1e-8
"""Part of the largest Hankel value that rounding may add to an error: twenty times the most that was measured."""


@dataclass(frozen=True, eq=False)
class Parts:
    """A model as the sum of two: kept (does not decay, or too slowly to tell) and decaying.

    kept: (A, B, C), sampled if the model is; decaying: (A, B, C, D), continuous, by the bilinear map of a sampled one;
    left, right: what balances it; hankel: its Hankel singular values, the largest first, in units of an output's scale
    over an input's scale.
    """

    kept: tuple[Real, Real, Real]
    decaying: tuple[Real, Real, Real, Real]
    left: Real
    right: Real
    hankel: Real


def reduced(model: LinearModel, order: int, *, scales: Mapping[str, float] | None = None) -> tuple[LinearModel, float]:
    """The model with `order` states, and a bound of its error.

    order: at least the number of states that are kept exactly (see `hankel_values`), at most that of the model;
    scales: sizes of inputs and outputs by name, in their units, 1 for those not named: what counts as one for the
    weighing and for the bound. The bound is the largest singular value that output/scale over input/scale can err by at
    any frequency (H-infinity): twice the sum of the Hankel values left out, and 1e-8 of the largest one for rounding,
    which is measured and not proven: a bound near that says no more. A sampled model stays sampled.
    The states are combinations of the model's and have no names of their own. Errors: InputError for an order out of
    range, an unknown name or a scale that is not positive.
    """
    parts = split(model, scales)
    fixed, most = len(parts.kept[0]), len(model.A)
    given: object = order
    whole = isinstance(given, int | np.integer) and not isinstance(given, bool)
    if not (whole and fixed <= order <= most):
        remedy = f"give a whole number from {fixed} (states that do not decay) to {most}"
        raise InputError.single("order", order, "is no order for this model", remedy=remedy)
    count = min(order - fixed, int(np.sum(parts.hankel > 0.0)))
    bound = 2.0 * float(np.sum(parts.hankel[count:])) + ROUNDING * float(parts.hankel.max(initial=0.0))
    A, B, C, D = parts.decaying
    L, R = parts.left[:, :count], parts.right[:, :count]
    A, B, C = L.T @ A @ R, L.T @ B, C @ R
    if model.sample_time is not None:
        A, B, C, D = to_sampled(A, B, C, D, model.sample_time)
    first = parts.kept
    u, y = _scales(model, scales)
    A, B, C = _diagonal(first[0], A), np.vstack((first[1], B)) / u, np.hstack((first[2], C)) * y[:, None]
    D = D * y[:, None] / u
    names = [f"kept{i}" for i in range(1, fixed + 1)] + [f"balanced{i}" for i in range(1, count + 1)]
    states = tuple(Signal(name, "1") for name in names)
    return dataclasses.replace(model, states=states, A=A, B=B, C=C, D=D, x=np.zeros(len(names))), bound


def hankel_values(model: LinearModel, *, scales: Mapping[str, float] | None = None) -> tuple[int, Real]:
    """How many states are kept exactly, and the Hankel singular values of the others, the largest first."""
    parts = split(model, scales)
    return len(parts.kept[0]), parts.hankel


def split(model: LinearModel, scales: Mapping[str, float] | None = None) -> Parts:
    """The model apart, the decaying part with its balancing: A_reduced = left^T A right and so on."""
    u, y = _scales(model, scales)
    A, B, C, D = model.A, model.B * u, model.C / y[:, None], model.D * u / y[:, None]
    ts = model.sample_time
    balanced, (scale, _) = matrix_balance(A, permute=False, separate=True)
    edge = -MARGINAL if ts is None else np.exp(-MARGINAL * ts)
    T, Z, slow = schur(balanced, sort=lambda re, im: (re if ts is None else np.hypot(re, im)) >= edge)
    B, C = Z.T @ (B / scale[:, None]), C @ (scale[:, None] * Z)
    X = solve_sylvester(T[:slow, :slow], -T[slow:, slow:], -T[:slow, slow:])
    kept = T[:slow, :slow], B[:slow] - X @ B[slow:], C[:, :slow]
    decaying = T[slow:, slow:], B[slow:], C[:, slow:] + C[:, :slow] @ X, D
    if ts is not None:
        decaying = to_continuous(*decaying, ts)
    return Parts(kept, decaying, *_balancing(*decaying[:3]))


def _balancing(A: Real, B: Real, C: Real) -> tuple[Real, Real, Real]:
    """left, right, Hankel values: P = S S^T, Q = R R^T, R^T S = U h V^T; left = R U h^-1/2, right = S V h^-1/2."""
    if len(A) == 0:
        return A, A, np.zeros(0)
    S, R = gramian_factor(A, B), gramian_factor(A.T, C.T)
    U, hankel, Vt = svd(R.T @ S)
    hankel = np.where(hankel > 1e-14 * hankel[0], hankel, 0.0)
    root = np.zeros(len(hankel))
    root[hankel > 0.0] = hankel[hankel > 0.0] ** -0.5
    return R @ U * root, S @ Vt.T * root, hankel


def gramian_factor(A: Real, B: Real) -> Real:
    """S with P = S S^T of A P + P A^T + B B^T = 0, A stable (Hammarling 1982); real, square.

    Backwards through the complex Schur form, one column of the factor at a time, so that the small parts of P are as
    accurate as the large ones, which P itself would drown.
    """
    T, Z = schur(A, output="complex")
    n = len(T)
    F = np.zeros((n, n), dtype=np.complex128)
    R = _upper(Z.conj().T @ B)
    for k in range(n - 1, -1, -1):
        pole, rest = T[k, k], np.s_[:k]
        alpha = np.sqrt(-2.0 * pole.real)
        turn = np.exp(-1j * np.angle(R[k, k]))
        r, mu = R[:k, k] * turn, abs(R[k, k]) / alpha
        F[k, k] = mu
        if k > 0:
            shifted = T[:k, :k] + np.conj(pole) * np.eye(k)
            u = solve_triangular(shifted, -mu * T[:k, k] - alpha * r)
            F[rest, k] = u
            R = _upper(np.column_stack((R[:k, :k], r - alpha * u)))
    S = Z @ F
    return np.asarray(_upper(np.hstack((S.real, S.imag))).real)


def _upper(B: Complex) -> Complex:
    """Square upper triangular R with R R* = B B*."""
    n, m = B.shape
    if m < n:
        B = np.hstack((np.zeros((n, n - m)), B))
    return cast(Complex, rq(B, mode="r")[:, -n:])


def to_continuous(A: Real, B: Real, C: Real, D: Real, T: float) -> tuple[Real, Real, Real, Real]:
    """s = (2/T) (z - 1)/(z + 1) of a model without eigenvalues at z = -1: keeps Hankel values and norms."""
    n = len(A)
    inverse = np.linalg.inv(A + np.eye(n))
    gain = 2.0 / np.sqrt(T)
    return (
        np.asarray(2.0 / T * (A - np.eye(n)) @ inverse),
        np.asarray(gain * inverse @ B),
        np.asarray(gain * C @ inverse),
        np.asarray(D - C @ inverse @ B),
    )


def to_sampled(A: Real, B: Real, C: Real, D: Real, T: float) -> tuple[Real, Real, Real, Real]:
    """The inverse of `to_continuous`."""
    n = len(A)
    inverse = np.linalg.inv(2.0 / T * np.eye(n) - A)
    gain = 2.0 / np.sqrt(T)
    return (
        np.asarray((2.0 / T * np.eye(n) + A) @ inverse),
        np.asarray(gain * inverse @ B),
        np.asarray(gain * C @ inverse),
        np.asarray(D + C @ inverse @ B),
    )


def _diagonal(first: Real, second: Real) -> Real:
    n, m = len(first), len(second)
    return np.block([[first, np.zeros((n, m))], [np.zeros((m, n)), second]])


def _scales(model: LinearModel, scales: Mapping[str, float] | None) -> tuple[Real, Real]:
    """Sizes of all inputs and outputs."""
    given = dict(scales or {})
    for name, value in given.items():
        if not value > 0.0:
            raise InputError.single(f"scales.{name}", value, "must be positive", remedy="give the size of the signal")
    u, y = (np.array([given.get(s.name, 1.0) for s in signals]) for signals in (model.inputs, model.outputs))
    known = {s.name for s in (*model.inputs, *model.outputs)}
    unknown = [name for name in given if name not in known]
    if unknown:
        raise InputError.single("scales", unknown[0], "is no input or output", remedy="use their names")
    return u, y
