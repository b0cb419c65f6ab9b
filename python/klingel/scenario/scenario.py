"""The Scenario: plain immutable data, checked as a whole when made.
Strings carry units, plain numbers are SI."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Protocol, get_args

import numpy as np

from klingel.contact import DRY_AND_CLEAN, STANDARD, CreepOptions, Profile
from klingel.contact.checks import Kind, kind_problems
from klingel.control import Sensors, Timing, Traction
from klingel.errors import InputError, Problem, nearest
from klingel.scenario.fit import misfits, no_strategy
from klingel.track import Adhesion, Track
from klingel.units import Quantity, to_si
from klingel.vehicle import Vehicle

CreepLaw = Literal["table", "fastsim", "polach", "shen_hedrick_elkins", "linear"]
Contact = Literal["hertz", "kik_piotrowski"]

FRICTION = 0.35
"""Of dry rails [-], as the study has it."""

ELEMENTS_MIN, ELEMENTS_MAX = 2, 40
"""Coarsest and finest FASTSIM grid: elements along, and across, the ellipse."""

RUN_OUT = 2.0
"""Track kept free before the last and ahead of the first wheelset [m], for the drift of a slow speed hold."""


MISMATCH_MAX = 0.01
"""Largest difference of the radii of two wheels of a wheelset [m]: contact tables keep the nominal radius, half of this
is one per cent of it. Workshops turn wheels of one axle to within some tenths of a millimetre."""

SAMPLES_A_PERIOD = 2.0
"""Least number of samples in a period of the actuators' bandwidth: with fewer what they do to the vehicle comes back to
the controller as another, slower motion (aliasing). Good control wants ten times as many."""


IDEAL = Sensors()
"""Sensors without any error."""


class Strategy(Protocol):
    """What steers and drives a vehicle."""

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any] | None:
        """The controller as the core's control spec; None leaves the vehicle to itself.

        A strategy may also have `problems(vehicle)`, why it does not fit a vehicle: a Scenario asks before the run.
        """
        ...


@dataclass(frozen=True, init=False)
class Scenario:
    """One run: vehicle and track, then keywords; strings carry units, plain numbers are SI.

    vehicle: of the library or of a file; track: where it runs; speed: at the start, held by a slow ideal force;
    control: strategy of `klingel.control`, None for none; sensors: what it measures with; database: the track that it
    knows, None for the true one (see `Track.mistaken`); friction: coefficient of all contacts; adhesion: friction
    along the track in its place; headwind: speed of the air against the vehicle, for the running resistance;
    contact: normal contact by `hertz` (an ellipse in every zone of the wheel) or `kik_piotrowski` (not Hertzian),
    equally fast; creep_law with creep_elements (along, across) for FASTSIM and its creep_options; wheel: profile of all
    wheels, None for the vehicle's; rail: its profile or the name of a standard one; rail_inclination (slope, positive
    leans inwards), gauge; radius_mismatch: radius of the right wheel minus that of the left one, of all wheelsets or of
    the four from the front, each wheel has half of it;
    stick: creepages need way to build up, so that standing wheels stick instead of creeping;
    step: of the integrator; record_interval: of the results; duration: None runs to the end of the track; a vehicle
    that starts from rest needs one, with a traction loop it is that of the commands; energy: book it (channels
    `energy.*`, see `klingel.assess.energy`).
    Errors: InputError with every problem.

    >>> from klingel import library
    >>> scenario = Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed="108 km/h")
    >>> scenario.speed, round(scenario.end_time, 2)
    (30.0, 15.81)
    """

    vehicle: Vehicle
    track: Track
    speed: float
    control: Strategy | None
    sensors: Sensors
    database: Track | None
    friction: float
    adhesion: Adhesion | None
    headwind: float
    contact: Contact
    creep_law: CreepLaw
    creep_elements: tuple[int, int]
    creep_options: CreepOptions
    stick: bool
    wheel: Profile | None
    rail: str | Profile
    rail_inclination: float
    gauge: float
    radius_mismatch: tuple[float, float, float, float]
    step: float
    record_interval: float
    duration: float | None
    energy: bool

    def __init__(
        self,
        vehicle: Vehicle,
        track: Track,
        *,
        speed: Quantity,
        control: Strategy | None = None,
        sensors: Sensors = IDEAL,
        database: Track | None = None,
        friction: Quantity = FRICTION,
        adhesion: Adhesion | None = None,
        headwind: Quantity = 0.0,
        contact: Contact = "hertz",
        creep_law: CreepLaw = "table",
        creep_elements: tuple[int, int] = (10, 10),
        creep_options: CreepOptions = DRY_AND_CLEAN,
        stick: bool = False,
        wheel: Profile | None = None,
        rail: str | Profile = "60E1",
        rail_inclination: Quantity = 0.025,
        gauge: Quantity = "1435 mm",
        radius_mismatch: Quantity | Sequence[Quantity] = 0.0,
        step: Quantity = "0.5 ms",
        record_interval: Quantity = "1 ms",
        duration: Quantity | None = None,
        energy: bool = True,
    ) -> None:
        values: dict[str, Any] = {
            "vehicle": vehicle,
            "track": track,
            "speed": to_si(speed, "m/s", key="speed"),
            "control": control,
            "sensors": sensors,
            "database": database,
            "friction": to_si(friction, "1", key="friction"),
            "adhesion": adhesion,
            "headwind": to_si(headwind, "m/s", key="headwind"),
            "contact": contact,
            "creep_law": creep_law,
            "creep_elements": _as_tuple(creep_elements),
            "creep_options": creep_options,
            "stick": stick,
            "wheel": wheel,
            "rail": rail,
            "rail_inclination": to_si(rail_inclination, "1", key="rail_inclination"),
            "gauge": to_si(gauge, "m", key="gauge"),
            "radius_mismatch": _four(radius_mismatch, "radius_mismatch"),
            "step": to_si(step, "s", key="step"),
            "record_interval": to_si(record_interval, "s", key="record_interval"),
            "duration": None if duration is None else to_si(duration, "s", key="duration"),
            "energy": energy,
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        problems = list(_problems(self))
        if problems:
            raise InputError(problems)

    @classmethod
    def read(cls, path: str | Path) -> Scenario:
        """The scenario of a TOML file (see `klingel.scenario.files`); errors: InputError."""
        from klingel.scenario.files import read

        return read(path)

    def replace(self, **changes: Any) -> Scenario:
        """The same scenario with other values."""
        values = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return Scenario(**(values | changes))

    @property
    def start(self) -> float:
        """Arc length of the vehicle's centre at the start [m]: the last wheelset stands just inside the track."""
        return self.vehicle.geometry.half_length + RUN_OUT

    @property
    def traction(self) -> Traction | None:
        """The traction loop of the strategy, without which the speed is held."""
        traction: Traction | None = getattr(self.control, "traction", None)
        return traction

    @property
    def end_time(self) -> float:
        """Duration of the run [s]; by default until the first wheelset is at the end of the track.

        With a traction loop by default until its last time.
        """
        if self.duration is not None:
            return self.duration
        if self.traction is not None:
            return self.traction.time[-1]
        return (self.track.length - 2.0 * self.start) / self.speed


def _as_tuple(value: object) -> object:
    """The arrays of a file as tuples; anything else as it is, for the check to refuse."""
    return tuple(value) if isinstance(value, (list, tuple)) else value


def _four(value: Quantity | Sequence[Quantity], key: str) -> tuple[float, ...]:
    """Lengths of the four wheelsets from the front [m], from one for all or one each."""
    if isinstance(value, (list, tuple)):
        if len(value) != 4:
            raise InputError.single(key, value, "is no length a wheelset", remedy="give one length, or four")
        return tuple(to_si(each, "m", key=f"{key}[{i}]") for i, each in enumerate(value))
    return (to_si(value, "m", key=key),) * 4  # type: ignore[arg-type]  # it refuses what is no quantity


def _is_grid(elements: object) -> bool:
    """Two whole numbers within the limits; 10.0 and True are no whole numbers."""
    if not isinstance(elements, tuple) or len(elements) != 2:
        return False
    return all(type(n) is int and ELEMENTS_MIN <= n <= ELEMENTS_MAX for n in elements)


def _problems(scenario: Scenario) -> Iterator[Problem]:
    if (problem := no_strategy(scenario.control)) is not None:  # the checks below ask the strategy
        yield problem
        return
    positive = {"friction": "1", "gauge": "m", "step": "s", "record_interval": "s", "duration": "s"}
    for key, unit in positive.items():
        value = getattr(scenario, key)
        if value is not None and not value > 0.0:
            yield Problem(key, value, f"must be positive [{unit}]", "give a value above zero")
    if not scenario.speed >= 0.0:
        yield Problem("speed", scenario.speed, "must not be negative [m/s]", "give a speed, or 0 to start from rest")
    if not isinstance(scenario.stick, bool):
        yield Problem("stick", scenario.stick, "is no yes or no", "give True or False")
    if scenario.friction > 1.5:
        yield Problem("friction", scenario.friction, "is no coefficient of friction", "give 0.05 to 0.6")
    if not isinstance(scenario.sensors, Sensors):
        yield Problem("sensors", scenario.sensors, "are none", "give klingel.control.Sensors")
    if not isinstance(scenario.database, Track | None):
        yield Problem("database", scenario.database, "is no track", "give a klingel.Track, or None")
    yield from _along_track_problems(scenario)
    yield from misfits(scenario.control, scenario.vehicle)
    if not abs(scenario.rail_inclination) <= 0.1:
        yield Problem(
            "rail_inclination", scenario.rail_inclination, "is too steep", "give a slope such as 1/40 = 0.025"
        )
    for i, mismatch in enumerate(scenario.radius_mismatch):
        if not abs(mismatch) <= MISMATCH_MAX:
            remedy = f"give at most {MISMATCH_MAX * 1e3:g} mm; plain numbers are metres"
            yield Problem(f"radius_mismatch[{i}]", mismatch, "is too much for a pair of wheels [m]", remedy)
    for key, choice in (("contact", Contact), ("creep_law", CreepLaw)):
        value, known = getattr(scenario, key), get_args(choice)
        if (key, value) == ("creep_law", "exact"):
            remedy = f"choose {', '.join(known)}; klingel.contact.creep_force has it for single patches"
            yield Problem(key, value, "takes milliseconds a contact, too slow for a simulation", remedy)
        elif value not in known:
            yield Problem(key, value, "is not known", nearest(value, known))
    yield from _profile_problems(scenario)
    if type(scenario.energy) is not bool:
        yield Problem("energy", scenario.energy, "is neither true nor false", "give true or false")
    if not isinstance(scenario.creep_options, CreepOptions):
        yield Problem("creep_options", scenario.creep_options, "are none", "give klingel.contact.CreepOptions")
    if not _is_grid(scenario.creep_elements):
        remedy = f"give two whole numbers from {ELEMENTS_MIN} to {ELEMENTS_MAX}"
        yield Problem("creep_elements", scenario.creep_elements, "is no grid (along, across)", remedy)
    if scenario.step > 0.0:
        yield from _step_problems(scenario)
    yield from _sampling_problems(scenario)
    yield from _run_problems(scenario)


def _along_track_problems(scenario: Scenario) -> Iterator[Problem]:
    adhesion = scenario.adhesion
    if adhesion is not None and not isinstance(adhesion, Adhesion):
        yield Problem("adhesion", adhesion, "is none", "give klingel.track.Adhesion")
    elif adhesion is not None and scenario.friction not in (FRICTION, adhesion.base):
        remedy = f"give one friction: leave it out, or make it the base {adhesion.base:g} of the adhesion"
        yield Problem("friction", scenario.friction, "and adhesion contradict each other", remedy)
    if scenario.headwind != 0.0 and scenario.vehicle.running_resistance is None:
        remedy = "give the vehicle a [running_resistance]"
        yield Problem("headwind", scenario.headwind, "needs a running resistance", remedy)


def _profile_problems(scenario: Scenario) -> Iterator[Problem]:
    """Profiles are profiles, of a wheel and of a rail."""
    kinds: tuple[tuple[Kind, object], ...] = (("wheel", scenario.wheel), ("rail", scenario.rail))
    for kind, given in kinds:
        if isinstance(given, Profile):
            # a steep cone of the library meets its flange high up, where a measured wheel would be out of place
            if not (kind == "wheel" and str(given.standard).startswith("cone(")):
                yield from kind_problems(kind, given.y, given.z)
        elif kind == "rail" and isinstance(given, str):
            if given not in STANDARD["rail"]:
                yield Problem("rail", given, "is not known", nearest(given, list(STANDARD["rail"])))
        elif given is not None:
            yield Problem(kind, given, "is no profile", "give a klingel.contact.Profile")


def _step_problems(scenario: Scenario) -> Iterator[Problem]:
    """The step divides the controller's sample time and the record interval."""
    step, interval = scenario.step, scenario.record_interval
    timing = getattr(scenario.control, "timing", None)  # of the strategies that are sampled
    if isinstance(timing, Timing) and not _divides(step, timing.sample_time):
        message = f"does not divide the controller's sample time {timing.sample_time:g} s"
        yield Problem("step", step, message, f"give {_nearest_step(step, timing.sample_time, interval):g} s")
    elif interval > 0.0 and not _divides(step, interval):
        yield Problem("record_interval", interval, "is no multiple of the step", f"give a multiple of {step:g} s")


def _sampling_problems(scenario: Scenario) -> Iterator[Problem]:
    """A controller is quick enough for the actuators that it commands, in any case it acts within the run."""
    strategy, vehicle = scenario.control, scenario.vehicle
    timing = getattr(strategy, "timing", None)
    if not isinstance(timing, Timing):
        if timing is not None:
            yield Problem("control.timing", timing, "is no sampling", "give klingel.control.Timing")
        return
    name, key = getattr(strategy, "name", type(strategy).__name__), "control.timing.sample_time"
    commands = getattr(strategy, "commands", None)
    steers = not isinstance(commands, tuple) or any(str(target).endswith(".force") for target in commands)
    actuators = [each for each in (vehicle.steering, vehicle.secondary_steering) if each is not None and steers]
    endless = scenario.duration is None and scenario.traction is None and not scenario.speed > 0.0
    if actuators:
        bandwidth = max(each.bandwidth for each in actuators)
        least, good = (1.0 / (n * bandwidth) for n in (SAMPLES_A_PERIOD, 10.0 * SAMPLES_A_PERIOD))
        if timing.sample_time > least * (1.0 + 1e-9):
            message = f"is too slow for `{name}`: the vehicle's actuators have {bandwidth:g} Hz [s]"
            yield Problem(key, timing.sample_time, message, f"give {least:.2g} s at most, better {good:.1g} s")
    elif not endless and timing.sample_time > scenario.end_time > 0.0:
        remedy = f"give {scenario.end_time:.3g} s at most"
        yield Problem(key, timing.sample_time, f"is longer than the run of `{name}` [s]", remedy)


def _divides(part: float, whole: float) -> bool:
    ratio = whole / part
    return 0.5 < ratio < math.inf and abs(ratio - round(ratio)) <= 1e-9


def _nearest_step(step: float, sample_time: float, interval: float) -> float:
    """The short decimal next to `step` [s] that divides the sample time, and the record interval too if one can."""
    short = [float(f"{sample_time / n:.4g}") for n in range(1, 1001)]
    steps = [s for s in short if _divides(s, sample_time)]
    both = [s for s in steps if _divides(s, interval)]
    return min(both or steps or [sample_time], key=lambda s: abs(s - step))


def _traction_problems(scenario: Scenario, traction: Traction, room: float) -> Iterator[Problem]:
    """The run ends after it began, and a speed that is followed from the start stays on the track."""
    if not scenario.end_time > 0.0:
        yield Problem("duration", scenario.duration, "is missing for a command that never changes", "give it [s]")
    elif traction.speed is not None:
        if abs(traction.speed[0] - scenario.speed) > 0.5:
            remedy = f"start with {scenario.speed:g} m/s, the speed of the scenario"
            yield Problem("control.traction.speed", traction.speed[0], "begins elsewhere [m/s]", remedy)
        time = np.linspace(0.0, scenario.end_time, 1001)
        distance = float(np.trapezoid(np.interp(time, traction.time, traction.speed), time))
        if distance > room:
            remedy = f"give a track of {scenario.track.length + distance - room:.0f} m, or an earlier end"
            yield Problem("track", f"{scenario.track.length:g} m", f"ends before {distance:.0f} m are run", remedy)


def _run_problems(scenario: Scenario) -> Iterator[Problem]:
    if not scenario.speed >= 0.0:
        return
    room = scenario.track.length - 2.0 * scenario.start
    if room <= 0.0:
        remedy = f"give more than {2.0 * scenario.start:.1f} m, the vehicle's length included"
        yield Problem("track", f"{scenario.track.length:g} m", "is too short for the vehicle", remedy)
    elif scenario.traction is not None:
        yield from _traction_problems(scenario, scenario.traction, room)
    elif scenario.duration is None and scenario.speed == 0.0:
        yield Problem("duration", None, "is missing", "say how long a vehicle that starts from rest shall run [s]")
    elif scenario.duration is not None and scenario.duration * scenario.speed > room:
        remedy = f"give at most {room / scenario.speed:.2f} s, or lengthen the track"
        yield Problem("duration", scenario.duration, "runs over the end of the track [s]", remedy)
