"""Formulas of running resistance and of curve resistance, with their constants, sources and statuses.
The numbers are in `resistance.toml` beside this module; every formula gives a whole train on straight level track."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Literal

from klingel.errors import InputError, nearest
from klingel.records import Record, Status, validated
from klingel.units import Length, PositiveLength, PositiveMass

GRAVITY = 9.81
"""[m/s2], as in the runs."""

KMH = 1.0 / 3.6
"""One km/h [m/s]."""

Resistance = Callable[[float], float]
"""Running resistance [N] over speed [m/s]."""

Unit = Literal["N", "daN", "kN", "N/kN", "N/kg"]

NEWTONS: Mapping[str, float] = {"N": 1.0, "daN": 10.0, "kN": 1e3, "N/kN": 1e-3 * GRAVITY, "N/kg": 1.0}
"""One of the unit in N, for the last two of one kg of the train."""


@dataclass(frozen=True)
class DavisCoefficients:
    """R = constant + linear v + quadratic v^2, v in m/s: N, N s/m, N s2/m2.

    >>> DavisCoefficients(400.0, 20.0, 3.0)(10.0)
    900.0
    """

    constant: float
    linear: float
    quadratic: float

    def __call__(self, speed: float) -> float:
        """Resistance [N] at `speed` [m/s]."""
        return self.constant + self.linear * speed + self.quadratic * speed**2

    def share(self, parts: float) -> DavisCoefficients:
        """One of `parts` equal parts."""
        return DavisCoefficients(self.constant / parts, self.linear / parts, self.quadratic / parts)


class _Entry(Record):
    source: str
    status: Status


class _Front(_Entry):
    values: dict[str, float]


class _SncfGeneral(_Entry):
    lambda_: dict[str, float]
    k1: _Front
    k2: dict[str, float]


class _Sauthoff(_Entry):
    constant: float
    linear: float
    air: float
    locomotive: float
    area: float
    wind: float


class _Strahl(_Entry):
    constant: float
    quadratic: float
    load: dict[str, float]


class _Polynomial(_Entry):
    unit: Unit
    speed: Literal["m/s", "km/h"]
    coefficients: tuple[float, float, float]
    train_mass: PositiveMass | None = None


class _Curve(_Entry):
    force: float
    less: Length
    radius_min: PositiveLength


class _File(Record):
    sncf_general: _SncfGeneral
    sauthoff: _Sauthoff
    strahl: _Strahl
    polynomial: dict[str, _Polynomial]
    curve: dict[str, _Curve]


@cache
def constants() -> _File:
    """Constants of all formulas with their sources and statuses, as `resistance.toml` has them.

    >>> constants().sauthoff.status
    'repo'
    """
    tables = tomllib.loads((resources.files("klingel.drives") / "resistance.toml").read_text(encoding="utf-8"))
    general = tables["sncf_general"]
    general["lambda_"] = general.pop("lambda")  # a word of the language
    return validated(_File, tables, file="resistance.toml")


def sncf_general(
    *, mass: float, axle_load: float, front_area: float, perimeter: float, length: float, stock: str
) -> DavisCoefficients:
    """The general SNCF formula.

    R[daN] = lambda M sqrt(10/m) + 0.01 M V + (k1 S + k2 p L) V^2 with train mass M [t], mass per axle m [t], speed V
    [km/h], front area S [m2], partial perimeter p [m], train length L [m].

    mass, axle_load: kg; front_area: m2; perimeter, length: m; stock: "tgv", "passenger" or "freight".
    Source: constants of a public file (TEGA davis.h) whose sqrt(1e5/m) is wrong by sqrt(10); corrected as here it
    gives 48.5 kN for a TGV of 418 t at 265 km/h, where the TGV formula gives 50.0 kN. Error: InputError for a stock
    that has no constants.

    >>> train = sncf_general(mass=418e3, axle_load=16.1e3, front_area=10.0, perimeter=10.0, length=200.0, stock="tgv")
    >>> round(train(265 / 3.6) / 1e3, 1)
    48.5
    """
    c = constants().sncf_general
    tonnes, per_axle = mass / 1e3, axle_load / 1e3
    drag = _row(c.k1.values, stock) * front_area + _row(c.k2, stock) * perimeter * length
    return DavisCoefficients(
        constant=10.0 * _row(c.lambda_, stock) * tonnes * (10.0 / per_axle) ** 0.5,
        linear=10.0 * 0.01 * tonnes * 3.6,
        quadratic=10.0 * drag * 3.6**2,
    )


def sauthoff(*, mass: float, cars: float) -> DavisCoefficients:
    """Sauthoff's formula for passenger trains.

    w[N/kN] = 1.9 + 0.0025 V + 0.0048 (n + 2.7) 1.45/m (V + 15)^2 with n coaches, train mass m [t] and V [km/h].
    mass: of the train [kg]; cars: coaches [-].

    >>> round(sauthoff(mass=355.856e3, cars=8)(30.0) / 64)
    291
    """
    c = constants().sauthoff
    air = c.air * (cars + c.locomotive) * c.area / (mass / 1e3)
    constant, linear = c.constant + air * c.wind**2, c.linear + 2.0 * air * c.wind
    return _davis((constant, linear, air), mass * NEWTONS["N/kN"], KMH)


def strahl(*, mass: float, stock: str) -> DavisCoefficients:
    """Strahl's formula for freight trains.

    w[N/kN] = 2.0 + (0.007 + 1/m) (V/10)^2, V [km/h]. mass: of the train [kg]; stock: "block", "loaded" or "empty".
    Error: InputError for another stock.

    >>> round(strahl(mass=1000e3, stock="loaded")(20.0) / 1e3, 1)
    43.5
    """
    c = constants().strahl
    quadratic = (c.quadratic + 1.0 / _row(c.load, stock)) / 100.0
    return _davis((c.constant, 0.0, quadratic), mass * NEWTONS["N/kN"], KMH)


def polynomial(name: str, *, mass: float) -> DavisCoefficients:
    """The formula of a type of train: "tgv", "x2000", "osrd_high_speed", "shinkansen_200", "ave_s100", "crh2" or
    "crh380a", in proportion to the mass where it is that of one train.

    mass: of what runs [kg]. Error: InputError for another name.

    >>> round(polynomial("tgv", mass=418e3)(265 / 3.6) / 1e3, 1)
    50.0
    """
    known = constants().polynomial
    if name not in known:
        raise InputError.single("formula", name, "is not known", remedy=nearest(name, list(known)))
    c = known[name]
    share = 1.0 if c.train_mass is None else 1.0 / c.train_mass
    return _davis(c.coefficients, mass * share * NEWTONS[c.unit], 1.0 if c.speed == "m/s" else KMH)


def curve_resistance(*, mass: float, radius: float, formula: str = "roeckl") -> float:
    """What a curve adds to the running resistance [N], by "roeckl", 650/(R - 55) N/kN, or "sncf", 800/R N/kN.

    mass: of what runs [kg]; radius [m]. A simulated vehicle makes its own curve resistance in its contacts, so no run
    adds this one. Errors: InputError for another formula, and for a radius that it is not made for.

    >>> round(curve_resistance(mass=44.482e3, radius=600.0))
    520
    """
    known = constants().curve
    if formula not in known:
        raise InputError.single("formula", formula, "is not known", remedy=nearest(formula, list(known)))
    c = known[formula]
    if radius < c.radius_min:
        remedy = f"give {c.radius_min:g} m or more"
        raise InputError.single("radius", radius, f"is tighter than {formula}'s formula is made for [m]", remedy=remedy)
    return mass * NEWTONS["N/kN"] * c.force / (radius - c.less)


def _davis(coefficients: tuple[float, float, float], newtons: float, speed: float) -> DavisCoefficients:
    """Coefficients in units of `newtons` [N] and of `speed` [m/s] as SI."""
    a, b, c = coefficients
    return DavisCoefficients(a * newtons, b * newtons / speed, c * newtons / speed**2)


def _row(rows: Mapping[str, float], stock: str) -> float:
    if stock not in rows:
        raise InputError.single("stock", stock, "has no constants", remedy=f"give one of {', '.join(rows)}")
    return rows[stock]
