"""Reads profiles from files: CSV, SIMPACK .prw and .prr, MiniProf .whl and .ban; the content tells which.
What the file holds is turned into the canonical right-hand profile, or refused where that would be a guess."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from klingel.contact import read_miniprof, read_simpack
from klingel.contact.checks import point_problems, size_problems
from klingel.contact.read_points import Drawn, Points, number
from klingel.contact.read_side import right_hand, trimmed
from klingel.errors import InputError
from klingel.units import to_si

HEADERS = {("y_m", "z_m"): 1.0, ("y_mm", "z_mm"): 1e-3}
"""Headers of CSV files, and metres per unit."""

FORMATS = "CSV with the header y_m,z_m or y_mm,z_mm, SIMPACK .prw and .prr, MiniProf .whl and .ban"


def read_profile(path: Path, units: str | None) -> Points:
    """The canonical points of a file [m]: y rising, of the right-hand wheel or rail.

    units: of lengths, such as "mm"; None takes those that the file states, or its format has. Errors: InputError.
    """
    if not path.is_file():
        raise InputError.single("", None, "no such file", remedy="check the path", file=str(path))
    try:
        drawn = _drawn(path, _text(path), units)
        if drawn.outline and np.isfinite(drawn.y).all():
            # Before points are taken for repeated ones: in a wrong unit all of them may be.
            if problems := list(size_problems(drawn.y)):
                raise InputError(problems)
            drawn = trimmed(drawn)
        problems = list(point_problems(*_rising(drawn)))
        if problems:
            raise InputError(problems)
        y, z = _rising(drawn)
        return right_hand(replace(drawn, y=y, z=z))
    except InputError as error:
        raise error.in_file(str(path)) from None


def _drawn(path: Path, text: str, units: str | None) -> Drawn:
    """What the file draws, in metres, in the order and on the side that it has."""
    scale = None if units is None else to_si(f"1 {units}", "m", key="units")
    suffix = path.suffix.lower()
    if re.search(r"^\s*(spline|point)\.begin", text, re.MULTILINE):
        return read_simpack.read(text, scale, suffix)
    if suffix in read_miniprof.KINDS or re.search(r"^(ColumnDef|XYPoints)\s*=", text, re.MULTILINE | re.IGNORECASE):
        return read_miniprof.read(text, scale, suffix)
    return _csv(text, scale)


def _csv(text: str, scale: float | None) -> Drawn:
    """Two columns with a header that states their unit; `#` comments, further columns ignored."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    rows = list(csv.reader(lines))
    header = tuple(name.strip() for name in rows[0][:2]) if rows else ()
    if len(header) != 2 or header not in HEADERS:
        remedy = f"use y_m,z_m or y_mm,z_mm in a CSV file; read are {FORMATS}"
        raise InputError.single("header", ",".join(header), "is not known", remedy=remedy)
    stated = HEADERS[header]
    if scale is not None and not np.isclose(scale, stated, rtol=1e-9):
        remedy = f"leave units out, or correct the header {header[0]},{header[1]}"
        raise InputError.single("units", f"{scale:g} m", "are not those of the file's header", remedy=remedy)
    points = np.array([number(row, i) for i, row in enumerate(rows[1:], start=1)]).reshape(-1, 2) * stated
    return Drawn(points[:, 0], points[:, 1], kind=None, sided=True, outline=False)


def _rising(drawn: Drawn) -> Points:
    y, z = drawn.y, drawn.z
    falling = len(y) > 1 and y[0] > y[-1]
    return Points(y[::-1], z[::-1]) if falling else Points(y, z)


def _text(path: Path) -> str:
    """Text of a file; measuring devices write UTF-8 or the code page of Western Europe."""
    raw = path.read_bytes()
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")
