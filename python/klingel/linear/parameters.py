"""Numbers of a scenario by dotted path: "speed", "conicity", "vehicle.yaw_damper.damping", "control.frequency".
Read, and replaced in a new scenario; what sweeps, loci and sensitivities vary."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from typing import Any, TypeVar

from klingel.contact import Profile
from klingel.errors import InputError, nearest
from klingel.records import Record, validated
from klingel.scenario import Scenario
from klingel.scenario.files import UNITS as CONTROL_UNITS
from klingel.units import Quantity, to_si

OWN = {"speed": "m/s", "friction": "1", "rail_inclination": "1", "gauge": "m"}
"""Parameters of the scenario itself and their units."""

CONICITY = "conicity"
"""Slope of coned wheels; giving it to a vehicle with another profile makes its wheels cones."""

MISMATCH = "radius_mismatch"
"""Of all four wheelsets if it is the same, and with .0 to .3 that of each."""

R = TypeVar("R", bound=Record)
_CONE = re.compile(r"cone\((.+)\)")


def names(scenario: Scenario) -> tuple[str, ...]:
    """Every dotted path that `get` reads in this scenario, sorted by where it is: scenario, control, vehicle.

    >>> from klingel import Scenario, Track, library
    >>> coach = Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed="108 km/h")
    >>> "vehicle.yaw_damper.damping" in names(coach)
    True
    """
    return tuple(name for name, _, _ in _entries(scenario))


def get(scenario: Scenario, path: str) -> float:
    """The value of a parameter in SI; errors: InputError for an unknown path, with the nearest one.

    >>> from klingel import Scenario, Track, library
    >>> coach = Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed="108 km/h")
    >>> get(coach, "speed"), get(coach, "vehicle.body.mass")
    (30.0, 32000.0)
    """
    for name, value, _ in _entries(scenario):
        if name == path:
            return value
    raise _unknown(scenario, path)


def unit(scenario: Scenario, path: str) -> str:
    """The SI unit of a parameter, "1" for a pure number; errors as `get`."""
    if path in (CONICITY, MISMATCH):
        return "1" if path == CONICITY else "m"
    for name, _, its_unit in _entries(scenario):
        if name == path:
            return its_unit
    raise _unknown(scenario, path)


def replace(scenario: Scenario, path: str, value: Quantity) -> Scenario:
    """The same scenario with one parameter at another value, in SI or a string with a unit.

    "conicity" makes all wheels cones of that slope, whatever they were.
    Errors: InputError for an unknown path, and for a value that the scenario refuses.

    >>> from klingel import Scenario, Track, library
    >>> coach = Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed="108 km/h")
    >>> get(replace(coach, "vehicle.secondary.stiffness.y", "200 kN/m"), "vehicle.secondary.stiffness.y")
    200000.0
    """
    number = to_si(value, unit(scenario, path), key=path)
    if path == CONICITY:
        return scenario.replace(wheel=Profile.cone(number))
    head, _, rest = path.partition(".")
    match head:
        case "vehicle":
            try:
                return scenario.replace(vehicle=_record(scenario.vehicle, rest.split("."), number))
            except InputError as error:
                raise error.within("vehicle") from None
        case "control" | "creep_options" | "sensors":
            return scenario.replace(**{head: _object(getattr(scenario, head), rest.split("."), number, path)})
        case "radius_mismatch" if rest:
            return scenario.replace(radius_mismatch=_object(scenario.radius_mismatch, [rest], number, path))
        case _:
            return scenario.replace(**{path: number})


def _entries(scenario: Scenario) -> Iterator[tuple[str, float, str]]:
    """Path, value, unit."""
    for name, its_unit in OWN.items():
        yield name, getattr(scenario, name), its_unit
    slope = _slope(scenario)
    if slope is not None:
        yield CONICITY, slope, "1"
    if len(set(scenario.radius_mismatch)) == 1:
        yield MISMATCH, scenario.radius_mismatch[0], "m"
    yield from ((f"{MISMATCH}.{i}", dr, "m") for i, dr in enumerate(scenario.radius_mismatch))
    yield from _numbers("creep_options", scenario.creep_options)
    if scenario.control is not None:
        yield from _numbers("control", scenario.control)
    for name, sensor in scenario.sensors.kinds():
        for field in dataclasses.fields(sensor):
            its_unit = sensor.unit_of(field.name)
            yield f"sensors.{name}.{field.name}", getattr(sensor, field.name), its_unit
    for parameter in scenario.vehicle.parameters():
        path = f"vehicle.{parameter.key}"
        if isinstance(parameter.value, tuple):
            yield from ((f"{path}.{i}", float(v), parameter.unit) for i, v in enumerate(parameter.value))
        else:
            yield path, float(parameter.value), parameter.unit


def _slope(scenario: Scenario) -> float | None:
    """Of coned wheels, None for another profile."""
    standard = scenario.wheel.standard if scenario.wheel is not None else None
    cone = _CONE.fullmatch(standard) if isinstance(standard, str) else None
    return float(cone[1]) if cone else None


def _numbers(path: str, value: object) -> Iterator[tuple[str, float, str]]:
    """Every number of a dataclass, of those inside it and of their tuples."""
    if isinstance(value, bool):
        return
    if isinstance(value, (int, float)):
        its_unit = CONTROL_UNITS.get(path.rpartition(".")[2].rpartition("_")[2], "1")
        yield path, float(value), its_unit
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _numbers(f"{path}.{i}", item)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from _numbers(f"{path}.{field.name}", getattr(value, field.name))


def _record(record: R, keys: list[str], number: float) -> R:
    """A record with one number inside it at another value; each table on the way checks itself again."""
    key, inside = keys[0], keys[1:]
    old = getattr(record, key)
    if isinstance(old, tuple):
        new: Any = tuple(number if str(i) == inside[0] else item for i, item in enumerate(old))
    elif isinstance(old, Record):
        try:
            new = _record(old, inside, number)
        except InputError as error:
            raise error.within(key) from None
    else:
        new = number
    return validated(type(record), dict(record) | {key: new})


def _object(value: Any, keys: list[str], number: float, path: str) -> Any:
    """A dataclass, or a tuple, with one number inside it at another value."""
    key, inside = keys[0], keys[1:]
    if isinstance(value, tuple):
        changed = list(value)
        changed[int(key)] = _object(value[int(key)], inside, number, path) if inside else number
        return tuple(changed)
    old = getattr(value, key)
    if inside:
        return dataclasses.replace(value, **{key: _object(old, inside, number, path)})
    if isinstance(old, int):
        if number != round(number):
            raise InputError.single(path, number, "is no whole number", remedy=f"give {round(number)}")
        return dataclasses.replace(value, **{key: round(number)})
    return dataclasses.replace(value, **{key: number})


def _unknown(scenario: Scenario, path: str) -> InputError:
    known = names(scenario)
    if path == CONICITY:
        remedy = "give the scenario coned wheels: wheel=klingel.contact.Profile.cone(1/20)"
        return InputError.single(
            path, None, "is that of coned wheels only; this wheel has another profile", remedy=remedy
        )
    same_end = [name for name in known if name.rpartition(".")[2] == str(path).rpartition(".")[2]]
    close = nearest(path, known)
    if close.startswith("known"):
        close = (
            f"did you mean one of {', '.join(same_end)}?" if same_end else "klingel.linear.parameters.names lists all"
        )
    return InputError.single("parameter", path, "is not of this scenario", remedy=close)
