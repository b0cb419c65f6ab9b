"""Whether a strategy holds on the full vehicle: eigenvalues over speed, conicity and friction, and in curves.
Every design is checked this way by itself, and says where it fails in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from klingel.design.loops import of_model
from klingel.design.margins import COLUMNS, margins_of_all, row
from klingel.errors import SimulationError
from klingel.linear.blocks import eigenvalues, lives
from klingel.linear.model import LinearModel
from klingel.linear.modes import modes
from klingel.linear.parameters import CONICITY, replace
from klingel.linear.steady import UNSTABLE
from klingel.linear.sweep import Linearised, Sweep
from klingel.scenario import Scenario
from klingel.track.cases import Case, perez2004
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd

Row = dict[str, Any]

CONICITIES = (None, 0.05, 0.2, 0.4)
"""Of the check: None stands for the scenario's own profiles, numbers for cones."""

FRICTIONS = (0.3, 0.5)

SLOWEST = 0.1
"""Frequency from which an eigenvalue is one of an oscillation that counts [Hz]."""

STEEP = 0.35
"""Conicity of cones from which the root of the flange is met at the middle of standard gauge already."""

WIDER = 5e-3
"""By which the gauge is widened for those [m]."""

NO_STEADY_STATE = "no steady state"
"""How the core says that it found none; whatever else it refuses is no matter of speed or friction."""

WORDS = 6
"""Places of failure that are told one by one."""


@dataclass(frozen=True, eq=False)
class Check:
    """What a strategy did on the full linear vehicle, everywhere it was looked at.

    table: one row a place: speed [m/s]; radius of the curve [m], infinite on straight track; conicity, NaN for the
    scenario's own profiles; friction; growth [1/s], the largest real part of the eigenvalues; damping, the least ratio
    of an oscillation, and its frequency [Hz]; outcome: stable, unstable, or no steady state.
    worst: the least stable mode by name, such as "bogie hunting"; margins: rows of `klingel.design.margins` at the same
    places, None where they were not asked for.
    """

    name: str
    table: pd.DataFrame
    worst: str
    margins: pd.DataFrame | None = None

    @property
    def stable(self) -> bool:
        """Whether it is stable everywhere."""
        return bool((self.table["outcome"] == "stable").all())

    @property
    def failures(self) -> pd.DataFrame:
        """Rows that are not stable, the worst first."""
        return self.table[self.table["outcome"] != "stable"].sort_values("growth", ascending=False)

    def words(self) -> tuple[str, ...]:
        """The verdict: a sentence on all, then the worst failures."""
        failed, count = self.failures, len(self.table)
        if not len(failed):
            least = self.table.sort_values("damping").iloc[0]
            told = f"least damping {100.0 * least['damping']:.1f} % at {least['frequency']:.2f} Hz ({self.worst})"
            return (f"{self.name} is stable at all {count} places; {told} {place(least)}.",)
        grows = f", the fastest growing mode is its {self.worst}" if (failed["outcome"] == "unstable").any() else ""
        first = f"{self.name} fails at {len(failed)} of {count} places{grows}."
        return (first, *(_failure(each) for _, each in failed.head(WORDS).iterrows()))


def place(row: pd.Series[Any]) -> str:
    """Where a row of the table is, in words."""
    wheels = "" if math.isnan(row["conicity"]) else f", conicity {row['conicity']:g}"
    track = "" if math.isinf(row["radius"]) else f" in R = {row['radius']:.0f} m"
    return f"at {3.6 * row['speed']:.0f} km/h{track}{wheels}, friction {row['friction']:g}"


def _failure(row: pd.Series[Any]) -> str:
    if row["outcome"] == "no steady state":
        return f"No steady state {place(row)}."
    return f"Unstable {place(row)}: grows with {row['growth']:.2g} 1/s at {row['frequency']:.2f} Hz."


def check(
    scenario: Scenario,
    *,
    speeds: Sequence[Quantity] | None = None,
    conicities: Sequence[float | None] = CONICITIES,
    frictions: Sequence[float] = FRICTIONS,
    curves: Sequence[Case] | None = None,
    margins: bool = False,
    linearised: Callable[[float | None], Callable[[Scenario], Linearised]] = lambda at: Sweep(at=at),
) -> Check:
    """The closed loop of the full vehicle over speed x conicity x friction on straight track, and in curves x friction.

    speeds: None for those of the five curves of the study; conicities: of wheels as cones, None for the profiles as
    they are; curves: with their own speeds, None for the five of the study, () for none; cones have no flange, so
    curves are run with the scenario's own profiles; margins: also those of every loop at every place, at ten times the
    cost; linearised: makes what linearises scenarios at a place on their track, such as with a compensator around them.
    Each new conicity compiles its contact table first, which takes some seconds and is kept. Errors: InputError.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=30.0, control=kl.control.SolidLike())
    >>> check(scenario, speeds=["108 km/h"], conicities=[None], curves=()).stable
    True
    """
    import pandas as pd

    cases = perez2004() if curves is None else tuple(curves)
    fast = [case.speed for case in perez2004()] if speeds is None else [to_si(v, "m/s", key="speeds") for v in speeds]
    rows: list[Row] = []
    edges: list[dict[str, object]] = []
    worst: tuple[float, Linearised | None] = (-math.inf, None)
    for here, made in _places(scenario, fast, conicities, frictions, cases, linearised):
        found: Row = {"growth": math.inf, "damping": math.nan, "frequency": math.nan, "outcome": "no steady state"}
        if made is not None:
            found = stability(made.model)
            severity = float(found["growth"]) if found["outcome"] == "unstable" else -float(found["damping"])
            if severity > worst[0]:
                worst = severity, made
            if margins:
                loops = of_model(made.model)
                edges += [here | row(loop, m) for loop, m in zip(loops, margins_of_all(loops), strict=True)]
        rows.append(here | found)
    columns = ["speed", "radius", "conicity", "friction", "growth", "damping", "frequency", "outcome"]
    return Check(
        name="the vehicle without control" if scenario.control is None else type(scenario.control).__name__,
        table=pd.DataFrame(rows, columns=columns),
        worst="" if worst[1] is None else _mode(worst[1]),
        margins=pd.DataFrame(edges, columns=[*columns[:4], "loop", "kind", *COLUMNS]) if margins else None,
    )


def _places(
    scenario: Scenario,
    speeds: Sequence[float],
    conicities: Sequence[float | None],
    frictions: Sequence[float],
    cases: Sequence[Case],
    linearised: Callable[[float | None], Callable[[Scenario], Linearised]],
) -> Iterator[tuple[Row, Linearised | None]]:
    """Where to look, and the model there, None without a steady state; neighbours follow each other."""
    for conicity in conicities:
        wheels = scenario if conicity is None else coned(scenario, conicity)
        for friction in frictions:
            sweep = linearised(None)
            for speed in speeds:
                slope = math.nan if conicity is None else conicity
                here: Row = {"speed": speed, "radius": math.inf, "conicity": slope, "friction": friction}
                yield here, _solved(sweep, wheels.replace(speed=speed, friction=friction, adhesion=None))
    for case in cases:
        sweep = linearised(middle(case))
        for friction in frictions:
            here = {"speed": case.speed, "radius": case.radius, "conicity": math.nan, "friction": friction}
            curved = scenario.replace(track=case.track, speed=case.speed, friction=friction, adhesion=None)
            yield here, _solved(sweep, curved)


def coned(scenario: Scenario, conicity: float) -> Scenario:
    """The scenario on cones; steep ones on wider gauge, as they would stand on the roots of their flanges."""
    made = replace(scenario, CONICITY, conicity)
    return made if conicity <= STEEP else made.replace(gauge=made.gauge + WIDER)


def middle(case: Case) -> float:
    """Arc length of the middle of the arc of a curve [m]."""
    s = np.array([*case.track.starts, case.track.length])
    arc = int(np.argmax([min(map(abs, segment.curvature)) for segment in case.track.segments]))
    return float(0.5 * (s[arc] + s[arc + 1]))


def _solved(sweep: Callable[[Scenario], Linearised], scenario: Scenario) -> Linearised | None:
    try:
        return sweep(scenario)
    except SimulationError as error:
        if NO_STEADY_STATE not in str(error):
            raise
        return None


def stability(model: LinearModel) -> Row:
    """growth [1/s], damping and frequency [Hz] of the least damped oscillation, and outcome of a closed model."""
    s = eigenvalues(model)
    s = s[lives(s, model.sample_time)]
    growth = float(s.real.max())
    swinging = s[s.imag > 2.0 * np.pi * SLOWEST]
    ratio = -swinging.real / np.abs(swinging)
    least = int(np.argmin(ratio))
    frequency = float(swinging[least].imag / (2.0 * np.pi))
    if growth > UNSTABLE:
        frequency = float(abs(s[np.argmax(s.real)].imag) / (2.0 * np.pi))
    outcome = "unstable" if growth > UNSTABLE else "stable"
    return {"growth": growth, "damping": float(ratio[least]), "frequency": frequency, "outcome": outcome}


def _mode(made: Linearised) -> str:
    """Name of the least stable mode of a model: the fastest growing, or the least damped."""
    found = modes(made.model, made.spec, plant=made.plant)
    growing = max(found, key=lambda mode: mode.eigenvalue.real)
    if growing.eigenvalue.real > UNSTABLE:
        return growing.name
    return min((m for m in found if m.frequency > SLOWEST), key=lambda mode: mode.damping).name
