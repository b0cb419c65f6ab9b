"""Vehicles in railway words: bodies, bogies, wheelsets or axle bridges, suspension, drives, steering.
A Vehicle is immutable and comes from a TOML file that states units and sources."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from klingel.errors import InputError
from klingel.records import Parameter, Record, parameters, read_toml, validated
from klingel.vehicle.base import resolved
from klingel.vehicle.bodies import AxleBridge, Geometry, RigidBody, SolidWheelset, WheelProfile
from klingel.vehicle.drive import (
    Actuator,
    AnyDrive,
    Drive,
    InductionDrive,
    SecondaryActuator,
    SteeringActuator,
    Transmission,
)
from klingel.vehicle.resistance import RunningResistance
from klingel.vehicle.suspension import (
    AntiRollBar,
    LateralStop,
    Primary,
    Secondary,
    TorqueLink,
    TractionRod,
    YawDamper,
)


class Vehicle(Record):
    """Bogie vehicle: one body, two bogies, four wheelsets, solid or with independently rotating wheels.

    Exactly one of `wheelset` (solid) and `axle_bridge` (two wheels, each with its own spin) is given. A drive needs an
    axle bridge, and an axle bridge needs a torque link that holds its pitch. `steering`: actuators between wheelset and
    bogie; `secondary_steering`: between bogie and body.

    >>> from klingel import library
    >>> coach = library.vehicle("manchester_coach")
    >>> coach.total_mass
    44482.0
    """

    name: str
    description: str
    sources: dict[str, str]
    geometry: Geometry
    body: RigidBody
    bogie: RigidBody
    wheelset: SolidWheelset | None = None
    axle_bridge: AxleBridge | None = None
    wheel_profile: WheelProfile
    primary: Primary
    secondary: Secondary
    lateral_stop: LateralStop
    anti_roll_bar: AntiRollBar
    traction_rod: TractionRod
    yaw_damper: YawDamper | None = None
    torque_link: TorqueLink | None = None
    drive: AnyDrive | None = None
    steering: SteeringActuator | None = None
    secondary_steering: SecondaryActuator | None = None
    running_resistance: RunningResistance | None = None

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The vehicle of a TOML file; `base` names another file beside it that it is a variant of.

        Errors: InputError with every problem, naming file, key, value and remedy.
        """
        folder = Path(path).parent
        tables = resolved(read_toml(path), lambda base: read_toml(folder / base), file=str(path))
        return validated(cls, tables, file=str(path))

    @classmethod
    def from_tables(cls, tables: dict[str, Any], *, file: str | None = None) -> Self:
        """The vehicle of the tables of a file; errors as for `read`."""
        return validated(cls, tables, file=file)

    def replace(self, **changes: Any) -> Self:
        """The same vehicle with other tables, such as `drive=library.drive("induction_160kw")`; errors: InputError.

        >>> from klingel import library
        >>> vehicle = library.vehicle("mechatronic_irw")
        >>> vehicle.replace(drive=library.drive("induction_160kw")).drive.kind
        'induction'
        """
        return validated(type(self), {name: getattr(self, name) for name in type(self).model_fields} | changes)

    @property
    def dc_drive(self) -> Drive:
        """The drive of a vehicle with DC motors; errors: InputError for one without drives or with other motors."""
        if not isinstance(self.drive, Drive):
            remedy = "take a vehicle with DC motors" if self.drive else f"{self.name} is hauled; take a driven vehicle"
            raise InputError.single("drive", getattr(self.drive, "kind", None), "is no DC drive", remedy=remedy)
        return self.drive

    @property
    def induction_drive(self) -> InductionDrive:
        """The drive of a vehicle with induction motors; errors: InputError for one without drives or with others."""
        if not isinstance(self.drive, InductionDrive):
            remedy = 'replace its drive with library.drive("induction_160kw")'
            raise InputError.single("drive", getattr(self.drive, "kind", None), "is no induction drive", remedy=remedy)
        return self.drive

    @property
    def independent_wheels(self) -> bool:
        """Whether the two wheels of an axle rotate independently."""
        return self.axle_bridge is not None

    @property
    def wheelset_mass(self) -> float:
        """Of one solid wheelset, or of one axle bridge with its wheels [kg]."""
        if self.axle_bridge is not None:
            return self.axle_bridge.total_mass
        return self.solid_wheelset.mass

    @property
    def solid_wheelset(self) -> SolidWheelset:
        """The wheelset of a vehicle with solid ones; errors: InputError for independent wheels."""
        if self.wheelset is None:
            raise InputError.single("wheelset", None, f"{self.name} has none", remedy="take its axle_bridge")
        return self.wheelset

    @property
    def total_mass(self) -> float:
        """Body, two bogie frames, four wheelsets [kg]."""
        return self.body.mass + 2.0 * self.bogie.mass + 4.0 * self.wheelset_mass

    def parameters(self) -> list[Parameter]:
        """Every number of the vehicle with its unit, status, sources and note."""
        return list(parameters(self))

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.wheelset is None) == (self.axle_bridge is None):
            raise _inconsistent("needs either a wheelset or an axle_bridge", "give exactly one of the two tables")
        if self.axle_bridge is None:
            extra = [key for key in ("torque_link", "drive") if getattr(self, key) is not None]
            if extra:
                raise _inconsistent(f"{extra[0]} needs an axle_bridge", f"remove [{extra[0]}] or give an axle_bridge")
        elif self.torque_link is None:
            raise _inconsistent("axle_bridge needs a torque_link that holds its pitch", "add the table [torque_link]")
        if self.drive is not None and self.running_resistance is None:
            raise _inconsistent("drive needs a running_resistance", "add the table [running_resistance]")
        listed = {*self.sources, *(self.drive.sources if self.drive else ())}
        unknown = sorted({s for p in self.parameters() for s in p.source} - listed)
        if unknown:
            raise _inconsistent(f"source {unknown[0]!r} is not listed", "add it to [sources]")
        return self


def _inconsistent(message: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("inconsistent", "{message}", {"message": message, "remedy": remedy})


__all__ = [
    "Actuator",
    "AntiRollBar",
    "AnyDrive",
    "AxleBridge",
    "Drive",
    "Geometry",
    "InductionDrive",
    "LateralStop",
    "Primary",
    "RigidBody",
    "RunningResistance",
    "Secondary",
    "SecondaryActuator",
    "SolidWheelset",
    "SteeringActuator",
    "TorqueLink",
    "TractionRod",
    "Transmission",
    "Vehicle",
    "WheelProfile",
    "YawDamper",
]
