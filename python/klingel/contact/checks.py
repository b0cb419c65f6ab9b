"""What a wheel and a rail profile must be, found in their points: every problem at once.
Also tells a wheel from a rail, so that one taken for the other is caught."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from klingel.errors import Problem

Values = NDArray[np.float64]
Kind = Literal["wheel", "rail"]

POINTS_MIN = 20
WIDTH = (0.02, 0.5)
"""Least and largest width of a profile [m]; what is outside is given in another unit or not whole."""
SCALES = {"millimetres": 1e-3, "metres": 1e3, "inches": 25.4e-3}
"""Units that are mistaken for the right one, and what they are to be multiplied with."""

FLANGE_HEIGHT = (0.012, 0.05)
FLANGE_TIP = (-0.07, -0.04)
FLANK = (-0.052, -0.028)
"""Where the flank stands 10 mm above the tread, y from the tape circle [m]."""
TREAD = (-0.005, 0.02)
TREAD_HEIGHT = 0.008
GAUGE_DEPTH = 0.014
"""Depth below the top of rail where the gauge is measured [m]."""
CROWN = 0.002
"""Largest depth of a rail's crown 8 mm beside its top [m]; the tip of a flange is deeper."""


def point_problems(y: Values, z: Values) -> Iterator[Problem]:
    """What is wrong with points (y, z) [m] as a curve z(y): lengths, number, NaN, order, units."""
    if y.shape != z.shape or y.ndim != 1:
        yield Problem("points", f"{y.shape} and {z.shape}", "y and z differ in length", "give one z for every y")
        return
    if len(y) < POINTS_MIN:
        yield Problem("points", len(y), "are too few", f"give {POINTS_MIN} or more")
    finite = np.isfinite(y) & np.isfinite(z)
    if not finite.all():
        where = int(np.argmin(finite)) + 1
        value = (float(y[where - 1]), float(z[where - 1]))
        yield Problem(f"point {where}", value, "points are not all finite", "remove the others")
        return
    if np.any(np.diff(y) <= 0.0):
        where = int(np.argmax(np.diff(y) <= 0.0)) + 2
        yield Problem(
            f"point {where}",
            float(y[where - 1]),
            "y does not rise",
            "remove it, sort the points or cut overhanging parts",
        )
    if len(y):
        yield from size_problems(y)


def size_problems(y: Values) -> Iterator[Problem]:
    """Whether the width can be that of a profile in metres."""
    width = float(np.ptp(y))
    if WIDTH[0] <= width <= WIDTH[1]:
        return
    remedy = "give the whole profile, in metres"
    for unit, scale in SCALES.items():
        if WIDTH[0] <= width * scale <= WIDTH[1]:
            remedy = f"these look like {unit}"
            break
    yield Problem("width", width, f"[m] is outside {WIDTH[0]:g} to {WIDTH[1]:g} m", remedy)


def wheel_problems(y: Values, z: Values) -> Iterator[Problem]:
    """Why points [m] are not a right-hand wheel: y from the tape circle, + to the field side, z + on the flange."""
    tip = int(np.argmax(z))
    height, place = float(z[tip]), float(y[tip])
    axes = "y from the tape circle, + to the field side, z the radius increment, + on the flange"
    if not FLANGE_HEIGHT[0] <= height <= FLANGE_HEIGHT[1]:
        yield Problem("flange", height, f"its height [m] is outside {_range(FLANGE_HEIGHT)}", axes)
    elif not FLANGE_TIP[0] <= place <= FLANGE_TIP[1]:
        yield Problem("flange", place, f"its tip [m] is outside {_range(FLANGE_TIP)}", axes)
    elif tip == len(y) - 1 or height - float(np.interp(place + 1e-3, y, z)) > 1.5e-3:
        yield Problem("flange", place, "ends without a rounded tip [m]", "give the profile over the tip of the flange")
    else:
        after = np.nonzero(z[tip:] < 0.01)[0]
        flank = float(y[tip + after[0]]) if len(after) else float(y[-1])
        if not FLANK[0] <= flank <= FLANK[1]:
            remedy = "move the profile: y = 0 is the tape circle, 70 mm outside the flange back"
            yield Problem("flange", flank, f"its flank [m] is outside {_range(FLANK)}", remedy)
    if y[-1] < TREAD[1]:
        yield Problem("tread", float(y[-1]), f"ends before {TREAD[1]:g} m", "give the whole tread to the field side")
        return
    tread = np.interp(np.linspace(*TREAD, 11), y, z)
    if y[0] <= TREAD[0] and np.max(np.abs(tread)) > TREAD_HEIGHT:
        high = float(tread[np.argmax(np.abs(tread))])
        yield Problem("tread", high, f"is more than {TREAD_HEIGHT:g} m off the tape circle's height", axes)
    if z[-1] > 0.5 * TREAD_HEIGHT:
        yield Problem("tread", float(z[-1]), "rises on the field side [m]", axes)


def rail_problems(y: Values, z: Values) -> Iterator[Problem]:
    """Why points [m] are not those of a right-hand rail: y + to the field side, z down from the top."""
    top = int(np.argmin(z))
    depths = z - z[top]
    axes = "y + to the field side, z down from the top"
    if top in (0, len(y) - 1):
        yield Problem("top of rail", float(y[top]), "is at the end of the profile [m]", f"give the whole head: {axes}")
        return
    for side in (-8e-3, 8e-3):
        beside = float(y[top]) + side
        if y[0] <= beside <= y[-1] and float(np.interp(beside, y, depths)) > CROWN:
            depth = float(np.interp(beside, y, depths))
            yield Problem("crown", depth, f"is too sharp for a rail [m at {side * 1e3:+g} mm beside its top]", axes)
            return
    if depths[0] < GAUGE_DEPTH:
        remedy = f"give the rail down to {GAUGE_DEPTH:g} m below its top on the gauge side (negative y)"
        yield Problem("gauge face", float(depths[0]), "does not reach its gauge point [m below the top]", remedy)
    if float(y[-1] - y[top]) < 5e-3:
        yield Problem("field side", float(y[-1] - y[top]), "is shorter than 5 mm [m]", "give the whole crown")


def kind_of(y: Values, z: Values) -> Kind | None:
    """What right-hand points are: a wheel, a rail, or neither."""
    if not any(wheel_problems(y, z)):
        return "wheel"
    return None if any(rail_problems(y, z)) else "rail"


def kind_problems(wanted: Kind, y: Values, z: Values) -> list[Problem]:
    """Why a profile cannot serve as a wheel or as a rail; one problem if it is the other one."""
    problems = list((wheel_problems if wanted == "wheel" else rail_problems)(y, z))
    found = kind_of(y, z)
    if problems and found is not None:
        return [Problem(wanted, None, f"this is a {found} profile", f"give a {wanted} profile here")]
    return problems


def _range(limits: tuple[float, float]) -> str:
    return f"{limits[0]:g} to {limits[1]:g}"
