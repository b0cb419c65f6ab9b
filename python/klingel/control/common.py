"""What both active strategies share: sampling and delays, curve sensing, feedforward, and the commands to the plant.
Wheelsets are named as in the results: bogie1.wheelset1 leads, bogie2.wheelset2 trails."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.basics import SPEED, SPEED_GRID, Timing, Wheelset, scheduled
from klingel.control.diagram import Diagram, Gain
from klingel.control.discrete import Section, low_pass, slope_low_pass
from klingel.control.feedforward import ContactDesign, SteeringGeometry, attack_angle_table
from klingel.errors import InputError
from klingel.track import CANT_BASE

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import SteeringActuator, Vehicle

BUTTERWORTH = 0.7
"""Damping ratio of all second-order low-passes here."""

FAR = 50e-3
"""Displacement beyond a strategy's reach up to which it still counts [m]; no wheelset goes so far."""


@dataclass(frozen=True)
class Plant:
    """The numbers of one vehicle that a strategy is made from; steering: None where nothing steers."""

    geometry: SteeringGeometry
    steering: SteeringActuator | None
    radius: float

    @classmethod
    def of(cls, vehicle: Vehicle) -> Plant:
        """Errors: InputError for a vehicle without steering actuators."""
        if vehicle.steering is None:
            remedy = f"{vehicle.name} is passive; take a vehicle with [steering], or no control"
            raise InputError.single("steering", None, "is missing", remedy=remedy)
        return cls(SteeringGeometry.of(vehicle), vehicle.steering, vehicle.geometry.wheel_radius)

    @classmethod
    def unsteered(cls, vehicle: Vehicle) -> Plant:
        """For strategies that leave the steering actuators alone, or do without."""
        return cls(SteeringGeometry.of(vehicle), None, vehicle.geometry.wheel_radius)

    @property
    def actuators(self) -> SteeringActuator:
        """Errors: InputError where nothing steers."""
        if self.steering is None:
            raise InputError.single("steering", None, "is missing", remedy="make the plant with Plant.of")
        return self.steering

    @property
    def speed_ratio(self) -> float:
        """wd over the yaw rate of the track: lambda/r0 [-]; half of Eq. (1) is lambda V rho/r0."""
        return self.geometry.half_tape_distance / self.radius

    @property
    def moment_max(self) -> float:
        """Of both actuators of a wheelset together [N m]."""
        return self.actuators.moment_max

    @property
    def actuator_lag(self) -> float:
        """Delay of the actuators for slow commands, 2 zeta/w [s]; nil without."""
        return self.steering.lag if self.steering is not None else 0.0


def speed_difference(d: Diagram, wheelset: Wheelset, timing: Timing) -> str:
    """wd [rad/s], half of wL - wR as the encoders of the two wheels measure it."""
    left, right = (d.measure(f"{wheelset.name}.{side}.spin_speed") for side in ("left", "right"))
    now = d.sum(f"{wheelset.name}.wd.now", {left: 0.5, right: -0.5})
    return d.delay(f"{wheelset.name}.wd", now, timing.sensor_samples)


def pair_feedback(
    d: Diagram, w: Wheelset, name: str, quantity: str, *, common: Gain, opposed: Gain, centring: Gain | None = None
) -> str:
    """Feedback of both wheelsets of a bogie on their displacements: common q + (+-1) (opposed p + centring q).

    q = (q1 + q2)/2 and p = (q1 - q2)/2 of `<wheelset>.<quantity>`, which tells the displacement: q how far the bogie is
    aside, p how far it is turned; + for the leading wheelset. Its shares `<bogie>.<name>.<share>` are made once.
    """
    shares = {share: f"{w.bogie_name}.{name}.{share}" for share in ("mean", "half", "common", "opposed")}
    if not d.has(shares["mean"]):
        first, second = (f"{w.bogie_name}.wheelset{i}.{quantity}" for i in (1, 2))
        d.sum(shares["mean"], {first: 0.5, second: 0.5})
        d.sum(shares["half"], {first: 0.5, second: -0.5})
        d.sum(shares["common"], {shares["mean"]: common})
        turning: dict[str, Gain] = {shares["half"]: opposed}
        d.sum(shares["opposed"], turning if centring is None else turning | {shares["mean"]: centring})
    return d.sum(f"{w.name}.{name}", {shares["common"]: 1.0, shares["opposed"]: w.lead})


def profile_of(track: Track, key: str) -> tuple[list[float], list[float]]:
    """Corner points of the track's curvature or cant: arc lengths [m] and values."""
    ends = [getattr(segment, key) for segment in track.segments]
    places = [*track.starts, track.length]
    return [float(s) for s in places], [float(ends[0][0]), *(float(end[1]) for end in ends)]


def database_curvature(d: Diagram, name: str, track: Track, position: str) -> str:
    """Curvature [1/m] at a position along the track, from the track database."""
    return d.lookup(name, position, *profile_of(track, "curvature"))


def twist_of(track: Track) -> tuple[list[float], list[float]]:
    """Roll of the track per metre [rad/m] at arc lengths [m]; its steps at the ends of cant ramps are a metre long."""
    slopes = [(segment.cant[1] - segment.cant[0]) / segment.length / CANT_BASE for segment in track.segments]
    places, values = [0.0], slopes[:1]
    for start, slope in zip(track.starts, slopes, strict=True):
        if slope != values[-1]:
            places += [start - 0.5, start + 0.5]
            values += [values[-1], slope]
    return [*places, track.length], [*values, values[-1]]


def database_curve(d: Diagram, plant: Plant, w: Wheelset, track: Track, timing: Timing) -> tuple[str, str]:
    """Curvature [1/m] between a wheelset and its bogie's centre, and roll rate of the track [rad/s] at the wheelset.

    From the track database, looking ahead by what the actuators and the computation take.
    """
    preview = plant.actuator_lag + timing.computation_samples * timing.sample_time
    speed = d.measure(SPEED)
    terms: dict[str, float | str] = {d.measure(f"{w.name}.s"): 1.0, speed: preview}
    here = d.sum(f"{w.name}.ahead", terms)
    middle = d.sum(f"{w.name}.middle", {here: 1.0}, bias=-0.5 * w.lead * plant.geometry.half_wheelbase)
    twist = d.lookup(f"{w.name}.twist", here, *twist_of(track))
    return database_curvature(d, f"{w.name}.rho", track, middle), d.product(f"{w.name}.track_roll_rate", twist, speed)


def sense_curve(
    d: Diagram, plant: Plant, contact: ContactDesign, timing: Timing, *, frequency: float, slow_speed: float
) -> None:
    """Curvature [1/m] and its slope [1/(m s)] at both bogies, from their gyros and the errors `wd.error`.

    A gyro cannot tell the turning of the track from that of the bogie on it, and the second follows from the steering
    itself: a feedforward of the bare yaw rate is a loop with gain one. So the bogie's own turning is taken out:
    psi_b = (y1 - y2)/(2 a) with the displacements that the speed differences tell, y V gamma/r0^2 = wd - lambda r/r0.
    Below `slow_speed` [m/s] it is taken out by less and less, as the displacement is told worse and worse.
    Both pass low-passes, at `frequency` [Hz] the track's yaw rate and at four times that the bogie's own.
    """
    ts = timing.sample_time
    per_error = -(plant.radius**2) / (contact.conicity * 2.0 * plant.geometry.half_wheelbase)
    gain = scheduled(d, "bogie_yaw.gain", lambda v: per_error * min(1.0, v / slow_speed) / v)
    minus = d.sum("bogie_yaw.minus", {gain: -1.0})
    for bogie in ("bogie1", "bogie2"):
        first, second = (f"{bogie}.wheelset{i}.wd.error" for i in (1, 2))
        yaw = d.sum(f"{bogie}.psi", {first: gain, second: minus})
        own = d.filter(f"{bogie}.turning", yaw, [slope_low_pass(4.0 * frequency, sample_time=ts)])
        gyro = d.delay(f"{bogie}.gyro", d.measure(f"{bogie}.yaw_rate"), timing.sensor_samples)
        track = d.sum(f"{bogie}.track_rate", {gyro: 1.0, own: -1.0})
        for name, section in (("rho", low_pass), ("rho.slope", slope_low_pass)):
            rate = d.filter(f"{bogie}.{name}.rate", track, [section(frequency, sample_time=ts)])
            d.quotient(f"{bogie}.{name}", rate, d.measure(SPEED), floor=SPEED_GRID[0])


def sensed_curve(d: Diagram, plant: Plant, w: Wheelset, *, frequency: float, extrapolation: float) -> str:
    """Curvature [1/m] between a wheelset and its bogie's centre, after `sense_curve`.

    It is carried forward along the measured slope by `extrapolation` times what the filter and the actuators lag.
    """
    lag = extrapolation * (2.0 * BUTTERWORTH / (2.0 * math.pi * frequency) + plant.actuator_lag)
    ahead = 0.5 * w.lead * plant.geometry.half_wheelbase
    time = scheduled(d, f"{w.name}.rho.time", lambda v: lag + extrapolation * ahead / v)
    return d.sum(f"{w.name}.rho", {f"{w.bogie_name}.rho": 1.0, f"{w.bogie_name}.rho.slope": time})


def sensed_roll_rate(d: Diagram, w: Wheelset, timing: Timing, *, frequency: float) -> str:
    """Roll rate of the track [rad/s] from the gyro of the wheelset, which cannot but roll with the rails."""
    roll = d.delay(f"{w.name}.roll_rate.now", d.measure(f"{w.name}.roll_rate"), timing.sensor_samples)
    return d.filter(f"{w.name}.roll_rate.slow", roll, [low_pass(frequency, sample_time=timing.sample_time)])


def sense_inertia(d: Diagram, plant: Plant, timing: Timing, *, frequency: float) -> None:
    """Mean lateral force [N] of the wheelsets of each bogie and the yaw-damper moment [N m], by inertial sensors.

    Body and bogies weigh what they accelerate: m_b a/4 +- I_z r'/(4 L) from the body's accelerometer and gyro, and the
    bogie's own mass; c (r_bogie - r_body) from the gyros. The roll on the springs is taken out of the accelerations.
    """
    g, ts = plant.geometry, timing.sample_time

    def sense(name: str, channel: str, section: Section) -> str:
        return d.filter(name, d.delay(f"{name}.now", d.measure(channel), timing.sensor_samples), [section])

    low = low_pass(frequency, sample_time=ts)
    ay = sense("body.ay", "body.lateral_acceleration", low)
    turn = sense("body.turn", "body.yaw_rate", slope_low_pass(frequency, sample_time=ts))
    rate = sense("body.rate", "body.yaw_rate", low)
    weight = g.body_mass / 4.0 / (1.0 + g.sway.body)
    for bogie, front in (("bogie1", 1.0), ("bogie2", -1.0)):
        own = sense(f"{bogie}.ay", f"{bogie}.lateral_acceleration", low)
        leverage = front * g.body_yaw_inertia / (4.0 * g.half_bogie_spacing)
        d.sum(f"{bogie}.Y", {ay: weight, turn: leverage, own: g.bogie_mass / 2.0 / (1.0 + g.sway.bogie)})
        relative = sense(f"{bogie}.rate", f"{bogie}.yaw_rate", low)
        d.sum(f"{bogie}.M.damper", {relative: g.yaw_damping, rate: -g.yaw_damping})


def gyroscopic_moment(d: Diagram, plant: Plant, w: Wheelset, roll_rate: str) -> str:
    """The yaw moment [N m] that turns the spinning wheels with a track that rolls: -H p, H their angular momentum."""
    momentum = scheduled(d, f"{w.name}.momentum", lambda v: -plant.geometry.spin_momentum * v)
    return d.product(f"{w.name}.M.gyroscopic", momentum, roll_rate)


def steering_feedforward(
    d: Diagram, plant: Plant, contact: ContactDesign, w: Wheelset, *, rho: str, roll_rate: str, gyroscopic: str
) -> str:
    """M = kpsi [+-a rho + alpha_Y - psi_b - h p/V] - H p [N m] of a wheelset, after `sense_inertia`.

    On a cant ramp the bogie follows the axles, which at their height h run askew of the rails by h times the twist p/V.
    """
    g = plant.geometry
    bogie = w.bogie_name
    pair: dict[str, float | str] = {
        rho: g.lateral_share(w.bogie, w.number),
        f"{bogie}.M.damper": g.pair_share(w.number),
    }
    force = d.sum(f"{w.name}.Y", {f"{bogie}.Y": 1.0, **pair})
    alpha = d.lookup(f"{w.name}.alpha", force, *attack_angle_table(g, contact))
    radial = w.lead * g.half_wheelbase - g.bogie_yaw(w.bogie)
    askew = scheduled(d, f"{w.name}.askew", lambda v: -g.yaw_stiffness * g.primary_height / v)
    terms: dict[str, float | str] = {rho: g.yaw_stiffness * radial, alpha: g.yaw_stiffness}
    return d.sum(f"{w.name}.M.feedforward", {**terms, roll_rate: askew, gyroscopic: 1.0})


def command_steering(d: Diagram, plant: Plant, w: Wheelset, moment: str, timing: Timing) -> None:
    """Both actuators of a wheelset make a moment [N m]: F_left = -F_right = M/(2 b)."""
    limited = d.saturation(f"{w.name}.M.limited", moment, -plant.moment_max, plant.moment_max)
    sent = d.delay(f"{w.name}.M.sent", limited, timing.computation_samples)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        force = d.sum(f"{w.name}.F.{side}", {sent: sign / (2.0 * plant.actuators.half_spacing)})
        d.command(f"{w.name}.actuator_{side}.force", force)
    d.probe(f"{w.name}.steering_moment_command", "N m", sent)
