"""Track: straights, clothoids, arcs, cant ramps and grades, one behind the other, and the friction of its rails.
All are linear inside a segment; rho > 0 is a right-hand curve, cant > 0 raises the left rail, grade > 0 climbs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.errors import InputError, Problem
from klingel.track.adhesion import Adhesion, Patch, Rail
from klingel.track.mistaken import scaled, shifted
from klingel.units import Quantity, to_si

CANT_BASE = 1.5
"""Lateral distance over which cant is measured [m] (EN 13803, 1435 mm gauge)."""

RADIUS_MIN = 150.0
"""Tightest curve [m]: EN 13803 plans main tracks no tighter than this."""

CANT_MAX = 0.2
"""Largest cant [m]: EN 13803 stays at 180 mm, the exceptional limit."""

RAMP_MAX = 1.0 / 400.0
"""Steepest cant ramp [m/m]: EN 13803's limit against derailment by twist is 2.5 mm/m."""

GRADE_MAX = 0.1
"""Steepest grade [-]: beyond it railways use racks."""

Hand = Literal["right", "left"]


@dataclass(frozen=True)
class Segment:
    """Piece of track: length [m]; curvature [1/m], cant [m] and grade [-] at its start and end, linear between.

    grade: rise over way, positive uphill. It tilts gravity along the track; the vertical curvature that goes with a
    change of grade is left out.
    """

    length: float
    curvature: tuple[float, float] = (0.0, 0.0)
    cant: tuple[float, float] = (0.0, 0.0)
    grade: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Track:
    """Segments one behind the other, from s = 0; checked when made (errors: InputError with every problem).

    >>> track = Track.curve(radius="800 m", cant="160 mm", transition="195 m", arc="300 m")
    >>> track.length, float(track.curvature(500.0))
    (990.0, 0.00125)
    """

    segments: tuple[Segment, ...]
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "segments", tuple(self.segments))
        problems = list(_problems(self.segments))
        if problems:
            raise InputError(problems)

    @classmethod
    def straight(cls, length: Quantity, *, grade: Quantity = 0.0, name: str = "") -> Self:
        """Straight track of that length [m] and grade [-].

        >>> Track.straight("1 km").length
        1000.0
        """
        slope = to_si(grade, "1", key="grade")
        return cls((Segment(to_si(length, "m", key="length"), grade=(slope, slope)),), name=name)

    @classmethod
    def curve(
        cls,
        *,
        radius: Quantity,
        cant: Quantity = 0.0,
        transition: Quantity = "100 m",
        arc: Quantity = "300 m",
        straight_before: Quantity = "150 m",
        straight_after: Quantity = "150 m",
        hand: Hand = "right",
        grade: Quantity = 0.0,
        name: str = "",
    ) -> Self:
        """A circular arc between two clothoids with linear cant ramps, and straights around them [m].

        radius and cant are given as positive numbers, `hand` says which way the curve turns;
        grade [-] is the same from end to end.
        """
        lengths = {
            "radius": to_si(radius, "m", key="radius"),
            "cant": to_si(cant, "m", key="cant"),
            "transition": to_si(transition, "m", key="transition"),
            "arc": to_si(arc, "m", key="arc"),
            "straight_before": to_si(straight_before, "m", key="straight_before"),
            "straight_after": to_si(straight_after, "m", key="straight_after"),
        }
        problems = [
            Problem(k, v, "must be positive [m]", "give a length above zero") for k, v in lengths.items() if v < 0
        ]
        if lengths["radius"] == 0.0:
            problems.append(Problem("radius", 0.0, "must be positive [m]", "give a radius, or use Track.straight"))
        if hand not in ("right", "left"):
            problems.append(Problem("hand", hand, "is no hand", "use 'right' or 'left'"))
        if problems:
            raise InputError(problems)
        sign = 1.0 if hand == "right" else -1.0
        climb = (to_si(grade, "1", key="grade"),) * 2
        rho, h, ramp = sign / lengths["radius"], sign * lengths["cant"], lengths["transition"]
        segments = [
            Segment(lengths["straight_before"], grade=climb),
            Segment(ramp, (0.0, rho), (0.0, h), climb),
            Segment(lengths["arc"], (rho, rho), (h, h), climb),
            Segment(ramp, (rho, 0.0), (h, 0.0), climb),
            Segment(lengths["straight_after"], grade=climb),
        ]
        return cls(tuple(s for s in segments if s.length > 0.0), name=name)

    @property
    def length(self) -> float:
        """Total length [m]."""
        return float(sum(segment.length for segment in self.segments))

    @property
    def starts(self) -> tuple[float, ...]:
        """Arc length at which each segment starts [m]."""
        return tuple(accumulate((segment.length for segment in self.segments[:-1]), initial=0.0))

    def curvature(self, s: ArrayLike) -> NDArray[np.float64]:
        """Curvature at arc length s [1/m]; errors: InputError outside the track."""
        return self._at(s, [segment.curvature for segment in self.segments])

    def cant(self, s: ArrayLike) -> NDArray[np.float64]:
        """Cant at arc length s [m]; errors: InputError outside the track."""
        return self._at(s, [segment.cant for segment in self.segments])

    def grade(self, s: ArrayLike) -> NDArray[np.float64]:
        """Grade at arc length s [-]; errors: InputError outside the track."""
        return self._at(s, [segment.grade for segment in self.segments])

    def mirrored(self) -> Track:
        """The same track with right and left exchanged."""
        flipped = (
            Segment(s.length, (-s.curvature[0], -s.curvature[1]), (-s.cant[0], -s.cant[1]), s.grade)
            for s in self.segments
        )
        return Track(tuple(flipped), name=self.name)

    def mistaken(
        self,
        *,
        curvature_scale: Quantity = 1.0,
        cant_scale: Quantity = 1.0,
        only: int | None = None,
        shift: Quantity = 0.0,
    ) -> Track:
        """This track as a database with mistakes has it, for `Scenario(database=...)`.

        curvature_scale, cant_scale: factors on all curves, or `only` on one of them (1 is the first): 1.1 is a tenth
        too much, 0 a missing curve (give both), -1 one of the wrong hand; shift [m]: how much farther along the
        track everything lies, nearer for a negative one.
        Errors: InputError for a curve that there is not, and for what is no track.

        >>> track = Track.curve(radius="800 m", cant="100 mm", transition="100 m")
        >>> wrong = track.mistaken(curvature_scale=1.1, shift="-30 m")
        >>> float(wrong.curvature(220.0)) == 1.1 * float(track.curvature(250.0))
        True
        >>> float(abs(track.mistaken(curvature_scale=0, cant_scale=0, only=1).cant([300.0, 500.0])).max())
        0.0
        """
        factors = (to_si(curvature_scale, "1", key="curvature_scale"), to_si(cant_scale, "1", key="cant_scale"))
        wrong = tuple(scaled(self.segments, *factors, only))
        by = to_si(shift, "m", key="shift")
        if not abs(by) < self.length:
            raise InputError.single("shift", shift, "is beyond the track", remedy=f"give less than {self.length:g} m")
        return Track(tuple(shifted(wrong, by)) if by else wrong, name=self.name)

    def _at(self, s: ArrayLike, ends: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
        at = np.asarray(s, dtype=np.float64)
        if at.size and (np.min(at) < 0.0 or np.max(at) > self.length):
            outside = float(np.min(at)) if np.min(at) < 0.0 else float(np.max(at))
            raise InputError.single("s", outside, "is outside the track", remedy=f"use 0 to {self.length:g} m")
        starts = np.asarray(self.starts)
        i = np.clip(np.searchsorted(starts, at, side="right") - 1, 0, len(starts) - 1)
        share = (at - starts[i]) / np.asarray([segment.length for segment in self.segments])[i]
        a, b = np.asarray(ends).T
        return np.asarray(a[i] + share * (b[i] - a[i]), dtype=np.float64)


def _problems(segments: Sequence[Segment]) -> Iterable[Problem]:
    if not segments:
        yield Problem("segments", None, "the track has no segment", "give at least one")
    for i, segment in enumerate(segments):
        key = f"segments.{i}"
        if not segment.length > 0.0:
            yield Problem(f"{key}.length", segment.length, "must be positive [m]", "give a length above zero")
            continue
        tightest = max(abs(rho) for rho in segment.curvature)
        if tightest * RADIUS_MIN > 1.0:
            remedy = f"use a radius of {RADIUS_MIN:g} m or more"
            yield Problem(f"{key}.radius", round(1.0 / tightest, 3), "curve is too tight [m]", remedy)
        highest = max(segment.cant, key=abs)
        if abs(highest) > CANT_MAX:
            remedy = f"use {CANT_MAX * 1e3:g} mm or less; plain numbers are metres"
            yield Problem(f"{key}.cant", highest, "is too high [m]", remedy)
        steepest = max(segment.grade, key=abs)
        if abs(steepest) > GRADE_MAX:
            remedy = f"use {GRADE_MAX:g} or less, rise over way"
            yield Problem(f"{key}.grade", steepest, "is too steep [-]", remedy)
        ramp = abs(segment.cant[1] - segment.cant[0]) / segment.length
        if ramp > RAMP_MAX:
            remedy = f"use 1:{1.0 / RAMP_MAX:g} or flatter: lengthen the transition"
            yield Problem(f"{key}.cant", segment.cant, f"cant ramp of 1:{1.0 / ramp:.0f} is too steep", remedy)
    for i, (before, after) in enumerate(pairwise(segments), start=1):
        if abs(after.cant[0] - before.cant[1]) > 1e-9:
            yield Problem(f"segments.{i}.cant", after.cant, "cant jumps", f"start it at {before.cant[1]:g} m")
        if abs(after.curvature[0] - before.curvature[1]) > 1e-12:
            remedy = f"start it at {before.curvature[1]:g} 1/m, with a transition between"
            yield Problem(f"segments.{i}.curvature", after.curvature, "curvature jumps", remedy)
        if abs(after.grade[0] - before.grade[1]) > 1e-12:
            remedy = f"start it at {before.grade[1]:g}, with a vertical transition between"
            yield Problem(f"segments.{i}.grade", after.grade, "grade jumps", remedy)


__all__ = ["CANT_BASE", "Adhesion", "Hand", "Patch", "Rail", "Segment", "Track"]
