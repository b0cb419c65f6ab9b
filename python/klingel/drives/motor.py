"""Statics of the separately excited motor: field current, torque and its limit, Eqs (4) to (9).
The dynamics, Eqs (2), (10) and (11), are in the core; the transfer functions made of them in `transfer`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import Drive


def torque_constant(drive: Drive, field_current: float) -> float:
    """KT = Ke If, Eq. (6) [N m/A], at a field current [A]."""
    return drive.emf_constant * field_current


def wheel_torque(drive: Drive, field_current: float, motor_speed: float) -> float:
    """TW, Eq. (5) [N m]: the air-gap torque seen at the wheel with the traction share x VaMax on the armature.

    field_current: If [A]; motor_speed: wM, of the motor and not of the wheel [rad/s].
    """
    voltage = drive.traction_share * drive.armature_voltage_max
    amplification = drive.emf_constant / (drive.gear_ratio * drive.armature_resistance)
    return amplification * (voltage * field_current - drive.emf_constant * motor_speed * field_current**2)


def wheel_torque_max(drive: Drive, motor_speed: float) -> float:
    """The largest TW of any field current up to the rated one [N m]; motor_speed: wM [rad/s].

    (x VaMax)^2 / (4 N Ra wM) where the field that gives it, x VaMax/(2 Ke wM), is within its rating.
    """
    voltage = drive.traction_share * drive.armature_voltage_max
    if 2.0 * drive.emf_constant * motor_speed * drive.field_current_rated <= voltage:
        return wheel_torque(drive, drive.field_current_rated, motor_speed)
    return voltage**2 / (4.0 * drive.gear_ratio * drive.armature_resistance * motor_speed)


def field_current(drive: Drive, wheel_torque: float, motor_speed: float) -> float:
    """If [A] that gives TW [N m] at the motor speed wM [rad/s]: the larger root of Eq. (5).

    The larger root is the one with little armature current; the smaller one gives the same torque with a weak field
    and a current near short circuit. Errors: InputError for a torque above `wheel_torque_max` or a speed of zero.

    >>> from klingel import library
    >>> drive = library.vehicle("mechatronic_irw").drive
    >>> round(field_current(drive, 185.0, 318.8), 2)
    6.05
    """
    if motor_speed <= 0.0:
        raise InputError.single("motor_speed", motor_speed, "must be positive [rad/s]", remedy="give the motor's speed")
    voltage = drive.traction_share * drive.armature_voltage_max
    root = voltage**2 - 4.0 * drive.gear_ratio * drive.armature_resistance * wheel_torque * motor_speed
    if root < 0.0:
        limit = wheel_torque_max(drive, motor_speed)
        raise InputError.single(
            "wheel_torque",
            wheel_torque,
            f"is more than the motor gives at {motor_speed:.4g} rad/s ({limit:.4g} N m with {voltage:.4g} V)",
            remedy="ask for less torque or less speed, or raise the traction share",
        )
    return float((voltage + root**0.5) / (2.0 * drive.emf_constant * motor_speed))
