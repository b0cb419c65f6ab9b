"""The motors as a strategy commands them: a mean torque of every pair of wheels, and a difference for steering.
Without a traction loop the field and the mean voltage are those of the operating point, as in Perez et al. (2004)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.common import Plant, Timing, Wheelset, scheduled
from klingel.control.diagram import Diagram
from klingel.control.traction import DEMAND, Traction
from klingel.drives import OperatingPoint, operating_point

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

FIELD_MIN = 0.1
"""Least field current over its rated value: far above the speeds of the vehicle."""


@dataclass(frozen=True)
class Motors:
    """The motors of a vehicle under a strategy; `traction` None holds field and mean voltage at `point`."""

    vehicle: Vehicle
    plant: Plant
    timing: Timing
    traction: Traction | None
    point: OperatingPoint | None

    @classmethod
    def of(cls, vehicle: Vehicle, plant: Plant, timing: Timing, traction: Traction | None, speed: float) -> Motors:
        """Errors: InputError for a speed [m/s] at which the motors have no operating point to be held at."""
        point = operating_point(vehicle, speed) if traction is None else None
        return cls(vehicle, plant, timing, traction, point)

    def prepare(self, d: Diagram) -> None:
        """What all wheelsets share."""
        if self.traction is not None:
            demand = self.traction.demand(d, self.vehicle)
            d.probe("traction.torque_asked", "N m", demand)

    def gain(self, d: Diagram, w: Wheelset, damping: Callable[[float], float]) -> str:
        """Volts per rad/s that make a damping torque [N m s/rad] over the speed, through KT/(N Ra)."""
        drive = self.plant.drive
        if self.point is not None:
            kt = self.point.torque_constant
            name = "speed_loop.gain"
            if d.has(name):
                return name
            return scheduled(d, name, lambda v: damping(v) * drive.gear_ratio * drive.armature_resistance / kt)
        name = "speed_loop.damping"
        wanted = name if d.has(name) else scheduled(d, name, damping)
        volts = d.sum(f"{w.name}.speed_loop.volts", {wanted: drive.gear_ratio * drive.armature_resistance})
        return d.quotient(f"{w.name}.speed_loop.gain", volts, self._torque_constant(d, w), floor=self._least_constant)

    def back_emf(self, d: Diagram, w: Wheelset, turn: str) -> tuple[str, float]:
        """Signal and gain of the voltage that the commanded half difference of the wheels' speeds takes."""
        per_turn = self.plant.speed_ratio / self.plant.drive.gear_ratio
        if self.point is not None:
            return turn, self.point.torque_constant / self.plant.drive.gear_ratio * self.plant.speed_ratio
        return d.product(f"{w.name}.u.emf", turn, self._torque_constant(d, w)), per_turn

    def command(self, d: Diagram, w: Wheelset, voltage: str) -> None:
        """VaL = Va + u and VaR = Va - u, Eqs (22) and (23), with |u| at most (1 - x) VaMax; fields where they move."""
        limit = self.plant.steering_voltage_max
        limited = d.saturation(f"{w.name}.u.limited", voltage, -limit, limit)
        sent = d.delay(f"{w.name}.u.sent", limited, self.timing.computation_samples)
        mean = None if self.traction is None else self._mean_voltage(d, w, self.traction)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            if self.point is not None:
                total = d.sum(f"{w.name}.Va.{side}", {sent: sign}, bias=self.point.armature_voltage)
            else:
                assert mean is not None
                total = d.sum(f"{w.name}.Va.{side}", {sent: sign, mean: 1.0})
            d.command(f"{w.name}.{side}.armature_voltage", total)
        d.probe(f"{w.name}.steering_voltage", "V", sent)

    def _mean(self, d: Diagram, w: Wheelset, quantity: str) -> str:
        name = f"{w.name}.{quantity}.mean"
        if not d.has(name):
            sides = {d.measure(f"{w.name}.{side}.{quantity}"): 0.5 for side in ("left", "right")}
            now = d.sum(f"{name}.now", dict(sides))
            return d.delay(name, now, self.timing.sensor_samples)
        return name

    def _torque_constant(self, d: Diagram, w: Wheelset) -> str:
        """KT = Ke If of the measured field [N m/A]."""
        name = f"{w.name}.KT"
        return name if d.has(name) else d.sum(name, {self._mean(d, w, "field_current"): self.plant.drive.emf_constant})

    @property
    def _least_constant(self) -> float:
        return FIELD_MIN * self.plant.drive.field_current_rated * self.plant.drive.emf_constant

    def _mean_voltage(self, d: Diagram, w: Wheelset, traction: Traction) -> str:
        """Va = EMF + Ra Ia* + PI(Ia* - Ia) within +-x VaMax, Ia* = (N T + CM wM)/KT; and the field for it."""
        drive = self.plant.drive
        slip = traction.slip
        torque = DEMAND if slip is None else slip.limited(d, self.vehicle, w, DEMAND, self.timing)
        d.probe(f"{w.name}.torque_asked", "N m", torque)
        kt, turning = self._torque_constant(d, w), self._mean(d, w, "motor_speed")
        air_gap = d.sum(f"{w.name}.TM", {torque: drive.gear_ratio, turning: drive.rotor_damping})
        wanted = d.quotient(f"{w.name}.Ia.asked", air_gap, kt, floor=self._least_constant)
        rated = drive.armature_current_rated
        current = d.saturation(f"{w.name}.Ia.wanted", wanted, -rated, rated)
        share = drive.traction_share * drive.armature_voltage_max
        emf = d.product(f"{w.name}.EMF", kt, turning)
        forward = d.sum(f"{w.name}.Va.forward", {emf: 1.0, current: drive.armature_resistance})
        error = d.sum(f"{w.name}.Ia.error", {current: 1.0, self._mean(d, w, "armature_current"): -1.0})
        lower = d.sum(f"{w.name}.Va.lower", {forward: -1.0}, bias=-share)
        upper = d.sum(f"{w.name}.Va.upper", {forward: -1.0}, bias=share)
        crossover = 2.0 * math.pi * traction.current_frequency
        back = d.pi(
            f"{w.name}.Va.feedback",
            error,
            proportional=crossover * drive.armature_inductance,
            integral=crossover * drive.armature_resistance,
            within=(lower, upper),
        )
        self._excite(d, w, traction, current, turning)
        mean = d.sum(f"{w.name}.Va.mean", {forward: 1.0, back: 1.0})
        sent = d.delay(f"{w.name}.Va.sent", mean, self.timing.computation_samples)
        d.probe(f"{w.name}.traction_voltage", "V", sent)
        return sent

    def _excite(self, d: Diagram, w: Wheelset, traction: Traction, current: str, turning: str) -> None:
        """Vf = Rf If* + 2 pi f Lf (If* - If); If* leaves the back-EMF what the armature's drop takes of x VaMax."""
        drive = self.plant.drive
        share = drive.traction_share * drive.armature_voltage_max
        driving = d.saturation(f"{w.name}.Ia.driving", current, 0.0, drive.armature_current_rated)
        room = d.sum(f"{w.name}.EMF.most", {driving: -drive.armature_resistance}, bias=traction.field_margin * share)
        flux = d.sum(f"{w.name}.flux.speed", {turning: drive.emf_constant})
        weakened = d.quotient(f"{w.name}.If.weakened", room, flux, floor=drive.emf_constant)
        rated = drive.field_current_rated
        wanted = d.saturation(f"{w.name}.If.wanted", weakened, FIELD_MIN * rated, rated)
        gain = 2.0 * math.pi * traction.field_frequency * drive.field_inductance
        terms: dict[str, float | str] = {
            wanted: drive.field_resistance + gain,
            self._mean(d, w, "field_current"): -gain,
        }
        voltage = d.sum(f"{w.name}.Vf", terms)
        sent = d.delay(f"{w.name}.Vf.sent", voltage, self.timing.computation_samples)
        for side in ("left", "right"):
            d.command(f"{w.name}.{side}.field_voltage", sent)
