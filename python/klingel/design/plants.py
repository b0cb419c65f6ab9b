"""Loops of a strategy on the plants of the formulas: Eqs (27) and (29) of a wheel pair, a steered axle on its springs.
The controller is the block diagram that runs; the plant is sampled exactly behind its hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike, NDArray
from scipy.signal import cont2discrete

from klingel.control import ContactDesign
from klingel.control.basics import SPEED
from klingel.control.common import Plant
from klingel.control.response import controller_response
from klingel.drives import DriveTransfer, InductionTransfer, Rational, WheelPair, operating_point
from klingel.errors import InputError
from klingel.scenario import Scenario
from klingel.vehicle import InductionDrive, Vehicle

Complex = NDArray[np.complex128]
Response = Callable[[ArrayLike], Complex]

FIRST = "bogie1.wheelset1"
"""The wheelset whose blocks are read; all have the same."""

S = Polynomial([0.0, 1.0])


def motor_plants(vehicle: Vehicle, speed: float, contact: ContactDesign) -> dict[str, Rational]:
    """Half differences of what the motors of a pair show, over that of their commands: wheel speeds by Eq. (29), shaft
    torques by Eq. (27), armature currents of DC motors.

    speed: [m/s]; contact: whose longitudinal creep coefficient holds the wheels. Errors: InputError without drives.

    >>> from klingel import library
    >>> sorted(motor_plants(library.vehicle("mechatronic_irw"), 30.0, ContactDesign()))
    ['armature_current', 'shaft_torque', 'spin_speed']
    """
    drive = vehicle.drive
    if drive is None or vehicle.axle_bridge is None:
        remedy = f"{vehicle.name} has no motors; take a vehicle with [drive]"
        raise InputError.single("drive", None, "is missing", remedy=remedy)
    spin = vehicle.axle_bridge.wheel.inertia.spin
    pair = WheelPair(spin, vehicle.geometry.wheel_radius, speed, contact.longitudinal_creep)
    if isinstance(drive, InductionDrive):
        induction = InductionTransfer.of(drive)
        return {"spin_speed": induction.speed_plant(pair), "shaft_torque": induction.torque_plant(pair)}
    transfer = DriveTransfer.of(drive, field_current=operating_point(vehicle, speed).field_current)
    return {
        "spin_speed": transfer.speed_plant(pair),
        "shaft_torque": transfer.torque_plant(pair),
        "armature_current": transfer.current_plant(pair),
    }


def steering_plants(vehicle: Vehicle, speed: float, contact: ContactDesign) -> dict[str, Rational]:
    """What an axle shows over the force F_left = -F_right of its actuators, its bogie at rest.

    yaw_moment: the actuators' own, as for an axle that the contact holds. yaw_rate psi' and spin_speed wd: of an axle
    on its primary springs that rolls freely, Iz psi'' + c psi' + kpsi psi = M, y' = V psi and
    wd = lambda psi'/r0 + V gamma y/r0^2. Errors: InputError without actuators.

    >>> from klingel import library
    >>> plants = steering_plants(library.vehicle("mechatronic_irw"), 30.0, ContactDesign())
    >>> round(plants["yaw_moment"](0j).real, 3)  # 2 b [m]
    2.0
    """
    plant = Plant.of(vehicle)
    geometry, steering, primary = plant.geometry, plant.actuators, vehicle.primary
    assert vehicle.axle_bridge is not None
    w = 2.0 * np.pi * steering.bandwidth
    lag = 1.0 + 2.0 * steering.damping_ratio / w * S + (S / w) ** 2
    moment = Polynomial([2.0 * steering.half_spacing])
    damping = 2.0 * primary.damping.x * primary.half_spacing**2
    axle = vehicle.axle_bridge.total_inertia[2] * S**2 + damping * S + geometry.yaw_stiffness
    rolls = speed * contact.conicity / plant.radius**2
    return {
        "yaw_moment": Rational(moment, lag),
        "yaw_rate": Rational(moment * S, lag * axle),
        "spin_speed": Rational(moment * (plant.speed_ratio * S**2 + rolls * speed), lag * axle * S),
    }


def plant_loop(scenario: Scenario, kind: Literal["steering", "motors"]) -> Response:
    """L of a wheelset's steering or motors on the plants, at frequencies [Hz], for a scenario's strategy and speed.

    The diagram's own delays, the sample of output and the hold are included; the rest of the vehicle is at rest.
    Errors: InputError as `motor_plants` and `steering_plants`, and for a strategy that does not close such a loop.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed="176 km/h", control=kl.control.IRWLike())
    >>> bool(abs(plant_loop(scenario, "motors")([4.0])[0]) > 1.0)
    True
    """
    strategy, vehicle, speed = scenario.control, scenario.vehicle, scenario.speed
    spec = None if strategy is None else strategy.lower(vehicle, scenario.track, speed)
    if spec is None:
        raise InputError.single("control", None, "closes no loop", remedy="give a strategy that drives or steers")
    contact = getattr(strategy, "contact", ContactDesign())
    if kind == "motors":
        plants = motor_plants(vehicle, speed, contact)
        targets = [f"{FIRST}.left.{name}" for name in ("armature_voltage", "torque_command")]
    else:
        plants = steering_plants(vehicle, speed, contact)
        targets = [f"{FIRST}.actuator_left.force"]
    target = next((name for name in targets if name in {c["target"] for c in spec["commands"]}), None)
    if target is None:
        remedy = f"{type(strategy).__name__} commands none of {', '.join(targets)}"
        raise InputError.single("kind", kind, "is no loop of this strategy", remedy=remedy)
    spec = leading_to(spec, (target, target.replace("left", "right")))
    T, measured = spec["sample_time"], spec["measurements"]
    sampled = {name: _held(plant, T) for name, plant in plants.items()}

    def response(frequencies: ArrayLike) -> Complex:
        omega = 2.0 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
        z = np.exp(1j * omega * T)
        commands = controller_response(spec, {SPEED: speed}, omega)
        u = 0.5 * (commands[:, 0] - commands[:, 1])
        L = np.zeros(len(z), dtype=np.complex128)
        for name, (numerator, denominator) in sampled.items():
            P = np.polyval(numerator, z) / np.polyval(denominator, z)
            for channel, weight in _shown(name):
                if channel in measured:
                    L -= weight * u[:, measured.index(channel)] * P / z
        return L

    return response


def leading_to(spec: Mapping[str, Any], targets: Sequence[str]) -> dict[str, Any]:
    """The part of a block diagram that makes some of its commands, in their order."""
    commands = [next(c for c in spec["commands"] if c["target"] == target) for target in targets]
    needed = {command["signal"] for command in commands}
    blocks = []
    for block in reversed(spec["blocks"]):
        if block["name"] in needed or needed & set(block.get("outputs", ())):
            blocks.append(block)
            needed |= set(_words({key: value for key, value in block.items() if key not in ("kind", "name")}))
    measured = [name for name in spec["measurements"] if name in needed]
    return {**spec, "measurements": measured, "blocks": blocks[::-1], "commands": commands, "probes": []}


def _words(value: object) -> Iterator[str]:
    """Every string inside a value: names of signals, in a block."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for each in value.values():
            yield from _words(each)
    elif isinstance(value, (list, tuple)):
        for each in value:
            yield from _words(each)


def _held(plant: Rational, sample_time: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Numerator and denominator in z of a plant behind a hold."""
    numerator, denominator, _ = cont2discrete(plant.coefficients(), sample_time, method="zoh")
    return np.ravel(numerator), np.ravel(denominator)


def _shown(name: str) -> list[tuple[str, float]]:
    """Channels in which a plant's output shows, and their weights."""
    if name in ("yaw_moment", "yaw_rate"):
        return [(f"{FIRST}.{name}", 1.0)]
    return [(f"{FIRST}.left.{name}", 1.0), (f"{FIRST}.right.{name}", -1.0)]
