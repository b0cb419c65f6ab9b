"""What running at a speed asks of each motor, whatever its kind: a share of the running resistance, and its friction.
Straight level track; the resistance is any callable of the speed, such as a formula's coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.drives.formulas import Resistance
from klingel.drives.resistance import running_resistance
from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import Transmission, Vehicle

WHEELS = 8


@dataclass(frozen=True)
class Demand:
    """Of one wheel: resistance [N]; wheel: torque on it [N m]; motor_speed: wM [rad/s]; air_gap: torque at the
    air gap as seen at the wheel [N m], which adds the rotor's friction."""

    resistance: float
    wheel: float
    motor_speed: float
    air_gap: float


def torque_demand(vehicle: Vehicle, drive: Transmission, speed: float, resistance: Resistance | None = None) -> Demand:
    """What each wheel of a vehicle with `drive` needs at `speed` [m/s].

    resistance: of the vehicle [N]; None for the formula of its file. Nothing at rest.
    Error: InputError for a negative speed.

    >>> from klingel import library
    >>> vehicle = library.vehicle("mechatronic_irw")
    >>> demand = torque_demand(vehicle, vehicle.drive, 30.0, lambda v: 1600.0)
    >>> demand.resistance, round(demand.wheel), round(demand.air_gap - demand.wheel, 1)
    (200.0, 92, 11.7)
    """
    if not speed >= 0.0:
        raise InputError.single("speed", speed, "must not be negative [m/s]", remedy="give the running speed")
    radius = vehicle.geometry.wheel_radius
    # a vehicle at rest needs no torque, though formulas of the running resistance begin above zero
    share = (resistance or running_resistance(vehicle))(speed) / WHEELS if speed > 0.0 else 0.0
    motor_speed = speed / radius / drive.gear_ratio
    friction = drive.rotor_damping * motor_speed / drive.gear_ratio
    return Demand(share, share * radius, motor_speed, share * radius + friction)
