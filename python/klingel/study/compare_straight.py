"""Whether a strategy is stable on straight track: the least damped mode of the whole vehicle with its controllers.
Linear models of the full vehicle, sampled controllers and delays included; nothing is simplified."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from klingel.linear.critical import SLOWEST
from klingel.linear.modes import STILL, Mode, modes

if TYPE_CHECKING:
    from klingel.study.compare_cases import Contender

COLUMNS = ("strategy", "speed_kmh", "stable", "damping", "frequency_Hz", "mode")
"""Of the table; `stable` is `yes`, `no` or `unknown`; damping ratio, frequency and name are those of the worst mode."""

Row = dict[str, float | str]


def on_straight(contender: Contender, speeds: Iterable[float]) -> list[Row]:
    """One row a speed [m/s], columns `COLUMNS`; where there is no linear model, `mode` has the reason."""
    return [_row(contender, speed) for speed in speeds]


def _row(contender: Contender, speed: float) -> Row:
    head: Row = {"strategy": contender.name, "speed_kmh": round(3.6 * speed, 6)}
    try:
        worst = least_damped(modes(contender.straight(speed)))
    except Exception as error:  # whatever a user's strategy does
        return head | {"stable": "unknown", "damping": float("nan"), "frequency_Hz": float("nan"), "mode": str(error)}
    return head | {
        "stable": "no" if worst.damping < 0.0 else "yes",
        "damping": worst.damping,
        "frequency_Hz": worst.frequency,
        "mode": worst.name,
    }


def least_damped(found: Iterable[Mode]) -> Mode:
    """The mode that decides: oscillations from 0.1 Hz on, and all that grows; slow decay hides nothing."""
    counted = [
        mode
        for mode in found
        if abs(mode.eigenvalue) > STILL and (mode.frequency > SLOWEST or mode.eigenvalue.real > 0.0)
    ]
    return min(counted, key=lambda mode: mode.damping)
