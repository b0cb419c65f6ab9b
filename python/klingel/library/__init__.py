"""The vehicle library: TOML files with units and sources, shipped inside the package.
`klingel doctor` prints their check sums, so that two installations can be compared."""

from __future__ import annotations

import hashlib
import tomllib
from importlib import resources
from typing import Any

from klingel.errors import InputError, nearest
from klingel.records import validated
from klingel.vehicle import InductionDrive, Vehicle
from klingel.vehicle.base import resolved


def names() -> list[str]:
    """Names of the library's vehicles, sorted.

    >>> names()
    ['actuated_coach', 'manchester_coach', 'mechatronic_irw', 'mechatronic_solid', 'trailed_irw']
    """
    files = resources.files(__name__).iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def vehicle(name: str) -> Vehicle:
    """The library's vehicle of that name; errors: InputError with the nearest known name.

    >>> vehicle("mechatronic_irw").independent_wheels
    True
    """
    if name not in names():
        raise InputError.single("vehicle", name, "is not in the library", remedy=nearest(name, names()))
    return Vehicle.from_tables(tables(name), file=f"{name}.toml")


def tables(name: str) -> dict[str, Any]:
    """The tables of that vehicle's file, with those of its base."""
    return resolved(tomllib.loads(text(name)), lambda file: tomllib.loads(text(file.removesuffix(".toml"))))


def drives() -> list[str]:
    """Names of the library's drives, sorted; that of a vehicle's file is in the vehicle.

    >>> drives()
    ['induction_160kw']
    """
    files = (resources.files(__name__) / "drives").iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def drive(name: str) -> InductionDrive:
    """The library's drive of that name, for `Vehicle.replace`; errors: InputError with the nearest known name.

    >>> drive("induction_160kw").pole_pairs
    2.0
    """
    if name not in drives():
        raise InputError.single("drive", name, "is not in the library", remedy=nearest(name, drives()))
    file = resources.files(__name__) / "drives" / f"{name}.toml"
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    return validated(InductionDrive, tables["drive"] | {"sources": tables["sources"]}, file=f"{name}.toml")


def text(name: str) -> str:
    """The file of that vehicle as text."""
    return (resources.files(__name__) / f"{name}.toml").read_text(encoding="utf-8")


def check_sum(name: str) -> str:
    """SHA-256 of the vehicle's file, first 16 hexadecimal digits."""
    return hashlib.sha256(text(name).encode()).hexdigest()[:16]
