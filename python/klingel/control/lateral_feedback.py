"""Independently rotating wheels steered by their lateral position in the track, with equal torques of their motors.
It needs a sensor that sees the rails (`wheelset.y`); there is no such sensor in service, so this one is ideal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import Plant, sense_inertia
from klingel.control.diagram import Diagram
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.steering import database_feedforward, hold_equal_torques, steer
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class LateralFeedback:
    """M = feedforward - K (1 + 1/(Ti s)) y, K = 2 pi f kpsi/V: y' = V psi and psi = M/kpsi give y the crossover f.

    The position itself is fed back, so neither conicity nor wheel radii nor the curvature matter to where it settles.

    frequency: crossover f [Hz]: a gain margin of 2.6 at 108 km/h, where the yaw of the wheelsets on their springs
        limits it. slow_speed: running speed below which K stays [m/s].
    integral_time: Ti [s], slow: a bogie turns with its wheelsets, below V/(4 pi a) Hz y is a double integral of M.
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

    frequency: float = 1.6
    slow_speed: float = 15.0
    integral_time: float = 3.0
    feedback_share: float = 0.5
    current_frequency: float = 30.0
    sensor_frequency: float = 2.0
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        loops = ("frequency", "slow_speed", "integral_time", "feedback_share")
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
        for w in WHEELSETS:
            self._loop(d, plant, w, track)
        return d.spec()

    def _gain(self, plant: Plant, speed: float) -> float:
        """K [N m/m]"""
        return 2.0 * math.pi * self.frequency * plant.geometry.yaw_stiffness / max(speed, self.slow_speed)

    def _loop(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """M = feedforward + K (1 + 1/(Ti s)) (0 - y)."""
        forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
        y = d.delay(f"{w.name}.y.measured", d.measure(f"{w.name}.y"), self.timing.sensor_samples)
        feedback = d.pi(
            f"{w.name}.M.feedback",
            d.sum(f"{w.name}.y.error", {y: -1.0}),
            proportional=scheduled(d, "steering.gain", lambda v: self._gain(plant, v)),
            integral=scheduled(d, "steering.integral_gain", lambda v: self._gain(plant, v) / self.integral_time),
            limit=self.feedback_share * plant.moment_max,
        )
        d.probe(f"{w.name}.steering_feedback", "N m", feedback)
        steer(d, plant, w, {forward.moment: 1.0, feedback: 1.0}, self.timing)
