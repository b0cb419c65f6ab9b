"""Operating points: a scenario on endless track of one curvature and cant, and the core's solution there.
What steady states, linear models and sweeps all begin with."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from klingel.core import core
from klingel.errors import SimulationError
from klingel.lower import Spec, lower
from klingel.scenario import Scenario
from klingel.track import CANT_BASE, Segment, Track
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    from klingel._core import OperatingPoint

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
    a run of it starts in the steady state, controllers settled. The track is level, its friction that at `at`, or the
    base of the scenario's adhesion.

    Controllers know an endless track too: of the curvature and cant that their database has where they believe to be;
    straight and level for None. A database that ends before goes on as it ends, as it does in a run.

    >>> from klingel import Scenario, Track, library
    >>> curve = Track.curve(radius="800 m", cant="160 mm")
    >>> spec = steady_spec(Scenario(library.vehicle("manchester_coach"), curve, speed=30.0), at="400 m")
    >>> spec["track"]["uniform"]
    {'curvature': 0.00125, 'cant': 0.16}
    """
    curvature, cant = endless(scenario, at)
    track = _uniform(curvature, cant)
    spec = lower(scenario.replace(track=track, database=_believed(scenario, at), duration=None))
    uniform = {"curvature": curvature, "cant": cant}
    spec["track"] = {"uniform": uniform, "start": spec["track"]["start"], "cant_base": CANT_BASE}
    if (adhesion := scenario.adhesion) is not None:
        s = None if at is None else to_si(at, "m", key="at")
        left, right = (adhesion.base,) * 2 if s is None else (float(adhesion.left(s)), float(adhesion.right(s)))
        spec["adhesion"] = {"s": [0.0], "left": [left], "right": [right]}
    spec["run"]["settled"] = True
    return spec


def _uniform(curvature: float, cant: float) -> Track:
    return Track((Segment(ENDLESS, (curvature, curvature), (cant, cant)),))


def _believed(scenario: Scenario, at: Quantity | None) -> Track | None:
    """The endless track that strategies believe in; None for the true one."""
    if at is None:
        return None
    known = scenario.track if scenario.database is None else scenario.database
    s = min(max(scenario.sensors.believed(to_si(at, "m", key="at")), 0.0), known.length)
    return _uniform(float(known.curvature(s)), float(known.cant(s)))


def solve(spec: Spec, near: OperatingPoint | None = None) -> OperatingPoint:
    """The core's operating point of a spec; errors: SimulationError where there is none."""
    extension = core()
    try:
        point: OperatingPoint = extension.operating_point(json.dumps(spec, allow_nan=False), near)
        return point
    except extension.CoreError as error:
        raise SimulationError(f"{spec['name']}: {error}") from None
