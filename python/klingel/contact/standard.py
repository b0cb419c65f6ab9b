"""Profiles by what people type: the name of a standard one, or the path of a file with measured points.
One list of names for scenarios, files and the command line."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path

from klingel.contact.checks import Kind
from klingel.contact.profile import Profile
from klingel.errors import InputError, nearest

STANDARD: Mapping[Kind, Mapping[str, Callable[[], Profile]]] = {
    "wheel": {"S1002": Profile.s1002},
    "rail": {"60E1": Profile.rail_60e1, "54E1": Profile.rail_54e1, "UIC60": Profile.rail_uic60},
}
"""Standard profiles by name; a wheel may also be a cone, such as "cone 1:20"."""

CONE = re.compile(r"cone 1:(\d+(?:\.\d+)?)")


def profile_of(text: str, kind: Kind, *, units: str | None = None, folder: Path | None = None) -> Profile:
    """The standard profile of that name, or the one in the file of that path, checked to be a wheel's or a rail's.

    text: a name of STANDARD, "cone 1:20" or a path, relative to `folder`; units: of the file, None for what it states.
    Errors: InputError for a name that is neither known nor a file, and what the file is refused for.

    >>> profile_of("cone 1:20", "wheel").name
    'cone 1:20'
    """
    known = STANDARD[kind]
    if text in known:
        return known[text]()
    if kind == "wheel" and (cone := CONE.fullmatch(text)):
        return Profile.cone(1.0 / float(cone[1]))
    path = (folder or Path()) / text
    if not Path(text).suffix and not path.is_file():
        remedy = f"{nearest(text, list(known))}, or give the path of a file"
        raise InputError.single(kind, text, "is no standard profile", remedy=remedy)
    profile = Profile.read(path, units=units)
    profile.check(kind, key=kind)
    return profile
