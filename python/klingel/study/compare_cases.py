"""Who is compared: contenders, each a strategy on the vehicle it is made for, read from short texts or given in Python.
Pure data; nothing here simulates."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from klingel import control, library
from klingel.errors import InputError
from klingel.linear import parameters
from klingel.lower import lower
from klingel.scenario import Scenario, Strategy
from klingel.scenario.files import STRATEGIES, strategy
from klingel.scenario.fit import misfits, no_strategy
from klingel.study.cases import STEP
from klingel.study.compare_curves import value_of
from klingel.track import Track
from klingel.track.cases import Case
from klingel.units import Quantity
from klingel.vehicle import Vehicle

COACH = "manchester_coach"
"""Vehicle that runs without control."""

VEHICLES = ("mechatronic_irw", "trailed_irw", "mechatronic_solid", "actuated_coach")
"""Vehicles of the library in the order in which a strategy is tried on them, then all others."""

STEP_SAFE = 0.5e-3
"""Integration step of strategies that `klingel.study.cases.STEP` says nothing of [s]."""


@dataclass(frozen=True)
class Contender:
    """One of those compared.

    name: in tables and of its files; label: in legends; scenario: vehicle, strategy and all settings; its track and
    speed are those of each curve in turn.
    """

    name: str
    label: str
    scenario: Scenario

    def through(self, case: Case) -> Scenario:
        """Its run through a curve; errors: InputError as Scenario."""
        return self.scenario.replace(track=case.track, speed=case.speed, duration=None)

    def straight(self, speed: float) -> Scenario:
        """The same on straight level track at a speed [m/s]; errors: InputError as Scenario."""
        return self.scenario.replace(track=Track.straight("1 km"), speed=speed, duration=None)

    @property
    def words(self) -> str:
        """Vehicle and strategy in words."""
        steering = self.scenario.control
        return f"{self.scenario.vehicle.name}, {'no control' if steering is None else type(steering).__name__}"


def contenders(
    strategies: Mapping[str, Any] | Iterable[str],
    first: Case,
    *,
    vehicle: str | Vehicle | None = None,
    settings: Mapping[str, Quantity] | None = None,
) -> list[Contender]:
    """Those to compare, checked on the first curve.

    Args:
        strategies: texts, or name to a text, a Strategy, None for no control, or a Scenario. A text is
            `[name=]what[:key=value,...]`: a strategy of the library, `file.py:Name` of one's own, or a scenario file
            (.toml), then parameters of the strategy as scenario files have them, also `step`, and `vehicle` of this
            one.
        first: curve that they are checked on.
        vehicle: of all that do not say their own: of the library, or a vehicle file (.toml).
        settings: numbers by dotted path (`klingel.linear.parameters`), for all.

    Raises:
        InputError: an unknown strategy, parameter or vehicle, one that does not fit, a name given twice.

    Example:
        >>> from klingel.track.cases import perez2004
        >>> one, other = contenders(["passive", "known=irw_like:curvature=database,frequency=1.2"], perez2004()[0])
        >>> one.words, other.name, other.scenario.control.frequency
        ('manchester_coach, Passive', 'known', 1.2)
    """
    named = list(strategies.items()) if isinstance(strategies, Mapping) else [_named(text) for text in strategies]
    if not named:
        remedy = f"name some of {', '.join(STRATEGIES)}, a file.py:Name or a scenario file"
        raise InputError.single("strategies", None, "there is nothing to compare", remedy=remedy)
    files = [slug(name) for name, _ in named]
    twice = [name for name, _ in named if files.count(slug(name)) > 1]
    if twice:
        remedy = "give each its own name, such as quick=irw_like:frequency=2"
        raise InputError.single("strategies", twice, "have the same name", remedy=remedy)
    made = [_contender(name, what, first, vehicle) for name, what in named]
    for path, value in (settings or {}).items():
        made = [dataclasses.replace(c, scenario=parameters.replace(c.scenario, path, value)) for c in made]
    return made


def _contender(name: str, what: object, first: Case, vehicle: str | Vehicle | None) -> Contender:
    label = " ".join(name.replace("_", " ").replace(":", ": ").replace(",", ", ").split())
    if isinstance(what, Scenario):
        return Contender(name, label, what if vehicle is None else what.replace(vehicle=_vehicle(vehicle)))
    if not isinstance(what, str):
        return Contender(name, label, _scenario(what, first, vehicle, {}))
    head, given = split(what)
    own = given.pop("vehicle", None)
    chosen = vehicle if own is None else own
    if not head.endswith(".toml"):
        step = {"step": given.pop("step")} if "step" in given else {}
        step = step or ({"step": STEP[head]} if head in STEP else {})
        steering = strategy({"strategy": head, **given})
        return Contender(name, label, _scenario(steering, first, chosen, step))
    read = Scenario.read(head)
    if chosen is not None:
        read = read.replace(vehicle=_vehicle(chosen))
    if "step" in given:
        read = read.replace(step=given.pop("step"))
    for key, value in given.items():
        read = parameters.replace(read, f"control.{key}", value)
    return Contender(name, label, read)


def _scenario(what: object, first: Case, vehicle: str | Vehicle | None, settings: Mapping[str, Any]) -> Scenario:
    """A strategy on the given vehicle, or on the one it is made for."""
    if (problem := no_strategy(what)) is not None:
        raise InputError([dataclasses.replace(problem, key="strategies")])
    steering: Strategy | None = what  # type: ignore[assignment]  # it has what a Strategy has
    chosen = made_for(steering) if vehicle is None else _vehicle(vehicle)
    step = {"step": STEP_SAFE} | dict(settings)
    return Scenario(chosen, first.track, speed=first.speed, control=steering, **step)


def made_for(steering: Strategy | None) -> Vehicle:
    """The vehicle of the library that a strategy is made for: the first that it says it fits.

    One of a user's own is also asked what it commands, which the vehicle must have as inputs; one that says nothing of
    both gets the mechatronic vehicle with independent wheels.
    Errors: InputError for one that fits none, with the reason of the first that has its inputs.

    >>> made_for(None).name, made_for(control.IRWLike()).name
    ('manchester_coach', 'mechatronic_irw')
    """
    if steering is None or isinstance(steering, control.Passive):
        return library.vehicle(COACH)
    near: list[str] = []
    far: list[str] = []
    for name in (*VEHICLES, *(name for name in library.names() if name not in VEHICLES)):
        vehicle = library.vehicle(name)
        against, missing = misfits(steering, vehicle), _missing(steering, vehicle)
        if not against and not missing:
            return vehicle
        told = "; ".join(map(str, against)) or f"it has no input `{missing[0]}`"
        (far if missing else near).append(f"{name}: {told}")
    remedy = "mend that, or say which vehicle it is made for"
    message = f"fits no vehicle of the library. {(near + far)[0]}"
    raise InputError.single("strategies", type(steering).__name__, message, remedy=remedy)


def _missing(steering: Strategy, vehicle: Vehicle) -> list[str]:
    """Inputs that a strategy of a user's own commands and a vehicle does not have; those of the library know theirs."""
    if type(steering) in STRATEGIES.values():
        return []
    track, speed = Track.straight("1 km"), 30.0
    try:
        spec = steering.lower(vehicle, track, speed)
        commanded = [] if spec is None else [command["target"] for command in spec["commands"]]
    except Exception:  # whatever a user's class does with a vehicle that it may not be made for; its run will say
        return []
    parts = lower(Scenario(vehicle, track, speed=speed))
    inputs = {f"{each['name']}.force" for each in parts["actuators"]}
    inputs |= {f"{each['name']}.{end}_voltage" for each in parts["drives"] for end in ("armature", "field")}
    inputs |= {f"{each['name']}.torque_command" for each in parts["induction_drives"]}
    return [target for target in commanded if target not in inputs]


def slug(name: str) -> str:
    """A name as a part of file names.

    >>> slug("irw_like:curvature=database")
    'irw_like_curvature_database'
    """
    return re.sub(r"[^\w.+-]+", "_", name)


def _vehicle(vehicle: str | Vehicle) -> Vehicle:
    if isinstance(vehicle, Vehicle):
        return vehicle
    return Vehicle.read(vehicle) if vehicle.endswith(".toml") else library.vehicle(vehicle)


def _named(text: str) -> tuple[str, str]:
    """A name and what it stands for: `name=what`, or the text itself for both."""
    found = re.fullmatch(r"\s*([\w .+-]*[\w+-])\s*=(.+)", text, flags=re.DOTALL)
    return (found.group(1), found.group(2)) if found else (text, text)


def strategy_of(text: str, *, key: str) -> Strategy:
    """The strategy of a text `what[:key=value,...]`; errors: InputError, at `key`.

    >>> strategy_of("irw_like:curvature=database,frequency=1.2", key="control").frequency
    1.2
    """
    head, given = split(text, key=key)
    return strategy({"strategy": head, **given})


def split(text: str, *, key: str = "strategies") -> tuple[str, dict[str, Any]]:
    """What a text names, and its parameters; dots in a parameter make tables. key: where errors say it stands.

    Raises:
        InputError: a parameter without value, given twice, or both a value and a table.

    Example:
        >>> split("mine.py:Mine:gain=2,timing.sample_time=2 ms")
        ('mine.py:Mine', {'gain': 2, 'timing': {'sample_time': '2 ms'}})
    """
    found = re.fullmatch(r"(.*?\.py:[^:=,]+|[^:]*)(?::(.*))?", text, flags=re.DOTALL)
    head, tail = (found.group(1), found.group(2)) if found else (text, None)
    given: dict[str, Any] = {}
    for pair in (tail or "").split(",") if tail else ():
        name, equals, value = pair.partition("=")
        if not equals or not name.strip():
            remedy = "give parameters as key=value,key=value"
            raise InputError.single(key, text, f"{pair!r} sets nothing", remedy=remedy)
        *tables, last = name.strip().split(".")
        place: Any = given
        for table in tables:
            place = place.setdefault(table, {}) if isinstance(place, dict) else place
        if not isinstance(place, dict) or last in place:
            remedy = "give each once, tables by their parts only: timing.sample_time=2 ms"
            raise InputError.single(key, text, f"{name.strip()!r} is given twice", remedy=remedy)
        place[last] = value_of(value.strip())
    return head, given
