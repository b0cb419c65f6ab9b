"""Controllers of one's own: one controller in three forms gives one result; bad ones end their run and no other.
The controller: wheelsets of trailed independently rotating wheels are steered to the speed difference of rolling."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import xarray as xr

import control as python_control
import klingel as kl
from klingel.control import (
    WHEELSETS,
    Composed,
    Diagram,
    DiscreteController,
    Plant,
    PythonController,
    Timing,
    command_steering,
    low_pass,
    speed_difference,
)
from klingel.control.state_space import split
from klingel.errors import InputError, SimulationError
from klingel.lower import lower
from klingel.study.runner import run_all

TS = 1e-3
FREQUENCY, GAIN, RATE = 1.5, 6e4, 4e4
"""Corner of the low-pass of the yaw rate [Hz]; proportional [N m s/rad] and integral [N m/rad] gain."""

VEHICLE = kl.library.vehicle("trailed_irw")
UNDELAYED = Timing(TS, 0, 0)
PLANT = Plant.of(VEHICLE)
LOW = low_pass(FREQUENCY, sample_time=TS)
PER_MOMENT = 1.0 / (2.0 * PLANT.steering.half_spacing)
SIDES = (("left", 1.0), ("right", -1.0))
COMMANDS = [f"{w.name}.actuator_{side}.force" for w in WHEELSETS for side, _ in SIDES]
MEASURED = [f"{w.name}.{what}" for w in WHEELSETS for what in ("yaw_rate", "left.spin_speed", "right.spin_speed")]


@dataclass(frozen=True, kw_only=True)
class Blocks(Composed):
    """As standard blocks."""

    timing: Timing = UNDELAYED

    def build(self, d: Diagram, vehicle: kl.Vehicle, track: kl.Track, speed: float) -> None:
        for w in WHEELSETS:
            rate = d.filter(f"{w.name}.rate", d.measure(f"{w.name}.yaw_rate"), [LOW])
            wd = speed_difference(d, w, self.timing)
            error = d.sum(f"{w.name}.error", {rate: PLANT.speed_ratio, wd: -1.0})
            moment = d.pi(f"{w.name}.moment", error, proportional=GAIN, integral=RATE)
            command_steering(d, PLANT, w, moment, self.timing)


class Stepped:
    """As a class."""

    def reset(self) -> None:
        self.filters: dict[str, list[float]] = {}
        self.integrals: dict[str, list[float]] = {}

    def step(self, t: float, measurements: Mapping[str, float]) -> dict[str, float]:
        commands = {}
        for w in WHEELSETS:
            left, right = (measurements[f"{w.name}.{side}.spin_speed"] for side, _ in SIDES)
            rate = self._low_pass(w.name, measurements[f"{w.name}.yaw_rate"])
            error = PLANT.speed_ratio * rate - 0.5 * (left - right)
            for side, sign in SIDES:
                commands[f"{w.name}.actuator_{side}.force"] = sign * PER_MOMENT * self._moment(w.name, error, sign)
        return commands

    def _low_pass(self, name: str, u: float) -> float:
        """The transposed direct form, begun where its first input leads it."""
        (b0, b1, b2), (a1, a2) = LOW.b, LOW.a
        x = self.filters.setdefault(name, [u * (b1 + b2 - a1 - a2), u * (b2 - a2)])
        y = b0 * u + x[0]
        x[:] = [b1 * u - a1 * y + x[1], b2 * u - a2 * y]
        return y

    def _moment(self, name: str, error: float, sign: float) -> float:
        total = self.integrals.setdefault(name, [0.0, error])
        if sign > 0.0:
            total[:] = [total[0] + 0.5 * TS * RATE * (error + total[1]), error]
        return GAIN * error + total[0]


def discrete(gain: float = GAIN) -> DiscreteController:
    """As matrices: low-pass, difference and PI of every wheelset."""
    z = python_control.tf([1.0, 0.0], [1.0], TS)
    low = python_control.tf(list(LOW.b), [1.0, *LOW.a], TS)
    one = python_control.tf([1.0], [1.0], TS)
    pi = gain + 0.5 * TS * RATE * (z + 1.0) / (z - 1.0)
    state = python_control.tf2ss
    moment = (
        state(pi)
        * python_control.append(state(one))
        * python_control.ss([], [], [], [[PLANT.speed_ratio, -0.5, 0.5]], TS)
        * python_control.append(state(low), state(one), state(one))
    )
    forces = python_control.ss([], [], [], [[PER_MOMENT], [-PER_MOMENT]], TS)
    return DiscreteController(
        python_control.append(*(forces * moment for _ in WHEELSETS)), measurements=MEASURED, commands=COMMANDS
    )


def python(controller: Any = None, **more: Any) -> PythonController:
    values = {"sample_time": TS, "measurements": MEASURED, "commands": COMMANDS, **more}
    return PythonController(controller or Stepped(), **values)


def scenario(strategy: object, duration: float = 4.0) -> kl.Scenario:
    track = kl.Track.curve(radius="800 m", cant="100 mm", transition="60 m", straight_before="30 m")
    return kl.Scenario(VEHICLE, track, speed="40 m/s", control=strategy, duration=duration, energy=False)


def apart(one: xr.Dataset, other: xr.Dataset) -> float:
    """The largest difference of any channel, but for what is rounding of its largest value, over its range."""
    names = [n for n in one.data_vars if n in other.data_vars]
    assert len(names) > 100
    return max(_apart(one[n].to_numpy(), other[n].to_numpy()) for n in names)


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    beyond = np.abs(one - other).max() - 1e-12 * np.abs(one).max()
    return max(float(beyond), 0.0) / max(float(np.ptp(one)), 1e-9)


def test_one_controller_in_three_forms_gives_one_result() -> None:
    blocks = kl.simulate(scenario(Blocks()), strict=True)
    alone = kl.simulate(scenario(None), strict=True)
    assert float(np.abs(blocks["bogie1.wheelset1.y"]).max()) < float(np.abs(alone["bogie1.wheelset1.y"]).max())
    for form in (discrete(), python()):
        assert apart(blocks, kl.simulate(scenario(form), strict=True)) < 1e-9


def test_blocks_and_matrices_have_one_linear_model() -> None:
    """The closed loop's responses of every output to every input; operating points are found to 1e-10."""
    models = [kl.linearise(scenario(form), at="150 m") for form in (Blocks(), discrete())]
    for frequency in (0.2, 1.0, 5.0, 30.0):
        z = np.exp(2j * math.pi * frequency * TS)
        one, other = (m.C @ np.linalg.solve(z * np.eye(len(m.A)) - m.A, m.B) + m.D for m in models)
        scale = np.abs(one).max(axis=1, keepdims=True) + 1e-300
        np.testing.assert_allclose(other / scale, one / scale, atol=1e-5)


def test_integrators_are_split_off_exactly() -> None:
    """K(z) of three states, two of them integrators of different signals, after a change of coordinates."""
    rng = np.random.default_rng(3)
    T = rng.normal(size=(3, 3))
    A = T @ np.diag([1.0, 0.7, 1.0]) @ np.linalg.inv(T)
    B, C, D = rng.normal(size=(3, 2)), rng.normal(size=(2, 3)), rng.normal(size=(2, 2))
    parts = split(A, B, C, D)
    assert (parts.a.shape, parts.b1.shape) == ((1, 1), (2, 2))
    for z in (0.3 + 0.8j, -1.0, 1.001):
        apart = parts.c / (z - parts.a) @ parts.b + parts.c1 @ parts.b1 / (z - 1.0) + parts.d
        np.testing.assert_allclose(apart, C @ np.linalg.solve(z * np.eye(3) - A, B) + D, rtol=1e-9)


def test_a_chain_of_integrators_is_refused() -> None:
    double = python_control.ss([[1.0, 1e-3], [0.0, 1.0]], [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]], TS)
    with pytest.raises(InputError, match="repeated poles at z = 1"):
        DiscreteController(double, measurements=["bogie1.yaw_rate"], commands=COMMANDS[:1])


def test_offsets_are_those_of_an_operating_point() -> None:
    gain = python_control.ss([], [], [], [[2.0]], TS)
    about = DiscreteController(
        gain, measurements=["body.speed"], commands=COMMANDS[:1], measured_at=[39.0], commanded_at=[100.0]
    )
    run = kl.simulate(scenario(about, 0.05))
    np.testing.assert_allclose(run[COMMANDS[0].replace("force", "command")][1:], 102.0, atol=1e-3)


@pytest.mark.parametrize(
    ("system", "word"),
    [
        (python_control.ss([[-1.0]], [[1.0]], [[1.0]], [[0.0]]), "c2d"),
        (python_control.ss([[0.5]], [[1.0]], [[1.0]], [[0.0]], True), "dt=1e-3"),
        (python_control.ss([], [], [], [[1.0, 2.0]], TS), "name 2"),
        (python_control.tf([1.0], [1.0, -0.5], TS), "tf2ss"),
        (python_control.ss([], [], [], [[math.nan]], TS), "is not finite"),
    ],
)
def test_bad_systems_are_refused_with_the_remedy(system: object, word: str) -> None:
    with pytest.raises(InputError, match=word):
        DiscreteController(system, measurements=["bogie1.yaw_rate"], commands=COMMANDS[:1])


class Failing:
    """Does as it is told at 0.02 s."""

    def __init__(self, given: object) -> None:
        self.given = given

    def reset(self) -> None: ...

    def step(self, t: float, measurements: Mapping[str, float]) -> Any:
        if t < 0.0195:
            return [0.0] * len(COMMANDS)
        if isinstance(self.given, Exception):
            raise self.given
        return self.given


ZERO = dict.fromkeys(COMMANDS, 0.0)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([0.0, 1.0], "gives 2 commands, 8 are declared"),
        ([0.0] * 7 + [math.nan], f"gives NaN for `Failing.{COMMANDS[7]}`"),
        (ZERO | {COMMANDS[1]: math.inf}, f"gives inf for `Failing.{COMMANDS[1]}`"),
        (ValueError("no such gear"), "raised ValueError: no such gear"),
        (KeyError(), "raised KeyError"),
        ({k: v for k, v in ZERO.items() if k != COMMANDS[2]}, f"command {COMMANDS[2]}: is missing"),
        (ZERO | {"bogie1.wheelset1.actuator_left.froce": 0.0}, "is not declared; did you mean"),
        (None, "raised TypeError"),
        (["much"] * 8, "raised ValueError"),
    ],
)
def test_a_bad_controller_ends_its_run_with_name_time_and_value(given: object, said: str) -> None:
    outcome = kl.simulate(scenario(python(Failing(given)), 0.1)).attrs["outcome"]
    assert outcome.startswith("controller failed: `Failing` ")
    assert said in outcome
    assert outcome.endswith(", at 0.020 s")


def test_a_batch_goes_on_after_a_bad_controller() -> None:
    strategies = {"bad": python(Failing(RuntimeError("lost"))), "good": python(), "again": python()}

    def work(task: str, progress: Any) -> xr.Dataset:
        return kl.simulate(scenario(strategies[task], 0.1), progress=progress)

    done = run_all(list(strategies), work, kl.progress, jobs=2).done
    assert "`Failing` raised RuntimeError: lost" in done["bad"].attrs["outcome"]
    assert done["good"].attrs["outcome"] == "completed"
    assert apart(done["good"], done["again"]) == 0.0


def test_every_run_has_a_controller_of_its_own() -> None:
    strategy = python()
    first, second = (kl.simulate(scenario(strategy, 0.1)) for _ in range(2))
    assert apart(first, second) == 0.0
    assert not hasattr(strategy.controller, "filters")


def test_a_failing_reset_ends_the_run_at_its_start() -> None:
    class Broken(Failing):
        def reset(self) -> None:
            raise OSError("no such file")

    outcome = kl.simulate(scenario(python(Broken(None)), 0.1)).attrs["outcome"]
    assert outcome == "controller failed: `Broken` raised OSError: no such file, at 0.000 s"


def test_a_slower_controller_with_a_probe() -> None:
    class Counter:
        def reset(self) -> None:
            self.count = 0

        def step(self, t: float, measurements: Mapping[str, float]) -> Sequence[float]:
            self.count += 1
            return [self.count, t]

    counting = PythonController(
        Counter(), sample_time="5 ms", measurements=[], commands=COMMANDS[:1], probes={"counter.time": "s"}
    )
    run = kl.simulate(scenario(counting, 0.1))
    np.testing.assert_allclose(run["counter.time"], np.floor(run["time"] / 5e-3 + 1e-9) * 5e-3, atol=1e-12)


def test_steady_states_refuse_a_controller_outside_the_core() -> None:
    with pytest.raises(SimulationError, match=r"`Stepped` is a controller outside the core.*StateSpace"):
        kl.linearise(scenario(python()))


def test_a_spec_does_not_run_without_its_controller() -> None:
    spec = lower(scenario(python(), 0.01))
    with pytest.raises(SimulationError, match="`Stepped` is a controller outside the core and none was given"):
        kl.simulate_spec(spec)
    assert kl.simulate_spec(spec, externals=python().externals()).attrs["outcome"] == "completed"


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: python(Stepped), r"give an object: Stepped\(\)"),
        (lambda: python(object()), "no method reset"),
        (lambda: python(sample_time=0.0), "must be positive"),
        (lambda: python(commands=COMMANDS[0]), "is no list of names"),
        (lambda: python(commands=COMMANDS[:1] * 2), "named twice"),
        (lambda: python(commands=[]), "name at least one"),
        (lambda: scenario(python(sample_time=1.3e-3)), "does not divide"),
        (lambda: scenario(python(sample_time=0.04)), "too slow for `Stepped`"),
    ],
)
def test_bad_declarations_are_refused_before_the_run(make: Any, word: str) -> None:
    with pytest.raises(InputError, match=word):
        make()
