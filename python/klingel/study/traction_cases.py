"""The runs of the traction study: launch, stop, traction and braking in curves, patches of low adhesion.
Pure data; nothing here simulates."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from klingel import control, library
from klingel.contact import CreepOptions
from klingel.control import SlipControl, Traction
from klingel.errors import InputError
from klingel.lower import Spec, lower
from klingel.scenario import Scenario, Strategy
from klingel.track import Adhesion, Track

Group = Literal["launch", "stop", "curve", "patch"]
GROUPS: tuple[Group, ...] = ("launch", "stop", "curve", "patch")

PARTS = (*GROUPS, "drives", "rig")
"""Of the study: groups of runs under traction, the five curves with both kinds of motor, the roller rig."""

STRATEGIES = ("solid_like", "irw_like")
"""In the order of the tables."""

STEP = 0.5e-3
"""Of the integration [s]."""

FRICTION = 0.35
LOW = 0.08
"""Coefficients of friction outside and inside a patch of low adhesion."""

OFFSET = 2e-3
"""Displacement of the vehicle at the start of runs on straight track [m]."""

PATCH = 200.0
"""Length of the patch [m]."""

FALLING = (0.4, 0.6)
"""A and B [s/m] of friction that falls with the slip velocity, mu ((1 - A) exp(-B w) + A); this project's choice."""

RAMP = 5.0
"""Over which friction falls and rises at its ends [m]."""


@dataclass(frozen=True)
class TractionRun:
    """One run of the study.

    Attributes:
        group: which part of the study it belongs to.
        name: of its file, unique in the study.
        title: in words.
        strategy: `solid_like` or `irw_like`.
        scenario: what to simulate.
        patch: begin and end of the patch of low adhesion [m], None without.
        offset: lateral displacement at which the vehicle begins [m], so that on straight track there is something to
            steer.
    """

    group: Group
    name: str
    title: str
    strategy: str
    scenario: Scenario
    patch: tuple[float, float] | None = None
    offset: float = 0.0

    def spec(self) -> Spec:
        """The spec of the run, ready for `klingel.result.simulate_spec`."""
        spec = lower(self.scenario)
        shift = {"displacement": [0.0, self.offset, 0.0]}
        spec["run"]["kicks"] = [{"body": body["name"], **shift} for body in spec["bodies"]] if self.offset else []
        return spec


def traction_runs(groups: Iterable[str] = GROUPS, *, strategies: Iterable[str] = STRATEGIES) -> list[TractionRun]:
    """The runs of some parts of the study, the long ones first.

    Raises:
        InputError: a part or a strategy that is not in the study.

    Example:
        >>> [run.name for run in traction_runs(["stop"])]
        ['stop_solid_like', 'stop_irw_like']
    """
    wanted, chosen = list(groups), list(strategies)
    for key, given, known in (("groups", wanted, GROUPS), ("strategies", chosen, STRATEGIES)):
        unknown = [each for each in given if each not in known]
        if unknown:
            raise InputError.single(key, unknown, "not in this study", remedy=f"choose from {', '.join(known)}")
    makers: dict[str, Callable[[str], Iterable[TractionRun]]] = {
        "launch": _launch,
        "stop": _stop,
        "curve": _curves,
        "patch": _patches,
    }
    return [run for group in GROUPS if group in wanted for strategy in chosen for run in makers[group](strategy)]


def _strategy(name: str, traction: Traction) -> Strategy:
    if name == "solid_like":
        return control.SolidLike(traction=traction)
    return control.IRWLike(traction=traction)


def _scenario(name: str, track: Track, speed: float, traction: Traction, adhesion: Adhesion | None = None) -> Scenario:
    return Scenario(
        library.vehicle("mechatronic_irw"),
        track,
        speed=speed,
        control=_strategy(name, traction),
        friction=FRICTION,
        adhesion=adhesion,
        step=STEP,
        record_interval=2.0 * STEP,
    )


def _launch(strategy: str) -> Iterable[TractionRun]:
    """0 to 265 km/h on straight level track, full torque until the speed is reached."""
    # full torque gives 1.0 m/s2 below the base speed, then falls with the power
    time = (0.0, 2.0, 35.0, 70.0, 110.0, 160.0, 190.0)
    speed = tuple(v / 3.6 for v in (0.0, 0.0, 105.0, 185.0, 232.0, 265.0, 265.0))
    scenario = _scenario(strategy, Track.straight(10e3), 0.0, Traction(time, speed=speed))
    yield TractionRun(
        "launch", f"launch_{strategy}", "0 to 265 km/h on straight track", strategy, scenario, offset=OFFSET
    )


def _stop(strategy: str) -> Iterable[TractionRun]:
    """A stop from 160 km/h with 0.8 m/s2."""
    v = 160.0 / 3.6
    end = 3.0 + v / 0.8
    traction = Traction((0.0, 3.0, end, end + 6.0), speed=(v, v, 0.0, 0.0))
    scenario = _scenario(strategy, Track.straight(1.6e3), v, traction)
    yield TractionRun(
        "stop", f"stop_{strategy}", "stop from 160 km/h on straight track", strategy, scenario, offset=OFFSET
    )


CURVES = {300.0: (78.0, 108.0, "120 m"), 800.0: (145.0, 176.0, "195 m")}
"""Radius [m] to the speeds between which the vehicle accelerates and brakes [km/h], and the transition."""


def _curves(strategy: str) -> Iterable[TractionRun]:
    """Full traction from a lower speed to that of the study, and full braking back, in the arc."""
    for radius, (low, high, transition) in CURVES.items():
        for word, begin, notch in (("accelerating", low, 1.0), ("braking", high, -1.0)):
            speed = begin / 3.6
            track = Track.curve(radius=radius, cant="160 mm", transition=transition, arc="700 m")
            # the last wheelset is in the arc after the straight, the transition and the vehicle's own length
            entered = (150.0 + float(transition.split()[0]) + 15.0) / speed
            full = _time_of_change(radius, low / 3.6, high / 3.6)
            traction = Traction.notched(
                [0.0, entered, entered + 0.5, entered + full, entered + full + 0.5, entered + full + 4.0],
                [0.0, 0.0, notch, notch, 0.0, 0.0],
            )
            yield TractionRun(
                "curve",
                f"{word}_R{radius:.0f}_{strategy}",
                f"{word} in the arc of R = {radius:.0f} m, {begin:.0f} km/h at its start",
                strategy,
                _scenario(strategy, track, speed, traction),
            )


def _time_of_change(radius: float, low: float, high: float) -> float:
    """Time of full torque between two speeds [s], with the least acceleration on the way, 0.95 or 0.6 m/s2."""
    return (high - low) / (0.95 if radius < 500.0 else 0.6)


def _patches(strategy: str) -> Iterable[TractionRun]:
    """A patch of 200 m with friction 0.08, under full traction, full braking and at speed in two curves."""
    begin = 250.0
    adhesion = Adhesion(base=FRICTION, patches=[(begin, begin + PATCH, LOW)], transition=RAMP)
    track = Track.straight("900 m")
    for word, speed, notch in (("accelerating", 50.0 / 3.6, 1.0), ("braking", 120.0 / 3.6, -1.0)):
        traction = Traction.notched([0.0, 2.0, 2.5, 22.0 if notch > 0.0 else 20.0], [0.0, 0.0, notch, notch])
        scenario = _scenario(strategy, track, speed, traction, adhesion)
        place, title = (begin, begin + PATCH), f"{word} over the patch"
        name = f"patch_{word}_{strategy}"
        yield TractionRun("patch", name, title, strategy, scenario, place, offset=OFFSET)
        falling = scenario.replace(creep_options=CreepOptions(falling=FALLING))
        name, title = f"patch_falling_{word}_{strategy}", f"{title}, friction falling with slip"
        yield TractionRun("patch", name, title, strategy, falling, place, offset=OFFSET)
    for radius, (_, high, transition) in CURVES.items():
        first = 150.0 + float(transition.split()[0]) + 100.0
        where = Adhesion(base=FRICTION, patches=[(first, first + PATCH, LOW)], transition=RAMP)
        curve = Track.curve(radius=radius, cant="160 mm", transition=transition, arc="700 m")
        v = high / 3.6
        traction = Traction((0.0, (first + PATCH + 400.0) / v), speed=(v, v), slip=SlipControl())
        scenario = _scenario(strategy, curve, v, traction, where)
        name = f"patch_R{radius:.0f}_{strategy}"
        title = f"at {high:.0f} km/h over the patch in R = {radius:.0f} m"
        yield TractionRun("patch", name, title, strategy, scenario, (first, first + PATCH))
