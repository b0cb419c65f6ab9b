"""Steady running of the induction motor under field-oriented control: fluxes, currents, voltage, slip and losses.
The dynamics are in the core; symbols and derivation are in docs/theory/induction.md."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.drives.demand import torque_demand
from klingel.drives.formulas import Resistance
from klingel.errors import InputError

if TYPE_CHECKING:
    from klingel.vehicle import InductionDrive, Vehicle


VOLTAGE_USED = 0.95
"""Share of the voltage that the control commands steady currents up to; the rest pays resistances and changes."""


@dataclass(frozen=True)
class Circuit:
    """What the control makes of the equivalent circuit; inductances [H], coupling: Lm/Lr [-], rotor_time: Lr/Rr [s]."""

    stator: float
    rotor: float
    transient: float
    coupling: float
    rotor_time: float
    torque_factor: float

    @classmethod
    def of(cls, drive: InductionDrive) -> Circuit:
        """Ls, Lr, sigma Ls, Lm/Lr, Lr/Rr, 3/2 p Lm/Lr of a drive."""
        lm = drive.magnetizing_inductance
        stator, rotor = drive.stator_leakage + lm, drive.rotor_leakage + lm
        coupling = lm / rotor
        factor = 1.5 * drive.pole_pairs * coupling
        return cls(stator, rotor, stator - coupling * lm, coupling, rotor / drive.rotor_resistance, factor)


@dataclass(frozen=True)
class InductionPoint:
    """Steady running at one speed; SI units, amplitudes of a phase.

    speed [m/s]; resistance: per wheel [N]; wheel_torque: on the wheel [N m]; torque_command: air-gap torque as seen at
    the wheel, the rotor's friction included [N m]; motor_speed: wM [rad/s]; rotor_flux [V s]; current_d, current_q
    [A]; stator_voltage [V]; stator_frequency [Hz]; slip: of the rotor against the field [-]; copper_loss: of stator
    and rotor [W].
    """

    speed: float
    resistance: float
    wheel_torque: float
    torque_command: float
    motor_speed: float
    rotor_flux: float
    current_d: float
    current_q: float
    stator_voltage: float
    stator_frequency: float
    slip: float
    copper_loss: float


def weakening_speed(drive: InductionDrive) -> float:
    """Motor speed [rad/s] above which the flux falls with 1/speed: its voltage has reached its share there."""
    stator_flux = Circuit.of(drive).stator * drive.rotor_flux_rated / drive.magnetizing_inductance
    return drive.flux_share * drive.voltage_max / stator_flux / drive.pole_pairs


def rotor_flux(drive: InductionDrive, motor_speed: float) -> float:
    """Rotor flux [V s] that the control keeps at a motor speed [rad/s]."""
    corner = weakening_speed(drive)
    return drive.rotor_flux_rated * corner / max(abs(motor_speed), corner)


def induction_torque_max(drive: InductionDrive, motor_speed: float) -> float:
    """Largest air-gap torque [N m] on the motor at a motor speed [rad/s]: by its current, and by voltage at speed."""
    circuit = Circuit.of(drive)
    flux = rotor_flux(drive, motor_speed)
    i_d = flux / drive.magnetizing_inductance
    by_current = drive.current_max**2 - i_d**2
    linked = VOLTAGE_USED * drive.voltage_max / max(abs(motor_speed), 0.5 * weakening_speed(drive)) / drive.pole_pairs
    by_voltage = (linked**2 - (circuit.stator * i_d) ** 2) / circuit.transient**2
    return circuit.torque_factor * flux * math.sqrt(min(by_current, by_voltage))


def induction_point(vehicle: Vehicle, speed: float, *, resistance: Resistance | None = None) -> InductionPoint:
    """Steady running of a vehicle with induction motors at `speed` [m/s], each wheel taking an eighth of what resists.

    resistance: of the vehicle [N] over its speed [m/s]; None for the formula of the vehicle's file.
    Errors: InputError for a vehicle with other motors, a torque out of reach, a negative speed.

    >>> from klingel import library
    >>> vehicle = library.vehicle("mechatronic_irw").replace(drive=library.drive("induction_160kw"))
    >>> point = induction_point(vehicle, 176 / 3.6)
    >>> round(point.wheel_torque), round(point.rotor_flux, 2), round(point.current_q)
    (177, 1.22, 19)
    """
    drive = vehicle.induction_drive
    demand = torque_demand(vehicle, drive, speed, resistance)
    torque = demand.air_gap * drive.gear_ratio
    limit = induction_torque_max(drive, demand.motor_speed)
    if abs(torque) > limit:
        message = f"needs {torque:.4g} N m of a motor that gives {limit:.4g} N m"
        raise InputError.single("speed", speed, message, remedy="run slower or with less resistance")
    circuit = Circuit.of(drive)
    flux = rotor_flux(drive, demand.motor_speed)
    i_d, i_q = flux / drive.magnetizing_inductance, torque / (circuit.torque_factor * flux)
    slip_speed = drive.magnetizing_inductance / circuit.rotor_time * i_q / flux
    omega = drive.pole_pairs * demand.motor_speed + slip_speed
    v_d = drive.stator_resistance * i_d - omega * circuit.transient * i_q
    v_q = drive.stator_resistance * i_q + omega * circuit.stator * i_d
    rotor_loss = 1.5 * drive.rotor_resistance * (circuit.coupling * i_q) ** 2
    return InductionPoint(
        speed=speed,
        resistance=demand.resistance,
        wheel_torque=demand.wheel,
        torque_command=demand.air_gap,
        motor_speed=demand.motor_speed,
        rotor_flux=flux,
        current_d=i_d,
        current_q=i_q,
        stator_voltage=math.hypot(v_d, v_q),
        stator_frequency=omega / (2.0 * math.pi),
        slip=slip_speed / omega if omega != 0.0 else 0.0,
        copper_loss=1.5 * drive.stator_resistance * (i_d**2 + i_q**2) + rotor_loss,
    )
