"""Patch by patch: CONTACT's wheel on its rail beside ours, from a file of CONTACT's rows.
Left wheels are mirrored into the frame of the right one, in which profiles are described."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from klingel.contact import Profile, WheelRailPair, creep_force

FRICTION = 0.3
SHEAR_MODULUS, POISSON = 8.2e10, 0.28
"""CONTACT's material of these runs, as ours."""


def pair(normal: str = "kik_piotrowski") -> WheelRailPair:
    """The pair of the rows: S1002 on the UIC60 variant, 1:40, 1435 mm, r0 460 mm."""
    return WheelRailPair(
        Profile.s1002(),
        Profile.rail_uic60(),
        rail_inclination=1 / 40,
        gauge=1.435,
        flange_back=1.36,
        radius=0.46,
        normal=normal,  # type: ignore[arg-type]
    )


def compared(path: Path, of: WheelRailPair) -> pd.DataFrame:
    """One row for every patch of CONTACT with ours nearest to it on the wheel; columns of both, in SI and radians.

    In files with creep forces the vertical force of a wheel is that of its normal and its creep force together.
    """
    rows = pd.read_csv(path, comment="#").to_dict("records")
    return pd.DataFrame([_patch(row, _touching(row, of), of) for row in rows])


def _touching(row: Mapping[Hashable, Any], of: WheelRailPair) -> pd.DataFrame:
    """Our patches of the row's wheel, with the creep forces in its vertical balance if the row has them."""
    sign = _sign(row)
    load = row["Fz_N"]
    while True:
        ours = of.contact(row["y_ws_mm"] * 1e-3, yaw=row["yaw_rad"], wheel_load=load)
        ours = ours[ours["side"] == row["side"]]
        creep = [_force(of, patch, sign, row["yaw_rad"]) for patch in ours.to_dict("records")]
        ours = ours.assign(fx=[fx for fx, _ in creep], fy=[fy for _, fy in creep])
        # Across the rolling direction on the wheel: (0, cos, -sin) of the angle, so that a positive force lifts it.
        missing = row["Fz_N"] - load - float((ours["fy"] * np.sin(ours["angle"])).sum())
        if "Fx_N" not in row or abs(missing) < 1e-3 * row["Fz_N"]:
            return ours
        load += 0.8 * missing


def _sign(row: Mapping[Hashable, Any]) -> float:
    return 1.0 if row["side"] == "right" else -1.0


def _patch(row: Mapping[Hashable, Any], ours: pd.DataFrame, of: WheelRailPair) -> dict[str, Any]:
    sign = _sign(row)
    y_wheel = sign * row["y_wheel_mm"] * 1e-3
    near = ours.iloc[int(np.argmin(np.abs(ours["y_wheel"].to_numpy() - y_wheel)))]
    return {
        "y": row["y_ws_mm"] * 1e-3,
        "side": row["side"],
        "load": row["Fz_N"],
        "yaw": row["yaw_rad"],
        "patches": len(ours),
        "y_wheel": near["y_wheel"],
        "y_wheel_contact": y_wheel,
        "y_rail": near["y_rail"],
        "y_rail_contact": sign * row["y_rail_mm"] * 1e-3,
        "radius": near["rolling_radius"],
        "radius_contact": row["rolling_radius_mm"] * 1e-3,
        "normal_force": near["normal_force"],
        "normal_force_contact": row["Fn_N"],
        "area": near["area"],
        "area_contact": row["area_mm2"] * 1e-6,
        "pressure": near["pressure"],
        "pressure_contact": row["pmax_MPa"] * 1e6,
        "fx": near["fx"],
        "fx_contact": -row.get("Fx_N", math.nan),
        "fy": near["fy"],
        "fy_contact": -sign * row.get("Fs_N", math.nan),
    }


def _force(of: WheelRailPair, patch: Mapping[Hashable, Any], sign: float, yaw: float) -> tuple[float, float]:
    """Creep forces on the wheel that rolls straight at the angular speed V/r0, in the frame of a right wheel.

    xi = (V - omega r)/V_ref, eta = -psi/cos(delta) V/V_ref, phi = -omega sin(gamma)/V_ref with V_ref = (V + omega r)/2,
    r of the unstrained wheel and gamma the contact angle against the axle.
    """
    angle = patch["angle"]
    radius = patch["rolling_radius"] + patch["penetration"] / math.cos(angle)
    ratio = radius / of.radius
    mean = 0.5 * (1.0 + ratio)
    fx, fy, _ = creep_force(
        "fastsim",
        a=patch["a"],
        b=patch["b"],
        xi=(1.0 - ratio) / mean,
        eta=-sign * yaw / math.cos(angle) / mean,
        phi=-math.sin(angle + sign * patch["roll"]) / of.radius / mean,
        normal_force=patch["normal_force"],
        friction=FRICTION,
        shear_modulus=SHEAR_MODULUS,
        poisson=POISSON,
    )
    return fx, fy


def clear(rows: pd.DataFrame) -> pd.Series:
    """Away from |y| 4.4-5.6 and 6.3-7.1 mm, where the contact jumps and CONTACT merges patches nearer than 4 mm."""
    y = rows["y"].abs() * 1e3
    return ~(y.between(4.4, 5.6) | y.between(6.3, 7.1))
