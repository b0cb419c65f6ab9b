"""Motors under a traction loop: the mean torque of a pair follows what is asked, the difference is left to steering.
DC motors take it by armature voltage and field, induction motors by their torque commands."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.basics import Timing, scheduled
from klingel.control.diagram import BEYOND, Diagram
from klingel.control.motors import Dc, DcMotors, InductionMotors, Motors
from klingel.control.traction import Traction
from klingel.drives import induction_point, operating_point, steering_torque_max
from klingel.vehicle import InductionDrive

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

FIELD_MIN = 0.1
"""Least field current over its rated value: enough for speeds far above the vehicle's."""


def motors_of(vehicle: Vehicle, traction: Traction | None, timing: Timing, speed: float) -> Motors:
    """The motors of a vehicle, held at their operating point at a speed [m/s] if there is no traction loop.

    Errors: InputError for none, or an operating point out of their reach.
    """
    drive = vehicle.drive
    if isinstance(drive, InductionDrive):
        if traction is not None:
            return DrivenInduction(vehicle, drive, traction, timing)
        return InductionMotors(drive, induction_point(vehicle, speed), timing)
    if traction is not None:
        return DrivenDc(vehicle=vehicle, drive=vehicle.dc_drive, traction=traction, timing=timing)
    return DcMotors(drive=vehicle.dc_drive, point=operating_point(vehicle, speed), timing=timing)


def mean_of(d: Diagram, w: str, quantity: str, timing: Timing) -> str:
    """Mean of a quantity of both motors of a wheelset as measured; made once."""
    name = f"{w}.{quantity}.mean"
    if d.has(name):
        return name
    now = d.sum(f"{name}.now", {d.measure(f"{w}.{side}.{quantity}"): 0.5 for side in ("left", "right")})
    return d.delay(name, now, timing.sensor_samples)


@dataclass(frozen=True, kw_only=True)
class DrivenDc(Dc):
    """DC motors under a traction loop: docs/theory/traction.md. The rated current bounds the mean of a pair."""

    vehicle: Vehicle
    traction: Traction

    def gain(self, d: Diagram, w: str, damping: Callable[[float], float]) -> str:
        """Through KT/(N Ra) of the measured field [V s/rad]"""
        wanted = self.traction.gripped(d, self.vehicle, w, scheduled(d, "speed_loop.damping", damping), self.timing)
        volts = d.sum(f"{w}.speed_loop.volts", {wanted: self.drive.gear_ratio * self.drive.armature_resistance})
        return d.quotient(f"{w}.speed_loop.gain", volts, self._torque_constant(d, w), floor=self._least_constant)

    def per_speed(self, d: Diagram, w: str, ratio: float) -> str:
        """The back-EMF, KT/N [V/(rad/s)]"""
        return d.sum(f"{w}.u.per_speed", {self._torque_constant(d, w): ratio / self.drive.gear_ratio})

    def mean(self, d: Diagram, w: str) -> str:
        """Va = EMF + Ra Ia* + PI(Ia* - Ia) within +-x VaMax [V], Ia* = (N T + CM wM)/KT; and the field for it."""
        drive = self.drive
        torque = self.traction.torque(d, self.vehicle, w, self.timing)
        kt, turning = self._torque_constant(d, w), mean_of(d, w, "motor_speed", self.timing)
        air_gap = d.sum(f"{w}.TM", {torque: drive.gear_ratio, turning: drive.rotor_damping})
        wanted = d.quotient(f"{w}.Ia.asked", air_gap, kt, floor=self._least_constant)
        rated = drive.armature_current_rated
        current = d.saturation(f"{w}.Ia.wanted", wanted, -rated, rated)
        share = drive.traction_share * drive.armature_voltage_max
        emf = d.product(f"{w}.EMF", kt, turning)
        forward = d.sum(f"{w}.Va.forward", {emf: 1.0, current: drive.armature_resistance})
        measured = mean_of(d, w, "armature_current", self.timing)
        error = d.sum(f"{w}.Ia.error", {current: 1.0, measured: -1.0})
        lower = d.sum(f"{w}.Va.lower", {forward: -1.0}, bias=-share)
        upper = d.sum(f"{w}.Va.upper", {forward: -1.0}, bias=share)
        crossover = 2.0 * math.pi * self.traction.current_frequency
        back = d.pi(
            f"{w}.Va.feedback",
            error,
            proportional=crossover * drive.armature_inductance,
            integral=crossover * drive.armature_resistance,
            within=(lower, upper),
        )
        self._excite(d, w, current, turning)
        mean = d.sum(f"{w}.Va.mean", {forward: 1.0, back: 1.0})
        return d.delay(f"{w}.Va.sent", mean, self.timing.computation_samples)

    def _excite(self, d: Diagram, w: str, current: str, turning: str) -> None:
        """Vf = Rf If* + 2 pi f Lf (If* - If); If* leaves the back-EMF what the armature's drop takes of x VaMax."""
        drive, traction = self.drive, self.traction
        share = drive.traction_share * drive.armature_voltage_max
        driving = d.saturation(f"{w}.Ia.driving", current, 0.0, drive.armature_current_rated)
        room = d.sum(f"{w}.EMF.most", {driving: -drive.armature_resistance}, bias=traction.field_margin * share)
        forward = d.saturation(f"{w}.flux.turning", turning, 1.0, BEYOND)  # backwards and at rest the field is full
        flux = d.sum(f"{w}.flux.speed", {forward: drive.emf_constant})
        weakened = d.quotient(f"{w}.If.weakened", room, flux, floor=drive.emf_constant)
        rated = drive.field_current_rated
        wanted = d.saturation(f"{w}.If.wanted", weakened, FIELD_MIN * rated, rated)
        gain = 2.0 * math.pi * traction.field_frequency * drive.field_inductance
        measured = mean_of(d, w, "field_current", self.timing)
        voltage = d.sum(f"{w}.Vf", {wanted: drive.field_resistance + gain, measured: -gain})
        sent = d.delay(f"{w}.Vf.sent", voltage, self.timing.computation_samples)
        for side in ("left", "right"):
            d.command(f"{w}.{side}.field_voltage", sent)

    def _torque_constant(self, d: Diagram, w: str) -> str:
        """KT = Ke If of the measured field [N m/A]."""
        name = f"{w}.KT"
        field = mean_of(d, w, "field_current", self.timing)
        return name if d.has(name) else d.sum(name, {field: self.drive.emf_constant})

    @property
    def _least_constant(self) -> float:
        return FIELD_MIN * self.drive.field_current_rated * self.drive.emf_constant


@dataclass(frozen=True)
class DrivenInduction:
    """Induction motors under a traction loop: the torque asked is their command."""

    vehicle: Vehicle
    drive: InductionDrive
    traction: Traction
    timing: Timing
    input: str = "torque_command"
    probe: tuple[str, str] = ("steering_torque", "N m")
    lag: float = 0.0

    @property
    def steering_max(self) -> float:
        """A share of the largest torque at standstill [N m]"""
        return steering_torque_max(self.drive)

    def mean(self, d: Diagram, w: str) -> str:
        """T + CM wM/N [N m]"""
        torque = self.traction.torque(d, self.vehicle, w, self.timing)
        turning = mean_of(d, w, "motor_speed", self.timing)
        asked = d.sum(f"{w}.T.air_gap", {torque: 1.0, turning: self.drive.rotor_damping / self.drive.gear_ratio})
        return d.delay(f"{w}.T.sent", asked, self.timing.computation_samples)

    def gain(self, d: Diagram, w: str, damping: Callable[[float], float]) -> str:
        """The damping itself [N m s/rad]"""
        wanted = scheduled(d, "speed_loop.damping", damping)
        return self.traction.gripped(d, self.vehicle, w, wanted, self.timing)

    def per_speed(self, d: Diagram, w: str, ratio: float) -> float:
        """None: the drive makes up for its back-EMF itself."""
        return 0.0

    def equal_torques(self, d: Diagram, w: str, *, frequency: float) -> str:
        """No difference: the drives' own loops keep the torques [N m]."""
        return d.sum(f"{w}.u", {})
