"""What a motor gives at most over the speed: limits of field, armature current and voltage, Fig. 6 of the paper.
Below the base speed the rated field and current, above it the field that leaves the voltage for the current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.drives.demand import torque_demand
from klingel.drives.induction import induction_torque_max
from klingel.errors import InputError
from klingel.vehicle import InductionDrive

if TYPE_CHECKING:
    from klingel.vehicle import Drive, Vehicle


@dataclass(frozen=True)
class OperatingLimit:
    """One point of the limit curve.

    motor_speed [rad/s]; armature_voltage, armature_current, field_current [V, A, A]; motor_torque: at the shaft of the
    motor, its friction taken off; wheel_torque: the same behind the gear [N m]; power: mechanical [W].
    """

    motor_speed: float
    armature_voltage: float
    armature_current: float
    field_current: float
    motor_torque: float
    wheel_torque: float
    power: float


def operating_limit(drive: Drive, motor_speed: float, *, share: float | None = None) -> OperatingLimit:
    """The most a motor gives at a speed wM [rad/s] with rated current and a share of VaMax (x, if not given).

    If = min(rated, (x VaMax - Ra Ia)/(Ke wM)) and TM = Ke If Ia - CM wM. Error: InputError for a negative speed.

    >>> from klingel import library
    >>> drive = library.vehicle("mechatronic_irw").drive
    >>> round(operating_limit(drive, 100.0).motor_torque), round(operating_limit(drive, 480.0).motor_torque)
    (834, 318)
    """
    if not motor_speed >= 0.0:
        raise InputError.single("motor_speed", motor_speed, "is negative", remedy="give the speed of the motor [rad/s]")
    limit = drive.armature_voltage_max * (drive.traction_share if share is None else share)
    current = drive.armature_current_rated
    field = drive.field_current_rated
    room = limit - drive.armature_resistance * current
    if motor_speed > 0.0:
        field = min(field, room / (drive.emf_constant * motor_speed))
    torque = drive.emf_constant * field * current - drive.rotor_damping * motor_speed
    voltage = drive.armature_resistance * current + drive.emf_constant * field * motor_speed
    return OperatingLimit(motor_speed, voltage, current, field, torque, torque / drive.gear_ratio, torque * motor_speed)


def traction_torque_max(vehicle: Vehicle, speed: float) -> float:
    """The torque [N m] that the motor of each wheel gives it at most at a speed [m/s], with x VaMax for DC motors.

    Error: InputError for a vehicle without drives, or a negative speed.
    """
    drive = vehicle.drive
    if drive is None:
        raise InputError.single("drive", None, "is missing", remedy=f"{vehicle.name} is hauled; take a driven vehicle")
    motor_speed = speed / vehicle.geometry.wheel_radius / drive.gear_ratio
    if isinstance(drive, InductionDrive):
        return (induction_torque_max(drive, motor_speed) - drive.rotor_damping * motor_speed) / drive.gear_ratio
    return operating_limit(drive, motor_speed).wheel_torque


def starting_point(vehicle: Vehicle, speed: float, *, margin: float) -> tuple[float, float]:
    """Field current [A] and armature voltage [V] that keep a vehicle at a speed [m/s] against its running resistance.

    margin: share of x VaMax that the back-EMF may reach, above the base speed it does. Standing still there is no
    resistance to keep up with. Error: InputError for a vehicle without DC motors.

    >>> from klingel import library
    >>> starting_point(library.vehicle("mechatronic_irw"), 0.0, margin=0.97)
    (10.0, 0.0)
    """
    drive = vehicle.dc_drive
    demand = torque_demand(vehicle, drive, speed)
    field = drive.field_current_rated
    if demand.motor_speed > 0.0:
        most = margin * drive.traction_share * drive.armature_voltage_max
        field = min(field, most / (drive.emf_constant * demand.motor_speed))
    constant = drive.emf_constant * field
    current = drive.gear_ratio * demand.air_gap / constant
    return field, constant * demand.motor_speed + drive.armature_resistance * current
