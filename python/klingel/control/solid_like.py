"""Strategy S, "solid-wheelset-like": the motors couple the two wheels, the actuators take the yaw moment away.
Differential speed control and yaw-moment control of Perez et al. (2004), with a feedforward of the steering moment."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import SPEED, SPEED_GRID, WHEELSETS, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import (
    FAR,
    Plant,
    database_curvature,
    pair_feedback,
    sense_inertia,
    speed_difference,
)
from klingel.control.diagram import Diagram
from klingel.control.discrete import lead, notch
from klingel.control.driven import motors_of
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.motors import Motors, command_motors
from klingel.control.steering import steer_to_no_moment
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class SolidLike:
    """Differential speed control plus yaw-moment control; parameters with their reasons.

    coupling: damping between the wheels over f11 r0^2/V up to `coupling_speed` [m/s], falling with 1/V above: enough to
        centre the wheelsets, little enough that their hunting stays damped on the soft primary suspension.
    common_share: of that damping where both wheelsets of a bogie err alike, which moves the bogie aside, up to
        `slow_speed`, falling with 1/V above; where they err opposedly, which turns it, all of it acts:
        docs/theory/control.md.
    reach: displacement of a bogie [m] beyond which all of it acts on that too: far aside, where lost adhesion leaves a
        wheelset, a strong coupling brings it back.
    slow_speed: running speed below which that damping stays [m/s]; delays and the transmission's torsion bear no more.
    integral_time: of the speed loop [s]. Slow, because integral coupling of two wheels acts as a spring at the hunting
        frequency; it only removes what friction and unequal radii leave.
    lead_pole: time constant [s] that replaces the armature's La/Ra in the speed loop of DC motors.
    notch_frequency, notch_depth, notch_width: of the transmission's torsion mode with the wheel held by creep [Hz].
    yaw_frequency: crossover of the yaw-moment loop [Hz], below the hunting band of 2 to 8 Hz.
    yaw_speed: running speed below which that falls with the speed [m/s], as the hunting does.
    yaw_share: of the largest moment of the actuators that the yaw-moment loop may add: three times what it takes at
        friction 0.25; more would only wind up where adhesion is lost.
    sensor_frequency: low-pass of the inertial sensors [Hz], above the body's own modes near 1 Hz.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.
    traction: loop that drives and brakes the vehicle through the same motors; None holds their field and mean voltage.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = SolidLike().lower(library.vehicle("mechatronic_irw"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    16
    """

    coupling: float = 0.36
    coupling_speed: float = 56.0
    common_share: float = 0.3
    reach: float = 3.2e-3
    slow_speed: float = 26.0
    integral_time: float = 5.0
    lead_pole: float = 0.002
    notch_frequency: float = 55.0
    notch_depth: float = 0.1
    notch_width: float = 0.5
    yaw_frequency: float = 0.5
    yaw_speed: float = 28.0
    yaw_share: float = 0.1
    sensor_frequency: float = 2.0
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        names = (
            "coupling",
            "coupling_speed",
            "common_share",
            "reach",
            "slow_speed",
            "integral_time",
            "lead_pole",
            "notch_frequency",
            "notch_depth",
            "notch_width",
        )
        check_positive(self, (*names, "yaw_frequency", "yaw_speed", "yaw_share", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge", "drive", "steering"), take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s] on a track whose curvature the database knows.

        Errors: InputError for a vehicle without drives or steering actuators.
        """
        plant = Plant.of(vehicle)
        motors = motors_of(vehicle, self.traction, self.timing, speed)
        d = Diagram(sample_time=self.timing.sample_time)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for wheelset in WHEELSETS:
            self._speed_error(d, plant, wheelset, track)
        for wheelset in WHEELSETS:
            self._speed_loop(d, plant, motors, wheelset)
            steer_to_no_moment(
                d,
                plant,
                self.contact,
                wheelset,
                track,
                self.timing,
                frequency=self.yaw_frequency,
                slow_speed=self.yaw_speed,
                share=self.yaw_share,
            )
        return d.spec()

    def _damping(self, plant: Plant, speed: float) -> float:
        """Of the coupling between the wheels [N m s/rad]."""
        coupling = self.coupling * min(1.0, self.coupling_speed / speed)
        return coupling * self.contact.longitudinal_creep * plant.radius**2 / max(speed, self.slow_speed)

    def _speed_error(self, d: Diagram, plant: Plant, w: Wheelset, track: Track) -> None:
        """lambda V rho/r0 - wd [rad/s]"""
        rho = database_curvature(d, f"{w.name}.rho.here", track, d.measure(f"{w.name}.s"))
        turn = d.product(f"{w.name}.turn", rho, d.measure(SPEED))
        d.sum(f"{w.name}.wd.error", {turn: plant.speed_ratio, speed_difference(d, w, self.timing): -1.0})

    def _speed_loop(self, d: Diagram, plant: Plant, motors: Motors, w: Wheelset) -> None:
        """u = K(s) (lambda V rho/r0 - wd) of the pair, plus the back-EMF of the commanded difference."""
        ts = self.timing.sample_time
        share = scheduled(d, "speed_loop.common_share", lambda v: self.common_share * min(1.0, self.slow_speed / v))
        within = pair_feedback(d, w, "wd.shared", "wd.error", common=share, opposed=1.0)
        error = d.sum(f"{w.name}.wd.coupled", {within: 1.0, self._beyond_reach(d, plant, w): 1.0})
        shape = [notch(self.notch_frequency, depth=self.notch_depth, width=self.notch_width, sample_time=ts)]
        if motors.lag > 0.0:
            shape.insert(0, lead(motors.lag, self.lead_pole, sample_time=ts))
        shaped = d.filter(f"{w.name}.wd.shaped", error, shape)
        proportional = motors.gain(d, w.name, lambda v: self._damping(plant, v))
        name = f"{proportional}.integral"
        integral = name if d.has(name) else d.sum(name, {proportional: 1.0 / self.integral_time})
        limit = motors.steering_max
        feedback = d.pi(f"{w.name}.u.feedback", shaped, proportional=proportional, integral=integral, limit=limit)
        back_emf = motors.per_speed(d, w.name, plant.speed_ratio)
        command_motors(d, motors, w.name, d.sum(f"{w.name}.u", {feedback: 1.0, f"{w.name}.turn": back_emf}))

    def _beyond_reach(self, d: Diagram, plant: Plant, w: Wheelset) -> str:
        """What a bogie errs as a whole by more than the reach tells, V gamma y/r0^2 [rad/s]; made once."""
        name = f"{w.bogie_name}.wd.beyond"
        if d.has(name):
            return name
        slope = self.contact.conicity / plant.radius**2
        aside = d.quotient(f"{name}.mean", f"{w.bogie_name}.wd.shared.mean", d.measure(SPEED), floor=SPEED_GRID[0])
        reach, far = slope * self.reach, slope * (self.reach + FAR)
        excess = d.lookup(f"{name}.excess", aside, (-far, -reach, reach, far), (reach - far, 0.0, 0.0, far - reach))
        return d.product(name, excess, d.measure(SPEED))
