"""What the motors of a vehicle give at most over its speed, and how they stand before a traction loop begins.
For either kind of motor; the limits themselves are in `characteristic` and `induction`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.drives.characteristic import torque_limit
from klingel.drives.demand import torque_demand
from klingel.drives.induction import induction_torque_max
from klingel.errors import InputError
from klingel.vehicle import InductionDrive

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


STEERING_SHARE = 0.1
"""Of the torque at standstill that steering may use of induction motors, as the voltage of DC motors leaves it."""


def steering_torque_max(drive: InductionDrive) -> float:
    """What is kept of each induction motor's torque for steering [N m], at the wheel."""
    return STEERING_SHARE * induction_torque_max(drive, 0.0) / drive.gear_ratio


def traction_torque_max(vehicle: Vehicle, speed: float) -> float:
    """The torque [N m] that the motor of each wheel gives it at most for traction at a speed [m/s].

    With x VaMax for DC motors; without what steering may use of induction motors.

    Error: InputError for a vehicle without drives, or a negative speed.
    """
    drive = vehicle.drive
    if drive is None:
        raise InputError.single("drive", None, "is missing", remedy=f"{vehicle.name} is hauled; take a driven vehicle")
    motor_speed = speed / vehicle.geometry.wheel_radius / drive.gear_ratio
    if isinstance(drive, InductionDrive):
        limit = induction_torque_max(drive, motor_speed) / drive.gear_ratio - steering_torque_max(drive)
    else:
        limit = torque_limit(drive, motor_speed)
    return limit - drive.rotor_damping * motor_speed / drive.gear_ratio


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
