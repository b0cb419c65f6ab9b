"""Loops of a closed-loop model: the gain of one that closes through an actuating signal, and how far it is from
instability."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.linear.model import LinearModel
from klingel.linear.response import Combination, frequency_response

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Margins:
    """How far a loop is from instability.

    phase: least angle that L may lag or lead more [rad], at phase_frequency [Hz]; gain: factor that L may grow by, at
    gain_frequency; distance: least |1 + L|, at distance_frequency. Infinite, with frequency NaN, where there is none.
    """

    gain: float
    gain_frequency: float
    phase: float
    phase_frequency: float
    distance: float
    distance_frequency: float


def loop_gain(
    model: LinearModel, input: str | Combination, total: str | Combination, frequencies: ArrayLike
) -> Complex:
    """L of the loop that closes through an actuating signal, all other loops closed: 1 + L = input / total.

    model: with its controllers; input: what is added to the signal that the controller sends; total: the channel that
    holds both, in the same weights. With u added, the sum is (1 + L)^-1 u. Returns an array over the frequencies [Hz].
    """
    return np.asarray(1.0 / frequency_response(model, input, total, frequencies) - 1.0)


def margins(L: Complex, frequencies: ArrayLike) -> Margins:
    """Margins of an open-loop response over frequencies [Hz], interpolated between neighbours.

    >>> f = np.geomspace(0.01, 10.0, 4001)
    >>> s = 2j * np.pi * f
    >>> found = margins(4.0 / (s + 1.0) ** 3, f)
    >>> round(found.gain, 3), round(2.0 * np.pi * found.gain_frequency, 3), round(found.phase, 3)
    (2.0, 1.732, 0.474)
    """
    f = np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    size, angle = np.log(np.abs(L)), np.unwrap(np.angle(L))
    phases = [(_wrapped(float(np.interp(w, f, angle)) + np.pi), w) for w in _crossings(f, size)]
    turns = np.arange(np.floor(angle.min() / (2.0 * np.pi)) - 1.0, np.ceil(angle.max() / (2.0 * np.pi)) + 1.0)
    opposite = [w for turn in turns for w in _crossings(f, angle - np.pi * (2.0 * turn + 1.0))]
    gains = [(float(np.exp(-np.interp(w, f, size))), w) for w in opposite]
    phase = min(phases, default=(np.inf, np.nan))
    gain = min((each for each in gains if each[0] > 1.0), default=(np.inf, np.nan))
    distance = np.abs(1.0 + L)
    least = int(np.argmin(distance))
    return Margins(gain[0], gain[1], phase[0], phase[1], float(distance[least]), float(f[least]))


def _wrapped(angle: float) -> float:
    """Size of an angle between -pi and pi."""
    return abs((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _crossings(f: Real, value: Real) -> list[float]:
    """Where a function over f changes its sign, interpolated."""
    i = np.flatnonzero(np.sign(value[:-1]) * np.sign(value[1:]) < 0.0)
    share = value[i] / (value[i] - value[i + 1])
    return [float(x) for x in f[i] + share * (f[i + 1] - f[i])]
