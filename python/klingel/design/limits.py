"""Margins that a loop of the library's strategies shall have on the full vehicle, and which of them are missed.
The figures are this project's own choice; see docs/theory/design.md for what they are worth."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.scenario import Scenario

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd


@dataclass(frozen=True)
class Limits:
    """Least margins: gain (factor), phase [rad], delay [s]."""

    gain: float = 2.0
    phase: float = 0.0
    delay: float = 0.0


STEERING = Limits(gain=2.0, delay=50e-3)
MOTORS = Limits(gain=2.0, phase=math.radians(45.0), delay=10e-3)
OTHERS = Limits(gain=2.0, phase=math.radians(30.0))

DATABASE = Limits(gain=2.0)
SLOW_DATABASE = Limits(gain=1.6)
"""Of steering by a curvature database, above `DATABASE_SPEED` and up to it: it has no gyro to lean on."""

DATABASE_SPEED = 31.0
"""[m/s]"""


def limits(scenario: Scenario, kind: str, speed: float) -> Limits:
    """Of a kind of loop of a scenario's strategy at a speed [m/s].

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=30.0, control=kl.control.SolidLike())
    >>> limits(scenario, "steering", 30.0)
    Limits(gain=2.0, phase=0.0, delay=0.05)
    """
    if kind == "motors":
        return MOTORS
    if kind not in ("steering", "secondary"):
        return OTHERS
    if getattr(scenario.control, "curvature", None) == "database":
        return SLOW_DATABASE if speed <= DATABASE_SPEED else DATABASE
    return STEERING


def missed(row: Mapping[Any, Any], wanted: Limits) -> Iterator[str]:
    """What a row of `klingel.design.margins` falls short of, in words; nothing where it keeps the limits.

    >>> list(missed({"stable": True, "gain": 1.5, "phase": 1.0, "delay": 0.1}, STEERING))
    ['gain 1.50 of 2']
    """
    if not row["stable"]:
        yield "unstable"
        return
    if row["gain"] < wanted.gain:
        yield f"gain {row['gain']:.2f} of {wanted.gain:g}"
    if row["phase"] < wanted.phase:
        yield f"phase {math.degrees(row['phase']):.0f}° of {math.degrees(wanted.phase):.0f}°"
    if row["delay"] < wanted.delay:
        yield f"delay {1e3 * row['delay']:.1f} ms of {1e3 * wanted.delay:g} ms"


def judged(scenario: Scenario, table: pd.DataFrame) -> pd.DataFrame:
    """A table of `klingel.design.margins` with the column `missed`: what falls short of the limits, in words."""
    rows = table.to_dict("records")
    words = ["; ".join(missed(row, limits(scenario, row["kind"], row["speed"]))) for row in rows]
    return table.assign(missed=words)
