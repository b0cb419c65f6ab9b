"""A profile as points in metres: standard ones, and measured ones read from CSV.
Checked when made: finite, y rising, enough points, metres rather than millimetres."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.core import core
from klingel.errors import InputError, Problem

Values = NDArray[np.float64]

POINTS_MIN = 20
WIDTH_MAX = 1.0
"""Wider profiles [m] are taken for millimetres."""

SCALES = {("y_m", "z_m"): 1.0, ("y_mm", "z_mm"): 1e-3}
"""Headers of CSV files, and metres per unit."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Cross-section of a wheel or rail: points (y, z) in metres, y rising; the canonical one is the right one.

    Wheel: y from the tape circle, + to the field side, z the radius increment, + on the flange.
    Rail: y from its axis, + to the field side, z down from the top, not inclined.
    Errors: InputError with every problem.

    >>> float(Profile.s1002().depth(-0.05).round(4))
    0.0269
    """

    name: str
    y: Values
    z: Values

    def __post_init__(self) -> None:
        for axis in ("y", "z"):
            values = np.array(getattr(self, axis), dtype=np.float64)
            values.setflags(write=False)
            object.__setattr__(self, axis, values)
        problems = list(_problems(self.y, self.z))
        if problems:
            raise InputError(problems, file=self.name)

    @classmethod
    def s1002(cls) -> Self:
        """Wheel S1002 (EN 13715; flange 28 mm high, 32.5 mm thick) from its zone formulas, as the core runs it."""
        return cls("S1002", *core().profile("s1002"))

    @classmethod
    def rail_60e1(cls) -> Self:
        """Rail head 60E1 (EN 13674-1) from its three arcs and flank, as the core runs it."""
        return cls("60E1", *core().profile("60e1"))

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Points of a CSV file: `#` comments, header `y_m,z_m` or `y_mm,z_mm`, further columns ignored."""
        path = Path(path)
        if not path.is_file():
            raise InputError.single("", None, "no such file", remedy="check the path", file=str(path))
        lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip() and line[0] != "#"]
        rows = list(csv.reader(lines))
        header = tuple(name.strip() for name in rows[0][:2]) if rows else ()
        if len(header) != 2 or header not in SCALES:
            raise InputError.single(
                "header", ",".join(header), "is not known", remedy="use y_m,z_m or y_mm,z_mm", file=str(path)
            )
        points = np.array([_numbers(row, i, path) for i, row in enumerate(rows[1:], start=1)]).reshape(-1, 2)
        y, z = points.T * SCALES[header]
        order = slice(None, None, -1) if len(y) > 1 and y[0] > y[-1] else slice(None)
        return cls(str(path), y[order], z[order])

    def depth(self, y: ArrayLike) -> Values:
        """z at y [m], linear between the points; errors: InputError outside the profile."""
        at = np.asarray(y, dtype=np.float64)
        outside = at[(at < self.y[0]) | (at > self.y[-1])]
        if outside.size:
            remedy = f"use {self.y[0]:g} to {self.y[-1]:g} m"
            raise InputError.single("y", float(outside.flat[0]), "is outside the profile [m]", remedy=remedy)
        return np.asarray(np.interp(at, self.y, self.z))


def _numbers(row: list[str], index: int, path: Path) -> tuple[float, float]:
    try:
        return float(row[0]), float(row[1])
    except (ValueError, IndexError):
        remedy = "give two numbers in a row"
        raise InputError.single(f"point {index}", ",".join(row), "is no point", remedy=remedy, file=str(path)) from None


def _problems(y: Values, z: Values) -> Iterator[Problem]:
    if y.shape != z.shape or y.ndim != 1:
        yield Problem("points", f"{y.shape} and {z.shape}", "y and z differ in length", "give one z for every y")
        return
    if len(y) < POINTS_MIN:
        yield Problem("points", len(y), "are too few", f"give {POINTS_MIN} or more")
        return
    if not (np.all(np.isfinite(y)) and np.all(np.isfinite(z))):
        yield Problem("points", None, "are not all finite", "remove the others")
        return
    if np.any(np.diff(y) <= 0.0):
        where = int(np.argmax(np.diff(y) <= 0.0)) + 1
        yield Problem(f"point {where}", float(y[where]), "y does not rise", "sort the points, cut overhanging parts")
    if y[-1] - y[0] > WIDTH_MAX:
        yield Problem("width", float(y[-1] - y[0]), "is over a metre", "give metres; these look like millimetres")
