"""Strategy I, "IRW-like": the motors give both wheels equal torque, the actuators steer on the speed difference.
Differential torque control and rotational speed control of Perez et al. (2004), with a feedforward of the moment."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

from klingel.control.common import (
    SPEED,
    WHEELSETS,
    Plant,
    Timing,
    Wheelset,
    check_positive,
    command_motors,
    command_steering,
    database_curvature,
    database_curve,
    gyroscopic_moment,
    scheduled,
    sense_curve,
    sense_inertia,
    sensed_curve,
    sensed_roll_rate,
    speed_difference,
    steering_feedforward,
)
from klingel.control.diagram import Diagram
from klingel.control.discrete import low_pass
from klingel.control.feedforward import ContactDesign
from klingel.errors import InputError, nearest

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle

Curvature = Literal["gyro", "database"]


@dataclass(frozen=True)
class IRWLike:
    """Differential torque control plus steering on the wheel speed difference; parameters with their reasons.

    curvature: where the curve is known from: "gyro" (gyros of wheelset and bogie) or "database"
        (position along a known track).
    frequency: crossover fI of the steering loop [Hz]; with a conicity half as large again the gain margin is still 2.
    integral_time: Ti of the steering loop [s], ten times the loop's own time so that it costs little phase.
    current_frequency: crossover of the differential current loop of DC motors [Hz]: above all motion of the wheelset,
        below what a delay of two samples bears.
    yaw_frequency: low-pass of the wheelset's yaw rate [Hz]. Above it lambda psi'/r0 stays in the speed difference, as
        it does with a database, and damps the yaw of the wheelset on its primary springs near 6 Hz.
    gyro_frequency: low-pass of the bogie's yaw rate [Hz] that the radial part of the feedforward is made of; low, so
        that the yaw of the bogie does not steer itself.
    extrapolation: share of the lag of that low-pass and of the actuators by which the sensed curvature is carried
        forward along its slope.
    roll_frequency: low-pass of the wheelset's roll gyro [Hz]; steering does not roll a wheelset, so it may be fast.
    sensor_frequency: low-pass of the inertial sensors [Hz], above the body's own modes near 1 Hz.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = IRWLike().lower(library.vehicle("mechatronic_irw"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    16
    """

    curvature: Curvature = "gyro"
    frequency: float = 1.6
    integral_time: float = 1.0
    current_frequency: float = 30.0
    yaw_frequency: float = 1.5
    gyro_frequency: float = 1.5
    extrapolation: float = 0.5
    roll_frequency: float = 20.0
    sensor_frequency: float = 2.0
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)

    def __post_init__(self) -> None:
        if self.curvature not in get_args(Curvature):
            remedy = nearest(self.curvature, get_args(Curvature))
            raise InputError.single("control.curvature", self.curvature, "is not known", remedy=remedy)
        loops = ("frequency", "integral_time", "current_frequency")
        sensors = ("yaw_frequency", "gyro_frequency", "extrapolation", "roll_frequency", "sensor_frequency")
        check_positive(self, (*loops, *sensors))

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s]; the track is used by the database variant only.

        Errors: InputError for a vehicle without drives or steering actuators.
        """
        plant = Plant.of(vehicle, speed)
        d = Diagram(sample_time=self.timing.sample_time)
        proportional = scheduled(d, "steering.gain", lambda v: self._steering_gain(plant, v))
        integral = d.sum("steering.integral_gain", {proportional: 1.0 / self.integral_time})
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for wheelset in WHEELSETS:
            self._torque_loop(d, plant, wheelset)
            self._speed_error(d, plant, wheelset, track)
        if self.curvature == "gyro":
            sense_curve(d, plant, self.contact, self.timing, frequency=self.gyro_frequency)
        for wheelset in WHEELSETS:
            self._steering_loop(d, plant, wheelset, track, proportional, integral)
        return d.spec()

    def _steering_gain(self, plant: Plant, speed: float) -> float:
        """K = 2 pi fI kpsi r0^2/(V^2 gamma) [N m s/rad]: y' = V psi, psi = M/kpsi and wd = V gamma y/r0^2."""
        stiffness = plant.geometry.yaw_stiffness * plant.radius**2 / self.contact.conicity
        return 2.0 * math.pi * self.frequency * stiffness / speed**2

    def _torque_loop(self, d: Diagram, plant: Plant, w: Wheelset) -> None:
        """Equal torques for both wheels."""
        samples = self.timing.sensor_samples
        u = plant.motors.equal_torques(d, w.name, samples=samples, frequency=self.current_frequency)
        command_motors(d, plant, w, u, self.timing)

    def _speed_error(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """lambda r/r0 - wd [rad/s], r the yaw rate of the wheelset or of the track: -V gamma y/r0^2."""
        wd = speed_difference(d, w, self.timing)
        if self.curvature == "gyro":
            gyro = d.delay(f"{w.name}.gyro", d.measure(f"{w.name}.yaw_rate"), self.timing.sensor_samples)
            slow = low_pass(self.yaw_frequency, sample_time=self.timing.sample_time)
            rate = d.filter(f"{w.name}.gyro.slow", gyro, [slow])
        else:
            here = database_curvature(d, f"{w.name}.rho.here", track, d.measure(f"{w.name}.s"))
            rate = d.product(f"{w.name}.turn", here, d.measure(SPEED))
        d.sum(f"{w.name}.wd.error", {rate: plant.speed_ratio, wd: -1.0})

    def _steering_loop(
        self, d: Diagram, plant: Plant, w: Wheelset, track: Track, proportional: str, integral: str
    ) -> None:
        """M = feedforward + K (1 + 1/(Ti s)) (lambda r/r0 - wd)."""
        if self.curvature == "gyro":
            rho = sensed_curve(d, plant, w, frequency=self.gyro_frequency, extrapolation=self.extrapolation)
            roll_rate = sensed_roll_rate(d, w, self.timing, frequency=self.roll_frequency)
        else:
            rho, roll_rate = database_curve(d, plant, w, track, self.timing)
        error, limit = f"{w.name}.wd.error", 0.5 * plant.moment_max
        feedback = d.pi(f"{w.name}.M.feedback", error, proportional=proportional, integral=integral, limit=limit)
        gyroscopic = gyroscopic_moment(d, plant, w, roll_rate)
        feedforward = steering_feedforward(
            d, plant, self.contact, w, rho=rho, roll_rate=roll_rate, gyroscopic=gyroscopic
        )
        command_steering(d, plant, w, d.sum(f"{w.name}.M", {feedforward: 1.0, feedback: 1.0}), self.timing)
