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
"""A point is far from the smoothed curve, or from the runs beside it, beyond the first [m] and the second times the
scatter. A spike is far from the runs on both sides, a corner lies on at least one of them."""
RUN = 5
"""Points of a run: few, so that a rounded corner does not spoil it."""
WIDTH = 5e-4
WIDTH_POINTS = (5, 10)
"""Widest spike [m], and the least and the most of its points."""
NAMED = 5
"""Most spikes that are named one by one."""


def smoothed(y: Values, z: Values, cutoff: float) -> tuple[Values, Values]:
    """The points moved onto the smooth curve.

    Over the chord length s, each coordinate p(s) becomes the spline f that minimises the integral of (p - f)^2 +
    lambda f''^2 with lambda = (cutoff / (2 pi))^4: a wave of the length L keeps 1/(1 + (cutoff/L)^4) of its height,
    half of it at the cut-off. y, z, cutoff: [m]. Errors: InputError for a cut-off out of range or shorter than two
    steps of the points, and for spikes, all at once; corners and ends are none.

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
    moved = np.hypot(y - new_y, z - new_z)
    far = moved > max(SPIKE_LEAST, SPIKE_TIMES * float(np.median(moved)))
    if far.any():
        # The curve is far from spikes and corners; it may pass near a spike beside a corner.
        spikes, off = _spikes(y, z, np.convolve(far, np.ones(2 * RUN + 1), "same") > 0.0, cutoff)
        if spikes:
            raise InputError(_spike_problems(spikes, y, off))
    return new_y, new_z


def _spikes(y: Values, z: Values, suspect: NDArray[np.bool_], apart: float) -> tuple[list[int], Values]:
    """Places of spikes among suspects, of those closer together than `apart` [m] the farthest off, and how far off.

    A spike is a group of neighbouring points of which each lies off the run before and the run after the group, so
    that a spike of several points does not hide behind its own. At the ends, where one side has no run, it is a point
    off every run of the other side that ends up to a spike's width away: a spike beside it spoils only some of them.
    """
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    step = float(np.median(np.diff(s)))
    width = min(max(WIDTH_POINTS[0], math.floor(WIDTH / step)), WIDTH_POINTS[1])
    before = _off_runs_before(y, z, s, width)
    after = _off_runs_before(y[::-1], z[::-1], s[-1] - s[::-1], width)[:, ::-1]
    limit = max(SPIKE_LEAST, SPIKE_TIMES * float(np.median(np.minimum(before[0], after[0]))))
    both = np.isfinite(before[0]) & np.isfinite(after[0])
    ends = np.where(both, 0.0, np.minimum(before, after).min(axis=0))
    off = np.where(ends > limit, ends, 0.0)
    for size in range(1, width + 1):
        # Row j: the group's j-th points, for every place where a group can begin.
        last = len(y) - size + 1
        group = np.array([np.minimum(before[j, j : j + last], after[size - 1 - j, j : j + last]) for j in range(size)])
        inside = both[:last] & both[size - 1 :]
        for start in np.nonzero(inside & (group > limit).all(axis=0))[0]:
            off[start : start + size] = np.maximum(off[start : start + size], group[:, start])
    off[~suspect] = 0.0
    return [int(i) for i in np.nonzero(off)[0] if off[i] == off[np.abs(s - s[i]) < apart].max()], off


def _off_runs_before(y: Values, z: Values, s: Values, width: int) -> Values:
    """Distance [m] of every point from the parabola through the run that ends 1, 2, ... `width` points before it.

    s: chord length [m]. It is measured across the parabola, as a spike shifts the chord length after it; infinite
    where no run is.
    """
    windows = np.lib.stride_tricks.sliding_window_view(np.arange(len(y)), RUN)
    end = windows[:, -1]
    length = s[end] - s[windows[:, 0]]
    t = (s[windows] - s[end][:, None]) / length[:, None]
    fits = np.linalg.pinv(np.stack([np.ones_like(t), t, t**2], axis=2)) @ np.stack([y[windows], z[windows]], axis=2)
    off = np.full((width, len(y)), np.inf)
    for ahead in range(1, width + 1):
        point = end[:-ahead] + ahead
        t_point = ((s[point] - s[point - ahead]) / length[:-ahead])[:, None]
        c0, c1, c2 = np.moveaxis(fits[:-ahead], 1, 0)
        away = np.stack([y[point], z[point]], axis=1) - (c0 + t_point * (c1 + t_point * c2))
        along = c1 + 2.0 * t_point * c2
        across = away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0]
        off[ahead - 1, point] = np.abs(across) / np.hypot(along[:, 0], along[:, 1])
    return off


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
