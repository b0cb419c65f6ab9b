"""Controllers of one's own: one controller in three forms gives one result; bad ones end their run and no other.
The examples run, and what the page about them shows is theirs."""

from __future__ import annotations

import _thread
import math
import re
import signal
import textwrap
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

import control as python_control
import klingel as kl
import own_strategy
import three_forms
from klingel.control import Diagram, DiscreteController, PythonController, Timing, low_pass
from klingel.control.state_space import split
from klingel.errors import InputError, RunCancelledError, SimulationError
from klingel.lower import lower
from klingel.study.runner import run_all
from three_forms import COMMANDS, MEASURED, TS, Stepped, blocks, discrete, scenario


def python(controller: Any = None, **more: Any) -> PythonController:
    values = {"sample_time": TS, "measurements": MEASURED, "commands": COMMANDS, **more}
    return PythonController(controller or Stepped(), **values)


def apart(one: xr.Dataset, other: xr.Dataset) -> float:
    """The largest difference of any channel over its range, but for rounding: of its largest value, and what energies
    add up to."""
    names = [n for n in one.data_vars if n in other.data_vars and n != "energy.residual"]
    assert len(names) > 100
    return max(_apart(one[n].to_numpy(), other[n].to_numpy()) for n in names)


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    beyond = np.abs(one - other).max() - 1e-12 * np.abs(one).max()
    return max(float(beyond), 0.0) / max(float(np.ptp(one)), 1e-9)


def test_one_controller_in_three_forms_gives_one_result() -> None:
    composed = kl.simulate(scenario(blocks, 4.0), strict=True)
    for form in (discrete(), python()):
        assert apart(composed, kl.simulate(scenario(form, 4.0), strict=True)) < 1e-9


def test_blocks_and_matrices_have_one_linear_model() -> None:
    """The closed loop's responses of every output to every input; operating points are found to 1e-10."""
    models = [kl.linearise(scenario(form), at="150 m") for form in (blocks, discrete())]
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


def test_slow_poles_of_badly_scaled_states_are_no_integrators() -> None:
    """Position in um, force in MN: entries of 1e9 beside a pole that decays over a day."""
    scale = np.diag([1.0, 1e9, 1e-6])
    A = scale @ np.array([[1.0 - 1e-8, 0.3, 0.0], [0.0, 0.5, 0.2], [0.0, -0.2, 0.6]]) @ np.linalg.inv(scale)
    assert split(A, np.ones((3, 1)), np.ones((1, 3)), np.zeros((1, 1))).b1.shape == (0, 1)


def test_what_cannot_be_copied_is_refused() -> None:
    class Locked(Failing):
        def __init__(self) -> None:
            self.lock = threading.Lock()

    with pytest.raises(InputError, match="cannot be copied for a run"):
        kl.simulate(scenario(python(Locked()), 0.1))


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
        (
            lambda: scenario(
                DiscreteController(
                    python_control.ss([], [], [], np.zeros((1, 1)), 0.04),
                    measurements=MEASURED[:1],
                    commands=COMMANDS[:1],
                )
            ),
            "too slow for `controller`",
        ),
        (
            lambda: scenario(type(blocks)(timing=Timing(0.04))),
            r"0\.04: is too slow for `SpeedDifference`.*0\.033 s at most",
        ),
        (lambda: scenario(python(sample_time=5.0, commands=[], probes={"a": "1"}), 1.0), "longer than the run"),
        (lambda: Timing("1 ms"), "control.timing.sample_time = '1 ms': is no number"),  # type: ignore[arg-type]
        (lambda: Timing(0.0), "control.timing.sample_time = 0.0: must be positive"),
        (lambda: Timing(1e-3, -1, 0), "sensor_samples = -1: is no number of samples"),
        (lambda: Timing(1e-3, 1.5, 1), "sensor_samples = 1.5: is no number of samples"),  # type: ignore[arg-type]
        (lambda: Diagram(sample_time=1e-3).delay("late", "x", -3), "late.samples = -3: is no number of samples"),
        (lambda: low_pass(900.0, sample_time=1e-3), "frequency = 900.*less than 500 Hz"),
        (lambda: lower(scenario(Lowered([]))), r"what Lowered.lower\(\) returns = \[\]: is no control spec"),
        (lambda: lower(scenario(Lowered({"blocks": []}))), "has no sample_time, measurements, commands"),
        (lambda: lower(scenario(Lowered(Diagram(sample_time=0.0).spec()))), "sample_time in what Lowered"),
    ],
)
def test_bad_declarations_are_refused_before_the_run(make: Any, word: str) -> None:
    with pytest.raises(InputError, match=word):
        make()


class Lowered:
    """A strategy that gives what it was made with."""

    def __init__(self, given: Any) -> None:
        self.given = given

    def lower(self, *_: object) -> Any:
        return self.given


@pytest.mark.parametrize(
    ("probes", "measured", "said"),
    [
        ({"bogie1.yaw": "rad"}, MEASURED, "control probe `bogie1.yaw` would replace the channel"),
        ({"energy.drag": "J"}, MEASURED, "control probe `energy.drag` has a name that results keep"),
        ({}, ["bogie1.yaw_rat"], "control measures `bogie1.yaw_rat`, but .* is `bogie1.yaw_rate`"),
    ],
)
def test_wires_to_what_is_not_or_is_taken_are_refused_by_name(probes: Any, measured: Any, said: str) -> None:
    with pytest.raises(SimulationError, match=said):
        kl.simulate(scenario(python(probes=probes, measurements=measured), 0.01))


def test_a_run_is_cancelled_from_within_its_controller_and_by_ctrl_c() -> None:
    class Impatient(Failing):
        def __init__(self, end: Any) -> None:
            self.end = end

        def step(self, t: float, measurements: Mapping[str, float]) -> Any:
            if abs(t - 0.02) < 1e-6:
                self.end()
            return [0.0] * len(COMMANDS)

        def __deepcopy__(self, _: object) -> Any:
            return self

    progress = kl.progress()
    with pytest.raises(RunCancelledError):
        kl.simulate(scenario(python(Impatient(progress.cancel)), 9.0), progress=progress)
    # A job of a shell's background inherits a SIGINT that is ignored; a person at a terminal does not.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            kl.simulate(scenario(python(Impatient(_thread.interrupt_main)), 9.0))
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    mpl.use("Agg")
    monkeypatch.chdir(tmp_path)
    own_strategy.main()
    largest = [float(line.split()[-2]) for line in capsys.readouterr().out.splitlines()]
    passive, own, library = largest
    assert library < own < 0.5 * passive
    assert (tmp_path / "own_strategy.png").stat().st_size > 10_000
    monkeypatch.setattr(three_forms, "scenario", lambda form: scenario(form, 0.2))
    three_forms.main(repeats=1)
    assert len(capsys.readouterr().out.splitlines()) == 4


def test_what_the_page_shows_is_in_the_examples() -> None:
    root = Path(three_forms.__file__).parents[1]
    page = (root / "docs" / "own_controller.md").read_text()
    shown = [
        textwrap.dedent(part).strip("\n") for part in re.findall(r"(?:^    .*\n|^\n(?=    ))+", page, re.MULTILINE)
    ]
    sources = "".join((root / "examples" / name).read_text() for name in ("own_strategy.py", "three_forms.py"))
    code = [part for part in shown if part.startswith(("class", "@", "def", "python ="))]
    assert len(code) == 4
    for part in code:
        assert part in sources
