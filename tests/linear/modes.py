"""What matrices say: oscillations, and the speed from which one of them grows."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from tests.linear.textbook import Matrix

Complex = NDArray[np.complex128]


def oscillations(A: Matrix, slowest: float = 1.0) -> Complex:
    """Eigenvalues above the real axis that are faster than `slowest` [rad/s], from the slowest."""
    values = np.linalg.eigvals(A).astype(np.complex128)
    kept = values[values.imag > slowest]
    return kept[np.argsort(kept.imag)]


def critical_speed(
    A: Callable[[float], Matrix], low: float, high: float, *, step: float = 1.0, within: float = 1e-4
) -> float:
    """The lowest speed [m/s] from which an oscillation grows, by steps and bisection; infinite if none does."""

    def grows(speed: float) -> bool:
        return bool(oscillations(A(speed)).real.max() > 0.0)

    speed = low
    while not grows(speed):
        speed += step
        if speed > high:
            return math.inf
    below, above = speed - step, speed
    while above - below > within:
        middle = 0.5 * (below + above)
        below, above = (below, middle) if grows(middle) else (middle, above)
    return above
