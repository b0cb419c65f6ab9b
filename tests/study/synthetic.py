"""Synthetic runs with known answers: a dataset like the simulator's, made of constants, steps and sines.
One quantity at a time is given a shape; the rest stays at its quiet value."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

WHEELSETS = ("bogie1.wheelset1", "bogie1.wheelset2", "bogie2.wheelset1", "bogie2.wheelset2")
OFFSETS = (10.78, 8.22, -8.22, -10.78)
SIDES = ("left", "right")
MASS = 44482.0
GRAVITY = 9.81
CANT = 0.16
UNITS = {
    "s": "m", "y": "m", "z": "m", "roll": "rad", "pitch": "rad", "yaw": "rad", "speed": "m/s",
    "lateral_acceleration": "m/s2", "yaw_rate": "rad/s", "curvature": "1/m", "cant": "m", "yaw_moment": "N m",
    "Q": "N", "Y": "N", "X": "N", "spin_speed": "rad/s", "tgamma": "N", "spin_work": "N", "contact_angle": "rad",
    "steep_force": "N", "armature_current": "A", "armature_voltage": "V", "shaft_torque": "N m", "force": "N",
    "stroke": "m", "steering_voltage": "V", "steering_moment_command": "N m",
}  # fmt: skip

Shape = Callable[[np.ndarray], np.ndarray] | float


def spec(
    radius: float = 300.0, speed: float = 30.0, *, hand: float = 1.0, friction: float = 0.35, active: bool = False
) -> dict[str, object]:
    """The parts of a spec that the assessment reads: 3 s straight, 4 s transition, 6 s arc, 4 s, 6 s straight."""
    rho, cant = hand / radius, hand * CANT
    ramps = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]
    segments = [
        {"length": seconds * speed, "curvature": [a * rho, b * rho], "cant": [a * cant, b * cant]}
        for seconds, (a, b) in zip((3.0, 4.0, 6.0, 4.0, 6.0), ramps, strict=True)
    ]
    wheels = [
        {"name": f"{name}.{side}", "body": name, "side": side, "friction": friction}
        for name in WHEELSETS
        for side in SIDES
    ]
    return {
        "name": "irw" if active else "coach",
        "gravity": GRAVITY,
        "speed": speed,
        "track": {"segments": segments, "cant_base": 1.5, "start": 0.0},
        "bodies": [{"name": "body", "mass": MASS - 4000.0}, *({"name": name, "mass": 1000.0} for name in WHEELSETS)],
        "wheels": wheels,
    }


def run(
    channels: Mapping[str, Shape] | None = None,
    *,
    radius: float = 300.0,
    speed: float = 30.0,
    hand: float = 1.0,
    friction: float = 0.35,
    active: bool = False,
    duration: float = 22.0,
    interval: float = 1e-3,
    outcome: str = "completed",
) -> xr.Dataset:
    """A quiet run at constant speed with some channels replaced.

    Args:
        channels: dotted name to a constant or to a function of the time the body's reference is at [s].
    """
    time = np.arange(0.0, duration, interval)
    quiet: dict[str, Shape] = {"body.s": lambda t: speed * t, "body.speed": speed, "body.y": 0.0, "body.roll": 0.0}
    quiet["body.lateral_acceleration"] = 0.0
    for name, offset in zip(WHEELSETS, OFFSETS, strict=True):
        quiet |= {f"{name}.s": lambda t, d=offset: speed * t + d, f"{name}.y": 0.0, f"{name}.yaw": 0.0}
        for side in SIDES:
            wheel = f"{name}.{side}"
            quiet |= {f"{wheel}.Q": 54.5e3, f"{wheel}.Y": 0.0, f"{wheel}.tgamma": 0.0, f"{wheel}.spin_work": 0.0}
            quiet |= {f"{wheel}.contact_angle": 0.03, f"{wheel}.steep_force": 0.0}
            if active:
                quiet |= {f"{wheel}.armature_current": 0.0, f"{wheel}.armature_voltage": 0.0}
                quiet |= {f"{name}.actuator_{side}.force": 0.0}
        if active:
            quiet |= {f"{name}.steering_voltage": 0.0}
    shapes = quiet | dict(channels or {})
    data = {
        name: ("time", shape(time) if callable(shape) else np.full_like(time, shape), {"units": _unit(name)})
        for name, shape in shapes.items()
    }
    attrs = {
        "spec": json.dumps(spec(radius, speed, hand=hand, friction=friction, active=active)),
        "format": "klingel-result-1",
        "outcome": outcome,
        "realtime_factor": 12.5,
        "static_wheel_loads": json.dumps({f"{name}.{side}": 54.5e3 for name in WHEELSETS for side in SIDES}),
    }
    return xr.Dataset(data, {"time": ("time", time, {"units": "s"})}, attrs)


def _unit(channel: str) -> str:
    return UNITS[channel.rsplit(".", 1)[1]]
