"""What strategies that steer share: the database's feedforward of the moment, deflections of the actuators, commands.
Positive moments turn a wheelset, or a bogie, to the right."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from klingel.control.basics import SPEED, WHEELSETS, Timing, Wheelset, scheduled
from klingel.control.common import (
    Plant,
    command_steering,
    database_curvature,
    database_curve,
    gyroscopic_moment,
    profile_of,
    steering_feedforward,
)
from klingel.control.diagram import Diagram, Gain
from klingel.control.driven import motors_of
from klingel.control.feedforward import GRAVITY, ContactDesign
from klingel.control.motors import command_motors
from klingel.control.traction import Traction
from klingel.track import CANT_BASE

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Actuator, Vehicle


class Forward(NamedTuple):
    """Signals of one wheelset [N m]: the whole feedforward, and the part of it that turns the spinning wheels."""

    moment: str
    gyroscopic: str


def database_feedforward(
    d: Diagram, plant: Plant, contact: ContactDesign, w: Wheelset, track: Track, timing: Timing
) -> Forward:
    """M = kpsi [+-a rho + alpha_Y - psi_b - h p/V] - H p at the place the database knows.

    The lateral force of each bogie, `bogie1.Y` and `bogie1.M.damper`, must be known before.
    """
    rho, roll_rate = database_curve(d, plant, w, track, timing)
    gyroscopic = gyroscopic_moment(d, plant, w, roll_rate)
    moment = steering_feedforward(d, plant, contact, w, rho=rho, roll_rate=roll_rate, gyroscopic=gyroscopic)
    return Forward(moment, gyroscopic)


def expect_inertia(d: Diagram, plant: Plant, track: Track) -> None:
    """Mean lateral force [N] of the wheelsets of each bogie from the database: m/4 (V^2 rho - g u/b), u the cant.

    What `sense_inertia` measures, without sensors: quasi-static, and no yaw dampers.
    """
    quarter = plant.geometry.mass / 4.0
    speed = d.measure(SPEED)
    square = d.product("speed.square", speed, speed)
    for bogie in ("bogie1", "bogie2"):
        here = d.measure(f"{bogie}.s")
        turning = d.product(f"{bogie}.centripetal", database_curvature(d, f"{bogie}.rho", track, here), square)
        cant = d.lookup(f"{bogie}.cant_known", here, *profile_of(track, "cant"))
        d.sum(f"{bogie}.Y", {turning: quarter, cant: -quarter * GRAVITY / CANT_BASE})
        d.sum(f"{bogie}.M.damper", {})


def steer(d: Diagram, plant: Plant, w: Wheelset, moments: Mapping[str, Gain], timing: Timing) -> None:
    """The actuators of a wheelset make the sum of moments [N m]."""
    command_steering(d, plant, w, d.sum(f"{w.name}.M", moments), timing)


def steer_to_no_moment(
    d: Diagram,
    plant: Plant,
    contact: ContactDesign,
    w: Wheelset,
    track: Track,
    timing: Timing,
    *,
    frequency: float,
    slow_speed: float,
    share: float,
) -> None:
    """M = feedforward + integral of 2 pi f (-H p - M_total): the total yaw moment on a wheelset to what its spin needs.

    M_total is that of springs, dampers and actuators together. frequency: f [Hz], below `slow_speed` [m/s] in
    proportion to the speed; share: of the largest moment of the actuators that the integral may add.
    """
    forward = database_feedforward(d, plant, contact, w, track, timing)
    total = d.delay(f"{w.name}.M.total", d.measure(f"{w.name}.yaw_moment"), timing.sensor_samples)
    error = d.sum(f"{w.name}.M.error", {forward.gyroscopic: 1.0, total: -1.0})
    crossover = scheduled(d, "yaw_loop.crossover", lambda v: 2.0 * math.pi * frequency * min(1.0, v / slow_speed))
    limit = share * plant.moment_max
    feedback = d.pi(f"{w.name}.M.feedback", error, proportional=0.0, integral=crossover, limit=limit)
    d.probe(f"{w.name}.steering_feedback", "N m", feedback)
    steer(d, plant, w, {forward.moment: 1.0, feedback: 1.0}, timing)


def relative_yaw(d: Diagram, name: str, actuator: Actuator, timing: Timing) -> str:
    """Yaw [rad] of what a pair of actuators pushes against what it stands on, from their strokes.

    name: of the pair without its side, `bogie1.wheelset1.actuator` or `bogie1.yaw_actuator`.
    """
    share = 1.0 / (2.0 * actuator.half_spacing)
    strokes = {d.measure(f"{name}_left.stroke"): share, d.measure(f"{name}_right.stroke"): -share}
    return d.delay(f"{name}.yaw", d.sum(f"{name}.yaw.now", strokes), timing.sensor_samples)


def hold_equal_torques(
    d: Diagram, vehicle: Vehicle, traction: Traction | None, timing: Timing, *, speed: float, frequency: float
) -> None:
    """The motors of every pair give equal torques, so that the wheels roll as freely as trailed ones; nothing to do
    for a vehicle without motors. frequency: crossover of the current loop of DC motors [Hz]."""
    if vehicle.drive is None:
        return
    motors = motors_of(vehicle, traction, timing, speed)
    for w in WHEELSETS:
        command_motors(d, motors, w.name, motors.equal_torques(d, w.name, frequency=frequency))
