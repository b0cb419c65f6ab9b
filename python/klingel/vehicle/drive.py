"""Drive of one wheel and actuators as tables of a file.
Symbols are those of Perez et al. (2004), Eqs (2) to (11); the names say what they are."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from klingel.records import TAG, Sourced
from klingel.units import (
    AngularDamping,
    Current,
    EmfConstant,
    Flux,
    ForceRate,
    Frequency,
    Inductance,
    Length,
    PositiveAngularStiffness,
    PositiveForce,
    PositiveInertia,
    PositiveLength,
    PositiveNumber,
    PositiveStiffness,
    Rate,
    Ratio,
    Resistance,
    Voltage,
)


class Transmission(Sourced):
    """Rotor, gearbox and elastic shaft of every wheel, the same for each kind of motor.

    gear_ratio: N, wheel speed over motor speed; transmission values are on the wheel's side; rotor_inertia and
    rotor_damping on the motor's. sources: names and citations, for a drive that has its own file.
    """

    sources: dict[str, str] = Field(default_factory=dict)
    gear_ratio: PositiveNumber
    rotor_inertia: PositiveInertia
    rotor_damping: AngularDamping
    transmission_stiffness: PositiveAngularStiffness
    transmission_damping: AngularDamping


class Drive(Transmission):
    """Separately excited DC motor, gearbox and elastic transmission of every wheel.

    traction_share: x, the part of VaMax that traction may use, the rest steers; field_voltage_max: above Rf times the
    rated field current, so that the field can be forced.
    """

    kind: Literal["dc"] = "dc"
    armature_voltage_max: Voltage
    traction_share: Ratio
    armature_current_rated: Current
    field_current_rated: Current
    armature_resistance: Resistance
    armature_inductance: Inductance
    field_resistance: Resistance
    field_inductance: Inductance
    field_voltage_max: Voltage
    emf_constant: EmfConstant


class InductionDrive(Transmission):
    """Induction motor with field-oriented control and inverter, gearbox and elastic transmission of every wheel.

    The equivalent circuit is that of one phase (star), rotor values seen from the stator. rotor_flux_rated,
    current_max, voltage_max: amplitudes of a phase; current_rated: r.m.s.; flux_share: of voltage_max that the flux may
    take at speed; torque_bandwidth, flux_bandwidth: of the closed loops of torque and flux; rotor_resistance_assumed:
    what the control takes the rotor's for, which changes with its temperature by a third (None: for what it is).
    """

    kind: Literal["induction"] = "induction"
    stator_resistance: Resistance
    rotor_resistance: Resistance
    stator_leakage: Inductance
    rotor_leakage: Inductance
    magnetizing_inductance: Inductance
    pole_pairs: PositiveNumber
    rotor_flux_rated: Flux
    current_rated: Current
    current_max: Current
    voltage_max: Voltage
    flux_share: Ratio
    torque_bandwidth: Rate
    flux_bandwidth: Rate
    rotor_resistance_assumed: Resistance | None = None


def _kind(value: Any) -> str:
    kind = value.get("kind", "dc") if isinstance(value, dict) else getattr(value, "kind", "dc")
    return f"{TAG}{kind}"


AnyDrive = Annotated[
    Annotated[Drive, Tag(f"{TAG}dc")] | Annotated[InductionDrive, Tag(f"{TAG}induction")], Discriminator(_kind)
]
"""A drive of either kind; a file's `kind` tells which, "dc" if it says nothing."""


class Actuator(Sourced):
    """Longitudinal electromechanical actuator, one on each side.

    Second-order force dynamics with `bandwidth` and `damping_ratio`; half stroke; stop_stiffness of its end stops.
    """

    half_spacing: PositiveLength
    force_max: PositiveForce
    force_rate_max: ForceRate
    bandwidth: Frequency
    damping_ratio: PositiveNumber
    stroke: PositiveLength
    stop_stiffness: PositiveStiffness

    @property
    def moment_max(self) -> float:
        """Yaw moment of the two together [N m]."""
        return 2.0 * self.half_spacing * self.force_max

    @property
    def lag(self) -> float:
        """Delay for slow commands, 2 zeta/w [s]."""
        return 2.0 * self.damping_ratio / (2.0 * math.pi * self.bandwidth)


class SteeringActuator(Actuator):
    """At both tips of a wheelset, between axle box and bogie frame, at the height of the axle."""


class SecondaryActuator(Actuator):
    """Between bogie frame and body, two per bogie, in place of yaw dampers or beside them; height of both ends."""

    height: Length
