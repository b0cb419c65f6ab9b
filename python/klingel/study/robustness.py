"""How robust a vehicle is: many runs of one scenario with drawn inputs, and each input tried alone.
Rows are kept as they finish; the same seed gives the same runs, whatever the number of threads."""

from __future__ import annotations

import inspect
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

import klingel
from klingel import result
from klingel.assess import curving
from klingel.assess.header import course_of
from klingel.control.sensor import whole_of
from klingel.core import core
from klingel.errors import InputError, SimulationError
from klingel.lower import explicit_step, lower
from klingel.scenario import Scenario, Strategy
from klingel.study import robustness_output as output
from klingel.study.folder import conclude, study_folder
from klingel.study.robustness_effects import EFFECTS, changed
from klingel.study.robustness_inputs import Inputs, draw, inputs, levels
from klingel.study.robustness_pairs import PAIRS
from klingel.study.robustness_rows import Rows
from klingel.study.runner import run_all
from klingel.study.screen import console as default_console
from klingel.study.screen import prepare

if TYPE_CHECKING:
    import pandas as pd

    from klingel._core import Progress

FIGURES = (
    "y_max_mm", "y_curve_mm", "attack_angle_max_mrad", "lateral_force_max_kN", "wear_index_N", "actuator_force_max_kN",
    "steering_voltage_max_V", "contact_angle_max_deg", "yq_max", "q_min_kN", "body_lateral_acc_mps2", "flange_contact",
    "outcome",
)  # fmt: skip
"""What is kept of each run, of `klingel.assess.COLUMNS`."""

WORDS = ("flange_contact", "outcome")

INTERVAL = 2e-3
"""Longest interval of the samples that `klingel.assess.curving` takes [s]."""

REFUSED = "refused"
"""First word of the outcome of a run that could not begin."""


@dataclass(frozen=True)
class Robustness:
    """The study's results.

    Attributes:
        out: folder with everything that was written.
        drawn: one row a drawn run: its inputs in SI, then its figures.
        alone: one row a run with one input away from its nominal value, `input` in front.
        nominal: the run with every input at its nominal value.
        given: the scenario as it was given, with its own creep law.
        elapsed: wall time [s].
    """

    out: Path
    drawn: pd.DataFrame
    alone: pd.DataFrame
    nominal: pd.Series[Any]
    given: pd.Series[Any]
    elapsed: float


@dataclass(frozen=True)
class Plan:
    """Which runs a study consists of.

    scenario: recorded for what is assessed; chosen: the inputs; runs: the inputs of every run by its name, in order;
    seed: of the draws; left_out: inputs that this strategy does not feel.
    """

    scenario: Scenario
    chosen: Inputs
    runs: Mapping[str, Mapping[str, float]]
    seed: int
    left_out: tuple[str, ...] = ()

    def of(self, name: str) -> Scenario:
        """The scenario of one run; errors: InputError for an unknown name."""
        if name not in self.runs:
            message = "is no run of this study"
            raise InputError.single("run", name, message, remedy="give a name such as drawn_0 of the table of runs")
        part, _, number = name.partition("_")
        seed = whole_of(self.seed, number) if part == "drawn" else None
        return changed(self.scenario, self.runs[name], seed=seed)


def plan_of(
    scenario: Scenario, *, runs: int = 200, seed: int = 1, chosen: Inputs | None = None, alone: bool = True
) -> Plan:
    """The runs of a study, without running them; arguments as `run`.

    Errors: InputError for a track without its one curve, which is what is assessed, and for no runs.
    """
    course_of({"segments": [vars(s) for s in scenario.track.segments], "cant_base": 1.5})
    if runs < 0 or (runs == 0 and not alone):
        raise InputError.single("runs", runs, "leaves nothing to run", remedy="give 1 or more")
    table = inputs() if chosen is None else dict(chosen)
    felt = {name: each for name, each in table.items() if EFFECTS[name].acts_on(scenario)}
    if not felt:
        remedy = "choose inputs of the vehicle too, such as friction"
        raise InputError.single("inputs", list(table), "are not felt by this strategy", remedy=remedy)
    base = recorded(scenario)
    nominal = {name: n for name in felt if (n := EFFECTS[name].nominal) is not None}
    values: dict[str, Mapping[str, float]] = {"given": {}, "nominal": nominal}
    if alone:
        for name, tried in levels(felt).items():
            for i, value in enumerate(tried):
                values[f"alone_{name}_{i}"] = nominal | {name: value}
    for i, drawn in enumerate(draw(felt, runs, seed) if runs else []):
        values[f"drawn_{i}"] = drawn
    return Plan(base, felt, values, seed, tuple(name for name in table if name not in felt))


def recorded(scenario: Scenario) -> Scenario:
    """The scenario with nothing recorded beyond what is assessed: 500 Hz if the step divides it, no energy.

    Its steps are explicit: halved where they would be implicit, which costs more.
    """
    step = explicit_step(scenario.vehicle, scenario.speed, scenario.step)
    interval = max(1, int(INTERVAL / step * (1.0 + 1e-9))) * step
    return scenario.replace(step=step, record_interval=interval, energy=False)


def run(
    scenario: Scenario,
    out: str | Path,
    *,
    runs: int = 200,
    seed: int = 1,
    chosen: Inputs | None = None,
    alone: bool = True,
    jobs: int | None = None,
    fresh: bool = False,
    again: str = "",
    console: Console | None = None,
) -> Robustness:
    """Run the study and write its folder, or go on with it where it ended.

    Writes `runs.csv` (a line a run, as it finishes), `plan.json` (what was asked), `percentiles.csv`,
    `correlations.csv`, `probabilities.csv`, figures as SVG and PNG and `report.html`.
    Runs that derail, or cannot begin, are rows with their outcome.

    Args:
        scenario: through one curve; its step is kept, or halved until it is explicit (`klingel.lower.explicit_step`).
        out: folder to write to; made if missing.
        runs: drawn ones; a study of more runs in the same folder goes on with those that are there.
        seed: of the draws; left_out: inputs that this strategy does not feel.
        chosen: inputs and their distributions, those of `inputs()` if not given; what acts through a
            measurement that the strategy does not take is left out.
        alone: also try each input alone.
        jobs: runs at a time; one a processor if not given.
        fresh: forget what the folder holds.
        again: command that runs one run again, for the report.
        console: to print on.

    Returns:
        The tables.

    Raises:
        InputError: as `plan_of`, for a folder that cannot be made, and one that holds another study.
        SimulationError: some runs failed in an unexpected way; the rest is written.
        KeyboardInterrupt: after Ctrl-C, once what there is has been written.
    """
    started = time.perf_counter()
    screen = console or default_console()
    plan = plan_of(scenario, runs=runs, seed=seed, chosen=chosen, alone=alone)
    folder = study_folder(out)
    rows = Rows(folder, asked(plan), ("part", "input", *plan.chosen, *FIGURES), fresh=fresh)
    pairs = {pair.name: pair.under(plan.scenario) for pair in PAIRS} if "conicity" in plan.chosen else {}
    prepare({"given": plan.scenario} | pairs, screen)
    names = list(plan.runs)
    left = [name for name in names if name not in rows]
    if len(left) < len(names):
        screen.print(f"{len(names) - len(left)} of {len(names)} runs are there already", highlight=False)
    cost: list[tuple[float, float]] = []

    def work(name: str, progress: Progress) -> None:
        began = time.thread_time()
        simulated, row = one_run(plan, name, progress)
        rows.add(name, row)
        cost.append((simulated, time.thread_time() - began))

    batch = run_all(left, work, result.progress, jobs=jobs, console=screen)
    rows.sort(names)
    table = rows.table(names)
    made = Robustness(folder, *_parts(table), time.perf_counter() - started)
    output.write(made, plan, again=again)
    output.show(screen, made, plan, cost)
    conclude(batch, folder)
    return made


def one_run(plan: Plan, name: str, progress: Progress | None = None) -> tuple[float, dict[str, float | str]]:
    """Simulated seconds and the row of one run; what cannot begin is a row too, with the reason as its outcome."""
    values = plan.runs[name]
    part, _, rest = name.partition("_")
    row: dict[str, float | str] = {"part": part, "input": rest.rpartition("_")[0] if part == "alone" else ""}
    row |= {each: values.get(each, float("nan")) for each in plan.chosen}
    simulated = 0.0
    try:
        series = result.simulate(plan.of(name), progress=progress)
        simulated = float(series["time"][-1]) if series.sizes["time"] else 0.0
        found = curving(series).row()
        figures = {figure: found[figure] for figure in FIGURES}
    except (InputError, SimulationError) as error:
        figures = {figure: "" if figure in WORDS else float("nan") for figure in FIGURES}
        figures["outcome"] = f"{REFUSED}: {error}"
    return simulated, row | figures


def _parts(table: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame, pd.Series[Any], pd.Series[Any]]:
    """Drawn, alone, nominal and given rows."""
    part = {name: rows.reset_index(drop=True) for name, rows in table.groupby("part")}
    nothing = table.iloc[:0]
    one = {
        name: part[name].iloc[0] if name in part else table.iloc[:0].reindex([0]).iloc[0]
        for name in ("nominal", "given")
    }
    return part.get("drawn", nothing), part.get("alone", nothing), one["nominal"], one["given"]


def asked(plan: Plan) -> dict[str, Any]:
    """All that the rows depend on, but how many there are."""
    return {
        "spec": lower(plan.scenario),
        "code": _code(plan.scenario.control),
        "inputs": {name: [each.kind, each.low, each.high, list(each.numbers)] for name, each in plan.chosen.items()},
        "seed": plan.seed,
        "version": klingel.__version__,
        "core": core().build_info()["source_hash"],
    }


def _code(strategy: Strategy | None) -> str:
    """Of a controller in Python, which the spec only names; empty for a strategy of blocks."""
    controller = getattr(strategy, "controller", None)
    if controller is None:
        return ""
    try:
        return inspect.getsource(type(controller))
    except (OSError, TypeError):  # typed in by hand: there is no file to read
        return type(controller).__name__
