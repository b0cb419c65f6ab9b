"""Smoothing of measured profiles: a cubic spline along the arc that gives up closeness for small curvature changes.
It acts as a filter whose cut-off wavelength is chosen; single points far off are refused, not averaged in."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from klingel.errors import InputError, Problem

Values = NDArray[np.float64]

CUTOFF = (2e-4, 0.02)
"""Cut-off wavelengths that make sense on a profile [m]."""
SPIKE_LEAST = 3e-5
SPIKE_TIMES = 8.0
"""A point is a spike if it lies farther from the smoothed curve [m] than the first and the second times the scatter."""
NAMED = 5
"""Most spikes that are named one by one."""


def smoothed(y: Values, z: Values, cutoff: float) -> tuple[Values, Values]:
    """The points moved onto the smooth curve.

    Over the chord length s, each coordinate p(s) becomes the spline f that minimises the integral of (p - f)^2 +
    lambda f''^2 with lambda = (cutoff / (2 pi))^4: a wave of the length L keeps 1/(1 + (cutoff/L)^4) of its height,
    half of it at the cut-off. y, z, cutoff: [m]. Errors: InputError for a cut-off out of range or shorter than two
    steps of the points, and for spikes, all at once.

    >>> s = np.linspace(-0.03, 0.03, 301)
    >>> wave = 1e-5 * np.sin(2 * np.pi * s / 0.003)
    >>> y, z = smoothed(s, wave, 0.003)
    >>> bool(abs(z[100:200].max() - 0.5e-5) < 0.02e-5)
    True
    """
    from scipy.interpolate import make_smoothing_spline

    steps = np.hypot(np.diff(y), np.diff(z))
    problems = list(_cutoff_problems(cutoff, float(np.median(steps))))
    if problems:
        raise InputError(problems)
    # In units of the cut-off the numbers are near one, and lambda is the same for all.
    s = np.concatenate([[0.0], np.cumsum(steps)]) / cutoff
    weights = np.gradient(s)
    strength = (2.0 * math.pi) ** -4
    new_y, new_z = (np.asarray(make_smoothing_spline(s, p / cutoff, weights, strength)(s)) * cutoff for p in (y, z))
    off = np.hypot(y - new_y, z - new_z)
    limit = max(SPIKE_LEAST, SPIKE_TIMES * float(np.median(off)))
    # A spike also bends the curve beside it: only the farthest point within a cut-off is named.
    spikes = [int(i) for i in np.nonzero(off > limit)[0] if off[i] == off[np.abs(s - s[i]) < 1.0].max()]
    if spikes:
        raise InputError(_spike_problems(spikes, y, off))
    return new_y, new_z


def _cutoff_problems(cutoff: float, step: float) -> list[Problem]:
    if not CUTOFF[0] <= cutoff <= CUTOFF[1]:
        return [Problem("cutoff", cutoff, f"[m] is outside {CUTOFF[0]:g} to {CUTOFF[1]:g}", 'give for example "3 mm"')]
    if cutoff < 2.0 * step:
        remedy = "give a longer one, or leave the points as they are"
        return [Problem("cutoff", cutoff, f"[m] is shorter than two steps of the points ({step:.2g} m)", remedy)]
    return []


def _spike_problems(spikes: list[int], y: Values, off: Values) -> list[Problem]:
    remedy = "remove it, or measure again"
    named = [
        Problem(f"point {i + 1}", float(y[i]), f"is a spike of {off[i] * 1e3:.2g} mm", remedy) for i in spikes[:NAMED]
    ]
    if len(spikes) > NAMED:
        named.append(Problem("points", len(spikes), "are spikes in all", remedy))
    return named
