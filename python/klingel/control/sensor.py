"""One sensor: its errors, and the blocks that they are; the kinds of sensors and the channels that they measure.
All draws come from a seed and the name of a channel alone, so they do not depend on what else is measured."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import NormalDist
from typing import ClassVar, Self

from klingel.control.diagram import Diagram
from klingel.errors import InputError, Problem
from klingel.units import Quantity, to_si

LONGEST = 10.0
"""Longest delay and hold of a sensor [s]: each sample of a delay is a number in memory."""


@dataclass(frozen=True, init=False)
class Sensor:
    """Errors of all sensors of one kind; strings carry units, plain numbers are SI.

    A sensor reads (1 + scale) x + bias + noise, holds it for `hold`, rounds it to `resolution`, tells it `delay` later.

    bias, scale: of all sensors of the kind alike; bias_spread, scale_spread: standard deviations of what each has in
    addition, always the same for one seed; noise: standard deviation of white noise at the controller's sample time;
    resolution: step of the numbers; delay, hold: [s], rounded to whole samples of the controller; 0 for none, 10 s at
    most.
    Errors: InputError with every problem.

    >>> Encoder(noise="0.02 rad/s", delay="30 ms").delay
    0.03
    """

    bias: float
    scale: float
    bias_spread: float
    scale_spread: float
    noise: float
    resolution: float
    delay: float
    hold: float

    unit: ClassVar[str] = "1"
    quantities: ClassVar[tuple[str, ...]] = ()
    """Last words of the channels that the kind measures."""
    shared: ClassVar[bool] = False
    """Whether all its channels come from one device, with one error."""

    def __init__(
        self,
        *,
        bias: Quantity = 0.0,
        scale: Quantity = 0.0,
        bias_spread: Quantity = 0.0,
        scale_spread: Quantity = 0.0,
        noise: Quantity = 0.0,
        resolution: Quantity = 0.0,
        delay: Quantity = 0.0,
        hold: Quantity = 0.0,
    ) -> None:
        given = {
            "bias": bias,
            "scale": scale,
            "bias_spread": bias_spread,
            "scale_spread": scale_spread,
            "noise": noise,
            "resolution": resolution,
            "delay": delay,
            "hold": hold,
        }
        problems: list[Problem] = []
        for name, value in given.items():
            try:
                number = to_si(value, self.unit_of(name), key=name)
            except InputError as error:
                problems += error.problems
                continue
            if number < 0.0 and name not in ("bias", "scale"):
                problems.append(Problem(name, value, "must not be negative", "give 0 or more"))
            if name == "scale" and not number > -1.0:
                message = "makes a sensor that reads nothing, or the opposite"
                problems.append(Problem(name, value, message, "give more than -1; a bad sign is the controller's"))
            if name in ("delay", "hold") and not number <= LONGEST:
                problems.append(Problem(name, value, "is too long for a sensor [s]", f"give {LONGEST:g} s at most"))
            object.__setattr__(self, name, number)
        if problems:
            raise InputError(problems)

    @classmethod
    def unit_of(cls, name: str) -> str:
        """SI unit of one of the parameters."""
        return {"scale": "1", "scale_spread": "1", "delay": "s", "hold": "s"}.get(name, cls.unit)

    def errors_of(self, channel: str, seed: int) -> tuple[float, float]:
        """Gain and bias of the sensor of a channel: what is alike, and its own part of the spread."""
        draw = [normal_of(seed, f"{channel}.{what}") for what in ("scale", "bias")]
        return 1.0 + self.scale + self.scale_spread * draw[0], self.bias + self.bias_spread * draw[1]

    def samples(self, name: str, sample_time: float) -> int:
        """`delay` or `hold` in whole samples, 0 for none."""
        time: float = getattr(self, name)
        return round(time / sample_time)

    def timing_problems(self, sample_time: float) -> Iterator[Problem]:
        """Why it does not fit the sample time [s] of a controller."""
        for name in ("delay", "hold"):
            if 0.0 < getattr(self, name) < sample_time * (1.0 - 1e-9):
                remedy = f"give 0, or {sample_time:g} s and more"
                yield Problem(name, getattr(self, name), "is less than a sample of the controller [s]", remedy)

    def put(self, d: Diagram, channel: str, seed: int) -> str:
        """Adds the blocks of the sensor of a channel; the signal that it gives, the channel itself without error."""
        source = type(self).__name__ if self.shared else channel
        signal = channel
        gain, bias = self.errors_of(source, seed)
        held, late = (self.samples(name, d.sample_time) for name in ("hold", "delay"))
        if self.noise > 0.0 or (gain, bias) != (1.0, 0.0):
            terms: dict[str, float | str] = {channel: gain}
            if self.noise > 0.0:
                terms[d.noise(f"sensor.noise.{channel}", self.noise, whole_of(seed, source))] = 1.0
            signal = d.sum(f"sensor.erring.{channel}", terms, bias=bias)
        if held > 1:
            signal = d.hold(f"sensor.held.{channel}", signal, held)
        if self.resolution > 0.0:
            signal = d.quantise(f"sensor.rounded.{channel}", signal, self.resolution)
        return d.delay(f"sensor.late.{channel}", signal, late)


class Encoder(Sensor):
    """Speeds of rotation of wheels and motors [rad/s]."""

    unit = "rad/s"
    quantities = ("spin_speed", "motor_speed")

    @classmethod
    def counting(cls, *, pulses: int, window: Quantity) -> Self:
        """An encoder that counts pulses (edges a turn) over a window [s]: a new speed each window, the mean over it.

        >>> round(Encoder.counting(pulses=4096, window="10 ms").resolution, 4)
        0.1534
        """
        time = to_si(window, "s", key="window")
        problems = [
            Problem(name, value, "must be positive", "give more than zero")
            for name, value in (("pulses", pulses), ("window", time))
            if not value > 0
        ]
        if problems:
            raise InputError(problems)
        return cls(resolution=2.0 * math.pi / (pulses * time), hold=time, delay=0.5 * time)

    def timing_problems(self, sample_time: float) -> Iterator[Problem]:
        """As of any sensor; of one that counts, whose hold and delay are the window and half of it, by the window."""
        if self.hold > 0.0 and self.delay == 0.5 * self.hold:
            if self.hold < 2.0 * sample_time * (1.0 - 1e-9):
                remedy = f"count over {2.0 * sample_time:g} s or more: the mean over a window is half of it late"
                yield Problem("window", self.hold, "is less than two samples of the controller [s]", remedy)
        else:
            yield from super().timing_problems(sample_time)


class Gyro(Sensor):
    """Rates of turn of body, bogies and wheelsets [rad/s]."""

    unit = "rad/s"
    quantities = ("roll_rate", "yaw_rate")


class Accelerometer(Sensor):
    """Accelerations across and down as the floor feels them [m/s2]."""

    unit = "m/s^2"
    quantities = ("lateral_acceleration", "vertical_acceleration")


class LoadCell(Sensor):
    """Yaw moment on a wheelset over all its paths, springs, dampers and actuators [N m]."""

    unit = "N m"
    quantities = ("yaw_moment",)


class CurrentSensor(Sensor):
    """Currents of the motors [A]."""

    unit = "A"
    quantities = ("armature_current", "field_current", "current_d", "current_q")


class StrokeSensor(Sensor):
    """Strokes of the steering actuators [m]."""

    unit = "m"
    quantities = ("stroke",)


class Position(Sensor):
    """Position along the track [m]: one device, whose error all positions of the vehicle share.

    bias: of the last fix; scale: of the way measured from the start of the track.
    """

    unit = "m"
    quantities = ("s",)
    shared = True


class Speedometer(Sensor):
    """Running speed [m/s]: one device for the vehicle."""

    unit = "m/s"
    quantities = ("speed",)
    shared = True


KINDS: dict[str, type[Sensor]] = {
    "encoder": Encoder,
    "gyro": Gyro,
    "accelerometer": Accelerometer,
    "load_cell": LoadCell,
    "current": CurrentSensor,
    "stroke": StrokeSensor,
    "position": Position,
    "speed": Speedometer,
}
"""Names of the kinds in `Sensors`, and in files."""


def whole_of(seed: int, key: str) -> int:
    """A whole number below 2^53 from a seed and a name, the same on every machine."""
    digest = hashlib.sha256(f"{seed}:{key}".encode()).digest()
    return int.from_bytes(digest[:8], "big") >> 11


def normal_of(seed: int, key: str) -> float:
    """A draw of the standard normal distribution from a seed and a name."""
    return NormalDist().inv_cdf((whole_of(seed, key) + 0.5) / 2.0**53)
