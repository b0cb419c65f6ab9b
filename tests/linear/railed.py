"""Wheels on rails for the linear tests: profiles of arcs, contact numbers read off the package's pair.
The textbook gets places, angles, radii, ellipses and Kalker's coefficients from here; never the package's forces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
from tests.linear.textbook import Contact
from validation.kalker.case import NAMES, coefficients

from klingel.contact import Profile, WheelRailPair

SHEAR_MODULUS, POISSON = 210e9 / 2.56, 0.28
"""Of the package's steel."""

STEP = 1e-5
"""Shift over which the slopes of the contact are taken [m]: small against the intervals of the package's table."""


def arc_wheel(angle: float, radius: float, middle_at: float = 0.00303) -> Profile:
    """A hollow tread of one arc, then root, flank and tip of a flange.

    angle: slope of the tread where the rail shall touch it, `middle_at` outside the tape circle [m]: 3 mm are where
    60E1 at 1:40 touches a cone of that slope; radius: of the arc [m].
    """
    field, step = 0.05, 2e-4
    points, slope = [], angle - (field - middle_at) / radius
    y, z = field, 0.0
    for length, curvature in ((field + 0.032, 1.0 / radius), (0.025, 40.0), (0.006, 0.0), (0.018, -80.0)):
        for _ in range(round(length / step)):
            points.append((y, z))
            middle = slope + 0.5 * step * curvature
            y, z, slope = y - step * math.cos(middle), z + step * math.sin(middle), slope + step * curvature
    curve = np.array(points[::-1])
    name = f"arc of {radius * 1e3:.0f} mm, slope {angle:g}"
    return Profile(name, curve[:, 0], curve[:, 1] - np.interp(0.0, curve[:, 0], curve[:, 1]))


def contact_numbers(pair: WheelRailPair, load: float) -> Contact:
    """The textbook's contact of a pair: place, angle, radius and ellipse under the wheel load [N], slopes per shift."""
    frame = pair.contact([-STEP, 0.0, STEP], wheel_load=load)
    left, middle, right = (frame[(frame["side"] == "right") & (frame["y"] == y)] for y in (-STEP, 0.0, STEP))
    if max(len(left), len(middle), len(right)) > 1:
        raise ValueError("the middle position has more than one patch a wheel")
    at = {name: float(middle[name].iloc[0]) for name in ("y_wheel", "angle")}

    def slope(name: str) -> float:
        return float(right[name].iloc[0] - left[name].iloc[0]) / (2.0 * STEP)

    (f11, f22, f23, f33), before, after = (kalker(patch) for patch in (middle, left, right))
    return Contact(
        load=load,
        half_distance=half_tape_distance(pair) + at["y_wheel"],
        radius=unstrained(middle),
        angle=at["angle"],
        conicity=(unstrained(right) - unstrained(left)) / (2.0 * STEP),
        roll=-slope("roll"),
        tilt=slope("angle"),
        f11=f11,
        f22=f22,
        f23=f23,
        f33=f33,
        f23_growth=(after[2] - before[2]) / (2.0 * STEP),
    )


def unstrained(patch: pd.DataFrame) -> float:
    """Radius of the wheel that creepages are made with [m]: the surface before it gives way along the normal."""
    return float((patch["rolling_radius"] + patch["penetration"] * np.cos(patch["angle"])).iloc[0])


def kalker(patch: pd.DataFrame) -> tuple[float, float, float, float]:
    """f11, f22 [N], f23 [N m], f33 [N m2] of one patch."""
    a, b = float(patch["a"].iloc[0]), float(patch["b"].iloc[0])
    c11, c22, c23, c33 = (float(coefficients(a / b, POISSON)[name]) for name in NAMES)
    stiff = SHEAR_MODULUS * a * b
    return stiff * c11, stiff * c22, stiff * (a * b) ** 0.5 * c23, stiff * a * b * c33


def half_tape_distance(pair: WheelRailPair) -> float:
    """Tape circles lie 70 mm outside the flange backs [m]."""
    return 0.5 * pair.flange_back + 0.07


def pair_of(wheel: Profile, inclination: float, rail: Profile | None = None, **options: Any) -> WheelRailPair:
    """The wheel on 60E1 at the standard gauge."""
    rail = rail or Profile.rail_60e1()
    return WheelRailPair(
        wheel, rail, rail_inclination=inclination, gauge=1.435, flange_back=1.36, radius=0.46, **options
    )
