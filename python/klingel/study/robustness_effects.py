"""What each input of a study of robustness does to a scenario: one small function each, scenario in, scenario out.
Strategies stay designed for the nominal vehicle; wheel and rail, load and errors of sensors are unknown to them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from klingel.contact import CreepOptions
from klingel.control.sensor import KINDS
from klingel.errors import InputError
from klingel.scenario import Scenario, Strategy
from klingel.study.robustness_pairs import with_conicity
from klingel.track import Track
from klingel.vehicle import Vehicle
from klingel.vehicle.bodies import Inertia


@dataclass(frozen=True)
class DesignedFor:
    """A strategy that goes on steering the vehicle that it was designed for, whatever it sits in.

    Everything but its design is that of the strategy itself.
    """

    strategy: Strategy
    vehicle: Vehicle

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any] | None:
        """The controller for the vehicle of the design, not for the one that runs."""
        return self.strategy.lower(self.vehicle, track, speed)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "strategy":
            raise AttributeError(name)
        return getattr(self.strategy, name)


@dataclass(frozen=True)
class Effect:
    """An input of the study.

    unit: SI, of its values; title: in tables; shown, factor: the unit that people read, and how many of it make one of
    `unit`; nominal: value without effect, None where the scenario's own is meant; least, most: values that make sense;
    through: kinds of sensors that it acts through, none for what acts on the vehicle; change: the scenario with the
    input at a value.
    """

    title: str
    unit: str
    change: Callable[[Scenario, float], Scenario]
    nominal: float | None = 0.0
    least: float = -math.inf
    most: float = math.inf
    shown: str = ""
    factor: float = 1.0
    through: tuple[str, ...] = ()

    def check(self, key: str, value: float) -> None:
        """Errors: InputError for a value that makes no sense."""
        if not self.least <= value <= self.most:
            remedy = f"give {self.least:g} to {self.most:g} {'' if self.unit == '1' else self.unit}".rstrip()
            raise InputError.single(key, value, f"is out of range [{self.unit}]", remedy=remedy)

    def acts_on(self, scenario: Scenario) -> bool:
        """Whether the vehicle or, of the kinds of sensors, a measurement of its strategy is touched."""
        words = {word for kind in self.through for word in KINDS[kind].quantities}
        return not self.through or any(channel.rpartition(".")[2] in words for channel in measured(scenario))

    def text(self, value: float) -> str:
        """A value as people read it.

        >>> EFFECTS["payload"].text(8000.0), EFFECTS["friction"].text(0.35)
        ('8 t', '0.35')
        """
        return f"{value * self.factor:.4g} {self.shown}".rstrip()


def measured(scenario: Scenario) -> list[str]:
    """Channels that the strategy of a scenario measures.

    >>> from klingel import library
    >>> measured(Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed=30.0))
    []
    """
    if scenario.control is None:
        return []
    spec = scenario.control.lower(scenario.vehicle, scenario.database or scenario.track, scenario.speed)
    return [] if spec is None else list(spec["measurements"])


def friction(scenario: Scenario, value: float) -> Scenario:
    """One coefficient of friction for all contacts."""
    return scenario.replace(friction=value, adhesion=None)


def creep_reduction(scenario: Scenario, value: float) -> Scenario:
    """Creep forces with a share of Kalker's slope at small creepage, up to the same friction limit.

    Of the laws, `polach` takes it as kA = kS, `fastsim` as k0; runs with another law go on with `polach`, whose
    closed form costs no more.

    >>> from klingel import library
    >>> coach = Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed=30.0)
    >>> creep_reduction(coach, 0.6).creep_law, creep_reduction(coach, 0.6).creep_options.reduction
    ('polach', (0.6, 0.6))
    """
    falling = scenario.creep_options.falling
    if scenario.creep_law == "fastsim":
        options = CreepOptions(blended=scenario.creep_options.blended, slope=(value, 1.0, 1.0), falling=falling)
        return scenario.replace(creep_options=options)
    return scenario.replace(creep_law="polach", creep_options=CreepOptions(reduction=(value, value), falling=falling))


def payload(scenario: Scenario, value: float) -> Scenario:
    """A body heavier by that [kg], its inertia grown alike; springs carry it in the same height, as air springs do."""
    vehicle = scenario.vehicle
    body = vehicle.body
    share = (body.mass + value) / body.mass
    inertia = Inertia(**{axis: share * getattr(body.inertia, axis) for axis in ("roll", "pitch", "yaw")})
    heavier = body.model_copy(update={"mass": body.mass + value, "inertia": inertia})
    return believed(scenario).replace(vehicle=vehicle.replace(body=heavier))


def believed(scenario: Scenario) -> Scenario:
    """The scenario whose strategy is designed for its vehicle as it is now, whatever changes later."""
    control = scenario.control
    if control is None or isinstance(control, DesignedFor):
        return scenario
    return scenario.replace(control=DesignedFor(control, scenario.vehicle))


def radius_mismatch(scenario: Scenario, value: float) -> Scenario:
    """Right minus left radius of every wheelset."""
    return scenario.replace(radius_mismatch=value)


def curvature_error(scenario: Scenario, value: float) -> Scenario:
    """A database whose curvatures are all wrong by that share."""
    known = scenario.database or scenario.track
    return scenario.replace(database=known.mistaken(curvature_scale=1.0 + value))


def with_sensors(scenario: Scenario, kinds: tuple[str, ...], **errors: float) -> Scenario:
    """The scenario whose sensors of these kinds have these errors in place of their own."""
    made: dict[str, Any] = {}
    for kind in kinds:
        sensor = getattr(scenario.sensors, kind) or KINDS[kind]()
        made[kind] = dataclasses.replace(sensor, **errors)
    return scenario.replace(sensors=dataclasses.replace(scenario.sensors, **made))


def delay(scenario: Scenario, value: float) -> Scenario:
    """Measurements that steer later by that [s], in whole samples of the controller; none for less than half of one."""
    timing = getattr(scenario.control, "timing", None)
    sample_time = timing.sample_time if timing is not None else scenario.step
    late = round(value / sample_time) * sample_time
    for kind in STEER:
        sensor = getattr(scenario.sensors, kind) or KINDS[kind]()
        scenario = with_sensors(scenario, (kind,), delay=sensor.delay + late)
    return scenario


STEER = tuple(kind for kind in KINDS if kind != "current")
"""Kinds of sensors that steering goes by; currents are measured inside the drives, where nothing waits for a bus."""


def sensed(title: str, unit: str, kind: str, error: str, **others: Any) -> Effect:
    """An effect on one error of one kind of sensors; others: as `Effect`."""
    return Effect(title, unit, lambda s, value: with_sensors(s, (kind,), **{error: value}), through=(kind,), **others)


EFFECTS: Mapping[str, Effect] = {
    "conicity": Effect("conicity", "1", with_conicity, nominal=None, least=0.01, most=0.8),
    "friction": Effect("friction", "1", friction, nominal=None, least=0.01, most=1.5),
    "creep_reduction": Effect("share of Kalker's slope", "1", creep_reduction, nominal=1.0, least=0.05, most=1.0),
    "payload": Effect("payload", "kg", payload, least=0.0, most=30e3, shown="t", factor=1e-3),
    "radius_mismatch": Effect("radius mismatch", "m", radius_mismatch, least=-5e-3, most=5e-3, shown="mm", factor=1e3),
    "curvature_error": Effect(
        "curvature error", "1", curvature_error, least=-0.5, most=0.5, shown="%", factor=100.0, through=("position",)
    ),
    "position_error": sensed("position error", "m", "position", "bias", least=-500.0, most=500.0, shown="m"),
    "delay": Effect("delay", "s", delay, least=0.0, most=1.0, shown="ms", factor=1e3, through=STEER),
    "encoder_noise": sensed("encoder noise", "rad/s", "encoder", "noise", least=0.0, most=1.0, shown="rad/s"),
    "gyro_noise": sensed("gyro noise", "rad/s", "gyro", "noise", least=0.0, most=1.0, shown="mrad/s", factor=1e3),
    "gyro_bias": sensed("gyro bias", "rad/s", "gyro", "bias", least=-0.5, most=0.5, shown="mrad/s", factor=1e3),
    "load_cell_bias": sensed("load cell bias", "N m", "load_cell", "bias", least=-1e5, most=1e5, shown="N m"),
}
"""Every input of the study, in the order of its tables."""


def changed(scenario: Scenario, values: Mapping[str, float], *, seed: int | None = None) -> Scenario:
    """The scenario with inputs at their values; its strategy stays designed for its vehicle as it was.

    seed: of the sensors' noise, None for their own.

    >>> from klingel import control, library
    >>> vehicle, track = library.vehicle("mechatronic_irw"), Track.straight("500 m")
    >>> active = Scenario(vehicle, track, speed=30.0, control=control.IRWLike())
    >>> heavy = changed(active, {"payload": 8e3, "friction": 0.2, "gyro_noise": 1e-3})
    >>> heavy.vehicle.body.mass, heavy.control.vehicle.body.mass, heavy.friction, heavy.sensors.gyro.noise
    (40000.0, 32000.0, 0.2, 0.001)
    """
    made = believed(scenario)
    for name, effect in EFFECTS.items():
        if name in values:
            made = effect.change(made, values[name])
    return made if seed is None else made.replace(sensors=dataclasses.replace(made.sensors, seed=seed))
