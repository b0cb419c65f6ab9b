"""Filters and statistics of sampled signals, as EN 14363 uses them.
Pure functions of one array and its sample interval; nothing here knows a vehicle."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, sosfiltfilt

from klingel.errors import InputError

Signal = NDArray[np.float64]
Mask = NDArray[np.bool_]

LOW_PASS_CORNER = 20.0
"""Corner frequency of EN 14363 for wheel-rail forces [Hz]."""

SLIDING_LENGTH = 2.0
"""Length of EN 14363's sliding mean for Y/Q [m]."""

# Each of two passes of a second-order Butterworth with this corner loses 1.5 dB at the nominal corner.
_PASS_CORNER = LOW_PASS_CORNER / (np.sqrt(2.0) - 1.0) ** 0.25


def low_pass(signal: Signal, interval: float) -> Signal:
    """Low-pass a signal at 20 Hz, fourth order, without a shift in time.

    EN 14363 asks for -3 dB at 20 Hz and at least 24 dB per octave and leaves the phase open. Recorded signals are
    filtered here as test reports do it: a second-order Butterworth forwards and backwards, its corner raised so that
    the two passes together have -3 dB at 20 Hz. A maximum then stays where it happened, and the overshoot behind a
    ramp's end is that of the vehicle rather than of a causal filter.

    Args:
        signal: samples at a constant interval, any unit.
        interval: sample interval [s].

    Returns:
        The filtered signal, same length and unit.

    Raises:
        InputError: the sample interval is too long for a 20 Hz filter.

    Source: EN 14363 (values as recalled in the project's data, unverified).

    Example:
        >>> import numpy as np
        >>> time = np.arange(0.0, 4.0, 1e-3)
        >>> corner = low_pass(np.sin(2 * np.pi * 20.0 * time), 1e-3)
        >>> round(float(np.max(np.abs(corner[1000:3000]))), 2)
        0.71
    """
    if not 0.0 < interval < 0.25 / LOW_PASS_CORNER:
        raise InputError.single(
            "interval",
            interval,
            "a 20 Hz filter needs a sample interval below 0.0125 s",
            remedy="record the run at 200 Hz or more",
        )
    pad = min(len(signal) - 1, round(0.2 / interval))
    return np.asarray(sosfiltfilt(_sections(interval), signal, padlen=pad), dtype=np.float64)


@lru_cache(maxsize=8)
def _sections(interval: float) -> Signal:
    """The second-order section of one pass; every channel of a run asks for the same."""
    return np.asarray(butter(2, _PASS_CORNER, fs=1.0 / interval, output="sos"), dtype=np.float64)


def sliding_mean(signal: Signal, interval: float, speed: float) -> Signal:
    """Mean over 2 m of travel, centred, one value for every sample.

    Args:
        signal: samples at a constant interval, any unit.
        interval: sample interval [s].
        speed: running speed [m/s], positive.

    Returns:
        The averaged signal, same length and unit; at both ends the edge value is continued.

    Raises:
        InputError: the speed is not positive.

    Source: EN 14363, sliding mean of Y/Q (window 2 m).

    Example:
        >>> import numpy as np
        >>> pulse = np.zeros(1001)
        >>> pulse[500] = 1.0
        >>> round(float(sliding_mean(pulse, 1e-3, 20.0).max()), 4)  # 0.1 s, that is 101 samples
        0.0099
    """
    if not speed > 0.0:
        raise InputError.single(
            "speed", speed, "a mean over travel needs a positive speed [m/s]", remedy="assess a run that moves"
        )
    half = round(0.5 * SLIDING_LENGTH / (speed * interval))
    return np.asarray(uniform_filter1d(signal, 2 * half + 1, mode="nearest"), dtype=np.float64)


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Unbroken stretches of a condition, as (first sample, one past the last sample).

    Args:
        mask: true where the condition holds.

    Returns:
        The stretches in order of time.

    Example:
        >>> import numpy as np
        >>> runs(np.array([False, True, True, False, True]))
        [(1, 3), (4, 5)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(begin), int(end)) for begin, end in zip(edges[::2], edges[1::2], strict=True)]


def longer_than(mask: Mask, interval: float, duration: float) -> list[tuple[int, int]]:
    """The stretches of a condition that last longer than a duration.

    Args:
        mask: true where the condition holds.
        interval: sample interval [s].
        duration: least duration [s]; a stretch of n samples lasts n intervals.

    Returns:
        Stretches as (first sample, one past the last sample).

    Example:
        >>> import numpy as np
        >>> longer_than(np.array([True, False, True, True, True]), 0.05, 0.1)
        [(2, 5)]
    """
    return [(begin, end) for begin, end in runs(mask) if (end - begin) * interval > duration * (1.0 + 1e-9)]
