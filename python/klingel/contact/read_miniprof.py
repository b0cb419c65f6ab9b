"""Reads MiniProf profiles (.whl wheels, .ban rails): keys and values, then rows of points in millimetres.
A wheel's X counts from the flange back or the tape circle, Y up or down: which, and the side, tells the shape."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from klingel.contact.checks import Kind
from klingel.contact.read_points import Drawn, number
from klingel.errors import InputError

KINDS: Mapping[str, Kind] = {".whl": "wheel", ".ban": "rail"}
SCALE = 1e-3
"""Metres per unit of the format."""
TAPER_LINE = 70.0
"""Tape circle from the flange back [mm] where the file does not say it as WheelDiameterTaperline."""


def read(text: str, scale: float | None, suffix: str) -> Drawn:
    """Points of a MiniProf file [m]; `scale` in metres per unit if the caller states it. Errors: InputError."""
    columns, taper_line = "X,Y", TAPER_LINE
    rows: list[list[str]] = []
    for raw in text.splitlines():
        # Comments begin with a double quote, ! or %: so the device also marks points that it leaves out.
        line = re.split(r'["!%]', raw, maxsplit=1)[0].strip()
        if not line or line.startswith("["):
            continue
        if "=" in line:
            key, value = (part.strip() for part in line.split("=", 1))
            if key.lower() == "columndef":
                columns = value
            elif key.lower() == "wheeldiametertaperline":
                taper_line = number([value, "0"], 0)[0]
        elif re.match(r"[-+.\d]|nan|inf", line, re.IGNORECASE):
            rows.append(re.split(r"[\s,;]+", line))
    order = [name.strip().upper() for name in columns.split(",")]
    if "X" not in order or "Y" not in order:
        raise InputError.single("ColumnDef", columns, "has no X or no Y", remedy="give for example X,Y,A,C")
    if not rows:
        raise InputError.single("points", None, "there are none", remedy="give X and Y in rows after the header")
    x, y = order.index("X"), order.index("Y")
    points = np.array([number([*row[x : x + 1], *row[y : y + 1]], i) for i, row in enumerate(rows, start=1)])
    unit = SCALE if scale is None else scale
    y, z = (points * unit).T
    tape = taper_line * SCALE
    return Drawn(y, z, kind=KINDS.get(suffix), sided=False, outline=True, origins=(0.0, tape, -tape))
