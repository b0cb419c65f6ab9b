"""Sensors and their errors: what stands between a channel of the vehicle and whoever measures it.
They are blocks put in front of any strategy's diagram, which does not know about them; None is ideal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Self

from klingel.control.diagram import Diagram
from klingel.control.sensor import (
    KINDS,
    Accelerometer,
    CurrentSensor,
    Encoder,
    Gyro,
    LoadCell,
    Position,
    Sensor,
    Speedometer,
    StrokeSensor,
)
from klingel.errors import InputError, Problem

Spec = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Sensors:
    """The sensors of a vehicle; a kind that is None is ideal. Errors: InputError with every problem.

    seed: of all noise and spread; every channel has its own stream, whatever else is measured. record: whether the
    results have what each sensor tells, as channels `<channel>.measured`.

    >>> late = Sensors(encoder=Encoder(noise="0.02 rad/s"), seed=3)
    >>> late.of("bogie1.wheelset1.left.spin_speed").noise
    0.02
    """

    encoder: Encoder | None = None
    gyro: Gyro | None = None
    accelerometer: Accelerometer | None = None
    load_cell: LoadCell | None = None
    current: CurrentSensor | None = None
    stroke: StrokeSensor | None = None
    position: Position | None = None
    speed: Speedometer | None = None
    seed: int = 0
    record: bool = False

    def __post_init__(self) -> None:
        problems = [
            Problem(name, given, "is no such sensor", f"give klingel.control.{kind.__name__}, or None")
            for name, kind in KINDS.items()
            if not isinstance(given := getattr(self, name), kind | None)
        ]
        if type(self.seed) is not int or not 0 <= self.seed < 2**63:
            problems.append(Problem("seed", self.seed, "is no seed", "give a whole number, 0 or more"))
        if type(self.record) is not bool:
            problems.append(Problem("record", self.record, "is no yes or no", "give True or False"))
        if problems:
            raise InputError(problems)

    @classmethod
    def typical(cls, seed: int = 0) -> Self:
        """Sensors as vehicles have them, calibrated; for controllers sampled at 1 ms. The numbers, their sources and
        their status are in docs/theory/sensors.md.
        """
        degree = math.pi / 180.0
        return cls(
            encoder=Encoder(noise=0.02, resolution=0.005),
            gyro=Gyro(bias_spread=0.02 * degree, scale_spread=2e-3, noise=0.16 * degree, resolution=0.01 * degree),
            accelerometer=Accelerometer(bias_spread=0.03, scale_spread=3e-3, noise=0.02, resolution=1e-3),
            load_cell=LoadCell(bias_spread=50.0, scale_spread=0.01, noise=20.0, resolution=5.0),
            current=CurrentSensor(bias_spread=0.5, scale_spread=5e-3, noise=0.3, resolution=0.1),
            stroke=StrokeSensor(bias_spread=1e-4, scale_spread=2e-3, noise=2e-5, resolution=1e-5),
            position=Position(bias_spread=3.0, scale_spread=2e-3, resolution=0.1, hold=0.02),
            speed=Speedometer(scale_spread=5e-3, noise=0.02, resolution=0.01, hold=0.02),
            seed=seed,
        )

    def kinds(self) -> Iterator[tuple[str, Sensor]]:
        """The kinds that are not ideal, with their names."""
        for name in KINDS:
            if (sensor := getattr(self, name)) is not None:
                yield name, sensor

    def of(self, channel: str) -> Sensor | None:
        """The sensor of a channel, by its last word; None where it is ideal."""
        word = channel.rpartition(".")[2]
        return next((sensor for _, sensor in self.kinds() if word in sensor.quantities), None)

    def applied(self, control: Spec) -> Spec:
        """A control spec whose blocks, commands and probes read the sensors in place of the channels.

        Errors: InputError for delays and holds of less than a sample time of the controller.
        """
        if problems := list(self._timing_problems(control["sample_time"])):
            raise InputError(problems)
        d = Diagram(sample_time=control["sample_time"])
        told = {
            channel: sensor.put(d, channel, self.seed)
            for channel in control["measurements"]
            if (sensor := self.of(channel)) is not None
        }
        told = {channel: signal for channel, signal in told.items() if signal != channel}
        if self.record:
            for channel, signal in told.items():
                sensor = self.of(channel)
                assert sensor is not None
                d.probe(f"{channel}.measured", sensor.unit.replace("^", ""), signal)
        chains = d.spec()
        return control | {
            "blocks": chains["blocks"] + [_reading(block, told) for block in control["blocks"]],
            "commands": [_reading(command, told) for command in control["commands"]],
            "probes": [_reading(probe, told) for probe in control.get("probes", ())] + chains["probes"],
        }

    def believed(self, s: float) -> float:
        """Where the vehicle believes to be on its track [m] when it is at `s` [m], without noise.

        >>> Sensors(position=Position(bias="-30 m")).believed(500.0)
        470.0
        """
        if self.position is None:
            return s
        gain, bias = self.position.errors_of(Position.__name__, self.seed)
        return gain * s + bias

    def notes(self, control: Spec | None) -> Iterator[str]:
        """What a reader of results should know: channels measured without error, as no kind of sensor covers them."""
        if control is None or not any(True for _ in self.kinds()):
            return
        covered = {word for kind in KINDS.values() for word in kind.quantities}
        ideal = [channel for channel in control["measurements"] if channel.rpartition(".")[2] not in covered]
        if ideal:
            yield f"sensors: {', '.join(ideal)} measured without error, as no kind of sensor covers it"

    def _timing_problems(self, sample_time: float) -> Iterator[Problem]:
        for name, sensor in self.kinds():
            yield from InputError(sensor.timing_problems(sample_time)).within(f"sensors.{name}").problems


def _reading(item: Any, told: Mapping[str, str]) -> Any:
    """The same block, command or probe with the signals of sensors for channels; kinds and own names stay."""
    if isinstance(item, str):
        return told.get(item, item)
    if isinstance(item, list):
        return [_reading(each, told) for each in item]
    if isinstance(item, dict):
        kept = ("kind", "name", "target", "channel", "unit", "outputs", "edge", "interpolation")
        return {key: value if key in kept else _reading(value, told) for key, value in item.items()}
    return item
