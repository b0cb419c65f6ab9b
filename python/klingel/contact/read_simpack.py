"""Reads SIMPACK profiles (.prw wheels, .prr rails): points in a spline block with the steps that prepare them.
The steps come as CONTACT applies them: distance, shift, rotation, bounds, mirrors, units. y to the right, z down."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from klingel.contact.checks import Kind
from klingel.contact.read_points import Drawn, number
from klingel.errors import InputError

Values = NDArray[np.float64]

KINDS: Mapping[str, Kind] = {".prw": "wheel", ".prr": "rail"}
TYPES: Mapping[float, Kind] = {0.0: "rail", 1.0: "wheel"}
"""The header's type."""

NAMES = {"m": 1.0, "cm": 1e2, "mm": 1e3, "in": 1 / 0.0254, "inch": 1 / 0.0254}
"""Names of lengths and how many of them make a metre."""

LOG = logging.getLogger("klingel")


def read(text: str, scale: float | None, suffix: str) -> Drawn:
    """Points of a SIMPACK file [m]; `scale` in metres per unit if the caller states it. Errors: InputError."""
    fields, rows = _parsed(text)
    points = np.array([number(row, i) for i, row in enumerate(rows, start=1)]).reshape(-1, 2)
    kind = _kind(fields, suffix)
    per_metre = _per_metre(fields, scale)
    if _real(fields, "approx.smooth", 0.0) != 0.0:
        LOG.warning("approx.smooth = %s is left to SIMPACK; smooth with Profile.smoothed", fields["approx.smooth"])
    points = _prepared(points, fields)
    if not len(points):
        raise InputError.single("point.begin", None, "no points are left", remedy="check the block and its bounds")
    return Drawn(points[:, 0] / per_metre, points[:, 1] / per_metre, kind=kind, sided=True, outline=True)


def _parsed(text: str) -> tuple[dict[str, str], list[list[str]]]:
    """Keys of the header and the spline block (the header's with `header.` before them), and the rows of points."""
    fields: dict[str, str] = {}
    rows: list[list[str]] = []
    blocks: list[str] = []
    for raw in text.splitlines():
        # A comment begins with ! outside a quoted text.
        line = re.sub(r"^((?:[^'!]|'[^']*')*)!.*$", r"\1", raw).strip()
        if line.endswith(".begin"):
            blocks.append(line.removesuffix(".begin"))
        elif line.endswith(".end") and "=" not in line:
            if not blocks or blocks.pop() != line.removesuffix(".end"):
                raise InputError.single(line, None, "closes no open block", remedy="pair every .begin with its .end")
        elif "=" in line:
            key, value = (part.strip() for part in line.split("=", 1))
            fields[f"header.{key}" if "header" in blocks else key] = value.strip("'\"")
        elif line and "point" in blocks:
            rows.append(line.replace(",", " ").split())
    return fields, rows


def _kind(fields: Mapping[str, str], suffix: str) -> Kind | None:
    """Wheel or rail by header and extension, which must agree."""
    by_name = KINDS.get(suffix)
    if "header.type" not in fields:
        return by_name
    stated = TYPES.get(_real(fields, "header.type", -1.0))
    if stated is None:
        remedy = "give 0 for a rail, 1 for a wheel"
        raise InputError.single("header type", fields["header.type"], "is not known", remedy=remedy)
    if by_name is not None and by_name != stated:
        remedy = f"a {stated} belongs into a {'.prw' if stated == 'wheel' else '.prr'} file"
        raise InputError.single("header type", fields["header.type"], f"is a {stated}'s, in a {suffix}", remedy=remedy)
    return stated


def _per_metre(fields: Mapping[str, str], scale: float | None) -> float:
    """User lengths in a metre: the factor, else the name, else metres; what is stated twice must agree."""
    stated: list[tuple[str, float]] = []
    if "units.len.f" in fields:
        stated.append(("units.len.f", _real(fields, "units.len.f", 1.0)))
    if (name := fields.get("units.len", "").lower()) in NAMES:
        stated.append(("units.len", NAMES[name]))
    if scale is not None:
        stated.append(("units", 1.0 / scale))
    if not stated:
        return 1.0
    for key, value in stated:
        if not value > 0.0:
            raise InputError.single(key, value, "must be positive", remedy="give lengths per metre, 1000 for mm")
        if not np.isclose(value, stated[0][1], rtol=1e-9):
            remedy = f"{stated[0][0]} says {stated[0][1]:g} a metre; make them agree"
            raise InputError.single(key, f"{value:g} a metre", "is another unit", remedy=remedy)
    return stated[0][1]


def _prepared(points: Values, fields: Mapping[str, str]) -> Values:
    """The steps of the spline block, in user units."""

    def value(key: str, absent: float = 0.0) -> float:
        return _real(fields, key, absent)

    least = value("point.dist.min")
    if least > 0.0 and len(points):
        kept = [0]
        for i in range(1, len(points)):
            if abs(points[i, 0] - points[kept[-1], 0]) > least:
                kept.append(i)
        points = points[kept]
    points = points + np.array([value("shift.y"), value("shift.z")])
    angle = value("rotate") / value("units.ang.f", 1.0)
    cos, sin = np.cos(angle), np.sin(angle)
    points = points @ np.array([[cos, sin], [-sin, cos]])
    # Bounds in reverse order, as SIMPACK writes them, mean none.
    low, high = value("bound.y.min", 1.0), value("bound.y.max")
    if low < high:
        points = points[(points[:, 0] >= low) & (points[:, 0] <= high)]
    low, high = value("bound.z.min", 1.0), value("bound.z.max")
    if low < high:
        points = np.column_stack([points[:, 0], np.clip(points[:, 1], low, high)])
    return points * [_sign(fields, "mirror.y"), _sign(fields, "mirror.z")]


def _sign(fields: Mapping[str, str], key: str) -> float:
    return -1.0 if _real(fields, key, 0.0) == 1.0 else 1.0


def _real(fields: Mapping[str, str], key: str, absent: float) -> float:
    if key not in fields:
        return absent
    try:
        return float(fields[key].lower().replace("d", "e"))
    except ValueError:
        raise InputError.single(key, fields[key], "is no number", remedy="correct the file") from None
