"""Turns what a file draws into the right-hand profile: way up, side of flange or gauge face, upright ends cut off.
Everything follows from the shape or from the format's own convention; where neither decides, the file is refused."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np

from klingel.contact.checks import GAUGE_DEPTH, Kind, rail_problems, wheel_problems
from klingel.contact.read_points import Drawn, Points
from klingel.errors import InputError, Problem

LEAN = 0.008
"""How much farther from its top [m] a rail's one side lies at the gauge's depth if that can only be its inclination
towards the gauge side (1:40 makes 15 mm on a crown of radius 300 mm); wear makes less."""
EVEN = 0.001
"""Sides that differ by less [m] are alike: the rail is its own mirror image."""
REPEATED = 1.5e-5
"""Points of an outline that lie closer together [m] are one point: devices give them to 0.01 mm."""

LOG = logging.getLogger("klingel")


def right_hand(drawn: Drawn) -> Points:
    """The canonical points of what is drawn, y rising; errors: InputError with every reason against."""
    wheels = [way for way in _ways(drawn) if not any(wheel_problems(*way[2]))]
    rails = [p for p in (_turned(drawn, 1.0, sz) for sz in (1.0, -1.0)) if _is_head(p)]
    found: Kind | None = "wheel" if wheels else "rail" if rails else None
    if drawn.kind is not None and found is not None and found != drawn.kind:
        remedy = f"rename it, or give a {drawn.kind} profile"
        raise InputError.single("profile", None, f"is a {found}, but the file is for a {drawn.kind}", remedy=remedy)
    if found == "wheel":
        sy, sz, points = wheels[0]
        if (sy, sz) != (1.0, 1.0):
            LOG.info("wheel profile turned: %s", " and ".join(_words(sy, sz)))
        return points if drawn.sided else Points(points.y, points.z - float(np.interp(0.0, *points)))
    if found == "rail":
        return _gauge_side(drawn, rails[0])
    raise InputError(_why_not(drawn))


def trimmed(drawn: Drawn) -> Drawn:
    """The outline without its upright ends (flange back, rim face, lower flanks) and without repeated points.

    Seen from the tip of the flange or the top of the rail, an end is cut where y first turns back; a turn back on the
    running surface itself is left for the checks to find.
    """
    y, z = drawn.y, drawn.z
    if not (np.isfinite(y).all() and np.isfinite(z).all()):
        return drawn
    if len(y) > 1 and y[0] > y[-1]:
        y, z = y[::-1], z[::-1]
    if len(y) > 2:
        kept = np.concatenate([[True], np.hypot(np.diff(y), np.diff(z)) > REPEATED])
        y, z = y[kept], z[kept]
        # The running surface: everything between 10 % and 90 % of the width keeps its points.
        low, high = float(np.min(y)), float(np.max(y))
        inner = np.nonzero((y > low + 0.1 * (high - low)) & (y < high - 0.1 * (high - low)))[0]
        if len(inner):
            first, last = int(inner[0]), int(inner[-1])
            while first > 0 and y[first - 1] < y[first]:
                first -= 1
            while last < len(y) - 1 and y[last + 1] > y[last]:
                last += 1
            y, z = y[first : last + 1], z[first : last + 1]
    return replace(drawn, y=y, z=z)


def _ways(drawn: Drawn) -> list[tuple[float, float, Points]]:
    """Every way to take a wheel: signs of y and z, and the points then."""
    signs = [(sy, sz) for sz in (1.0, -1.0) for sy in (1.0, -1.0)]
    return [(sy, sz, _turned(drawn, sy, sz, origin)) for origin in drawn.origins for sy, sz in signs]


def _turned(drawn: Drawn, sy: float, sz: float, origin: float = 0.0) -> Points:
    y, z = sy * (drawn.y - origin), sz * drawn.z
    return Points(y, z) if sy > 0.0 else Points(y[::-1], z[::-1])


def _is_head(points: Points) -> bool:
    """Whether the points are a rail's head whose gauge side may be either one."""
    y, z = points
    return not any(rail_problems(y, z)) or not any(rail_problems(-y[::-1], z[::-1]))


def _gauge_side(drawn: Drawn, points: Points) -> Points:
    """The rail with its gauge side at negative y."""
    y, z = points
    if not drawn.sided:
        z = z - z.min()
    mirrored = Points(-y[::-1], z[::-1])
    top = int(np.argmin(z))
    depth = z - z[top]
    if depth[0] < GAUGE_DEPTH or depth[-1] < GAUGE_DEPTH:
        # Only one side reaches the depth where the gauge is measured.
        if depth[0] < GAUGE_DEPTH:
            LOG.info("rail profile turned: its gauge face is at positive y")
        return Points(y, z) if depth[0] >= GAUGE_DEPTH else mirrored
    left = float(y[top] - np.interp(-GAUGE_DEPTH, -depth[: top + 1], y[: top + 1]))
    right = float(np.interp(GAUGE_DEPTH, depth[top:], y[top:]) - y[top])
    if abs(left - right) < EVEN or (drawn.sided and left > right - LEAN) or left > right + LEAN:
        return Points(y, z)
    if not drawn.sided and right > left + LEAN:
        LOG.info("rail profile turned: it leans towards positive y, which is its gauge side")
        return mirrored
    sides = f"{left * 1e3:.1f} and {right * 1e3:.1f} mm"
    remedy = "cut the field side less than 14 mm below the top, or turn the file so that the gauge face has negative y"
    message = "from the top to either side 14 mm below it: this does not tell the gauge side from the field side"
    raise InputError.single("gauge face", sides, message, remedy=remedy)


def _words(sy: float, sz: float) -> list[str]:
    return [word for word, sign in (("left to right", sy), ("upside down", sz)) if sign < 0.0]


def _why_not(drawn: Drawn) -> list[Problem]:
    """Reasons against a wheel and a rail, those of the orientation with the fewest."""

    def fewest(kind: Kind) -> list[Problem]:
        check = wheel_problems if kind == "wheel" else rail_problems
        ways = [list(check(*points)) for _, _, points in _ways(drawn)]
        return [Problem(f"as a {kind}: {p.key}", p.value, p.message, p.remedy) for p in min(ways, key=len)]

    kinds: tuple[Kind, ...] = ("wheel", "rail") if drawn.kind is None else (drawn.kind,)
    return [problem for kind in kinds for problem in fewest(kind)]
