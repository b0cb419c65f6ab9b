"""Operating points: a scenario on endless track of one curvature and cant, and its steady state.
The steady state is solved for, controllers settled, without time stepping."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from klingel.core import core
from klingel.errors import InputError, SimulationError
from klingel.lower import Spec, lower
from klingel.scenario import Scenario
from klingel.track import CANT_BASE, Segment, Track
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    from klingel._core import OperatingPoint

UNSTABLE = 1e-3
"""Growth above which a steady state is called unstable [1/s]."""

ENDLESS = 10_000.0
"""Length of the track of one curvature that controllers with a database are made for [m]."""


def endless(scenario: Scenario, at: Quantity | None) -> tuple[float, float]:
    """Curvature [1/m] and cant [m] of a scenario's track at an arc length; straight and level for None.

    Errors: InputError for a place outside the track.
    """
    if at is None:
        return 0.0, 0.0
    s = to_si(at, "m", key="at")
    return float(scenario.track.curvature(s)), float(scenario.track.cant(s))


def steady_spec(scenario: Scenario, *, at: Quantity | None = None) -> Spec:
    """The core's spec of a scenario on endless track, as it is at the arc length `at` of its own track;
    a run of it starts in the steady state, controllers settled.

    >>> from klingel import Scenario, Track, library
    >>> curve = Track.curve(radius="800 m", cant="160 mm")
    >>> spec = steady_spec(Scenario(library.vehicle("manchester_coach"), curve, speed=30.0), at="400 m")
    >>> spec["track"]["uniform"]
    {'curvature': 0.00125, 'cant': 0.16}
    """
    curvature, cant = endless(scenario, at)
    track = Track((Segment(ENDLESS, (curvature, curvature), (cant, cant)),))
    spec = lower(scenario.replace(track=track, duration=None))
    uniform = {"curvature": curvature, "cant": cant}
    spec["track"] = {"uniform": uniform, "start": spec["track"]["start"], "cant_base": CANT_BASE}
    spec["run"]["settled"] = True
    return spec


def solve(spec: Spec, near: OperatingPoint | None = None) -> OperatingPoint:
    """The core's operating point of a spec; errors: SimulationError where there is none."""
    extension = core()
    try:
        point: OperatingPoint = extension.operating_point(json.dumps(spec, allow_nan=False), near)
        return point
    except extension.CoreError as error:
        raise SimulationError(f"{spec['name']}: {error}") from None


@dataclass(frozen=True)
class Steady:
    """Steady state: value of every channel (SI; names as in a run, arc lengths from the middle of the vehicle).

    values: by channel; units: by channel; warnings: that it is unstable, elements near a kink; iterations: Newton
    steps; growth: largest real part of the eigenvalues there [1/s], controllers closed.
    """

    values: pd.Series[float]
    units: dict[str, str]
    warnings: tuple[str, ...]
    iterations: int
    growth: float


def steady_state(scenario: Scenario, *, at: Quantity | None = None) -> Steady:
    """Steady running of a scenario, solved by Newton's method with the exact Jacobian, controllers settled.

    at: arc length on the scenario's track [m] whose curvature and cant are held; None for straight level track.
    Errors: SimulationError where there is none, or a wheel cannot stay on its rail; InputError.

    >>> import klingel as kl
    >>> curve = kl.Track.curve(radius="800 m", cant="160 mm", transition="195 m")
    >>> scenario = kl.Scenario(kl.library.vehicle("manchester_coach"), curve, speed="176 km/h")
    >>> steady = kl.linear.steady_state(scenario, at="500 m")
    >>> bool(2e-3 < steady.values["bogie1.wheelset1.y"] < 7e-3)  # towards the outer, left rail it would be negative
    False
    """
    return read(solve(steady_spec(scenario, at=at)).linearise())


def steady_states(scenarios: Sequence[Scenario], *, at: Quantity | None = None) -> Iterator[Steady]:
    """Steady states of one vehicle over speed, radius, friction ..., each found from the one before.

    Where several exist the branch depends on the way; a jump in the values is a change of branch.

    Errors: as `steady_state`, at the scenario that has none.
    """
    near: OperatingPoint | None = None
    for scenario in scenarios:
        near = solve(steady_spec(scenario, at=at), near)
        yield read(near.linearise())


def read(raw: dict[str, Any]) -> Steady:
    """Values of the outputs of a raw linear model."""
    names = [name for name, _ in raw["outputs"]]
    values = pd.Series(np.asarray(raw["y"]), index=pd.Index(names, name="channel"))
    growth = growth_of(raw)
    unstable = (f"unstable: departures grow with {growth:.2g} 1/s, a run leaves it",) if growth > UNSTABLE else ()
    return Steady(values, dict(raw["outputs"]), (*unstable, *raw["kinks"]), raw["iterations"], growth)


def growth_of(raw: dict[str, Any]) -> float:
    """Largest real part of the eigenvalues [1/s], controllers closed; the free arc length, which is nil, left out."""
    from klingel.linear.statespace import of_raw

    model = of_raw(raw, "", 0.0)
    values = np.linalg.eigvals(model.A)
    free = np.argmin(np.abs(values if model.sample_time is None else values - 1.0))
    rest = np.delete(values, free)
    if model.sample_time is not None:
        return float(np.log(np.abs(rest).max()) / model.sample_time)
    return float(rest.real.max())


__all__ = ["InputError", "Steady", "endless", "solve", "steady_spec", "steady_state", "steady_states"]
