"""Drive of one wheel, steering actuator and running resistance as tables of a file.
Symbols are those of Perez et al. (2004), Eqs (2) to (11); the names say what they are."""

from __future__ import annotations

from klingel.records import Sourced
from klingel.units import (
    AngularDamping,
    Current,
    EmfConstant,
    ForceRate,
    Frequency,
    Inductance,
    PositiveAngularStiffness,
    PositiveForce,
    PositiveInertia,
    PositiveLength,
    PositiveNumber,
    PositiveStiffness,
    Ratio,
    Resistance,
    Voltage,
)


class Drive(Sourced):
    """Separately excited DC motor, gearbox and elastic transmission of every wheel.

    traction_share: x, the part of VaMax that traction may use, the rest steers; gear_ratio: N, wheel speed over motor
    speed; transmission values are on the wheel's side; rotor_inertia and rotor_damping on the motor's.
    """

    armature_voltage_max: Voltage
    traction_share: Ratio
    armature_current_rated: Current
    field_current_rated: Current
    armature_resistance: Resistance
    armature_inductance: Inductance
    field_resistance: Resistance
    field_inductance: Inductance
    emf_constant: EmfConstant
    gear_ratio: PositiveNumber
    rotor_inertia: PositiveInertia
    rotor_damping: AngularDamping
    transmission_stiffness: PositiveAngularStiffness
    transmission_damping: AngularDamping


class SteeringActuator(Sourced):
    """Longitudinal electromechanical actuator at both tips of a wheelset, between axle box and bogie frame.

    Second-order force dynamics with `bandwidth` and `damping_ratio`; half stroke; stop_stiffness of its end stops.
    """

    half_spacing: PositiveLength
    force_max: PositiveForce
    force_rate_max: ForceRate
    bandwidth: Frequency
    damping_ratio: PositiveNumber
    stroke: PositiveLength
    stop_stiffness: PositiveStiffness
