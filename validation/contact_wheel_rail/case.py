"""Wheel on rail: places, sizes, pressures and forces against CONTACT, position by position.
CONTACT merges patches nearer than 4 mm, so the places where the contact jumps are compared by their place alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from validation.common import Row
from validation.contact_wheel_rail.compare import FRICTION, clear, compared, pair

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Wheel on rail: CONTACT"
ABOUT = """
S1002 on the UIC60 variant, 1:40, gauge 1435 mm, r0 460 mm, each wheel loaded by 1 or 50 kN, moved from -10 to 10 mm
in steps of 1 mm; frictionless, and rolling at the friction 0.3 with the yaw 0 and 10 mrad. Reference: the program
CONTACT (github.com/eve70a/CONTACT, Apache-2.0), wheel-rail module, full half-space theory. Left out: |y| of 4.4 to 5.6
and 6.3 to 7.1 mm, where the contact jumps and CONTACT merges patches nearer than 4 mm. The contact of Kik and
Piotrowski and FASTSIM with 16 x 16 elements, creepages from our own geometry; the creep forces carry their share of
the wheel's load, as in CONTACT (on a flange at 10 mrad that is a sixth of it). The limits are those that a change of
program may cost an engineer without changing a decision: 0.1 mm of rolling radius is 2e-4 of it.
"""

DATA = Path(__file__).parent


def run() -> Iterator[Row]:
    """Geometry and normal contact at both loads, then the forces."""
    geometry = compared(DATA / "wheel_rail_geometry.csv", pair())
    for load in (1e3, 5e4):
        yield from _geometry(geometry[clear(geometry) & (geometry["load"] == load)], f"{load / 1e3:.0f} kN")
    forces = compared(DATA / "wheel_rail_forces.csv", pair())
    forces = forces[clear(forces)]
    error = _force_error(forces)
    yield Row.at_most("forces, vector error over mu Fn, median", "CONTACT", 100 * np.median(error), 5.0, "%")
    yield Row.at_most("forces, 95th percentile", "CONTACT", 100 * np.quantile(error, 0.95), 15.0, "%")
    yield Row.shown("forces, largest", "CONTACT", 100 * error.max(), "%")


def _geometry(rows: pd.DataFrame, load: str) -> Iterator[Row]:
    def millimetres(key: str) -> float:
        return 1e3 * float((rows[key] - rows[f"{key}_contact"]).abs().max())

    def percent(key: str) -> float:
        return 100 * float((rows[key] / rows[f"{key}_contact"] - 1).abs().max())

    yield Row.at_most(f"rolling radius, {load}", "CONTACT", millimetres("radius"), 0.1, "mm")
    yield Row.at_most(f"contact position on the wheel, {load}", "CONTACT", millimetres("y_wheel"), 1.0, "mm")
    yield Row.at_most(f"contact position on the rail, {load}", "CONTACT", millimetres("y_rail"), 1.0, "mm")
    yield Row.at_most(f"area, {load}", "CONTACT", percent("area"), 10.0, "%")
    yield Row.at_most(f"largest pressure, {load}", "CONTACT", percent("pressure"), 15.0, "%")
    yield Row.shown(f"normal force, {load}", "CONTACT", percent("normal_force"), "%")


def _force_error(rows: pd.DataFrame) -> NDArray[np.float64]:
    error = np.hypot(rows["fx"] - rows["fx_contact"], rows["fy"] - rows["fy_contact"])
    return np.asarray(error / (FRICTION * rows["normal_force_contact"]))


def figure() -> Figure:
    """Area, pressure and forces of the right wheel over its displacement."""
    from klingel.plot.style import INK, panels, styled

    geometry = compared(DATA / "wheel_rail_geometry.csv", pair())
    geometry = geometry[(geometry["side"] == "right") & (geometry["load"] == 5e4)]
    forces = compared(DATA / "wheel_rail_forces.csv", pair())
    forces = forces[(forces["side"] == "right") & (forces["yaw"] == 0.01)]
    with styled():
        drawn, axes = panels(3, height=6.4)
        for axis, rows, key, scale, label in (
            (axes[0], geometry, "area", 1e6, "area  [mm²]"),
            (axes[1], geometry, "pressure", 1e-9, "largest pressure  [GPa]"),
            (axes[2], forces, "fy", 1e-3, "lateral creep force\nat 10 mrad  [kN]"),
        ):
            y = rows["y"] * 1e3
            axis.plot(y, rows[f"{key}_contact"] * scale, "o", color=INK, mfc="none", label="CONTACT")
            axis.plot(y, rows[key] * scale, "x", color="#D55E00", label="Klingel")
            axis.set_ylabel(label)
            for low, high in ((4.4, 5.6), (6.3, 7.1)):
                for sign in (-1, 1):
                    axis.axvspan(sign * low, sign * high, color="#e8e8e8", lw=0)
        axes[0].set_title("Right wheel S1002 on UIC60, 1:40, 50 kN (grey: not compared)")
        axes[0].legend(loc="upper left")
        axes[2].set_xlabel("lateral displacement of the wheelset  [mm]")
    return drawn
