"""Each error alone, strategy by strategy, curve by curve: which strategy withstands what without flange contact.
Unequal wheels, delay, a wrong curvature, a wrong position and noise, as large as an engineer fears them."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from klingel import result
from klingel.assess import curving
from klingel.errors import InputError
from klingel.study import errors_output as output
from klingel.study.compare_cases import Contender, contenders, slug
from klingel.study.compare_curves import curves as cases_of
from klingel.study.folder import conclude, study_folder
from klingel.study.robustness import recorded
from klingel.study.robustness_effects import EFFECTS, changed
from klingel.study.runner import run_all
from klingel.study.screen import console as terminal
from klingel.study.screen import prepare

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from klingel._core import Progress
    from klingel.scenario import Scenario
    from klingel.track.cases import Case

STRATEGIES = (
    "S=solid_like",
    "I gyros=irw_like",
    "I database=irw_like:curvature=database",
    "trailed gyros=trailed_irw",
)
"""Those tried unless told otherwise, as `klingel.study.compare_cases.contenders` reads them."""

FIGURES = ("y_max_mm", "y_curve_mm", "attack_angle_max_mrad", "lateral_force_max_kN", "flange_contact", "outcome")
"""What is kept of each run, of `klingel.assess.COLUMNS`."""


@dataclass(frozen=True)
class Fault:
    """An error in words, and the inputs of `klingel.study.robustness_effects` that make it."""

    words: str
    inputs: Mapping[str, float]

    def meets(self, scenario: Scenario) -> bool:
        """Whether it touches the vehicle or anything that the strategy measures."""
        return all(EFFECTS[name].acts_on(scenario) for name in self.inputs)


ERRORS = (
    Fault("none", {}),
    Fault("right wheels 0.5 mm larger", {"radius_mismatch": 0.5e-3}),
    Fault("right wheels 0.5 mm smaller", {"radius_mismatch": -0.5e-3}),
    Fault("30 ms more delay", {"delay": 0.030}),
    Fault("curvature 10 % too large", {"curvature_error": 0.1}),
    Fault("curvature 10 % too small", {"curvature_error": -0.1}),
    Fault("believes to be 30 m behind", {"position_error": -30.0}),
    Fault("encoder noise 0.02 rad/s", {"encoder_noise": 0.02}),
)
"""Each is tried alone; sizes are those that this project asks its strategies to withstand."""


@dataclass(frozen=True)
class Withstood:
    """What came out.

    Attributes:
        out: folder with everything that was written.
        table: one row a strategy, error and curve: `strategy`, `error`, `curve`, `radius_m`, `FIGURES`; where an error
            touches nothing that the strategy measures the figures are those without error and `touched` is False.
        elapsed: wall time [s].
    """

    out: Path
    table: pd.DataFrame
    elapsed: float

    def robust(self) -> dict[str, list[str]]:
        """Of every error the strategies that no curve brings to flange contact."""
        good = self.table["flange_contact"].eq("") & self.table["outcome"].eq("completed")
        holds = good.groupby([self.table["error"], self.table["strategy"]], sort=False).all()
        return {
            error: [s for s in holds[error].index if holds[error, s]] for error in dict.fromkeys(self.table["error"])
        }


def run(
    out: str | Path,
    *,
    strategies: Mapping[str, Any] | Iterable[str] = STRATEGIES,
    curves: Iterable[float | str | Case] | None = None,
    faults: Iterable[Fault] = ERRORS,
    jobs: int | None = None,
    console: Console | None = None,
) -> Withstood:
    """Run every strategy with every error through every curve, and write and print who withstands what.

    Writes `summary.csv`, `errors` as SVG and PNG and `report.html`, each whole or not at all.

    Args:
        out: folder to write to; made if missing.
        strategies, curves: as `klingel.study.compare`; the five curves if not given.
        faults: to try, each alone.
        jobs: runs at a time; one a processor if not given.
        console: to print on.

    Returns:
        The table.

    Raises:
        InputError: as `klingel.study.compare`.
        SimulationError: some runs failed in an unexpected way; the rest is written.
        KeyboardInterrupt: after Ctrl-C, once the finished runs are written.
    """
    started = time.perf_counter()
    screen = console or terminal()
    cases, tried = cases_of(curves), tuple(faults)
    compared = contenders(strategies, cases[0])
    if not tried:
        raise InputError.single("faults", None, "there is no error to try", remedy="leave it out for all")
    folder = study_folder(out)
    runs = {
        f"{slug(c.name)}_{slug(fault.words)}_{case.track.name}": (c, fault, case)
        for c in compared
        for fault in tried
        for case in cases
        if not fault.inputs or fault.meets(c.scenario)
    }

    def work(task: str, progress: Progress) -> dict[str, Any]:
        contender, fault, case = runs[task]
        scenario = changed(recorded(contender.through(case)), fault.inputs)
        found = curving(result.simulate(scenario, progress=progress)).row()
        return {figure: found[figure] for figure in FIGURES}

    prepare({c.name: c.scenario for c in compared}, screen)
    batch = run_all(list(runs), work, result.progress, jobs=jobs, console=screen)
    done = {_key(*runs[task]): figures for task, figures in batch.done.items()}
    table = output.table(_rows(compared, tried, cases, done))
    made = Withstood(folder, table, time.perf_counter() - started)
    output.write(made, [fault.words for fault in tried])
    output.show(screen, made)
    conclude(batch, folder)
    return made


def _key(contender: Contender, fault: Fault, case: Case) -> tuple[str, str, str]:
    return contender.name, fault.words, case.track.name


def _rows(
    compared: Iterable[Contender], tried: Iterable[Fault], cases: Iterable[Case], done: Mapping[Any, Mapping[str, Any]]
) -> Iterable[dict[str, Any]]:
    """A row a strategy, error and curve that finished; what an error does not touch is as without it."""
    cases, tried = list(cases), list(tried)
    nothing = next((fault for fault in tried if not fault.inputs), None)
    for contender in compared:
        for fault in tried:
            touched = not fault.inputs or fault.meets(contender.scenario)
            source = fault if touched or nothing is None else nothing
            for case in cases:
                if (figures := done.get(_key(contender, source, case))) is not None:
                    head = {"strategy": contender.name, "error": fault.words, "curve": case.track.name}
                    yield head | {"radius_m": case.radius, "touched": touched, **figures}
