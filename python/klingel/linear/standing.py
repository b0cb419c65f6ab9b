"""The response of a linear model at one of its eigenvalues, such as 0 Hz of a vehicle that is free along the track.
It is finite for what does not reach the mode or does not show it; the others are named."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, svd

from klingel.errors import InputError
from klingel.linear.model import LinearModel

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

NIL = 1e-12
"""Singular values of the balanced s I - A below this share of the largest one are zero."""

UNTOUCHED = 1e-9
"""Shares of an input or output in a mode that are rounding."""

DEFECTIVE = 1e-8
"""Cosine of left and right vectors below which the eigenvalue has a chain of vectors, as that of 1/s^2."""


class Standing(NamedTuple):
    """Solutions of (s I - A) x = b near an eigenvalue s0: x = drift/(s - s0) + rest + terms that vanish.

    rest, drift (n, k); growing (p, k): which outputs C x are infinite at s0.
    """

    rest: Complex
    drift: Complex
    growing: NDArray[np.bool_]


def standing(A: Real, C: Real, s: complex, b: Complex) -> Standing:
    """At s0 = s; A: (n, n), C: (p, n), real; b: (n, k).

    With right and left vectors V, W of the eigenvalue (s0 I - A) rest + V a = b and W* rest = 0: a = (W* V)^-1 W* b is
    the share of the mode in b. Without V, where s is no eigenvalue to rounding, this is the plain solution; of a mode
    like 1/s^2, all that it shows and all that reaches it is called growing.

    >>> A, b = np.array([[0.0, 1.0], [0.0, -2.0]]), np.array([[0.0j], [1.0]])  # place and speed of a braked mass
    >>> found = standing(A, np.eye(2), 0.0, b)
    >>> found.growing.ravel(), found.rest[1].real, found.drift[0].real
    (array([ True, False]), array([0.5]), array([0.5]))
    """
    balanced, (scale, _) = matrix_balance(A, permute=False, separate=True)
    n, M = len(A), s * np.eye(len(A)) - balanced
    right, seen = b / scale[:, None], C * scale
    U, h, Vh = svd(M)
    first = int(np.sum(h > NIL * h[0]))
    W, V = U[:, first:], Vh[first:].conj().T
    reached, shown = W.conj().T @ right, seen @ V
    sizes = np.linalg.norm(seen, axis=1)[:, None], np.linalg.norm(right, axis=0)
    if first < n and svd(W.conj().T @ V, compute_uv=False)[-1] < DEFECTIVE:
        growing = (np.abs(shown).max(axis=1)[:, None] > UNTOUCHED * sizes[0]) | (
            np.abs(reached).max(axis=0) > UNTOUCHED * sizes[1]
        )
        return Standing(_in(scale, np.linalg.lstsq(M, right)[0]), np.zeros(b.shape, dtype=np.complex128), growing)
    bordered = np.block([[M, V], [W.conj().T, np.zeros((n - first, n - first))]])
    found = np.linalg.solve(bordered, np.vstack((right, np.zeros((n - first, b.shape[1])))))
    growing = np.abs(shown @ found[n:]) > UNTOUCHED * sizes[0] * sizes[1]
    return Standing(_in(scale, found[:n]), _in(scale, V @ found[n:]), growing)


def _in(scale: NDArray[Any], balanced: NDArray[Any]) -> Complex:
    """Balanced states in their own units."""
    return np.asarray(scale[:, None] * balanced, dtype=np.complex128)


def refuse(model: LinearModel, growing: NDArray[np.bool_], u: Complex, frequency: float) -> None:
    """InputError with the first output and the input of an infinite response; growing: (p, k), u: (m, k)."""
    if not growing.any():
        return
    output, column = np.argwhere(growing)[0]
    names = " with ".join(model.inputs[j].name for j in np.flatnonzero(u[:, column]))
    message = (
        f"is an eigenvalue of the model, where the response of {model.outputs[output].name} to {names} is infinite"
    )
    raise InputError.single(
        "frequency", float(frequency), message, remedy="leave one of the two out, or take another frequency"
    )
