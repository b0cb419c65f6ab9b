"""Actuated solid wheelsets free of yaw moment at low frequency: the springs stabilise, the actuators let them turn.
After Shen and Goodall (1997), as recalled; the loop of `SolidLike` with solid axles in place of motors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import (
    Plant,
    command_steering,
    database_curve,
    gyroscopic_moment,
    sense_inertia,
    steering_feedforward,
)
from klingel.control.diagram import Diagram
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class YawMoment:
    """Integral control of the total yaw moment between wheelset and bogie to -H p, around the feedforward.

    yaw_frequency: crossover of the loop [Hz], below the hunting of 2 to 8 Hz, where the springs must stay stiff.
    yaw_speed: running speed below which the crossover falls with it [m/s].
    yaw_share: of the largest moment of the actuators that the feedback may use.
    sensor_frequency: low-pass of the inertial sensors [Hz]: what they tell of the hunting of the bogies, 2 Hz, comes
        back as a moment of the stiff springs; with 1.4 Hz it grows in an arc of 800 m.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = YawMoment().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    8
    """

    yaw_frequency: float = 0.7
    yaw_speed: float = 28.0
    yaw_share: float = 0.3
    sensor_frequency: float = 0.5
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)

    def __post_init__(self) -> None:
        check_positive(self, ("yaw_frequency", "yaw_speed", "yaw_share", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("wheelset", "steering"), take="mechatronic_solid")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle on a track whose curvature the database knows.

        Errors: InputError for a vehicle without steering actuators.
        """
        plant = Plant.of(vehicle)
        d = Diagram(sample_time=self.timing.sample_time)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for w in WHEELSETS:
            self._loop(d, plant, w, track)
        return d.spec()

    def _loop(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """M = feedforward + integral of 2 pi f (-H p - M_total)."""
        rho, roll_rate = database_curve(d, plant, w, track, self.timing)
        gyroscopic = gyroscopic_moment(d, plant, w, roll_rate)
        feedforward = steering_feedforward(
            d, plant, self.contact, w, rho=rho, roll_rate=roll_rate, gyroscopic=gyroscopic
        )
        total = d.delay(f"{w.name}.M.total", d.measure(f"{w.name}.yaw_moment"), self.timing.sensor_samples)
        error = d.sum(f"{w.name}.M.error", {gyroscopic: 1.0, total: -1.0})
        crossover = scheduled(
            d, "yaw_loop.crossover", lambda v: 2.0 * math.pi * self.yaw_frequency * min(1.0, v / self.yaw_speed)
        )
        limit = self.yaw_share * plant.moment_max
        feedback = d.pi(f"{w.name}.M.feedback", error, proportional=0.0, integral=crossover, limit=limit)
        d.probe(f"{w.name}.steering_feedback", "N m", feedback)
        command_steering(d, plant, w, d.sum(f"{w.name}.M", {feedforward: 1.0, feedback: 1.0}), self.timing)
