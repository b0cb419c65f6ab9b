"""How a strategy drives a pair of motors, whatever their kind: the same torque is a voltage here and a command there.
Here they are held at their operating point, as in Perez et al. (2004); `driven` has them under a traction loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from klingel.control.basics import Timing, scheduled
from klingel.control.diagram import Diagram, Gain
from klingel.drives import (
    InductionPoint,
    OperatingPoint,
    induction_torque_max,
)

if TYPE_CHECKING:
    from klingel.vehicle import Drive, InductionDrive


class Motors(Protocol):
    """What a strategy asks of the motors of a wheelset; u is the half difference of what the two are commanded."""

    @property
    def timing(self) -> Timing:
        """Sampling and delays."""
        ...

    @property
    def input(self) -> str:
        """The input of each motor: `armature_voltage` [V] or `torque_command` [N m]."""
        ...

    @property
    def probe(self) -> tuple[str, str]:
        """Name and unit under which u is recorded."""
        ...

    @property
    def steering_max(self) -> float:
        """What traction leaves for |u|."""
        ...

    @property
    def lag(self) -> float:
        """Time constant from u to torque that a controller makes up for [s]; 0 for none."""
        ...

    def mean(self, d: Diagram, w: str) -> str | float:
        """What both motors of a wheelset get for traction."""
        ...

    def gain(self, d: Diagram, w: str, damping: Callable[[float], float]) -> str:
        """u over a half difference of speeds for a damping [N m s/rad] of the wheels over the running speed [m/s]."""
        ...

    def per_speed(self, d: Diagram, w: str, ratio: float) -> Gain:
        """u that a half difference of the wheel speeds needs to make no torque, times `ratio` [1/(rad/s)]."""
        ...

    def equal_torques(self, d: Diagram, w: str, *, frequency: float) -> str:
        """u that keeps the torques of a pair equal; frequency: of a loop that it may take [Hz]."""
        ...


def command_motors(d: Diagram, motors: Motors, w: str, u: str) -> None:
    """Left mean + u and right mean - u, Eqs (22) and (23) for voltages, with |u| within what traction leaves."""
    limited = d.saturation(f"{w}.u.limited", u, -motors.steering_max, motors.steering_max)
    sent = d.delay(f"{w}.u.sent", limited, motors.timing.computation_samples)
    mean = motors.mean(d, w)
    bias = 0.0 if isinstance(mean, str) else mean
    for side, sign in (("left", 1.0), ("right", -1.0)):
        name = f"{w}.{motors.input}.{side}"
        total = d.sum(name, {sent: sign} | ({mean: 1.0} if isinstance(mean, str) else {}), bias=bias)
        d.command(f"{w}.{side}.{motors.input}", total)
    name, unit = motors.probe
    d.probe(f"{w}.{name}", unit, sent)


def equal_currents(d: Diagram, drive: Drive, w: str, *, timing: Timing, frequency: float, limit: float) -> str:
    """u = K(s) (0 - (IaL - IaR)/2) [V]: equal armature currents are equal torques; K cancels the armature's pole."""
    left, right = (d.measure(f"{w}.{side}.armature_current") for side in ("left", "right"))
    now = d.sum(f"{w}.Id.now", {left: -0.5, right: 0.5})
    error = d.delay(f"{w}.Id.error", now, timing.sensor_samples)
    crossover = 2.0 * math.pi * frequency
    return d.pi(
        f"{w}.u",
        error,
        proportional=crossover * drive.armature_inductance,
        integral=crossover * drive.armature_resistance,
        limit=limit,
    )


@dataclass(frozen=True, kw_only=True)
class Dc:
    """What DC motors have in common, held or driven: VaL = Va + u and VaR = Va - u, Eqs (22) and (23)."""

    drive: Drive
    timing: Timing
    input: str = "armature_voltage"
    probe: tuple[str, str] = ("steering_voltage", "V")

    @property
    def steering_max(self) -> float:
        """(1 - x) VaMax [V]: what traction leaves for |u|."""
        return (1.0 - self.drive.traction_share) * self.drive.armature_voltage_max

    @property
    def lag(self) -> float:
        """Of the armature, La/Ra [s]"""
        return self.drive.armature_inductance / self.drive.armature_resistance

    def equal_torques(self, d: Diagram, w: str, *, frequency: float) -> str:
        """By equal armature currents [V]"""
        return equal_currents(d, self.drive, w, timing=self.timing, frequency=frequency, limit=self.steering_max)


@dataclass(frozen=True, kw_only=True)
class DcMotors(Dc):
    """DC motors at their operating point, Va that of the point."""

    point: OperatingPoint

    def mean(self, d: Diagram, w: str) -> float:
        """Va [V]"""
        return self.point.armature_voltage

    def gain(self, d: Diagram, w: str, damping: Callable[[float], float]) -> str:
        """Through KT/(N Ra) [V s/rad]"""
        drive, kt = self.drive, self.point.torque_constant
        return scheduled(d, "speed_loop.gain", lambda v: damping(v) * drive.gear_ratio * drive.armature_resistance / kt)

    def per_speed(self, d: Diagram, w: str, ratio: float) -> float:
        """The back-EMF, KT/N [V/(rad/s)]"""
        return self.point.torque_constant / self.drive.gear_ratio * ratio


@dataclass(frozen=True)
class InductionMotors:
    """Induction motors at their operating point; they make the torque that they are commanded."""

    drive: InductionDrive
    point: InductionPoint
    timing: Timing
    input: str = "torque_command"
    probe: tuple[str, str] = ("steering_torque", "N m")
    lag: float = 0.0

    @property
    def steering_max(self) -> float:
        """What current and voltage give beyond the mean [N m]."""
        limit = induction_torque_max(self.drive, self.point.motor_speed) / self.drive.gear_ratio
        return limit - abs(self.point.torque_command)

    def mean(self, d: Diagram, w: str) -> float:
        """Of the running resistance and the rotor's friction [N m]"""
        return self.point.torque_command

    def gain(self, d: Diagram, w: str, damping: Callable[[float], float]) -> str:
        """The damping itself [N m s/rad]"""
        return scheduled(d, "speed_loop.gain", damping)

    def per_speed(self, d: Diagram, w: str, ratio: float) -> float:
        """None: the drive makes up for its back-EMF itself."""
        return 0.0

    def equal_torques(self, d: Diagram, w: str, *, frequency: float) -> str:
        """No difference: the drives' own loops keep the torques [N m]."""
        return d.sum(f"{w}.u", {})
