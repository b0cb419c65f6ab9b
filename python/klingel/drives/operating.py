"""Operating point of the motors at a speed: Table 1 of the paper (torque per wheel, normalised field current).
The torque holds the vehicle against its running resistance on straight level track."""

from __future__ import annotations

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
    Below the base speed Eq. (5) would ask for more field than the motor has.
    Errors: InputError for a vehicle without drives, a torque out of reach, a field current above the rated one.

    >>> from klingel import library
    >>> point = operating_point(library.vehicle("mechatronic_irw"), 176 / 3.6)
    >>> round(point.wheel_torque), round(point.field_current_normalised, 2)
    (177, 0.61)
    """
    drive = vehicle.drive
    if drive is None:
        raise InputError.single("drive", None, "is missing", remedy=f"{vehicle.name} is hauled; take a driven vehicle")
    if not speed >= 0.0:
        raise InputError.single("speed", speed, "must not be negative [m/s]", remedy="give the running speed")
    if speed == 0.0:
        return _at_rest(drive)
    radius = vehicle.geometry.wheel_radius
    resistance = running_resistance(vehicle)(speed) / WHEELS
    torque = resistance * radius
    motor_speed = speed / radius / drive.gear_ratio
    air_gap = torque + drive.rotor_damping * motor_speed / drive.gear_ratio
    current = field_current(drive, air_gap, motor_speed)
    if current > drive.field_current_rated:
        raise InputError.single(
            "speed",
            speed,
            f"needs a field of {current:.4g} A, rated {drive.field_current_rated:.4g} A",
            remedy=f"run above the base speed, {speed * current / drive.field_current_rated:.4g} m/s",
        )
    kt = torque_constant(drive, current)
    return OperatingPoint(
        speed=speed,
        resistance=resistance,
        wheel_torque=torque,
        motor_speed=motor_speed,
        field_current=current,
        field_current_normalised=current / drive.field_current_rated,
        armature_current=drive.gear_ratio * air_gap / kt,
        torque_constant=kt,
        armature_voltage=drive.traction_share * drive.armature_voltage_max,
        wheel_torque_max=wheel_torque_max(drive, motor_speed),
    )


def _at_rest(drive: Drive) -> OperatingPoint:
    """Standing without torque: full field, no voltage."""
    current = drive.field_current_rated
    return OperatingPoint(
        speed=0.0,
        resistance=0.0,
        wheel_torque=0.0,
        motor_speed=0.0,
        field_current=current,
        field_current_normalised=1.0,
        armature_current=0.0,
        torque_constant=torque_constant(drive, current),
        armature_voltage=0.0,
        wheel_torque_max=wheel_torque(drive, current, 0.0),
    )


def operating_table(vehicle: Vehicle, speeds: Iterable[float]) -> tuple[OperatingPoint, ...]:
    """`operating_point` at each of `speeds` [m/s]: the rows of Table 1."""
    return tuple(operating_point(vehicle, speed) for speed in speeds)
