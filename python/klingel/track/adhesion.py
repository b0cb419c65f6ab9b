"""Adhesion: friction of both rails along the track, a base value with patches of another one.
It holds for a standing contact; falling friction (`klingel.contact.CreepOptions`) lowers it with the slip velocity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.errors import InputError, Problem, nearest
from klingel.units import Quantity, to_si

Rail = Literal["both", "left", "right"]

FRICTION_MAX = 1.5
"""No dry rail has more [-]."""

OTHER: dict[str, Rail] = {"both": "both", "left": "right", "right": "left"}


@dataclass(frozen=True)
class Patch:
    """Friction [-] between two arc lengths [m] on one rail or on both."""

    start: float
    end: float
    friction: float
    rail: Rail = "both"


@dataclass(frozen=True, init=False)
class Adhesion:
    """Coefficient of friction along the track: `base`, and inside the patches theirs.

    base [-]; patches: `Patch`, or (start, end, friction) or (start, end, friction, rail), arc lengths with units or in
    m; transition: length over which the friction goes straight from one value to the other [m], before the start and
    behind the end of a patch. Errors: InputError with every problem; patches of one rail must not overlap, their
    transitions included.

    >>> Adhesion(patches=[("300 m", "500 m", 0.08), ("400 m", "410 m", 0.3, "left")])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    klingel.errors.InputError: patches.1.start = 400.0: lies in another patch of the left rail, ...
    >>> leaves = Adhesion(patches=[("300 m", "500 m", 0.08, "left")], transition="10 m")
    >>> leaves.left([290.0, 295.0, 400.0]), leaves.right(400.0)
    (array([0.35 , 0.215, 0.08 ]), array(0.35))
    """

    base: float
    patches: tuple[Patch, ...]
    transition: float

    def __init__(
        self,
        *,
        base: Quantity = 0.35,
        patches: Sequence[Patch | Sequence[Quantity]] = (),
        transition: Quantity = "5 m",
    ) -> None:
        object.__setattr__(self, "base", to_si(base, "1", key="base"))
        object.__setattr__(self, "transition", to_si(transition, "m", key="transition"))
        object.__setattr__(self, "patches", tuple(_patch(i, p) for i, p in enumerate(patches)))
        problems = list(_problems(self))
        if problems:
            raise InputError(problems)

    def left(self, s: ArrayLike) -> NDArray[np.float64]:
        """Friction of the left rail at arc length s [m]."""
        return self._at(s, "left")

    def right(self, s: ArrayLike) -> NDArray[np.float64]:
        """Friction of the right rail at arc length s [m]."""
        return self._at(s, "right")

    def points(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Arc lengths [m] where the friction of either rail has a corner, and both frictions there, each of shape (n,).

        >>> [a.tolist() for a in Adhesion(base=0.3).points()]
        [[0.0], [0.3], [0.3]]
        """
        patched = [rail for rail in ("left", "right") if any(p.rail in ("both", rail) for p in self.patches)]
        places = np.unique([s for rail in patched for s in self._corners(rail)[0]] or [0.0])
        return places, self.left(places), self.right(places)

    def mirrored(self) -> Adhesion:
        """The same with left and right exchanged."""
        patches = [replace(p, rail=OTHER[p.rail]) for p in self.patches]
        return Adhesion(base=self.base, patches=patches, transition=self.transition)

    def _at(self, s: ArrayLike, rail: str) -> NDArray[np.float64]:
        return np.asarray(np.interp(np.asarray(s, dtype=np.float64), *self._corners(rail)), dtype=np.float64)

    def _corners(self, rail: str) -> tuple[list[float], list[float]]:
        own = sorted((p for p in self.patches if p.rail in ("both", rail)), key=lambda p: p.start)
        if not own:
            return [0.0], [self.base]
        places: list[float] = []
        values: list[float] = []
        for p in own:
            shape = (p.start - self.transition, p.start, p.end, p.end + self.transition)
            for place, value in zip(shape, (self.base, p.friction, p.friction, self.base), strict=True):
                if not places or place > places[-1]:  # transitions may touch
                    places.append(place)
                    values.append(value)
        return places, values


def _patch(i: int, given: object) -> Patch:
    key = f"patches.{i}"
    if isinstance(given, Patch):
        given = (given.start, given.end, given.friction, given.rail)
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) not in (3, 4):
        raise InputError.single(key, given, "is no patch", remedy="give (start, end, friction) or a Patch")
    rail = given[3] if len(given) == 4 else "both"
    if rail not in get_args(Rail):
        raise InputError.single(f"{key}.rail", rail, "is not known", remedy=nearest(str(rail), list(get_args(Rail))))
    return Patch(
        to_si(given[0], "m", key=f"{key}.start"),
        to_si(given[1], "m", key=f"{key}.end"),
        to_si(given[2], "1", key=f"{key}.friction"),
        rail,  # type: ignore[arg-type]  # checked above
    )


def _problems(adhesion: Adhesion) -> Iterator[Problem]:
    frictions = [
        ("base", adhesion.base),
        *((f"patches.{i}.friction", p.friction) for i, p in enumerate(adhesion.patches)),
    ]
    for key, value in frictions:
        if not 0.0 < value <= FRICTION_MAX:
            yield Problem(key, value, "is no coefficient of friction", "give 0.05 to 0.6")
    if not adhesion.transition > 0.0:
        yield Problem("transition", adhesion.transition, "must be positive [m]", "give a length above zero")
    for i, p in enumerate(adhesion.patches):
        if not p.end > p.start:
            yield Problem(f"patches.{i}.end", p.end, "lies before the start [m]", f"give more than {p.start:g} m")
    for rail in ("left", "right"):
        numbered = [(i, p) for i, p in enumerate(adhesion.patches) if p.rail in ("both", rail)]
        for (_, before), (i, after) in pairwise(sorted(numbered, key=lambda each: each[1].start)):
            if after.start - adhesion.transition < before.end + adhesion.transition:
                yield Problem(
                    f"patches.{i}.start",
                    after.start,
                    f"lies in another patch of the {rail} rail, transitions included [m]",
                    f"start it behind {before.end + 2.0 * adhesion.transition:g} m",
                )


__all__ = ["Adhesion", "Patch", "Rail"]
