"""What drives a vehicle along its track: a speed to follow or a driver's notch, as torque asked of every wheel.
The torque stays within what the motors give at the speed; how it is made of voltages is in `motors`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from klingel.control.basics import SPEED, Timing, check_positive
from klingel.control.diagram import Diagram
from klingel.control.slip import SlipControl, turning_inertia
from klingel.drives import running_resistance, traction_torque_max
from klingel.errors import InputError
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

WHEELS = 8
BRAKE_FADES = 2.0
"""Speed below which the torque of a braking notch falls to nil [m/s]."""
CREEP_CONTROL = SlipControl()
"""Unless another is given, or None for none."""
CORNER = 0.5
"""Over which a corner of the wanted speed is rounded in the acceleration fed forward [s]."""
DEMAND = "traction.torque"
"""The signal of the torque asked of every wheel, of the gear's wheel side [N m]."""


@dataclass(frozen=True)
class Traction:
    """A closed traction loop: speed over time, or a notch over time; made by `follow` or `notched`.

    time [s], with either speed [m/s] or notch (-1 full braking to 1 full traction), straight lines between the points;
    frequency: crossover of the speed loop [Hz], slow against all that steers; integral_time: of the same [s];
    torque_rate: limit of the torque asked of a wheel [N m/s], comfort; current_frequency: crossover of the loop of the
    mean armature current [Hz]; field_frequency: of the field current's loop [Hz]; field_margin: share of x VaMax that
    the back-EMF may reach at no current; slip: creep control of every pair of wheels, None for none.

    >>> start = Traction.follow([0.0, 60.0], ["0 km/h", "100 km/h"])
    >>> round(start.speed[1], 2), start.notch
    (27.78, None)
    """

    time: tuple[float, ...]
    speed: tuple[float, ...] | None = None
    notch: tuple[float, ...] | None = None
    frequency: float = 0.1
    integral_time: float = 10.0
    torque_rate: float = 2500.0
    current_frequency: float = 30.0
    field_frequency: float = 1.0
    field_margin: float = 0.97
    slip: SlipControl | None = field(default_factory=SlipControl)

    def __post_init__(self) -> None:
        values = self.speed if self.speed is not None else self.notch
        if (self.speed is None) == (self.notch is None) or values is None:
            remedy = "use Traction.follow for a speed or Traction.notched for a notch"
            raise InputError.single("control.traction", None, "needs a speed or a notch, not both", remedy=remedy)
        key = "speed" if self.speed is not None else "notch"
        if len(self.time) != len(values) or len(values) < 1 or not all(map(math.isfinite, (*self.time, *values))):
            remedy = "give one finite value for each time"
            raise InputError.single(f"control.traction.{key}", values, "does not go with its times", remedy=remedy)
        if any(b <= a for a, b in zip(self.time, self.time[1:], strict=False)):
            remedy = "give later and later times"
            raise InputError.single("control.traction.time", self.time, "does not grow", remedy=remedy)
        low, high, unit = (0.0, 120.0, "m/s") if key == "speed" else (-1.0, 1.0, "-")
        for value in values:
            if not low <= value <= high:
                remedy = f"give {low:g} to {high:g} [{unit}]"
                raise InputError.single(f"control.traction.{key}", value, "is out of range", remedy=remedy)
        names = ("frequency", "integral_time", "torque_rate", "current_frequency", "field_frequency")
        check_positive(self, names, key="control.traction")
        if not 0.5 <= self.field_margin <= 1.0:
            remedy = "give 0.5 to 1"
            raise InputError.single("control.traction.field_margin", self.field_margin, "is no margin", remedy=remedy)

    @classmethod
    def follow(
        cls, time: Iterable[Quantity], speed: Iterable[Quantity], *, slip: SlipControl | None = CREEP_CONTROL
    ) -> Traction:
        """Follow a speed over time: corner points, strings with units or SI; errors: InputError."""
        speeds = tuple(to_si(value, "m/s", key="control.traction.speed") for value in speed)
        return cls(_times(time), speed=speeds, slip=slip)

    @classmethod
    def notched(
        cls, time: Iterable[Quantity], notch: Iterable[Quantity], *, slip: SlipControl | None = CREEP_CONTROL
    ) -> Traction:
        """A share of the torque that the motors give at the speed: -1 (braking) to 1; errors: InputError.

        Braking fades below 2 m/s: it stops the vehicle and does not drive it backwards.
        """
        shares = tuple(to_si(value, "1", key="control.traction.notch") for value in notch)
        return cls(_times(time), notch=shares, slip=slip)

    def torque(self, d: Diagram, vehicle: Vehicle, w: str, timing: Timing) -> str:
        """The signal of the torque for each wheel of a pair [N m], what slip control takes off included."""
        asked = DEMAND if d.has(DEMAND) else self._demand(d, vehicle)
        torque = asked if self.slip is None else self.slip.limited(d, vehicle, w, asked, timing)
        d.probe(f"{w}.torque_asked", "N m", torque)
        return torque

    def gripped(self, d: Diagram, vehicle: Vehicle, w: str, damping: str, timing: Timing) -> str:
        """A damping between the wheels of a pair [N m s/rad], less of it while a wheel slips."""
        return damping if self.slip is None else self.slip.gripped(d, vehicle, w, damping, timing)

    def _demand(self, d: Diagram, vehicle: Vehicle) -> str:
        """The signal of the torque asked of every wheel [N m], within what the motors give and its rate."""
        speeds = speed_grid()
        limit = [traction_torque_max(vehicle, v) for v in speeds]
        most = d.lookup("traction.most", d.measure(SPEED), speeds, limit)
        least = d.sum("traction.least", {most: -1.0})
        now = d.clock()
        if self.notch is not None:
            share = d.lookup("traction.notch", now, *two_at_least(self.time, self.notch))
            # a brake holds at rest, it does not drive backwards
            rolling = d.lookup("traction.rolling", d.measure(SPEED), (0.0, BRAKE_FADES), (0.0, 1.0))
            braking = d.product("traction.braking", d.saturation("traction.brake", share, -1.0, 0.0), rolling)
            notch = d.sum("traction.share", {d.saturation("traction.drive", share, 0.0, 1.0): 1.0, braking: 1.0})
            asked = d.product("traction.asked", notch, most)
        else:
            asked = self._following(d, vehicle, now, most, least)
        within = d.saturation("traction.within", asked, least, most)
        d.probe("traction.torque_asked", "N m", d.rate_limit(DEMAND, within, self.torque_rate))
        return DEMAND

    def _following(self, d: Diagram, vehicle: Vehicle, now: str, most: str, least: str) -> str:
        """T = r0/8 [m* v_ref' + R(v_ref) + 2 pi f m* (e + integral of e/Ti)], e = v_ref - v; m* turns too."""
        assert self.speed is not None
        times, speeds = two_at_least(self.time, self.speed)
        wanted = d.lookup("traction.speed", now, times, speeds)
        error = d.sum("traction.error", {wanted: 1.0, d.measure(SPEED): -1.0})
        arm = vehicle.geometry.wheel_radius / WHEELS
        mass = inertial_mass(vehicle)
        resistance = running_resistance(vehicle)
        grid = speed_grid()
        drag = d.lookup("traction.drag", wanted, grid, [arm * resistance(v) if v > 0.0 else 0.0 for v in grid])
        slope = d.lookup("traction.acceleration", now, *corners(times, speeds))
        forward = d.sum("traction.forward", {slope: arm * mass, drag: 1.0})
        lower = d.sum("traction.lower", {least: 1.0, forward: -1.0})
        upper = d.sum("traction.upper", {most: 1.0, forward: -1.0})
        gain = 2.0 * math.pi * self.frequency * mass * arm
        back = d.pi(
            "traction.feedback", error, proportional=gain, integral=gain / self.integral_time, within=(lower, upper)
        )
        return d.sum("traction.asked", {forward: 1.0, back: 1.0})


def _times(time: Iterable[Quantity]) -> tuple[float, ...]:
    return tuple(to_si(value, "s", key="control.traction.time") for value in time)


def two_at_least(times: tuple[float, ...], values: tuple[float, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The points of a table; a single one is held."""
    return (times, values) if len(times) > 1 else ((times[0], times[0] + 1.0), values * 2)


def speed_grid() -> tuple[float, ...]:
    """Speeds [m/s] of the schedules of traction, from standstill on."""
    return tuple(float(v) for v in np.linspace(0.0, 100.0, 101))


def inertial_mass(vehicle: Vehicle) -> float:
    """Mass [kg] that a force along the track accelerates: with what wheels, and rotors through their gear, add."""
    return vehicle.total_mass + WHEELS * turning_inertia(vehicle) / vehicle.geometry.wheel_radius**2


def corners(times: Iterable[float], values: Iterable[float]) -> tuple[list[float], list[float]]:
    """Slope of a broken line over time, each corner rounded over `CORNER` [s]; nil before and after.

    >>> corners([0.0, 10.0], [0.0, 5.0])
    ([0.0, 0.5, 9.5, 10.0], [0.0, 0.5, 0.5, 0.0])
    """
    times, values = list(times), list(values)
    slopes = [(b - a) / (t1 - t0) for t0, t1, a, b in zip(times, times[1:], values, values[1:], strict=False)]
    places, result = [times[0]], [0.0]
    for k, slope in enumerate(slopes):
        reach = min(CORNER, (times[k + 1] - times[k]) / 3.0)
        places += [times[k] + reach, times[k + 1] - reach]
        result += [slope, slope]
    return [*places, times[-1]], [*result, 0.0]
