"""Standard profiles from their defining formulas, in millimetres as the standards print them.
Wheel S1002 (EN 13715, eight zones) and rail head 60E1 (EN 13674-1, three arcs and a flank of 1:20)."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

Values = NDArray[np.float64]

S1002_RANGE = (-69.99, 60.0)
"""[mm]; at -70 mm the flange back is vertical."""

_TREAD = (
    0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8, -1.562379023e-8, 5.309217349e-15,
    -5.957839843e-12, 2.646656573e-13,
)  # fmt: skip
_ROOT = (
    -4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875, -2.054332446e-1, -4.169739389e-3, -4.687195829e-5,
    -2.252755540e-7,
)  # fmt: skip

RAIL_60E1_RADII = (300.0, 80.0, 13.0)
_CENTRES = ((0.0, 300.0), (7.50053, 80.12790), (23.01603, 14.94915))
_TANGENTS = ((10.228, 0.17440), (26.0265, 2.30252), (35.99981, 14.29996))
_FLANK_DEPTH = 39.0


def s1002(y: Values) -> Values:
    """Radius increment [mm] of S1002 (flange height 28 mm, thickness 32.5 mm) at y [mm].

    Coefficients recalled from EN 13715 and checked within 2e-6 mm against public point files.
    """
    pieces = [
        _arc(y, -49.5, 9.519259302, 20.5, 1.0),
        _arc(y, -55.0, 16.0, 12.0, 1.0),
        _arc(y, -58.558326413, 8.834924130, 20.0, 1.0),
        -93.576667419 - 2.747477419 * y,
        _arc(y, -26.210665, 16.446, 13.0, -1.0),
        polyval(y, _ROOT),
        polyval(y, _TREAD),
        1.364323640 - 0.066666667 * y,
    ]
    ends = (-62.764705882, -49.662510381, -39.764473993, -38.426669071, -35.0, -26.0, 32.15796)
    return np.select([y < end for end in ends], pieces[:-1], pieces[-1])


def rail_60e1(y: Values) -> Values:
    """Depth below the top [mm] of the 60E1 head at y [mm]; recalled from EN 13674-1, arcs tangent to 1e-4 mm."""
    side = np.abs(y)
    arcs = [_arc(side, yc, zc, r, -1.0) for (yc, zc), r in zip(_CENTRES, RAIL_60E1_RADII, strict=True)]
    (y0, _), (y1, _), (y2, z2) = _TANGENTS
    return np.select([side <= y0, side <= y1, side <= y2], arcs, z2 + 20.0 * (side - y2))


def rail_60e1_half_width() -> float:
    """Half width of the head at the depth where the profile ends [mm]."""
    y2, z2 = _TANGENTS[2]
    return y2 + (_FLANK_DEPTH - z2) / 20.0


def along(y_first: float, y_last: float, curve: object, spacing: float = 0.05) -> tuple[Values, Values]:
    """Samples (y, z) [mm] of a curve z(y), `spacing` [mm] apart along its arc."""
    assert callable(curve)
    fine = np.linspace(y_first, y_last, 400_001)
    z = np.asarray(curve(fine), dtype=np.float64)
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(fine), np.diff(z)))))
    y = np.interp(np.linspace(0.0, arc[-1], int(arc[-1] / spacing) + 1), arc, fine)
    return y, np.asarray(curve(y), dtype=np.float64)


def _arc(y: Values, yc: float, zc: float, radius: float, side: float) -> Values:
    """Circle about (yc, zc): its edge of large z for side +1, of small z for -1; edge of the circle beyond it."""
    root: Values = np.sqrt(np.maximum(radius**2 - (y - yc) ** 2, 0.0))
    return zc + side * root
