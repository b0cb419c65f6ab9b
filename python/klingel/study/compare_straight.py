"""Whether a strategy is stable on straight track, and how far from its edge: least damped mode, margins of its loops.
Linear models of the full vehicle, sampled controllers and delays included; nothing is simplified."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.design.loops import loops
from klingel.design.margins import Margins, margins_of_all
from klingel.linear.blocks import eigenvalues
from klingel.linear.critical import SLOWEST
from klingel.linear.modes import STILL, Mode, modes
from klingel.linear.sensitivity import FELT
from klingel.linear.sweep import Linearised, Sweep

if TYPE_CHECKING:
    from klingel.study.compare_cases import Contender

COLUMNS = ("strategy", "speed_kmh", "stable", "growth_per_s", "damping", "frequency_Hz", "mode")
"""Of the table; `stable` is `yes`, `no` or `unknown`; all behind it are of the worst mode."""

MARGINS = ("strategy", "speed_kmh", "kind", "gain_margin", "phase_margin_deg", "delay_margin_ms")
"""Of the table of margins: the least of all loops of a kind, each opened alone (`klingel.design.margins`)."""

CHANGED = 1e-3
"""Relative distance to every eigenvalue of the vehicle alone from which one is the controllers' doing."""

Row = dict[str, float | str]


@dataclass(frozen=True)
class Straight:
    """One strategy on straight track: rows with the columns `COLUMNS` and `MARGINS`."""

    stability: list[Row]
    margins: list[Row]


def on_straight(contender: Contender, speeds: Iterable[float]) -> Straight:
    """At several speeds [m/s]; where there is no linear model, `mode` has the reason, and there are no margins."""
    stability, margins = [], []
    for speed in speeds:
        head: Row = {"strategy": contender.name, "speed_kmh": round(3.6 * speed, 6)}
        try:
            made = Sweep()(contender.straight(speed))
            stability.append(head | _stability(least_damped(made)))
            margins += [head | row for row in _margins(made)]
        except Exception as error:  # whatever a user's strategy does
            none = dict.fromkeys(("growth_per_s", "damping", "frequency_Hz"), float("nan"))
            stability.append(head | {"stable": "unknown", **none, "mode": str(error)})
    return Straight(stability, margins)


def _stability(worst: Mode) -> Row:
    return {
        "stable": "no" if worst.damping < 0.0 else "yes",
        "growth_per_s": worst.eigenvalue.real,
        "damping": worst.damping,
        "frequency_Hz": worst.frequency,
        "mode": worst.name,
    }


def _margins(made: Linearised) -> list[Row]:
    """The least margins of every kind of loop; none where the closed loop is unstable, as it has none."""
    found = loops(made.model)
    kinds: dict[str, list[Margins]] = {}
    for loop, margins in zip(found, margins_of_all(found), strict=True):
        if margins.stable:
            kinds.setdefault(loop.kind, []).append(margins)
    return [
        {
            "kind": kind,
            "gain_margin": min(m.gain for m in each),
            "phase_margin_deg": math.degrees(min(m.phase for m in each)),
            "delay_margin_ms": 1e3 * min(m.delay for m in each),
        }
        for kind, each in kinds.items()
    ]


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
