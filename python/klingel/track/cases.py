"""Track cases of published studies: a track and the speed it is run at, with their sources.
The numbers are in the TOML files beside this module."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib import resources

from klingel.records import Record, Status, validated
from klingel.track import Hand, Track
from klingel.units import PositiveLength, PositiveSpeed


@dataclass(frozen=True)
class Case:
    """A curve of a study: radius [m] (positive), speed [m/s], its track."""

    radius: float
    speed: float
    track: Track


class _Curve(Record):
    radius: PositiveLength
    speed: PositiveSpeed
    cant: PositiveLength
    transition: PositiveLength
    arc: PositiveLength
    straight: PositiveLength


class _File(Record):
    source: str
    status: Status
    curve: tuple[_Curve, ...]


def perez2004(*, hand: Hand = "right") -> tuple[Case, ...]:
    """The five curves of Perez et al. (2004), R 300 to 1800 m at 108 to 265 km/h, cant 160 mm.

    >>> [round(case.speed * 3.6) for case in perez2004()]
    [108, 140, 176, 216, 265]
    """
    text = (resources.files("klingel.track") / "perez2004.toml").read_text(encoding="utf-8")
    file = validated(_File, tomllib.loads(text), file="perez2004.toml")
    return tuple(Case(curve.radius, curve.speed, _track(curve, hand)) for curve in file.curve)


def _track(curve: _Curve, hand: Hand) -> Track:
    return Track.curve(
        radius=curve.radius,
        cant=curve.cant,
        transition=curve.transition,
        arc=curve.arc,
        straight_before=curve.straight,
        straight_after=curve.straight,
        hand=hand,
        name=f"R{curve.radius:g}",
    )
