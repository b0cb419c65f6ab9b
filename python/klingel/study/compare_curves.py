"""The curves of a comparison with their speeds: those of the study by radius, any other by a short text or a file.
Nothing here simulates."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from klingel.assess.header import course_of
from klingel.errors import InputError, nearest
from klingel.scenario import Scenario
from klingel.track import CANT_BASE, Track
from klingel.track.cases import Case, perez2004
from klingel.units import to_si

TRANSITION, ARC, STRAIGHT, STRAIGHT_MORE = 4.0, 6.0, 3.0, 25.0
"""Seconds that a curve without lengths lasts: either transition, arc, either straight with these metres more; about
what the five curves of the study have."""

CURVE_KEYS = tuple(inspect.signature(Track.curve).parameters)


def curves(wanted: Iterable[float | str | Case] | None) -> list[Case]:
    """Curves, each with its speed, sharpest first; their tracks have different names.

    Args:
        wanted: of each the radius of one of the five curves of Perez et al. (2004) [m]; `R=500,speed=140 km/h` with any
            keyword of `Track.curve` (lengths not given last as long as those of the five, no cant); a scenario file
            (.toml), of which track and speed are taken; or a Case. None: the five.

    Raises:
        InputError: an unknown radius or key, a missing speed, a track with no single arc.

    Example:
        >>> [case.track.name for case in curves(["R=500,cant=100mm,speed=100km/h", 300])]
        ['R300', 'R500']
    """
    known = perez2004()
    made = list(known) if wanted is None else [_case(each, known) for each in wanted]
    if not made:
        raise InputError.single("curves", None, "there is none", remedy="give one, or leave it out for the five")
    made.sort(key=lambda case: (case.radius, case.speed))
    return list(_distinct(made))


def _case(wanted: object, known: tuple[Case, ...]) -> Case:
    if isinstance(wanted, Case):
        return wanted
    if isinstance(wanted, str) and wanted.endswith(".toml"):
        read = Scenario.read(wanted)
        return _of_track(dataclasses.replace(read.track, name=Path(wanted).stem), read.speed, wanted)
    if isinstance(wanted, str) and "=" in wanted:
        return _of_text(wanted)
    radius = to_si(value_of(wanted) if isinstance(wanted, str) else wanted, "m", key="curves")  # type: ignore[arg-type]
    for case in known:
        if abs(case.radius - radius) < 1e-6:
            return case
    listed = ", ".join(f"{case.radius:.0f}" for case in known)
    remedy = f"choose from {listed}, or describe it: R={radius:g},cant=100 mm,speed=100 km/h"
    raise InputError.single("curves", wanted, "is none of the five curves [m]", remedy=remedy)


def _of_text(text: str) -> Case:
    """A curve from `R=500,cant=160 mm,speed=140 km/h`."""
    given: dict[str, Any] = {}
    for pair in text.split(","):
        key, _, value = pair.partition("=")
        given["radius" if key.strip() == "R" else key.strip()] = value_of(value.strip())
    unknown = [key for key in given if key not in (*CURVE_KEYS, "speed")]
    if unknown:
        remedy = nearest(unknown[0], [*CURVE_KEYS, "speed", "R"])
        raise InputError.single(f"curves.{unknown[0]}", given[unknown[0]], "is not a known key", remedy=remedy)
    for key in ("radius", "speed"):
        if key not in given:
            raise InputError.single("curves", text, f"has no {key}", remedy="give it as R=500,speed=140 km/h")
    speed = to_si(given.pop("speed"), "m/s", key="curves.speed")
    straight = dict.fromkeys(("straight_before", "straight_after"), STRAIGHT * speed + STRAIGHT_MORE)
    lasting = {"transition": TRANSITION * speed, "arc": ARC * speed} | straight
    name = f"R{to_si(given['radius'], 'm', key='curves.radius'):g}"
    try:
        return _of_track(Track.curve(**({"name": name} | lasting | given)), speed, text)
    except InputError as error:
        raise error.within("curves") from None


def _of_track(track: Track, speed: float, given: object) -> Case:
    segments = [dataclasses.asdict(segment) for segment in track.segments]
    try:
        course = course_of({"segments": segments, "cant_base": CANT_BASE})
    except InputError as error:
        problem = error.problems[0]
        raise InputError.single("curves", given, problem.message, remedy=problem.remedy) from None
    return Case(round(1.0 / abs(course.curvature), 6), speed, track)


def _distinct(cases: Sequence[Case]) -> Iterator[Case]:
    """Cases whose tracks have different names: with the speed, then a number, where they would share one."""
    names = [case.track.name or f"R{case.radius:g}" for case in cases]
    fast = [
        f"{name}_{3.6 * case.speed:.0f}kmh" if names.count(name) > 1 else name
        for name, case in zip(names, cases, strict=True)
    ]
    for i, (case, name) in enumerate(zip(cases, fast, strict=True)):
        own = f"{name}_{fast[: i + 1].count(name)}" if fast.count(name) > 1 else name
        yield dataclasses.replace(case, track=dataclasses.replace(case.track, name=own))


def value_of(text: str) -> bool | int | float | str:
    """A value as a TOML file would have it, but for quotes.

    >>> value_of("2"), value_of("2.5 m"), value_of("true")
    (2, '2.5 m', True)
    """
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text.strip("'\"")
