"""How a strategy drives a pair of motors, whatever their kind: the same torque is a voltage here and a command there.
DC motors are steered by the half difference u of their voltages, induction motors by that of their torque commands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from klingel.control.diagram import Diagram
from klingel.drives import (
    InductionPoint,
    OperatingPoint,
    induction_point,
    induction_torque_max,
    operating_point,
)
from klingel.vehicle import Drive, InductionDrive

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


class Motors(Protocol):
    """What a strategy asks of the motors of a wheelset; u is the half difference of what the two are commanded."""

    @property
    def input(self) -> str:
        """The input of each motor: `armature_voltage` [V] or `torque_command` [N m]."""
        ...

    @property
    def mean(self) -> float:
        """What both motors get for the running resistance."""
        ...

    @property
    def steering_max(self) -> float:
        """What traction leaves for |u|."""
        ...

    def of_torque(self, torque: float) -> float:
        """u for a half difference of the air-gap torques at the wheels [N m], slow."""
        ...

    @property
    def per_speed(self) -> float:
        """u that a half difference of the wheel speeds needs to make no torque [1/(rad/s)]."""
        ...

    @property
    def lag(self) -> float:
        """Time constant from u to torque that a controller makes up for [s]; 0 for none."""
        ...

    @property
    def probe(self) -> tuple[str, str]:
        """Name and unit under which u is recorded."""
        ...

    def equal_torques(self, d: Diagram, wheelset: str, *, samples: int, frequency: float) -> str:
        """u that keeps the torques of a pair equal; frequency: of a loop that it may take [Hz], `samples` its delay."""
        ...


@dataclass(frozen=True)
class DcMotors:
    """DC motors at their operating point: VaL = x VaMax + u and VaR = x VaMax - u, Eqs (22) and (23)."""

    drive: Drive
    point: OperatingPoint
    input: str = "armature_voltage"
    probe: tuple[str, str] = ("steering_voltage", "V")

    @property
    def mean(self) -> float:
        return self.point.armature_voltage

    @property
    def steering_max(self) -> float:
        """(1 - x) VaMax [V]"""
        return (1.0 - self.drive.traction_share) * self.drive.armature_voltage_max

    def of_torque(self, torque: float) -> float:
        """Through KT/(N Ra) [V]"""
        return torque * self.drive.gear_ratio * self.drive.armature_resistance / self.point.torque_constant

    @property
    def per_speed(self) -> float:
        """The back-EMF, KT/N [V/(rad/s)]"""
        return self.point.torque_constant / self.drive.gear_ratio

    @property
    def lag(self) -> float:
        """Of the armature, La/Ra [s]"""
        return self.drive.armature_inductance / self.drive.armature_resistance

    def equal_torques(self, d: Diagram, wheelset: str, *, samples: int, frequency: float) -> str:
        """u = K(s) (0 - (IaL - IaR)/2): equal armature currents are equal torques; K cancels the armature's pole."""
        left, right = (d.measure(f"{wheelset}.{side}.armature_current") for side in ("left", "right"))
        now = d.sum(f"{wheelset}.Id.now", {left: -0.5, right: 0.5})
        error = d.delay(f"{wheelset}.Id.error", now, samples)
        crossover = 2.0 * math.pi * frequency
        return d.pi(
            f"{wheelset}.u",
            error,
            proportional=crossover * self.drive.armature_inductance,
            integral=crossover * self.drive.armature_resistance,
            limit=self.steering_max,
        )


@dataclass(frozen=True)
class InductionMotors:
    """Induction motors at their operating point; they make the torque that they are commanded."""

    drive: InductionDrive
    point: InductionPoint
    input: str = "torque_command"
    probe: tuple[str, str] = ("steering_torque", "N m")

    @property
    def mean(self) -> float:
        return self.point.torque_command

    @property
    def steering_max(self) -> float:
        """What current and voltage give beyond the mean [N m]."""
        limit = induction_torque_max(self.drive, self.point.motor_speed) / self.drive.gear_ratio
        return limit - abs(self.point.torque_command)

    def of_torque(self, torque: float) -> float:
        return torque

    @property
    def per_speed(self) -> float:
        return 0.0

    @property
    def lag(self) -> float:
        return 0.0

    def equal_torques(self, d: Diagram, wheelset: str, *, samples: int, frequency: float) -> str:
        """No difference: the drives' own loops keep the torques."""
        return d.sum(f"{wheelset}.u", {})


def motors_of(vehicle: Vehicle, speed: float) -> Motors:
    """The motors of a vehicle at a speed [m/s]; errors: InputError for none, or a speed out of their reach."""
    if isinstance(vehicle.drive, InductionDrive):
        return InductionMotors(vehicle.drive, induction_point(vehicle, speed))
    return DcMotors(vehicle.dc_drive, operating_point(vehicle, speed))
