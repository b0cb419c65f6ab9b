"""Whether a strategy is stable on straight track: the least damped mode of the whole vehicle with its controllers.
Linear models of the full vehicle, sampled controllers and delays included; nothing is simplified."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from klingel.linear.blocks import eigenvalues
from klingel.linear.critical import SLOWEST
from klingel.linear.modes import STILL, Mode, modes
from klingel.linear.sensitivity import FELT
from klingel.linear.sweep import Linearised, Sweep

if TYPE_CHECKING:
    from klingel.study.compare_cases import Contender

COLUMNS = ("strategy", "speed_kmh", "stable", "growth_per_s", "damping", "frequency_Hz", "mode")
"""Of the table; `stable` is `yes`, `no` or `unknown`; all behind it are of the worst mode."""

CHANGED = 1e-3
"""Relative distance to every eigenvalue of the vehicle alone from which one is the controllers' doing."""

Row = dict[str, float | str]


def on_straight(contender: Contender, speeds: Iterable[float]) -> list[Row]:
    """One row a speed [m/s], columns `COLUMNS`; where there is no linear model, `mode` has the reason."""
    return [_row(contender, speed) for speed in speeds]


def _row(contender: Contender, speed: float) -> Row:
    head: Row = {"strategy": contender.name, "speed_kmh": round(3.6 * speed, 6)}
    try:
        worst = least_damped(Sweep()(contender.straight(speed)))
    except Exception as error:  # whatever a user's strategy does
        none = dict.fromkeys(("growth_per_s", "damping", "frequency_Hz"), float("nan"))
        return head | {"stable": "unknown", **none, "mode": str(error)}
    return head | {
        "stable": "no" if worst.damping < 0.0 else "yes",
        "growth_per_s": worst.eigenvalue.real,
        "damping": worst.damping,
        "frequency_Hz": worst.frequency,
        "mode": worst.name,
    }


def least_damped(made: Linearised) -> Mode:
    """The mode that decides: of all that grow, and of the oscillations from 0.1 to 20 Hz that controllers change.

    Without controllers, of all these oscillations. Slow decay hides nothing; the ringing of wheels on their contact
    springs counts only where it grows; bounce and pitch, which no steering moves, are the same for every strategy.
    """
    alone = eigenvalues(made.plant)

    def counts(mode: Mode) -> bool:
        s = mode.eigenvalue
        if abs(s) > STILL and s.real > 0.0:
            return True
        changed = made.model.sample_time is None or np.abs(alone - s).min() > CHANGED * abs(s)
        return SLOWEST < mode.frequency < FELT and bool(changed)

    found = modes(made.model, made.spec, plant=made.plant)
    return min(filter(counts, found), key=lambda mode: mode.damping)
