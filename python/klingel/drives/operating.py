"""Operating point of the motors at a speed: Table 1 of the paper (torque per wheel, normalised field current).
The torque holds the vehicle against its running resistance on straight level track."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.drives.characteristic import excitation
from klingel.drives.demand import torque_demand
from klingel.drives.formulas import Resistance
from klingel.drives.motor import torque_constant, wheel_torque_max

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class OperatingPoint:
    """Steady running at one speed; SI units.

    speed [m/s]; resistance: per wheel [N]; wheel_torque: on the wheel [N m]; motor_speed: wM [rad/s];
    field_current: If [A]; field_current_normalised: If over its rated value [-]; armature_current: Ia [A];
    torque_constant: KT [N m/A]; armature_voltage: Va, x VaMax above the base speed [V]; wheel_torque_max: the largest
    TW of Eq. (5) [N m].
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


def operating_point(vehicle: Vehicle, speed: float, *, resistance: Resistance | None = None) -> OperatingPoint:
    """Steady running of a vehicle with DC motors at `speed` [m/s], each wheel taking an eighth of the resistance.

    resistance: of the vehicle [N] over its speed [m/s]; None for the formula of the vehicle's file.
    The friction CM wM of the rotor is added to the torque asked of Eq. (5), so that the wheel really gets its torque.
    Below the base speed Eq. (5) would ask for more field than the motor has: there the field is the rated one and the
    voltage what the torque takes. Standing still there is no resistance.
    Errors: InputError for a vehicle without DC motors, a torque out of reach.

    >>> from klingel import library
    >>> point = operating_point(library.vehicle("mechatronic_irw"), 176 / 3.6)
    >>> round(point.wheel_torque), round(point.field_current_normalised, 2)
    (177, 0.61)
    """
    drive = vehicle.dc_drive
    demand = torque_demand(vehicle, drive, speed, resistance)
    made = excitation(drive, demand.air_gap, demand.motor_speed)
    return OperatingPoint(
        speed=speed,
        resistance=demand.resistance,
        wheel_torque=demand.wheel,
        motor_speed=demand.motor_speed,
        field_current=made.field_current,
        field_current_normalised=made.field_current / drive.field_current_rated,
        armature_current=made.armature_current,
        torque_constant=torque_constant(drive, made.field_current),
        armature_voltage=made.armature_voltage,
        wheel_torque_max=wheel_torque_max(drive, demand.motor_speed),
    )


def operating_table(
    vehicle: Vehicle, speeds: Iterable[float], *, resistance: Resistance | None = None
) -> tuple[OperatingPoint, ...]:
    """`operating_point` at each of `speeds` [m/s]: the rows of Table 1."""
    return tuple(operating_point(vehicle, speed, resistance=resistance) for speed in speeds)
