"""Tracks with mistakes, as a database of curves may have them: wrong curvature or cant, wrong places.
Small functions from one track to another; `Track.mistaken` has them all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import TYPE_CHECKING

from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.track import Segment

Ends = tuple[float, float]


def curves(segments: Sequence[Segment]) -> list[range]:
    """Indices of the segments of each curve, from the start: what lies between two places without curvature."""
    marks: list[int] = []
    number = 0
    for i, segment in enumerate(segments):
        if segment.curvature != (0.0, 0.0) and (i == 0 or segment.curvature[0] == 0.0):
            number += 1
        marks.append(number if segment.curvature != (0.0, 0.0) else 0)
    found = []
    for mark, group in groupby(range(len(marks)), key=marks.__getitem__):
        members = list(group)
        if mark:
            found.append(range(members[0], members[-1] + 1))
    return found


def scaled(segments: Sequence[Segment], curvature: float, cant: float, only: int | None) -> Iterator[Segment]:
    """Curvature and cant times a factor each, of `only` one curve (1 is the first) or, for None, of all.

    Errors: InputError for a curve that there is not.
    """
    found = curves(segments)
    if only is not None and not (type(only) is int and 1 <= only <= len(found)):
        remedy = f"give 1 to {len(found)}" if found else "this track is straight"
        raise InputError.single("only", only, "is not of this track", remedy=remedy)
    wrong = range(len(segments)) if only is None else found[only - 1]
    for i, segment in enumerate(segments):
        if i in wrong:
            yield replace(segment, curvature=_times(segment.curvature, curvature), cant=_times(segment.cant, cant))
        else:
            yield segment


def shifted(segments: Sequence[Segment], by: float) -> Iterator[Segment]:
    """Everything lies farther along the track by a way [m], nearer for a negative one; the length stays.

    What is missing at an end goes on as the track begins, or ends; what is too much is cut off.
    """
    starts = [by]
    for segment in segments:
        starts.append(starts[-1] + segment.length)
    length = starts[-1] - by
    if by > 0.0:
        yield _piece(segments[0], 0.0, 0.0, length=min(by, length))
    for segment, (start, end) in zip(segments, pairwise(starts), strict=True):
        first, last = max(start, 0.0), min(end, length)
        if last > first:
            shares = ((first - start) / segment.length, (last - start) / segment.length)
            yield segment if shares == (0.0, 1.0) else _piece(segment, *shares, length=last - first)
    if by < 0.0:
        yield _piece(segments[-1], 1.0, 1.0, length=min(-by, length))


def _times(ends: Ends, factor: float) -> Ends:
    return (ends[0] * factor, ends[1] * factor)


def _piece(segment: Segment, first: float, last: float, *, length: float) -> Segment:
    """A part of a segment between two shares of its length."""

    def part(ends: Ends) -> Ends:
        return (ends[0] + first * (ends[1] - ends[0]), ends[0] + last * (ends[1] - ends[0]))

    return replace(
        segment, length=length, curvature=part(segment.curvature), cant=part(segment.cant), grade=part(segment.grade)
    )
