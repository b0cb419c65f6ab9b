"""Options of the creep laws in a scenario; off by default, which gives the laws as published for dry, clean bodies.
The same words as the keywords of `klingel.contact.creep_force`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from klingel.errors import InputError, Problem

LENGTHS = {"slope": 3, "reduction": 2, "falling": 2}
"""Numbers that an option takes."""


@dataclass(frozen=True)
class CreepOptions:
    """What a creep law is asked for beside its grid; docs/theory/creep.md derives each.

    blended: of `fastsim`: its three flexibilities blend into one as sliding sets in;
    slope: of `fastsim`: (k0, alpha, beta) of Spiryagin's reduced initial slope;
    reduction: of `polach`: (kA, kS), the reduced stiffness in adhesion and in slip;
    falling: of every law: (A, B [s/m]), friction falls with the slip velocity w as mu ((1 - A) exp(-B w) + A).
    Errors: InputError for what is no set of numbers; the core refuses options of another law.

    >>> CreepOptions(falling=(0.4, 0.6)).spec()["falling"]
    [0.4, 0.6]
    """

    blended: bool = False
    slope: tuple[float, float, float] | None = None
    reduction: tuple[float, float] | None = None
    falling: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for key in LENGTHS:
            if isinstance(given := getattr(self, key), list):
                object.__setattr__(self, key, tuple(given))
        problems = list(self._problems())
        if problems:
            raise InputError(problems)

    def _problems(self) -> Iterator[Problem]:
        if not isinstance(self.blended, bool):
            yield Problem("blended", self.blended, "is no yes or no", "give True or False")
        for key, length in LENGTHS.items():
            given = getattr(self, key)
            numbers = isinstance(given, tuple) and all(type(x) in (int, float) for x in given)
            if given is not None and not (numbers and len(given) == length):
                yield Problem(key, given, f"is no set of {length} numbers", f"give {length} numbers or leave it out")

    def spec(self) -> dict[str, Any]:
        """The options as the core's spec has them."""
        return {"blended": self.blended} | {key: _plain(getattr(self, key)) for key in LENGTHS}


def _plain(numbers: tuple[float, ...] | None) -> list[float] | None:
    return None if numbers is None else list(numbers)


AS_PUBLISHED = CreepOptions()
"""No options."""
