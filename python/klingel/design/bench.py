"""What a page on a design shows, all at once: margins at several speeds and the check over a grid,
and of every kind of loop the worst one with its responses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.design.check import CONICITIES, FRICTIONS, Check, check
from klingel.design.grid import whole
from klingel.design.limits import judged
from klingel.design.loops import loops
from klingel.design.margins import COLUMNS, Shown, margins_of_all, row
from klingel.linear.sweep import Sweep
from klingel.scenario import Scenario
from klingel.track.cases import perez2004
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Bench:
    """A strategy on the bench.

    scenario: examined; table: of `klingel.design.margins` with the column `missed`; worst: kind of loop to the one with
    the least disk margin at any speed, shown at every speed; check: over speed, conicity, friction and curves.
    """

    scenario: Scenario
    table: pd.DataFrame
    worst: dict[str, tuple[Shown, ...]]
    check: Check


def examine(
    scenario: Scenario,
    *,
    speeds: Sequence[Quantity] | None = None,
    at: Quantity | None = None,
    conicities: Sequence[float | None] = CONICITIES,
    frictions: Sequence[float] = FRICTIONS,
    step: Callable[[str], None] = lambda what: None,
) -> Bench:
    """Margins of all loops of a scenario's strategy at speeds, and where it is stable.

    speeds: None for those of the five curves of the study; at: place on the scenario's track [m] for the margins, None
    for straight level track; conicities, frictions: of `klingel.design.check`; step: told what comes next.
    Errors: as `klingel.linearise`.
    """
    import pandas as pd

    sweep = Sweep(at=at)
    rows: list[dict[str, object]] = []
    shown: dict[str, list[Shown]] = {}
    kinds: dict[str, str] = {}
    fast = [case.speed for case in perez2004()] if speeds is None else [to_si(v, "m/s", key="speeds") for v in speeds]
    for speed in fast:
        step(f"margins at {3.6 * speed:.0f} km/h")
        found = loops(sweep(scenario.replace(speed=speed)).model)
        f, S = whole(found[0].closed) if found else (np.zeros(0), np.zeros((0, 0, 0), dtype=np.complex128))
        for loop, edge in zip(found, margins_of_all(found), strict=True):
            rows.append(row(loop, edge))
            L = 1.0 / S[:, loop.index, loop.index] - 1.0
            kinds[loop.name] = loop.kind
            shown.setdefault(loop.name, []).append(Shown(loop.name, speed, f, L, edge))
    step("stability over speed, conicity and friction")
    table = pd.DataFrame(rows, columns=["loop", "kind", "speed", *COLUMNS])
    return Bench(
        scenario=scenario,
        table=judged(scenario, table),
        worst=_worst(shown, kinds),
        check=check(scenario, speeds=fast, conicities=conicities, frictions=frictions),
    )


def _worst(shown: dict[str, list[Shown]], kinds: dict[str, str]) -> dict[str, tuple[Shown, ...]]:
    """Of every kind the loop with the least disk margin anywhere; an unstable one is the worst."""
    chosen: dict[str, tuple[float, tuple[Shown, ...]]] = {}
    for name, each in shown.items():
        least = min(s.margins.disk if s.margins.stable else -np.inf for s in each)
        kind = kinds[name]
        if kind not in chosen or least < chosen[kind][0]:
            chosen[kind] = least, tuple(each)
    return {kind: group for kind, (_, group) in chosen.items()}
