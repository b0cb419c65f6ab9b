"""Published spectra of track irregularity: ORE B176, FRA, SNCF, TB/T 3352; numbers and sources in irregularity.toml.
Each function gives a `Quality`: one spectrum for every kind that the source has."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Mapping
from importlib import resources
from types import MappingProxyType
from typing import Annotated, Any

from pydantic import Field

from klingel.errors import InputError, nearest
from klingel.records import Record, Sourced, Status, validated
from klingel.track import CANT_BASE
from klingel.track.irregularity import KINDS, Kind, Knee, Powers, Quality, Rational, Spectrum

Positive = Annotated[float, Field(gt=0.0)]


class _Family(Sourced):
    wavelengths: tuple[Positive, Positive]


class _Erri(_Family):
    Omega_c: Positive
    Omega_r: Positive
    Omega_s: Positive
    base: Positive
    A: dict[str, dict[Kind, Positive]]


class _FraClass(Record):
    A_v: Positive
    A_a: Positive
    Omega_s: Positive
    estimated: dict[str, Status] = Field(default_factory=dict)


class _Fra(_Family):
    k: Positive
    Omega_c: Positive
    classes: tuple[_FraClass, ...]


class _Sncf(_Family):
    n0: Positive
    A: dict[str, Positive]


class _Powers(Record):
    limits: tuple[Positive, ...]
    A: tuple[Positive, ...]
    exponents: tuple[Positive, ...]


class _China(_Family):
    vertical: _Powers
    alignment: _Powers
    crosslevel: _Powers
    gauge: _Powers


class _File(Record):
    sources: dict[str, str]
    erri_b176: _Erri
    fra: _Fra
    sncf: _Sncf
    china_ballastless: _China


@functools.cache
def _file() -> _File:
    text = (resources.files("klingel.track") / "irregularity.toml").read_text(encoding="utf-8")
    return validated(_File, tomllib.loads(text), file="irregularity.toml")


def erri_b176(level: str) -> Quality:
    """ORE B176, `low` or `high` level, all four kinds; 3 m to 150 m.

    S = A Oc^2/((O^2 + Or^2)(O^2 + Oc^2)); for the angle of crosslevel and gauge with O^2/(O^2 + Os^2) besides.
    """
    f = _file().erri_b176
    A = _chosen("level", level, f.A)
    mean, both = (f.Omega_r, f.Omega_c), (f.Omega_r, f.Omega_c, f.Omega_s)
    angle = A["vertical"] / f.base**2 * CANT_BASE**2
    laws: dict[Kind, Rational] = {
        "vertical": Rational(A["vertical"] * f.Omega_c**2, 0.0, mean),
        "alignment": Rational(A["alignment"] * f.Omega_c**2, 0.0, mean),
        "crosslevel": Rational(angle * f.Omega_c**2, 2.0, both),
        "gauge": Rational(A["gauge"] * f.Omega_c**2, 2.0, both),
    }
    return _quality(f"ORE B176 {level}", laws, f)


def fra(track_class: int) -> Quality:
    """FRA track class 1 (worst) to 6, all four kinds; 1.524 m to 304.8 m. A in cm2 rad/m.

    S = k A Oc^2/(O^2 (O^2 + Oc^2)); crosslevel and gauge 4 k Av Oc^2/((O^2 + Oc^2)(O^2 + Os^2)).
    """
    f = _file().fra
    known = {str(i): each for i, each in enumerate(f.classes, start=1)}
    c = _chosen("track_class", str(track_class), known)
    unit = 1e-4 * f.k * f.Omega_c**2
    both = Rational(4.0 * unit * c.A_v, 0.0, (f.Omega_c, c.Omega_s))
    laws: dict[Kind, Rational] = {
        "vertical": Rational(unit * c.A_v, 0.0, (0.0, f.Omega_c)),
        "alignment": Rational(unit * c.A_a, 0.0, (0.0, f.Omega_c)),
        "crosslevel": both,
        "gauge": both,
    }
    alignment, corner = c.estimated.get("A_a"), c.estimated.get("Omega_s")
    weaker = {"alignment": alignment, "crosslevel": corner, "gauge": corner}
    return _quality(f"FRA class {track_class}", laws, f, {k: s for k, s in weaker.items() if s is not None})


def sncf(level: str) -> Quality:
    """SNCF, `good` or `poor` track, vertical only; 2 m to 40 m. S = A/(1 + n/n0)^3 over n [1/m]."""
    f = _file().sncf
    return _quality(f"SNCF {level}", {"vertical": Knee(_chosen("level", level, f.A), f.n0)}, f)


def china_ballastless() -> Quality:
    """Ballastless high-speed track of TB/T 3352, all four kinds; 2 m to 200 m. S = A/n^k [mm2/(1/m)] in pieces."""
    f = _file().china_ballastless
    tables = {kind: getattr(f, kind) for kind in KINDS}
    laws = {kind: Powers(t.limits, tuple(1e-6 * a for a in t.A), t.exponents) for kind, t in tables.items()}
    return _quality("TB/T 3352 ballastless", laws, f)


def _quality(
    name: str, laws: Mapping[Kind, Any], family: _Family, weaker: Mapping[str, Status] = MappingProxyType({})
) -> Quality:
    """`weaker`: kinds some of whose numbers have another status than the family."""
    titles = tuple(f"{source}: {_file().sources[source]}" for source in family.source)
    return Quality(
        name,
        {
            kind: Spectrum(f"{name}, {kind}", kind, law, family.wavelengths, weaker.get(kind, family.status), titles)
            for kind, law in laws.items()
        },
    )


def _chosen(key: str, value: str, known: Mapping[str, Any]) -> Any:
    if value not in known:
        raise InputError.single(key, value, "is not known", remedy=nearest(value, list(known)))
    return known[value]
