"""Independently rotating wheels steered by their lateral position in the track, with equal torques of their motors.
It needs a sensor that sees the rails (`wheelset.y`); there is no such sensor in service, so this one is ideal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import Plant, pair_feedback, sense_inertia
from klingel.control.diagram import Diagram
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.steering import Forward, database_feedforward, hold_equal_torques, steer
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class LateralFeedback:
    """M = feedforward - K (1 + 1/(Ti s)) y, K = 2 pi f kpsi/V: y' = V psi and psi = M/kpsi give y the crossover f.

    As in `IRWLike` the wheelsets of a bogie are steered as a pair, equally by their mean displacement, which moves the
    bogie aside, and opposedly by its half difference, which turns it; the integral is each wheelset's own. The position
    itself is fed back, so neither conicity nor wheel radii nor the curvature matter to where it settles.

    frequency: crossover f of the mean displacement [Hz]. turn_frequency: of the bogie's yaw at `slow_speed` [Hz]; it
        grows with the root of the speed, as the bogie runs aside the faster. centring: share of K with which opposed
        angles turn the bogie back to the middle. More of any of them takes the gain margin below 2 near 6 Hz, where the
        wheelsets yaw on their springs.
    slow_speed: running speed below which the gains stay [m/s].
    integral_time: Ti [s], slow: below V/(4 pi a), 4 Hz and more, y is a double integral of M, as the bogie follows.
    feedback_share: of the largest moment of the actuators that the feedback may use.
    current_frequency: crossover of the differential current loop of DC motors [Hz], as `IRWLike` has it.
    sensor_frequency: low-pass of the inertial sensors [Hz], above the body's own modes near 1 Hz.
    timing: sampling and delays. contact: what the feedforward assumes of wheel and rail.
    traction: loop that drives and brakes the vehicle through the same motors.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = LateralFeedback().lower(library.vehicle("trailed_irw"), Track.straight("500 m"), 30.0)
    >>> sorted(m for m in spec["measurements"] if m.endswith(".y"))[0]
    'bogie1.wheelset1.y'
    """

    frequency: float = 1.0
    turn_frequency: float = 1.6
    centring: float = 0.08
    slow_speed: float = 24.0
    integral_time: float = 3.0
    feedback_share: float = 0.5
    current_frequency: float = 5.0
    sensor_frequency: float = 2.0
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        loops = ("frequency", "turn_frequency", "centring", "slow_speed", "integral_time", "feedback_share")
        check_positive(self, (*loops, "current_frequency", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge", "steering"), take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s] on a track whose curvature the database knows.

        Errors: InputError for a vehicle without steering actuators.
        """
        plant = Plant.of(vehicle)
        d = Diagram(sample_time=self.timing.sample_time)
        hold_equal_torques(d, vehicle, self.traction, self.timing, speed=speed, frequency=self.current_frequency)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        forwards = [self._sense(d, plant, w, track) for w in WHEELSETS]
        for w, forward in zip(WHEELSETS, forwards, strict=True):
            self._steer(d, plant, w, forward)
        return d.spec()

    def _gain(self, plant: Plant, speed: float, frequency: float) -> float:
        """K = 2 pi f kpsi/V [N m/m]"""
        return 2.0 * math.pi * frequency * plant.geometry.yaw_stiffness / max(speed, self.slow_speed)

    def _turning_gain(self, plant: Plant, speed: float) -> float:
        """K of the bogie's yaw [N m/m]"""
        return self._gain(plant, speed, self.turn_frequency * math.sqrt(max(speed / self.slow_speed, 1.0)))

    def _sense(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> Forward:
        """The error 0 - y [m], and the feedforward."""
        forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
        y = d.delay(f"{w.name}.y.measured", d.measure(f"{w.name}.y"), self.timing.sensor_samples)
        d.sum(f"{w.name}.y.error", {y: -1.0})
        return forward

    def _steer(self, d: Diagram, plant: Plant, w: Wheelset, forward: Forward) -> None:
        """M = feedforward + K (0 - y) of the pair + K/Ti times the integral of the wheelset's own."""
        f, ti = self.frequency, self.integral_time
        proportional = pair_feedback(
            d,
            w,
            "M.proportional",
            "y.error",
            common=scheduled(d, "steering.gain", lambda v: self._gain(plant, v, f)),
            opposed=scheduled(d, "steering.turning", lambda v: self._turning_gain(plant, v)),
            centring=scheduled(d, "steering.centring", lambda v: self.centring * self._gain(plant, v, f)),
        )
        limit = self.feedback_share * plant.moment_max
        integral = scheduled(d, "steering.integral_gain", lambda v: self._gain(plant, v, f) / ti)
        held = d.pi(f"{w.name}.M.integral", f"{w.name}.y.error", proportional=0.0, integral=integral, limit=limit)
        both = d.sum(f"{w.name}.M.unlimited", {proportional: 1.0, held: 1.0})
        feedback = d.saturation(f"{w.name}.M.feedback", both, -limit, limit)
        d.probe(f"{w.name}.steering_feedback", "N m", feedback)
        steer(d, plant, w, {forward.moment: 1.0, feedback: 1.0}, self.timing)
