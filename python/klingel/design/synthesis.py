"""Sampled systems as four matrices, their most robust compensator and the norm of the loop that it closes.
Riccati equations by scipy; derivations in docs/theory/design.md."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_continuous_are

from klingel.errors import InputError
from klingel.linear.reduce import to_continuous, to_sampled
from klingel.linear.response import Resolvent

Real = NDArray[np.float64]
System = tuple[Real, Real, Real, Real]
"""A, B, C, D."""

WORSE = 1.1
"""gamma of a loop shaping over the least one: a compensator at the very least would be ill-conditioned."""

POINTS = 2000
"""Frequencies at which a norm is computed again."""


def robust(A: Real, B: Real, C: Real, D: Real, sample_time: float) -> tuple[System, float]:
    """The compensator u = K y (positive feedback) of a sampled plant at 1.1 times the least gamma, and that gamma.

    By the bilinear map, which keeps the norm: Glover and McFarlane's formulas in continuous time.

    >>> plant = tuple(np.array([[v]]) for v in (1.0, 0.01, 1.0, 0.0))  # an integrator: gamma is sqrt(2) at least
    >>> bool(abs(robust(*plant, 0.01)[1] / WORSE - 2.0**0.5) < 0.01)
    True
    """
    A, B, C, D = to_continuous(A, B, C, D, sample_time)
    S, R = np.eye(B.shape[1]) + D.T @ D, np.eye(len(C)) + D @ D.T
    drift = A - B @ np.linalg.solve(S, D.T @ C)
    X = solved(solve_continuous_are, drift, B, C.T @ np.linalg.solve(R, C), S)
    Z = solved(solve_continuous_are, drift.T, C.T, B @ np.linalg.solve(S, B.T), R)
    gamma = WORSE * math.sqrt(1.0 + float(np.abs(np.linalg.eigvals(X @ Z)).max()))
    F = -np.linalg.solve(S, D.T @ C + B.T @ X)
    L = (1.0 - gamma**2) * np.eye(len(A)) + X @ Z
    H = np.asarray(gamma**2 * np.linalg.solve(L.T, Z @ C.T), dtype=np.float64)
    return to_sampled(A + B @ F + H @ (C + D @ F), H, B.T @ X, -D.T, sample_time), gamma


def solved(solver: Callable[..., Any], *matrices: Real, **more: Real) -> Real:
    """The solution of a Riccati equation; errors: InputError where there is none."""
    try:
        return np.asarray(solver(*matrices, **more))
    except np.linalg.LinAlgError:
        remedy = "measure or command what moves there, or give the scenario a strategy that holds it"
        message = "has no solution: something in the vehicle that does not decay is out of reach or not seen"
        raise InputError.single("synthesis", None, message, remedy=remedy) from None


def integrating(k: int, frequency: float | None, sample_time: float) -> System:
    """k times 1 + w/s by the bilinear rule, or one."""
    if frequency is None:
        return np.zeros((0, 0)), np.zeros((0, k)), np.zeros((k, 0)), np.eye(k)
    step = 2.0 * np.pi * frequency * sample_time
    return np.eye(k), np.eye(k), step * np.eye(k), (1.0 + 0.5 * step) * np.eye(k)


def delayed(A: Real, B: Real, C: Real, D: Real) -> System:
    """A sample later at its inputs."""
    n, k = B.shape
    longer = np.block([[A, B], [np.zeros((k, n + k))]])
    return longer, np.vstack((np.zeros((n, k)), np.eye(k))), np.hstack((C, D)), np.zeros((len(C), k))


def series(second: System, first: System) -> System:
    """second after first."""
    A1, B1, C1, D1 = first
    A2, B2, C2, D2 = second
    A = np.block([[A2, B2 @ C1], [np.zeros((len(A1), len(A2))), A1]])
    return A, np.vstack((B2 @ D1, B1)), np.hstack((C2, D2 @ C1)), D2 @ D1


def closed_of(plant: System, K: System) -> Real:
    """States of a plant without direct part and of u = K y."""
    A, B, C, _ = plant
    a, b, c, d = K
    return np.block([[A + B @ d @ C, B @ c], [b @ C, a]])


def norm_of(plant: System, K: System) -> float:
    """Largest singular value of [K; I] (I - P K)^-1 [P I] over all frequencies; the plant has no direct part."""
    z = np.exp(1j * np.append(np.geomspace(1e-6, np.pi, POINTS), [0.0, np.pi]))
    _, B, C, _ = plant
    a, b, c, d = K
    closed = closed_of(plant, K)
    into = np.block([[B, B @ d], [np.zeros((len(a), B.shape[1])), b]])
    out = np.block([[d @ C, c], [C, np.zeros((len(C), len(a)))]])
    through = np.block([[np.zeros((B.shape[1], B.shape[1])), d], [np.zeros((len(C), B.shape[1])), np.eye(len(C))]])
    x = Resolvent.of(closed).solve(z, into.astype(np.complex128))
    return float(np.linalg.svd(np.einsum("in,nfj->fij", out, x) + through, compute_uv=False).max())


def growth_of(A: Real, sample_time: float) -> float:
    """Largest real part of a sampled system's eigenvalues [1/s]."""
    return float(np.log(np.abs(np.linalg.eigvals(A)).max()) / sample_time)
