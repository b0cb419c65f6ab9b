"""Suspension of a bogie vehicle as tables of a file: primary, secondary, dampers, stops, rods.
Heights are above the top of rail; per box, per side or per bogie as each class says."""

from __future__ import annotations

from itertools import pairwise
from typing import Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from klingel.records import Record, Sourced
from klingel.units import (
    AngularStiffness,
    Damping,
    Force,
    Length,
    PositiveAngularStiffness,
    PositiveDamping,
    PositiveForce,
    PositiveLength,
    PositiveStiffness,
    Stiffness,
)


class DirectionalStiffness(Record):
    """Longitudinal, lateral and vertical stiffness [N/m]."""

    x: Stiffness
    y: Stiffness
    z: Stiffness


class DirectionalDamping(Record):
    """Longitudinal, lateral and vertical damping [N s/m]."""

    x: Damping
    y: Damping
    z: Damping


class Primary(Sourced):
    """Axle box suspension, one of it per axle box, between wheelset (or axle bridge) and bogie frame.

    stiffness and damping act in parallel; each damper has its series stiffness. height: where the elements act.
    """

    half_spacing: PositiveLength
    height: Length
    stiffness: DirectionalStiffness
    damping: DirectionalDamping
    series_stiffness: DirectionalStiffness

    @model_validator(mode="after")
    def _carries(self) -> Self:
        if self.stiffness.z <= 0.0:
            raise PydanticCustomError(
                "carries", "vertical stiffness must be positive", {"remedy": "give stiffness.z in N/m"}
            )
        return self


class SeriesDamper(Record):
    """Damper with a spring in series at a height."""

    damping: PositiveDamping
    series_stiffness: PositiveStiffness
    height: Length


class Secondary(Sourced):
    """Body suspension, one of it per bogie side, between bogie frame and body.

    stiffness.x and .y are the shear stiffnesses, acting at `height` (mid height of the spring);
    bending_stiffness: moment per relative roll or pitch of its end faces [N m/rad].
    """

    half_spacing: PositiveLength
    height: Length
    stiffness: DirectionalStiffness
    bending_stiffness: AngularStiffness
    lateral_damper: SeriesDamper
    vertical_damper: SeriesDamper


class YawDamper(Sourced):
    """Longitudinal damper between body and bogie frame, one per bogie side.

    Beyond blow_off_force the force grows with blow_off_damping only.
    """

    half_spacing: PositiveLength
    height: Length
    damping: PositiveDamping
    series_stiffness: PositiveStiffness
    blow_off_force: PositiveForce
    blow_off_damping: Damping


class LateralStop(Sourced):
    """Bump stop between body and bogie frame, one per bogie: force over deflection, odd, both from zero.

    Beyond its last point the curve continues with its last slope.
    """

    height: Length
    deflection: tuple[Length, ...]
    force: tuple[Force, ...]

    @model_validator(mode="after")
    def _curve(self) -> Self:
        n = len(self.deflection)
        if n < 2 or n != len(self.force):
            message = f"deflection has {n} and force {len(self.force)} points"
            raise PydanticCustomError(
                "curve", "{m}", {"m": message, "remedy": "give two or more of each, as many of both"}
            )
        if self.deflection[0] != 0.0 or self.force[0] != 0.0:
            raise PydanticCustomError("curve", "must begin at zero", {"remedy": "give the half of positive deflection"})
        if any(b <= a for a, b in pairwise(self.deflection)) or any(b < a for a, b in pairwise(self.force)):
            raise PydanticCustomError(
                "curve", "must rise from point to point", {"remedy": "sort deflection; let force never fall"}
            )
        return self


class AntiRollBar(Sourced):
    """Torsion bar between body and bogie frame, one per bogie."""

    stiffness: PositiveAngularStiffness


class TractionRod(Sourced):
    """Longitudinal link between body and bogie frame, one per bogie: a spring beside a damper with its own spring."""

    height: Length
    stiffness: PositiveStiffness
    damping: PositiveDamping
    series_stiffness: PositiveStiffness


class TorqueLink(Sourced):
    """Vertical link from the axle bridge to the bogie frame, `offset` from the axle towards the bogie centre.

    It holds the bridge's pitch against the reactions of motors and gears.
    """

    offset: PositiveLength
    stiffness: PositiveStiffness
    damping: Damping


__all__ = [
    "AntiRollBar",
    "DirectionalDamping",
    "DirectionalStiffness",
    "LateralStop",
    "Primary",
    "Secondary",
    "SeriesDamper",
    "TorqueLink",
    "TractionRod",
    "YawDamper",
]
