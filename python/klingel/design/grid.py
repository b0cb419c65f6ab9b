"""Frequencies that show a loop whole: spread evenly, about every resonance, and denser where L turns quickly.
Crossings and peaks are then searched for between them, so that margins do not depend on a grid."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from klingel.design.loops import Closed

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LOWEST = 2e-3
"""Lowest frequency [Hz]: integrals with time constants of ten seconds and more are seen whole."""

SHORT = 5e-6
"""Of half the sample rate, in sample rates: there bilinear filters have poles of no size, which are rounding."""

SPREAD = 160
"""Frequencies spread evenly over the logarithm."""

SHARP = 0.3
"""Damping ratio below which a pole gets frequencies of its own."""

ABOUT = (0.0, 0.3, 0.8, 2.0)
"""Distances from the frequency of such a pole, in its decay rate."""

TURN = 0.08
"""Chordal distance of neighbours on the sphere of L (of diameter 1) above which another one goes between."""

ROUNDS = 6
"""Of halving."""

ZOOMS = 3
"""Times that a crossing or a peak is looked at closer."""

PIECES = 8
"""Of its surroundings, each time."""


def frequencies(closed: Closed) -> Real:
    """[Hz], to half the sample rate, at the poles of a closed model and between them."""
    highest = (0.5 - SHORT) / closed.sample_time
    s = closed.poles
    s = s[(s.imag > 0.0) & (-s.real < SHARP * np.abs(s))]
    f, width = s.imag / (2.0 * np.pi), np.abs(s.real) / (2.0 * np.pi)
    own = [f + sign * share * width for share in ABOUT for sign in (-1.0, 1.0)]
    together = np.concatenate([np.geomspace(LOWEST, highest, SPREAD), *own])
    return np.unique(together[(together >= LOWEST) & (together <= highest)])


def whole(closed: Closed) -> tuple[Real, Complex]:
    """Frequencies (f) [Hz] and sensitivities (f, k, k) that show all loops."""
    f = frequencies(closed)
    S = closed.sensitivities(f)
    for _ in range(ROUNDS):
        far = np.flatnonzero((_chords(np.diagonal(S, axis1=1, axis2=2)) > TURN).any(axis=1))
        far = far[f[far + 1] > f[far] * (1.0 + 1e-4)]
        if not len(far):
            break
        between = np.sqrt(f[far] * f[far + 1])
        f, S = np.insert(f, far + 1, between), np.insert(S, far + 1, closed.sensitivities(between), axis=0)
    return f, S


def _chords(S: Complex) -> Real:
    """Distances of neighbours on Riemann's sphere: (f - 1, k); L = 1/S - 1."""
    L = 1.0 / S - 1.0
    size = np.sqrt(1.0 + np.abs(L) ** 2)
    return np.asarray(np.abs(np.diff(L, axis=0)) / (size[1:] * size[:-1]))


def crossings(value: Callable[[Real], Real], f: Real, known: Real) -> Real:
    """Where a function of the frequency changes its sign; known: its values at f.

    >>> f = np.array([1.0, 2.0, 4.0])
    >>> crossings(lambda x: x**2 - 3.0, f, f**2 - 3.0).round(6)
    array([1.732051])
    """
    i = np.flatnonzero(np.sign(known[:-1]) * np.sign(known[1:]) < 0.0)
    if not len(i):
        return np.zeros(0)
    x, y = np.stack((f[i], f[i + 1])), np.stack((known[i], known[i + 1]))
    for _ in range(ZOOMS):
        x, y = _between(value, x, y)
        change = np.argmax(np.sign(y[:-1]) * np.sign(y[1:]) <= 0.0, axis=0)
        x, y = _two(x, change), _two(y, change)
    share = np.where(y[0] == y[1], 0.0, y[0] / np.where(y[0] == y[1], 1.0, y[0] - y[1]))
    return np.asarray(x[0] + share * (x[1] - x[0]))


def peak(value: Callable[[Real], Real], f: Real, known: Real) -> tuple[float, float]:
    """The largest value of a function of the frequency, and where; known: its values at f.

    >>> f = np.linspace(0.5, 2.0, 5)
    >>> tuple(round(each, 2) for each in peak(lambda x: 3.0 - (x - 1.2) ** 2, f, 3.0 - (f - 1.2) ** 2))
    (3.0, 1.2)
    """
    most = int(np.argmax(known))
    ends = [max(most - 1, 0), min(most + 1, len(f) - 1)]
    x, y = f[ends][:, None], known[ends][:, None]
    for _ in range(ZOOMS):
        x, y = _between(value, x, y)
        most = int(np.argmax(y[:, 0]))
        ends = [max(most - 1, 0), min(most + 1, len(x) - 1)]
        best = float(y[most, 0]), float(x[most, 0])
        x, y = x[ends], y[ends]
    return best


def _between(value: Callable[[Real], Real], x: Real, y: Real) -> tuple[Real, Real]:
    """Brackets (2, k) with places between their ends, and the values there."""
    inside = x[0] + (x[1] - x[0]) * np.arange(1, PIECES)[:, None] / PIECES
    new = value(inside.ravel()).reshape(inside.shape)
    return np.vstack((x[:1], inside, x[1:])), np.vstack((y[:1], new, y[1:]))


def _two(rows: Real, first: NDArray[np.intp]) -> Real:
    columns = np.arange(rows.shape[1])
    return np.stack((rows[first, columns], rows[first + 1, columns]))
