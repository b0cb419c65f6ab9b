"""Linear critical speed: where the least damped mode of a vehicle loses its damping on straight level track.
A sweep over the speed finds the bracket, Brent's method the root; exact Jacobians make both quick."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from klingel.errors import InputError
from klingel.linear.blocks import eigenvalues, lives
from klingel.linear.model import LinearModel
from klingel.linear.modes import STILL, Mode, modes
from klingel.linear.sweep import Sweep
from klingel.scenario import Scenario
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd

SPEED_RESOLUTION = 1e-3
"""Of a critical speed [m/s]."""

LOWEST = 10.0
"""Where a search for a critical speed begins [m/s]."""

SLOWEST = 0.1
"""Frequency from which an eigenvalue is one of an oscillation that counts [Hz]."""

Outcome = Literal["found", "stable throughout", "unstable at the lowest", "unstable throughout"]


@dataclass(frozen=True, eq=False)
class CriticalSpeed:
    """Where a vehicle becomes unstable, and the sweep that led there.

    outcome: "found", or that it is stable, or unstable, at every speed looked at, or unstable at the lowest of them (an
    edge lies below it, whatever follows above); speed [m/s], frequency [Hz] and mode
    at the edge (without `found`: None, and those of the least damped mode at the speed nearest to the edge);
    speeds (k) [m/s]; growth (k): largest real part of those that count [1/s]; damping (k), frequencies (k) [Hz]: of the
    mode that has it.
    """

    outcome: Outcome
    speed: float | None
    frequency: float
    mode: Mode
    speeds: NDArray[np.float64]
    growth: NDArray[np.float64]
    damping: NDArray[np.float64]
    frequencies: NDArray[np.float64]

    def table(self) -> pd.DataFrame:
        """The sweep as rows: speed [m/s], growth [1/s], damping ratio and frequency [Hz] of the least stable mode."""
        import pandas as pd

        return pd.DataFrame(
            {"speed": self.speeds, "growth": self.growth, "damping": self.damping, "frequency": self.frequencies}
        )


def critical_speed(
    scenario: Scenario,
    *,
    lowest: Quantity = LOWEST,
    highest: Quantity = "120 m/s",
    points: int = 23,
    at: Quantity | None = None,
    controllers: bool = True,
    step: Callable[[int, int], None] | None = None,
) -> CriticalSpeed:
    """The lowest speed at which a mode loses its damping.

    lowest, highest, points: of the sweep that looks for it; at, controllers: as for `klingel.linearise`; step: called
    with how many speeds of the sweep are done and how many there are.
    Errors: InputError for a range that is none, and as `klingel.linearise`.
    """
    first = to_si(lowest, "m/s", key="lowest")
    ends = first, to_si(highest, "m/s", key="highest")
    if not 0.0 < ends[0] < ends[1]:
        raise InputError.single(
            "highest", highest, f"must exceed the lowest speed {ends[0]:g} m/s", remedy="give a range"
        )
    given: object = points
    if not isinstance(given, int) or points < 2:
        raise InputError.single("points", points, "make no sweep", remedy="give a whole number, 2 or more")

    sweep = Sweep(at=at, controllers=controllers)

    def least(speed: float) -> complex:
        return least_stable(sweep(scenario.replace(speed=speed)).model)

    speeds = np.linspace(*ends, points)
    swept = []
    for done, speed in enumerate(speeds, start=1):
        swept.append(least(float(speed)))
        if step is not None:
            step(done, points)
    s = np.array(swept)
    outcome, edge = _edge(speeds, s.real, lambda speed: least(speed).real)
    there = sweep(scenario.replace(speed=edge))
    found = modes(there.model, there.spec, plant=there.plant)
    deciding = least_stable(there.model)
    critical = min(found, key=lambda mode: abs(mode.eigenvalue - deciding))
    return CriticalSpeed(
        outcome,
        edge if outcome == "found" else None,
        critical.frequency,
        critical,
        speeds,
        s.real,
        -s.real / np.abs(s),
        np.abs(s.imag) / (2.0 * np.pi),
    )


def least_stable(model: LinearModel) -> complex:
    """The eigenvalue that decides on stability [1/s], the upper of a pair: the largest real part of all oscillations.

    One that does not oscillate counts only if it grows: slow decay, such as that of the speed hold, hides nothing.
    Free positions and the bare memory of controllers are not looked at.
    """
    s = eigenvalues(model)
    swings = np.abs(s.imag) > 2.0 * np.pi * SLOWEST
    s = s[lives(s, model.sample_time) & (np.abs(s) > STILL) & (swings | (s.real > 0.0))]
    most = complex(s[np.argmax(s.real)])
    return complex(most.real, abs(most.imag))


def _edge(
    speeds: NDArray[np.float64], growth: NDArray[np.float64], growth_at: Callable[[float], float]
) -> tuple[Outcome, float]:
    """Where the growth first becomes positive; without such a place, the end of the sweep nearest to it."""
    positive = growth > 0.0
    if positive[0]:
        return ("unstable throughout" if positive.all() else "unstable at the lowest"), float(speeds[0])
    rises = np.flatnonzero(~positive[:-1] & positive[1:])
    if rises.size == 0:
        return "stable throughout", float(speeds[-1])
    low, high = float(speeds[rises[0]]), float(speeds[rises[0] + 1])
    return "found", float(brentq(growth_at, low, high, xtol=SPEED_RESOLUTION))
