"""The figures that the study sets out to reach, each beside what came out.
They are this project's own; the paper's statements are in `claims`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.report.summary import ACTIVE, SHORT, Summary, joined

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Target:
    """One figure to reach: what, its limit, what came out, and whether it holds."""

    quantity: str
    limit: str
    found: str
    met: bool


FORCE_MARGINS = {1800.0: 0.15, 1200.0: 0.15, 800.0: 0.20, 500.0: 0.25, 300.0: 0.40}
"""Radius [m] to the share by which an active vehicle's lateral force may exceed the floor."""


def targets(summary: Summary, vehicle: Vehicle) -> list[Target]:
    """Check every figure to reach.

    Args:
        summary: of the main runs.
        vehicle: the mechatronic one, whose actuators and motors set limits.

    Returns:
        The targets; one whose runs are missing is not met.
    """
    assert vehicle.drive is not None
    assert vehicle.steering is not None
    drive = vehicle.drive
    voltage = (1.0 - drive.traction_share) * drive.armature_voltage_max
    current = 2.0 * drive.armature_current_rated
    worst = {
        column: float(np.max([summary.over_radii(v, column) for v in ACTIVE]))
        for column in (
            "y_max_mm",
            "y_curve_mm",
            "actuator_force_max_kN",
            "steering_voltage_max_V",
            "armature_current_max_A",
        )
    }
    contacts = [summary.text(v, radius, "flange_contact") for v in ACTIVE for radius in summary.radii]
    return [
        Target("active, every curve: flange contact", "none", _contacts(contacts), not any(contacts)),
        _below("active, every curve: y_max", worst["y_max_mm"], 2.0, "mm"),
        _below("active, every curve: y_curve", worst["y_curve_mm"], 0.2, "mm", digits=3),
        _below("active: actuator force", worst["actuator_force_max_kN"], vehicle.steering.force_max / 1e3, "kN"),
        _below("active: steering voltage, (1 − x) VaMax", worst["steering_voltage_max_V"], voltage, "V", digits=1),
        _below("active: armature current, twice rated", worst["armature_current_max_A"], current, "A", digits=0),
        *_passive_contact(summary),
        *_sharpest(summary),
        *_wear_band(summary),
        *_forces(summary),
        *_realtime(summary),
    ]


def _below(quantity: str, found: float, limit: float, unit: str, *, digits: int = 2) -> Target:
    return Target(quantity, f"≤ {limit:g} {unit}", f"{joined(np.array([found]), digits)} {unit}", bool(found <= limit))


def _contacts(contacts: list[str]) -> str:
    found = sorted({contact for contact in contacts if contact})
    return f"{sum(map(bool, contacts))} runs: {', '.join(found)}" if found else "none"


def _passive_contact(summary: Summary) -> list[Target]:
    sharp = [radius for radius in summary.radii if radius <= 800.0]
    return [
        Target(
            f"passive, R = {radius:.0f} m: root or flange contact",
            "yes",
            summary.text("passive", radius, "flange_contact") or "none",
            bool(summary.text("passive", radius, "flange_contact")),
        )
        for radius in sharp
    ]


def _sharpest(summary: Summary) -> list[Target]:
    if 300.0 not in summary.radii:
        return []
    return [
        _below(f"{SHORT[v]} over passive, R = 300 m: {name}", float(summary.ratio(column, v, "passive")[0]), limit, "")
        for column, name, limit in (
            ("attack_angle_max_mrad", "attack angle", 0.6),
            ("wear_index_N", "wear index", 0.2),
        )
        for v in ACTIVE
    ]


def _wear_band(summary: Summary) -> list[Target]:
    found = []
    for v in ACTIVE:
        wear = summary.over_radii(v, "wear_index_N")
        found.append(_below(f"{SHORT[v]}: wear index off its mean", 100 * _off_mean(wear), 15.0, "%", digits=1))
    return found


def _off_mean(numbers: np.ndarray) -> float:
    return float(np.max(np.abs(numbers / np.mean(numbers) - 1.0)))


def _forces(summary: Summary) -> list[Target]:
    found = []
    for radius in summary.radii:
        force = {v: summary.value(v, radius, "lateral_force_max_kN") for v in ACTIVE}
        if radius in FORCE_MARGINS:
            for v in ACTIVE:
                excess = force[v] / summary.value(v, radius, "lateral_force_floor_kN") - 1.0
                name = f"{SHORT[v]}, R = {radius:.0f} m: lateral force over the floor"
                found.append(_below(name, 100 * excess, 100 * FORCE_MARGINS[radius], "%", digits=1))
        # Equal within the accuracy of the study (0.05 kN) counts as not lower.
        lower = force["solid_like"] - force["irw_like"]
        name = f"R = {radius:.0f} m: lateral force of S not lower than of I"
        found.append(Target(name, "≥ −0.05 kN", "–" if math.isnan(lower) else f"{lower:+.2f} kN", bool(lower >= -0.05)))
    return found


def _realtime(summary: Summary) -> list[Target]:
    slowest = float(np.min([summary.over_radii(v, "realtime_factor") for v in ACTIVE]))
    return [Target("active: real-time factor per core", "≥ 10", joined(np.array([slowest]), 1), bool(slowest >= 10.0))]
