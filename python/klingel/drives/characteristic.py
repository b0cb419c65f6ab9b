"""What a DC motor gives over its speed, and how its two voltages are shared: Fig. 6 of the paper.
Up to the base speed the field is rated and the armature voltage rises; beyond, x VaMax stays and the field falls."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.drives.demand import torque_demand
from klingel.drives.formulas import Resistance
from klingel.drives.motor import field_current, wheel_torque_max

if TYPE_CHECKING:
    import pandas as pd

    from klingel.vehicle import Drive, Vehicle


@dataclass(frozen=True)
class Excitation:
    """How a torque is made at a speed: armature_voltage, field_voltage [V]; armature_current, field_current [A]."""

    armature_voltage: float
    field_voltage: float
    armature_current: float
    field_current: float


def excitation(drive: Drive, wheel_torque: float, motor_speed: float) -> Excitation:
    """Steady voltages and currents for an air-gap torque seen at the wheel [N m], either sign, at wM >= 0 [rad/s].

    With the rated field while x VaMax bears its back-EMF, else with the larger root of Eq. (5) at x VaMax.
    Error: InputError for a torque above `wheel_torque_max`.

    >>> from klingel import library
    >>> drive = library.vehicle("mechatronic_irw").drive
    >>> slow, fast = (excitation(drive, 200.0, speed) for speed in (100.0, 400.0))
    >>> round(slow.field_current, 2), round(slow.armature_voltage)
    (10.0, 467)
    >>> round(fast.field_current, 2), round(fast.armature_voltage)
    (4.82, 900)
    """
    share, rated = drive.traction_share * drive.armature_voltage_max, drive.field_current_rated
    current = drive.gear_ratio * wheel_torque / (drive.emf_constant * rated)
    voltage = drive.armature_resistance * current + drive.emf_constant * rated * motor_speed
    if voltage <= share:
        return Excitation(voltage, drive.field_resistance * rated, current, rated)
    weak = field_current(drive, wheel_torque, motor_speed)
    current = drive.gear_ratio * wheel_torque / (drive.emf_constant * weak)
    return Excitation(share, drive.field_resistance * weak, current, weak)


def base_speed(drive: Drive) -> float:
    """Motor speed [rad/s] up to which x VaMax drives the rated armature current through the rated field."""
    voltage = drive.traction_share * drive.armature_voltage_max
    used = drive.armature_resistance * drive.armature_current_rated
    return (voltage - used) / (drive.emf_constant * drive.field_current_rated)


def torque_limit(drive: Drive, motor_speed: float) -> float:
    """Largest air-gap torque at the wheel [N m] within rated currents and x VaMax at wM [rad/s]: constant up to base
    speed, beyond it constant power (x VaMax - Ra Ia) Ia."""
    torque = drive.emf_constant * drive.field_current_rated * drive.armature_current_rated / drive.gear_ratio
    return torque * min(1.0, base_speed(drive) / motor_speed) if motor_speed > 0.0 else torque


def operating_characteristic(
    vehicle: Vehicle, speeds: Iterable[float], *, resistance: Resistance | None = None
) -> pd.DataFrame:
    """Fig. 6 for a vehicle with DC motors: one row for each of `speeds` [m/s], limits and the line that is run along.

    resistance: of the vehicle [N] over its speed [m/s]; None for the formula of the vehicle's file.
    Columns (SI): `speed`, `motor_speed`; at the limit of currents and voltage `limit_torque` (at the wheel),
    `limit_power`, `limit_field_current`, `limit_armature_voltage`; `largest_torque` of Eq. (5), which the rated current
    does not bear; on the line of the running resistance `torque` (with the rotor's friction), `power`, `field_current`,
    `armature_current`, `armature_voltage`, `field_voltage`; `steering_voltage`, what it leaves of VaMax.
    Errors: InputError for a vehicle without DC motors, speeds not above zero, a torque out of reach.
    """
    import pandas as pd

    drive = vehicle.dc_drive
    rows = []
    for speed in speeds:
        demand = torque_demand(vehicle, drive, speed, resistance)
        wheel_speed = demand.motor_speed * drive.gear_ratio
        limit = torque_limit(drive, demand.motor_speed)
        most = excitation(drive, limit, demand.motor_speed)
        line = excitation(drive, demand.air_gap, demand.motor_speed)
        rows.append(
            {
                "speed": speed,
                "motor_speed": demand.motor_speed,
                "limit_torque": limit,
                "limit_power": limit * wheel_speed,
                "limit_field_current": most.field_current,
                "limit_armature_voltage": most.armature_voltage,
                "largest_torque": wheel_torque_max(drive, demand.motor_speed),
                "torque": demand.air_gap,
                "power": demand.air_gap * wheel_speed,
                "field_current": line.field_current,
                "armature_current": line.armature_current,
                "armature_voltage": line.armature_voltage,
                "field_voltage": line.field_voltage,
                "steering_voltage": drive.armature_voltage_max - line.armature_voltage,
            }
        )
    return pd.DataFrame(rows)


def characteristic_speeds(top: float, count: int = 200) -> np.ndarray:
    """Speeds [m/s] to draw a characteristic over, up to `top` [m/s]."""
    return np.linspace(top / count, top, count)
