"""Scenario files: TOML with the keywords of Scenario, the vehicle by name or path, track and control as tables.
Everything is checked before a scenario is made; messages name the file."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_type_hints

from klingel import control, library
from klingel.contact import STANDARD, CreepOptions, Profile, profile_of
from klingel.contact.checks import Kind
from klingel.control.sensor import KINDS, Sensor
from klingel.errors import InputError, Problem, nearest
from klingel.records import Record, read_toml, validated
from klingel.scenario import own
from klingel.scenario.scenario import FRICTION, Scenario, Strategy
from klingel.track import Adhesion, Hand, Patch, Rail, Segment, Track
from klingel.units import Curvature, Length, Number, PositiveLength, PositiveNumber, to_si
from klingel.vehicle import Vehicle

STRATEGIES: dict[str, type[Any]] = {
    "passive": control.Passive,
    "passive_irw": control.PassiveIRW,
    "trailed_irw": control.TrailedIRW,
    "solid_like": control.SolidLike,
    "irw_like": control.IRWLike,
    "yaw_moment": control.YawMoment,
    "yaw_relaxation": control.YawRelaxation,
    "lateral_feedback": control.LateralFeedback,
    "secondary_yaw": control.SecondaryYaw,
    "torque_vectoring": control.TorqueVectoring,
    "feedforward": control.Feedforward,
}
"""Names of strategies in files."""

PARTS: dict[str, type[Any]] = {
    "timing": control.Timing,
    "contact": control.ContactDesign,
    "traction": control.Traction,
    "slip": control.SlipControl,
    "pair": control.WheelCoupling,
}
"""Tables inside a strategy's table."""

UNITS = {
    "frequency": "Hz",
    "time": "s",
    "pole": "s",
    "speed": "m/s",
    "creep": "N",
    "load": "N",
    "rate": "N m/s",
    "reach": "m",
    "damping": "N m s/rad",
    "max": "N m",
}
"""SI units of a strategy's parameters by the last word of their names; all others are pure numbers."""


class _Curve(Record):
    """Keywords of Track.curve."""

    radius: PositiveLength
    cant: Length = 0.0
    transition: Length = 100.0
    arc: Length = 300.0
    straight_before: Length = 150.0
    straight_after: Length = 150.0
    hand: Hand = "right"
    grade: Number = 0.0


class _Segment(Record):
    length: PositiveLength
    curvature: tuple[Curvature, Curvature] = (0.0, 0.0)
    cant: tuple[Length, Length] = (0.0, 0.0)
    grade: tuple[Number, Number] = (0.0, 0.0)


class _Track(Record):
    """Exactly one of the three."""

    straight: PositiveLength | None = None
    curve: _Curve | None = None
    segment: tuple[_Segment, ...] | None = None


class _Database(_Track):
    """A course, or none of them for the scenario's own track; keywords of Track.mistaken."""

    curvature_scale: Number = 1.0
    cant_scale: Number = 1.0
    only: int | None = None
    shift: Length = 0.0


class _Patch(Record):
    """Keywords of klingel.track.Patch."""

    start: Length
    end: Length
    friction: PositiveNumber
    rail: Rail = "both"


class _Adhesion(Record):
    """Keywords of klingel.track.Adhesion."""

    base: PositiveNumber = FRICTION
    transition: PositiveLength = 5.0
    patch: tuple[_Patch, ...] = ()


def read(path: str | Path) -> Scenario:
    """The scenario of a file; errors: InputError.

    Keys: `vehicle` (a name of the library, or the path of a vehicle file relative to this one), `speed`, one of the
    tables `[track.curve]`, `[[track.segment]]` and the key `track.straight`, `[control]` with `strategy` and its
    parameters, `[sensors]` with a table a kind of sensor (`[sensors.gyro]`) and `typical = true` for all others,
    `[database]` with the keywords of `Track.mistaken` or a course as in `[track]`,
    `rail` and `wheel` (names of standard profiles or paths of measured ones), `[creep_options]`,
    `[adhesion]` with `[[adhesion.patch]]`, and every other keyword of Scenario.
    """
    path = Path(path)
    tables = read_toml(path)
    known = list(inspect.signature(Scenario).parameters)
    problems = [Problem(k, tables[k], "is not a known key", nearest(k, known)) for k in tables if k not in known]
    problems += [Problem(k, None, "is missing", "add it") for k in ("vehicle", "track", "speed") if k not in tables]
    if problems:
        raise InputError(problems, file=str(path))
    try:
        made: dict[str, Any] = {"vehicle": _vehicle(tables["vehicle"], path.parent), "track": _track(tables["track"])}
        if "control" in tables:
            made["control"] = strategy(tables["control"], folder=path.parent)
        if "sensors" in tables:
            made["sensors"] = _sensors(tables["sensors"])
        if "database" in tables:
            made["database"] = _database(tables["database"], made["track"])
        if "creep_options" in tables:
            made["creep_options"] = _creep_options(tables["creep_options"])
        if "adhesion" in tables:
            made["adhesion"] = _adhesion(tables["adhesion"])
        kinds: tuple[Kind, ...] = ("wheel", "rail")
        made |= {kind: _profile(tables[kind], kind, path.parent) for kind in kinds if kind in tables}
        return Scenario(**{**tables, **made})
    except InputError as error:
        raise error if error.file else error.in_file(str(path)) from None


def _sensors(table: object) -> control.Sensors:
    """Sensors of a `[sensors]` table: a table a kind, `typical = true` for the rest, `seed` and `record`."""
    if not isinstance(table, Mapping):
        raise InputError.single("sensors", table, "is no table", remedy="give [sensors]")
    known = [*KINDS, "typical", "seed", "record"]
    problems = [
        Problem(f"sensors.{k}", table[k], "is not a known key", nearest(k, known)) for k in table if k not in known
    ]
    if type(table.get("typical", False)) is not bool:
        problems.append(Problem("sensors.typical", table["typical"], "is no yes or no", "give true or false"))
    made: dict[str, Any] = {key: table[key] for key in ("seed", "record") if key in table}
    for name in KINDS:
        if name in table:
            try:
                made[name] = _sensor(name, table[name])
            except InputError as error:
                problems += error.within(f"sensors.{name}").problems
    if problems:
        raise InputError(problems)
    base = control.Sensors.typical() if table.get("typical") else control.Sensors()
    try:
        return dataclasses.replace(base, **made)
    except InputError as error:
        raise error.within("sensors") from None


def _sensor(name: str, table: object) -> Sensor | None:
    """One kind of sensor; `false` is an ideal one."""
    if table is False:
        return None
    if not isinstance(table, Mapping):
        raise InputError.single("", table, "is no table", remedy=f"give [sensors.{name}], or false for an ideal one")
    known = [field.name for field in dataclasses.fields(Sensor)]
    if problems := [Problem(k, table[k], "is not a known key", nearest(k, known)) for k in table if k not in known]:
        raise InputError(problems)
    return KINDS[name](**table)


def _database(table: object, track: Track) -> Track:
    if not isinstance(table, Mapping):
        raise InputError.single(
            "database", table, "is no table", remedy="give [database] with curvature_scale or shift"
        )
    try:
        given = validated(_Database, table)
        courses = any(getattr(given, key) is not None for key in ("straight", "curve", "segment"))
        base = _course(given) if courses else track
        return base.mistaken(
            curvature_scale=given.curvature_scale, cant_scale=given.cant_scale, only=given.only, shift=given.shift
        )
    except InputError as error:
        raise error.within("database") from None


def _creep_options(table: object) -> CreepOptions:
    known = [field.name for field in dataclasses.fields(CreepOptions)]
    if not isinstance(table, Mapping):
        raise InputError.single("creep_options", table, "is no table", remedy="give [creep_options]")
    unknown = [
        Problem(f"creep_options.{k}", table[k], "is not a known key", nearest(k, known))
        for k in table
        if k not in known
    ]
    if unknown:
        raise InputError(unknown)
    try:
        return CreepOptions(**table)
    except InputError as error:
        raise error.within("creep_options") from None


def _adhesion(table: object) -> Adhesion:
    if not isinstance(table, Mapping):
        raise InputError.single("adhesion", table, "is no table", remedy="give [adhesion] with [[adhesion.patch]]")
    try:
        given = validated(_Adhesion, table)
        patches = [Patch(**patch.model_dump()) for patch in given.patch]
        return Adhesion(base=given.base, patches=patches, transition=given.transition)
    except InputError as error:
        raise error.within("adhesion") from None


def _profile(name: object, kind: Kind, folder: Path) -> Profile | str:
    """A standard profile by its name, or a measured one by the path of its file, relative to the scenario's."""
    if not isinstance(name, str):
        remedy = "give the name of a standard profile or the path of a file"
        raise InputError.single(kind, name, "is not known", remedy=remedy)
    return name if kind == "rail" and name in STANDARD["rail"] else profile_of(name, kind, folder=folder)


def strategy(table: object, *, folder: Path = Path()) -> Strategy:
    """The strategy of a `[control]` table: of the library, or `file.py:Name` (see `klingel.scenario.own`).

    folder: that paths are relative to. Errors: InputError.
    """
    if not isinstance(table, Mapping) or not isinstance(table.get("strategy"), str):
        raise InputError.single("control", table, "needs a strategy", remedy=f"use one of {', '.join(STRATEGIES)}")
    name = table["strategy"]
    values = {key: value for key, value in table.items() if key != "strategy"}
    if own.is_own(name):
        kind = own.own(name, folder)
        if isinstance(kind, type) and dataclasses.is_dataclass(kind):
            values = _values(kind, values, "control")
        ready: Strategy = own.made(kind, name, values)
        return ready
    if name not in STRATEGIES:
        raise InputError.single("control.strategy", name, "is not known", remedy=nearest(name, list(STRATEGIES)))
    made: Strategy = _made(STRATEGIES[name], values, "control")
    return made


def _made(kind: type[Any], values: Mapping[str, Any], key: str) -> Any:
    """An object of a dataclass from a table, the tables inside it likewise; errors: InputError with every problem."""
    return kind(**_values(kind, values, key))


def _values(kind: type[Any], values: Mapping[str, Any], key: str) -> dict[str, Any]:
    """What a dataclass is made with."""
    made: dict[str, Any] = {}
    problems: list[Problem] = []
    for name, value in values.items():
        try:
            made[name] = _parameter(kind, name, value, key)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return made


def _parameter(kind: type[Any], name: str, value: object, key: str) -> Any:
    """One value of a strategy's table as its dataclass wants it: numbers in SI, whole numbers, tables inside."""
    place = f"{key}.{name}"
    hints = get_type_hints(kind)
    if name not in hints:
        raise InputError.single(place, value, "is not a known key", remedy=nearest(name, list(hints)))
    if name in PARTS:
        if value is False and name == "slip":
            return None
        if not isinstance(value, Mapping):
            raise InputError.single(place, value, "is no table", remedy=f"give [{place}]")
        return _made(PARTS[name], value, place)
    if hints[name] is int and (type(value) is not int or value < 0):
        raise InputError.single(place, value, "is no whole number", remedy="give 0, 1, 2 or more")
    if isinstance(value, list) and hints[name] is not float:
        unit = UNITS.get(name, "1")
        return tuple(to_si(each, unit, key=f"{place}[{i}]") for i, each in enumerate(value))
    if hints[name] is float:
        unit = UNITS.get(name.rpartition("_")[2], "1")
        number = to_si(value, unit, key=place)  # type: ignore[arg-type]  # it refuses what is no quantity
        if kind in PARTS.values() and name != "inclination" and number <= 0.0:  # strategies check their own
            raise InputError.single(place, value, f"must be positive [{unit}]", remedy="give a value above zero")
        return number
    return value


def _vehicle(name: object, folder: Path) -> Vehicle:
    if not isinstance(name, str):
        raise InputError.single("vehicle", name, "is no name or path", remedy="give a library name or a .toml file")
    return Vehicle.read(folder / name) if name.endswith(".toml") else library.vehicle(name)


def _track(table: object) -> Track:
    if not isinstance(table, Mapping):
        raise InputError.single("track", table, "is no table", remedy="give [track.curve] or track.straight")
    try:
        return _course(validated(_Track, table))
    except InputError as error:
        raise error.within("track") from None


def _course(track: _Track) -> Track:
    given = [key for key in ("straight", "curve", "segment") if getattr(track, key) is not None]
    if len(given) != 1:
        remedy = "give exactly one of straight, [track.curve], [[track.segment]]"
        raise InputError.single("", given or None, "needs one course", remedy=remedy)
    if track.straight is not None:
        return Track.straight(track.straight)
    if track.curve is not None:
        return Track.curve(**track.curve.model_dump())
    assert track.segment is not None
    return Track(tuple(Segment(s.length, s.curvature, s.cant, s.grade) for s in track.segment))
