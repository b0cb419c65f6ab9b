"""The vehicle library: TOML files with units and sources, shipped inside the package.
`klingel doctor` prints their check sums, so that two installations can be compared."""

from __future__ import annotations

import hashlib
import tomllib
from importlib import resources

from klingel.errors import InputError, nearest
from klingel.vehicle import Vehicle


def names() -> list[str]:
    """Names of the library's vehicles, sorted.

    >>> names()
    ['manchester_coach', 'mechatronic_irw']
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
    return Vehicle.from_tables(tomllib.loads(text(name)), file=f"{name}.toml")


def text(name: str) -> str:
    """The file of that vehicle as text."""
    return (resources.files(__name__) / f"{name}.toml").read_text(encoding="utf-8")


def check_sum(name: str) -> str:
    """SHA-256 of the vehicle's file, first 16 hexadecimal digits."""
    return hashlib.sha256(text(name).encode()).hexdigest()[:16]
