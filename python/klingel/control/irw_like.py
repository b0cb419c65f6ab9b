"""Strategy I, "IRW-like": the motors give both wheels equal torque, the actuators steer on the speed difference.
Differential torque control and rotational speed control of Perez et al. (2004), with a feedforward of the moment."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

from klingel.control.basics import SPEED, WHEELSETS, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import (
    FAR,
    Plant,
    command_steering,
    database_curvature,
    database_curve,
    gyroscopic_moment,
    pair_feedback,
    sense_curve,
    sense_inertia,
    sensed_curve,
    sensed_roll_rate,
    speed_difference,
    steering_feedforward,
)
from klingel.control.diagram import Diagram
from klingel.control.driven import motors_of
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.motors import Motors, command_motors
from klingel.control.traction import Traction
from klingel.errors import InputError, Problem, nearest

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle

Curvature = Literal["gyro", "database"]

BEYOND_REACH = 0.1
"""Share of what is beyond the reach that counts."""

REACH_ROUNDED = 1e-3
"""Over which `within_reach` falls from 1 to 0 beyond the reach [m]."""


@dataclass(frozen=True)
class IRWLike:
    """Differential torque control plus steering on the wheel speed difference; parameters with their reasons.

    curvature: where the curve is known from: "gyro" (gyros of wheelset and bogie) or "database"
        (position along a known track).
    frequency: crossover fI of the loop of the mean displacement of a bogie, by equal angles of its wheelsets [Hz].
    turn_frequency: the same of the loop of the bogie's yaw, by opposed angles, at `slow_speed` [Hz]; it grows with the
        root of the speed, as the bogie runs aside the faster: docs/theory/control.md.
    centring: share of the gain of the mean displacement with which opposed angles turn the bogie back to the middle.
    slow_speed: running speed below which the loops' gains stay [m/s], and their crossovers fall with the square of the
        speed: the gain also damps the wheelset's yaw, by K lambda/r0, which the actuators' lag bears so far.
    integral_time: Ti of the steering loop [s], long against the loops' own times so that it costs little phase.
    reach: displacement that the loop heeds [m]: what is beyond counts a tenth, as near the flange the speed difference
        tells more than there is; `within_reach` in the results says where (1) and where not (0).
    integral_share: of the largest moment of the actuators that the integral may use: three times what it takes at
        friction 0.25; more would only wind up where adhesion is lost.
    current_frequency: crossover of the differential current loop of DC motors [Hz]: above all motion of the wheelset,
        below what a delay of two samples bears.
    gyro_share: of the wheelset's own gyro in the yaw rate; the rest is the bogie's. So a part of lambda psi'/r0 of the
        wheelset against its bogie stays in the speed difference and damps its yaw on the primary springs near 7 Hz.
    gyro_frequency: low-pass of the bogie's yaw rate [Hz] that the radial part of the feedforward is made of; low, so
        that the yaw of the bogie does not steer itself.
    extrapolation: share of the lag of that low-pass and of the actuators by which the sensed curvature is carried
        forward along its slope.
    roll_frequency: low-pass of the wheelset's roll gyro [Hz]; steering does not roll a wheelset, so it may be fast.
    sensor_frequency: low-pass of the inertial sensors [Hz], above the body's own modes near 1 Hz.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.
    traction: loop that drives and brakes the vehicle through the same motors; None holds their field and mean voltage.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = IRWLike().lower(library.vehicle("mechatronic_irw"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    16
    """

    curvature: Curvature = "gyro"
    frequency: float = 1.1
    turn_frequency: float = 2.0
    centring: float = 0.06
    slow_speed: float = 26.0
    integral_time: float = 0.6
    reach: float = 4e-3
    integral_share: float = 0.1
    current_frequency: float = 5.0
    gyro_share: float = 0.6
    gyro_frequency: float = 1.5
    extrapolation: float = 0.5
    roll_frequency: float = 20.0
    sensor_frequency: float = 2.0
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        if self.curvature not in get_args(Curvature):
            remedy = nearest(self.curvature, get_args(Curvature))
            raise InputError.single("control.curvature", self.curvature, "is not known", remedy=remedy)
        loops = ("frequency", "turn_frequency", "centring", "slow_speed", "integral_time", "reach", "integral_share")
        sensors = ("gyro_share", "gyro_frequency", "extrapolation", "roll_frequency", "sensor_frequency")
        check_positive(self, (*loops, "current_frequency", *sensors))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge", "drive", "steering"), take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s]; the track is used by the database variant only.

        Errors: InputError for a vehicle without drives or steering actuators.
        """
        plant = Plant.of(vehicle)
        return self.diagram(plant, motors_of(vehicle, self.traction, self.timing, speed), track)

    def diagram(self, plant: Plant, motors: Motors | None, track: Track) -> dict[str, Any]:
        """The block diagram with motors that give equal torques, or without any."""
        d = Diagram(sample_time=self.timing.sample_time)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for wheelset in WHEELSETS:
            if motors is not None:
                self._torque_loop(d, motors, wheelset)
            self._speed_error(d, plant, wheelset, track)
        if self.curvature == "gyro":
            frequency, slow = self.gyro_frequency, self.slow_speed
            sense_curve(d, plant, self.contact, self.timing, frequency=frequency, slow_speed=slow)
        for wheelset in WHEELSETS:
            self._steering_loop(d, plant, wheelset, track)
        return d.spec()

    def _steering_gain(self, plant: Plant, speed: float, frequency: float) -> float:
        """K = 2 pi f kpsi r0^2/(V^2 gamma) [N m s/rad]: y' = V psi, psi = M/kpsi and wd = V gamma y/r0^2."""
        stiffness = plant.geometry.yaw_stiffness * plant.radius**2 / self.contact.conicity
        return 2.0 * math.pi * frequency * stiffness / max(speed, self.slow_speed) ** 2

    def _turning_gain(self, plant: Plant, speed: float) -> float:
        """K of the bogie's yaw [N m s/rad]"""
        frequency = self.turn_frequency * math.sqrt(max(speed / self.slow_speed, 1.0))
        return self._steering_gain(plant, speed, frequency)

    def _integral_gain(self, plant: Plant, speed: float) -> float:
        """K/Ti [N m/rad], Ti as long against a slow loop as against a quick one."""
        slow = min(1.0, speed / self.slow_speed)
        return self._steering_gain(plant, speed, self.frequency) * slow**2 / self.integral_time

    def _torque_loop(self, d: Diagram, motors: Motors, w: Wheelset) -> None:
        """Equal torques for both wheels."""
        command_motors(d, motors, w.name, motors.equal_torques(d, w.name, frequency=self.current_frequency))

    def _speed_error(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """lambda r/r0 - wd [rad/s], r the yaw rate of the wheelset or of the track: -V gamma y/r0^2 up to the reach.

        Near the flange the wheels' radii differ by far more than conicity says: a loop that heeded it all would swing.
        """
        wd = speed_difference(d, w, self.timing)
        if self.curvature == "gyro":
            own, bogie = d.measure(f"{w.name}.yaw_rate"), d.measure(f"{w.bogie_name}.yaw_rate")
            both = d.sum(f"{w.name}.gyros", {own: self.gyro_share, bogie: 1.0 - self.gyro_share})
            rate = d.delay(f"{w.name}.gyro", both, self.timing.sensor_samples)
        else:
            here = database_curvature(d, f"{w.name}.rho.here", track, d.measure(f"{w.name}.s"))
            rate = d.product(f"{w.name}.turn", here, d.measure(SPEED))
        told = d.sum(f"{w.name}.wd.told", {rate: plant.speed_ratio, wd: -1.0})
        per_metre = -self.contact.conicity / plant.radius**2
        y = d.product(f"{w.name}.y.told", told, scheduled(d, "y.per_error", lambda v: 1.0 / (per_metre * v)))
        far, beyond = self.reach + FAR, self.reach + BEYOND_REACH * FAR
        heeded = d.lookup(
            f"{w.name}.y.heeded", y, (-far, -self.reach, self.reach, far), (-beyond, -self.reach, self.reach, beyond)
        )
        d.product(f"{w.name}.wd.error", heeded, scheduled(d, "error.per_y", lambda v: per_metre * v))
        out = self.reach + REACH_ROUNDED
        within = d.lookup(f"{w.name}.within_reach", y, (-out, -self.reach, self.reach, out), (0.0, 1.0, 1.0, 0.0))
        d.probe(f"{w.name}.within_reach", "1", within)

    def _steering_loop(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """M = feedforward + K (lambda r/r0 - wd) of the pair + K/Ti times the integral of the wheelset's own."""
        if self.curvature == "gyro":
            rho = sensed_curve(d, plant, w, frequency=self.gyro_frequency, extrapolation=self.extrapolation)
            roll_rate = sensed_roll_rate(d, w, self.timing, frequency=self.roll_frequency)
        else:
            rho, roll_rate = database_curve(d, plant, w, track, self.timing)
        aside = scheduled(d, "steering.gain", lambda v: self._steering_gain(plant, v, self.frequency))
        proportional = pair_feedback(
            d,
            w,
            "M.proportional",
            "wd.error",
            common=aside,
            opposed=scheduled(d, "steering.turning", lambda v: self._turning_gain(plant, v)),
            centring=scheduled(
                d, "steering.centring", lambda v: self.centring * self._steering_gain(plant, v, self.frequency)
            ),
        )
        integral = scheduled(d, "steering.integral_gain", lambda v: self._integral_gain(plant, v))
        error, limit = f"{w.name}.wd.error", 0.5 * plant.moment_max
        bound = self.integral_share * plant.moment_max
        held = d.pi(f"{w.name}.M.integral", error, proportional=0.0, integral=integral, limit=bound)
        both = d.sum(f"{w.name}.M.unlimited", {proportional: 1.0, held: 1.0})
        feedback = d.saturation(f"{w.name}.M.feedback", both, -limit, limit)
        d.probe(f"{w.name}.steering_feedback", "N m", feedback)
        gyroscopic = gyroscopic_moment(d, plant, w, roll_rate)
        feedforward = steering_feedforward(
            d, plant, self.contact, w, rho=rho, roll_rate=roll_rate, gyroscopic=gyroscopic
        )
        command_steering(d, plant, w, d.sum(f"{w.name}.M", {feedforward: 1.0, feedback: 1.0}), self.timing)
