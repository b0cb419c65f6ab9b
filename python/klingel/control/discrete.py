"""Continuous filters and their discrete second-order sections by the bilinear rule.
Each is prewarped at its own frequency, so that notches and corners sit where they are designed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from klingel.errors import InputError


@dataclass(frozen=True)
class Section:
    """(b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2), one sample apart."""

    b: tuple[float, float, float]
    a: tuple[float, float]

    def response(self, omega: np.ndarray, sample_time: float) -> np.ndarray:
        """Frequency response at `omega` [rad/s]."""
        back = np.exp(-1j * np.asarray(omega) * sample_time)
        b, a = self.b, self.a
        return np.asarray((b[0] + b[1] * back + b[2] * back**2) / (1.0 + a[0] * back + a[1] * back**2))


def bilinear(
    numerator: tuple[float, float, float],
    denominator: tuple[float, float, float],
    *,
    sample_time: float,
    prewarp: float | None = None,
) -> Section:
    """The section of (n0 + n1 s + n2 s^2)/(d0 + d1 s + d2 s^2), coefficients lowest power first.

    prewarp: frequency [rad/s] at which both responses agree exactly. Errors: InputError for one that is not between
    zero and half the sample rate.

    >>> lag = bilinear((1.0, 0.0, 0.0), (1.0, 0.1, 0.0), sample_time=1e-3)
    >>> round(sum(lag.b) / (1.0 + sum(lag.a)), 12)   # the same steady state
    1.0
    """
    if prewarp is not None and not 0.0 < prewarp * sample_time < math.pi * (1.0 - 1e-9):
        remedy = f"give less than {0.5 / sample_time:g} Hz, half the sample rate, or sample faster"
        message = "is no frequency of a filter sampled like this [Hz]"
        raise InputError.single("frequency", prewarp / (2.0 * math.pi), message, remedy=remedy)
    k = 2.0 / sample_time if prewarp is None else prewarp / math.tan(0.5 * prewarp * sample_time)
    b = _substitute(numerator, k)
    a = _substitute(denominator, k)
    return Section(b=(b[0] / a[0], b[1] / a[0], b[2] / a[0]), a=(a[1] / a[0], a[2] / a[0]))


def _substitute(c: tuple[float, float, float], k: float) -> tuple[float, float, float]:
    """c0 + c1 s + c2 s^2 with s = k (1 - 1/z)/(1 + 1/z), times (1 + 1/z)^2, by powers of 1/z."""
    c0, c1, c2 = c[0], c[1] * k, c[2] * k * k
    return (c0 + c1 + c2, 2.0 * (c0 - c2), c0 - c1 + c2)


def transfer_function(
    numerator: Sequence[float],
    denominator: Sequence[float],
    *,
    sample_time: float,
    prewarp: float | None = None,
) -> list[Section]:
    """The sections of a continuous transfer function of any order, coefficients highest power first as in scipy.

    prewarp: frequency [rad/s] at which both responses agree exactly. Errors: InputError for one with more zeros than
    poles, or with a pole at s = 0.

    >>> sections = transfer_function([1.0], [1e-3, 0.02, 0.2, 1.0], sample_time=1e-3)
    >>> len(sections), round(math.prod(sum(s.b) / (1.0 + sum(s.a)) for s in sections), 9)
    (2, 1.0)
    """
    from scipy.signal import tf2zpk, zpk2sos

    n, d = (np.trim_zeros(np.asarray(c, dtype=float), "f") for c in (numerator, denominator))
    if len(n) == 0:
        raise InputError.single("numerator", list(numerator), "is nil", remedy="leave the filter out")
    if len(n) > len(d):
        remedy = "give at least as many poles as zeros, coefficients highest power first"
        raise InputError.single("denominator", list(denominator), "is of a lower order", remedy=remedy)
    if d[-1] == 0.0:
        remedy = "take the integral out of it and use a `pi` block"
        raise InputError.single("denominator", list(denominator), "has a pole at s = 0", remedy=remedy)
    zeros, poles, gain = tf2zpk(n, d)
    rows = zpk2sos(zeros, poles, gain, pairing="minimal", analog=True).tolist()
    sections = (((b0, b1, b2), (a0, a1, a2)) for b2, b1, b0, a2, a1, a0 in rows)
    return [bilinear(b, a, sample_time=sample_time, prewarp=prewarp) for b, a in sections]


def low_pass(frequency: float, *, sample_time: float, damping: float = 0.7) -> Section:
    """Second-order low-pass with its corner at `frequency` [Hz]."""
    w = 2.0 * math.pi * frequency
    return bilinear((w * w, 0.0, 0.0), (w * w, 2.0 * damping * w, 1.0), sample_time=sample_time, prewarp=w)


def high_pass(frequency: float, *, sample_time: float, damping: float = 0.7) -> Section:
    """Second-order high-pass with its corner at `frequency` [Hz]."""
    w = 2.0 * math.pi * frequency
    return bilinear((0.0, 0.0, 1.0), (w * w, 2.0 * damping * w, 1.0), sample_time=sample_time, prewarp=w)


def slope_low_pass(frequency: float, *, sample_time: float, damping: float = 0.7) -> Section:
    """The time derivative behind a second-order low-pass with its corner at `frequency` [Hz]."""
    w = 2.0 * math.pi * frequency
    return bilinear((0.0, w * w, 0.0), (w * w, 2.0 * damping * w, 1.0), sample_time=sample_time, prewarp=w)


def lead(zero: float, pole: float, *, sample_time: float) -> Section:
    """(1 + zero s)/(1 + pole s), both time constants in s."""
    return bilinear((1.0, zero, 0.0), (1.0, pole, 0.0), sample_time=sample_time)


def notch(frequency: float, *, depth: float, width: float, sample_time: float) -> Section:
    """A notch at `frequency` [Hz]: gain `depth` there, `width` the damping ratio of its poles."""
    w = 2.0 * math.pi * frequency
    numerator = (w * w, 2.0 * depth * width * w, 1.0)
    return bilinear(numerator, (w * w, 2.0 * width * w, 1.0), sample_time=sample_time, prewarp=w)
