"""Operating point of the motors at a speed: Table 1 of the paper (torque per wheel, normalised field current).
The torque holds the vehicle against its running resistance on straight level track."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.drives.motor import field_current, torque_constant, wheel_torque, wheel_torque_max
from klingel.drives.resistance import running_resistance
from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import Drive, Vehicle

WHEELS = 8


@dataclass(frozen=True)
class OperatingPoint:
    """Steady running at one speed; SI units.

    speed [m/s]; resistance: per wheel [N]; wheel_torque: on the wheel [N m]; motor_speed: wM [rad/s];
    field_current: If [A]; field_current_normalised: If over its rated value [-]; armature_current: Ia [A];
    torque_constant: KT [N m/A]; armature_voltage: x VaMax [V]; wheel_torque_max: the largest TW of Eq. (5) [N m].
    """

    speed: float
    resistance: float
    wheel_torque: float
    motor_speed: float
    field_current: float
    field_current_normalised: float
    armature_current: float
    torque_constant: float
    armature_voltage: float
    wheel_torque_max: float


def operating_point(vehicle: Vehicle, speed: float) -> OperatingPoint:
    """Steady running of a driven vehicle at `speed` [m/s], each wheel taking an eighth of the running resistance.

    The friction CM wM of the rotor is added to the torque asked of Eq. (5), so that the wheel really gets its torque.
    Below the base speed Eq. (5) would ask for more field than the motor has: there the field is the rated one and the
    voltage what the torque takes. Standing still there is no resistance.
    Errors: InputError for a vehicle without drives, a torque out of reach.

    >>> from klingel import library
    >>> point = operating_point(library.vehicle("mechatronic_irw"), 176 / 3.6)
    >>> round(point.wheel_torque), round(point.field_current_normalised, 2)
    (177, 0.61)
    """
    drive = _drive(vehicle)
    if not speed >= 0.0:
        raise InputError.single("speed", speed, "must not be negative [m/s]", remedy="give the running speed")
    resistance, torque, motor_speed, air_gap = _running(vehicle, drive, speed)
    rated = drive.field_current_rated
    current = min(rated, field_current(drive, air_gap, motor_speed)) if motor_speed > 0.0 else rated
    kt = torque_constant(drive, current)
    armature_current = drive.gear_ratio * air_gap / kt
    return OperatingPoint(
        speed=speed,
        resistance=resistance,
        wheel_torque=torque,
        motor_speed=motor_speed,
        field_current=current,
        field_current_normalised=current / drive.field_current_rated,
        armature_current=armature_current,
        torque_constant=kt,
        armature_voltage=kt * motor_speed + drive.armature_resistance * armature_current,
        wheel_torque_max=wheel_torque_max(drive, motor_speed) if motor_speed > 0.0 else math.inf,
    )


def base_speed(vehicle: Vehicle) -> float:
    """The speed [m/s] at which a driven vehicle runs steadily with the rated field; below, it would need more of it.

    Errors: InputError for a vehicle without drives, and for motors that the running resistance is too much for.

    >>> from klingel import library
    >>> round(base_speed(library.vehicle("mechatronic_irw")), 2)
    29.67
    """
    from scipy.optimize import brentq

    drive = _drive(vehicle)
    constant = torque_constant(drive, drive.field_current_rated)
    no_load = drive.traction_share * drive.armature_voltage_max / constant
    highest = no_load * drive.gear_ratio * vehicle.geometry.wheel_radius

    def surplus(speed: float) -> float:
        _, _, motor_speed, air_gap = _running(vehicle, drive, speed)
        return wheel_torque(drive, drive.field_current_rated, motor_speed) - air_gap

    if surplus(0.0) <= 0.0:
        remedy = "raise the traction share or the rated field"
        raise InputError.single("drive", None, "does not hold the running resistance at any speed", remedy=remedy)
    return float(brentq(surplus, 0.0, highest))


def _drive(vehicle: Vehicle) -> Drive:
    if vehicle.drive is None:
        raise InputError.single("drive", None, "is missing", remedy=f"{vehicle.name} is hauled; take a driven vehicle")
    return vehicle.drive


def _running(vehicle: Vehicle, drive: Drive, speed: float) -> tuple[float, float, float, float]:
    """Of a wheel: resistance [N], torque [N m], speed of its motor [rad/s], air-gap torque seen at the wheel [N m]."""
    radius = vehicle.geometry.wheel_radius
    resistance = running_resistance(vehicle)(speed) / WHEELS if speed > 0.0 else 0.0
    motor_speed = speed / radius / drive.gear_ratio
    return (
        resistance,
        resistance * radius,
        motor_speed,
        (resistance * radius + drive.rotor_damping * motor_speed / drive.gear_ratio),
    )


def operating_table(vehicle: Vehicle, speeds: Iterable[float]) -> tuple[OperatingPoint, ...]:
    """`operating_point` at each of `speeds` [m/s]: the rows of Table 1."""
    return tuple(operating_point(vehicle, speed) for speed in speeds)
