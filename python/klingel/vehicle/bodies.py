"""Bodies, wheels and geometry of a bogie vehicle as tables of a file.
Heights are above the top of rail, inertias about the own centre of mass."""

from __future__ import annotations

from typing import Literal

from klingel.records import Record, Sourced
from klingel.units import Length, PositiveInertia, PositiveLength, PositiveMass


class Inertia(Record):
    """Principal moments of inertia about x, y, z [kg m2]."""

    roll: PositiveInertia
    pitch: PositiveInertia
    yaw: PositiveInertia


class RigidBody(Sourced):
    """Car body or bogie frame; height of the centre of mass."""

    mass: PositiveMass
    inertia: Inertia
    height: Length


class SolidInertia(Record):
    """Of a solid wheelset [kg m2]: about x, about its own spin axis, about z."""

    roll: PositiveInertia
    spin: PositiveInertia
    yaw: PositiveInertia


class SolidWheelset(Sourced):
    """Two wheels on one axle; its centre is at the wheel radius."""

    mass: PositiveMass
    inertia: SolidInertia


class WheelInertia(Record):
    """Of one wheel [kg m2]: about its spin axis, about any diameter."""

    spin: PositiveInertia
    diameter: PositiveInertia


class Wheel(Sourced):
    """One independently rotating wheel; lateral_offset: of its centre of mass from the bridge's centre."""

    mass: PositiveMass
    inertia: WheelInertia
    lateral_offset: PositiveLength


class AxleBridge(Sourced):
    """Frame that holds two independently rotating wheels, with both motor stators and gear cases on it."""

    mass: PositiveMass
    inertia: Inertia
    wheel: Wheel

    @property
    def total_mass(self) -> float:
        """Bridge and both wheels [kg]."""
        return self.mass + 2.0 * self.wheel.mass

    @property
    def total_inertia(self) -> tuple[float, float, float]:
        """Bridge and both wheels about x, y, z [kg m2], without the wheels' own spin."""
        wheel = self.wheel
        beside = 2.0 * (wheel.inertia.diameter + wheel.mass * wheel.lateral_offset**2)
        return (self.inertia.roll + beside, self.inertia.pitch, self.inertia.yaw + beside)


class Geometry(Sourced):
    """Plan of the vehicle: half distance of the bogie centres, half wheelbase, nominal wheel radius."""

    half_bogie_spacing: PositiveLength
    half_wheelbase: PositiveLength
    wheel_radius: PositiveLength

    @property
    def half_length(self) -> float:
        """From the vehicle's centre to its first wheelset [m]."""
        return self.half_bogie_spacing + self.half_wheelbase


TAPE_CIRCLE = 0.070
"""Distance of the tape circle from the flange back [m] (EN 13715)."""


class WheelProfile(Sourced):
    """Wheel profile by name, and the distance of the two wheels' flange backs."""

    name: Literal["S1002"]
    flange_back_distance: PositiveLength

    @property
    def half_tape_distance(self) -> float:
        """Half distance of the tape circles [m], lambda in the paper."""
        return 0.5 * self.flange_back_distance + TAPE_CIRCLE
