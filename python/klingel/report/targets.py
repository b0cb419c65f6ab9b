"""The figures that the study sets out to reach, each beside what came out.
They are this project's own; the paper's statements are in `claims`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from klingel.report.summary import ACTIVE, SHORT, Summary, joined

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Target:
    """One figure to reach: what, its limit, what came out, and whether it holds or its runs are missing."""

    quantity: str
    limit: str
    found: str
    verdict: Literal["met", "not met", "not run"]

    @property
    def met(self) -> bool:
        """Whether it was run and holds."""
        return self.verdict == "met"


FORCE_MARGINS = {1800.0: 0.15, 1200.0: 0.15, 800.0: 0.20, 500.0: 0.25, 300.0: 0.40}
"""Radius [m] to the share by which an active vehicle's lateral force may exceed the floor."""


def targets(summary: Summary, vehicle: Vehicle) -> list[Target]:
    """Check every figure to reach.

    Args:
        summary: of the main runs.
        vehicle: the mechatronic one, whose actuators and motors set limits.

    Returns:
        The targets; one whose runs are missing is `not run`, as is one about every curve with fewer than three.
    """
    assert vehicle.steering is not None
    drive = vehicle.dc_drive
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
    contacts = [summary.contact(v, radius) for v in ACTIVE for radius in summary.radii]
    run = all(summary.made(v, radius) for v in ACTIVE for radius in summary.radii)
    every = run and summary.several
    force_max = vehicle.steering.force_max / 1e3
    return [
        _contact("active, every curve: flange contact", contacts, run=every),
        _below("active, every curve: y_max", worst["y_max_mm"], 2.0, "mm", run=every),
        _below("active, every curve: y_curve", worst["y_curve_mm"], 0.2, "mm", digits=3, run=every),
        _below("active: actuator force", worst["actuator_force_max_kN"], force_max, "kN", run=run),
        _below(
            "active: steering voltage, (1 − x) VaMax", worst["steering_voltage_max_V"], voltage, "V", digits=1, run=run
        ),
        _below(
            "active: armature current, twice rated", worst["armature_current_max_A"], current, "A", digits=0, run=run
        ),
        *_passive_contact(summary),
        *_sharpest(summary),
        *_wear_band(summary),
        *_forces(summary),
        *_realtime(summary),
    ]


def _below(quantity: str, found: float, limit: float, unit: str, *, digits: int = 2, run: bool) -> Target:
    return _target(
        quantity, f"≤ {limit:g} {unit}", f"{joined(np.array([found]), digits)} {unit}", holds=found <= limit, run=run
    )


def _target(quantity: str, limit: str, found: str, *, holds: bool, run: bool) -> Target:
    """`run`: whether all runs that the figure needs were made; one that ended early was made, and missed it."""
    return Target(quantity, limit, found, ("met" if holds else "not met") if run else "not run")


def _contact(quantity: str, contacts: list[str], *, run: bool) -> Target:
    touched = [contact for contact in contacts if contact in ("root", "flange")]
    found = f"{len(touched)} runs: {', '.join(sorted(set(touched)))}" if touched else "none" if run else "–"
    return _target(quantity, "none", found, holds=not touched, run=run)


def _passive_contact(summary: Summary) -> list[Target]:
    sharp = [radius for radius in summary.radii if radius <= 800.0]
    return [
        _target(
            f"passive, R = {radius:.0f} m: root or flange contact",
            "yes",
            summary.contact("passive", radius),
            holds=summary.contact("passive", radius) in ("root", "flange"),
            run=summary.made("passive", radius),
        )
        for radius in sharp
    ]


def _sharpest(summary: Summary) -> list[Target]:
    if 300.0 not in summary.radii:
        return []
    return [
        _below(
            f"{SHORT[v]} over passive, R = 300 m: {name}",
            summary.value(v, 300.0, column) / summary.value("passive", 300.0, column),
            limit,
            "",
            run=summary.made(v, 300.0) and summary.made("passive", 300.0),
        )
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
        run = summary.several and all(summary.made(v, radius) for radius in summary.radii)
        name = f"{SHORT[v]}: wear index off its mean"
        found.append(_below(name, 100 * _off_mean(wear), 15.0, "%", digits=1, run=run))
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
                limit = 100 * FORCE_MARGINS[radius]
                found.append(_below(name, 100 * excess, limit, "%", digits=1, run=summary.made(v, radius)))
        # Equal within the accuracy of the study (0.05 kN) counts as not lower.
        lower = force["solid_like"] - force["irw_like"]
        name = f"R = {radius:.0f} m: lateral force of S not lower than of I"
        shown = "–" if math.isnan(lower) else f"{lower:+.2f} kN"
        run = all(summary.made(v, radius) for v in ACTIVE)
        found.append(_target(name, "≥ −0.05 kN", shown, holds=lower >= -0.05, run=run))
    return found


def _realtime(summary: Summary) -> list[Target]:
    slowest = float(np.min([summary.over_radii(v, "realtime_factor") for v in ACTIVE]))
    run = all(summary.made(v, radius) for v in ACTIVE for radius in summary.radii)
    name = "active: real-time factor per core"
    return [_target(name, "≥ 10", joined(np.array([slowest]), 1), holds=slowest >= 10.0, run=run)]
