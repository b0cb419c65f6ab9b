"""What a design function gives back: the value found and the loop on its basis,
and beside them what the full vehicle says to it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from klingel.design.check import Check
from klingel.design.limits import Limits, missed
from klingel.design.margins import Margins, Shown
from klingel.scenario import Strategy

if TYPE_CHECKING:
    import pandas as pd

Basis = Literal["plant", "vehicle"]


@dataclass(frozen=True, eq=False)
class Design:
    """A loop that was designed.

    parameter, value: of the strategy, SI; strategy: with it; basis: what it was designed on, plant or vehicle; met:
    whether any value keeps the wanted margins there: without, the value has the largest least disk margin; shown: the
    loop on its basis, one a speed, the least robust one of the vehicle's; full: rows of `klingel.design.margins` on the
    full vehicle, of this kind of loop; check: of all that the strategy does.
    """

    parameter: str
    value: float
    strategy: Strategy
    basis: Basis
    met: bool
    wanted: Limits
    shown: tuple[Shown, ...]
    full: pd.DataFrame
    check: Check

    @property
    def gains(self) -> dict[str, float]:
        """What the strategy takes: parameter to value."""
        return {self.parameter: self.value}

    @property
    def margins(self) -> Margins:
        """On the basis, at the speed with the least disk margin."""
        return min((each.margins for each in self.shown), key=robustness)

    def bode(self) -> pd.DataFrame:
        """The loop on its basis: speed [m/s], frequency [Hz], magnitude [-], phase [rad]."""
        import pandas as pd

        return pd.concat(
            [
                pd.DataFrame(
                    {
                        "speed": each.speed,
                        "frequency": each.frequencies,
                        "magnitude": np.abs(each.response),
                        "phase": np.unwrap(np.angle(each.response)),
                    }
                )
                for each in self.shown
            ],
            ignore_index=True,
        )

    def words(self) -> tuple[str, ...]:
        """The verdict in sentences: on its basis, on the full vehicle, over the grid."""
        m, wanted = self.margins, self.wanted
        asked = f"gain {wanted.gain:g}, phase {math.degrees(wanted.phase):.0f}°, delay {1e3 * wanted.delay:.0f} ms"
        found = f"gain {m.gain:.2f}, phase {math.degrees(m.phase):.0f}°, delay {1e3 * m.delay:.1f} ms"
        where = "the plant" if self.basis == "plant" else "the full vehicle"
        verdict = f"keeps {asked} on {where}" if self.met else f"no value keeps {asked} on {where}"
        told = [f"{self.parameter} = {self.value:.4g}: {verdict}; the worst speed has {found}."]
        for each in self.full.to_dict("records"):
            if short := "; ".join(missed(each, wanted)):
                told.append(f"On the full vehicle {each['loop']} at {3.6 * each['speed']:.0f} km/h: {short}.")
        if len(told) == 1:
            told.append("All loops of the full vehicle keep them.")
        return (*told, *self.check.words())


def robustness(margins: Margins) -> float:
    """Disk margin, below zero for an unstable loop."""
    return margins.disk if margins.stable else -1.0
