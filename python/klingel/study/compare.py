"""Strategies beside each other: any of them, one's own included, through any curves; one table, five figures, one page.
Simulate, assess and save in threads; what fails is a row with its reason and stops nothing else."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from klingel import result
from klingel.assess import Assessment, curving
from klingel.assess.curving import SAMPLES_MIN
from klingel.plot.style import looks_of
from klingel.study import compare_output as output
from klingel.study.compare_cases import contenders, slug
from klingel.study.compare_curves import curves as cases_of
from klingel.study.compare_straight import Straight, on_straight
from klingel.study.folder import History, history_of, study_folder
from klingel.study.perez2004 import HISTORY_RADIUS
from klingel.study.runner import Batch, run_all
from klingel.study.screen import console as terminal
from klingel.study.screen import prepare

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from klingel._core import Progress
    from klingel.track.cases import Case
    from klingel.units import Quantity
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Finished:
    """What is kept in memory of one run; its time series are on disk.

    assessment: None of a run that ended before there was anything to assess; outcome: how it ended.
    """

    assessment: Assessment | None
    history: History | None
    outcome: str


@dataclass(frozen=True)
class Comparison:
    """What came out.

    Attributes:
        out: folder with everything that was written.
        table: one row a strategy and curve: `strategy`, `curve` and the columns of `klingel.assess.COLUMNS`; a run that
            could not be made, or ended at once, has its reason as `outcome` and no figures.
        straight: stability on straight track, one row a strategy and speed (`klingel.study.compare_straight`).
        margins: of the loops on straight track, one row a strategy, speed and kind of loop (same place).
        failed: run to the reason why it has no figures.
        elapsed: wall time of it all [s].
    """

    out: Path
    table: pd.DataFrame
    straight: pd.DataFrame
    margins: pd.DataFrame
    failed: Mapping[str, str] = field(default_factory=dict)
    elapsed: float = 0.0


def compare(
    strategies: Mapping[str, Any] | Iterable[str],
    *,
    curves: Iterable[float | str | Case] | None = None,
    out: str | Path = "out/compare",
    vehicle: str | Vehicle | None = None,
    settings: Mapping[str, Quantity] | None = None,
    jobs: int | None = None,
    console: Console | None = None,
) -> Comparison:
    """Run every strategy through every curve, and write and print how they compare.

    Writes `summary.csv`, `straight.csv`, `margins.csv`, `fig15` to `fig19` as SVG and PNG, `report.html`, and
    `runs/<run>.nc` for every run; each file whole or not at all.

    Args:
        strategies: name to a Strategy, None for no control, a Scenario (its track and speed are replaced) or a text; or
            texts alone, as `klingel.study.compare_cases.contenders` reads them: `irw_like`, `irw_like:frequency=1.2`,
            `file.py:Name`, `scenario.toml`. Each is run on the vehicle it is made for.
        curves: radii of the five curves of Perez et al. (2004) [m], texts such as `R=500,cant=160 mm,speed=140 km/h`,
            scenario files or Cases; the five if not given.
        out: folder to write to; made if missing.
        vehicle: for all strategies that do not say their own, of the library, of a file or as it is.
        settings: numbers of all scenarios by dotted path, such as `{"friction": 0.3}`.
        jobs: runs at a time; one a processor if not given.
        console: to print on.

    Returns:
        The tables and what failed.

    Raises:
        InputError: an unknown strategy or curve, a strategy that does not fit its vehicle, no folder.
        KeyboardInterrupt: after Ctrl-C, once the finished runs are written, saying how many and where.

    Example:
        >>> compare(["solid_lik"])
        Traceback (most recent call last):
        ...
        klingel.errors.InputError: control.strategy = 'solid_lik': is not known; did you mean 'solid_like'?
    """
    started = time.perf_counter()
    screen = console or terminal(170)
    cases = cases_of(curves)
    compared = contenders(strategies, cases[0], vehicle=vehicle, settings=settings)
    looks_of({c.name: c.label for c in compared})  # refuses too many before anything runs
    folder = study_folder(out)
    runs = {f"{slug(c.name)}_{case.track.name}": (c, case) for c in compared for case in cases}
    straights = {f"{slug(c.name)}, straight track": c for c in compared}
    shown = history_case(cases)

    def work(task: str, progress: Progress) -> Finished | Straight:
        if task in straights:
            return on_straight(straights[task], sorted({case.speed for case in cases}))
        contender, case = runs[task]
        series = result.simulate(contender.through(case), progress=progress)
        outcome = str(series.attrs["outcome"])
        if series.sizes["time"] < SAMPLES_MIN:
            return Finished(None, None, outcome)
        assessment = curving(series, vehicle=contender.scenario.vehicle.name)
        result.save(series, folder / "runs" / f"{task}.nc")
        return Finished(assessment, history_of(series) if case is shown else None, outcome)

    prepare({c.name: c.scenario for c in compared}, screen)
    batch: Batch[Finished | Straight] = run_all([*runs, *straights], work, result.progress, jobs=jobs, console=screen)
    table = output.comparison([(*runs[task], *_came_out(batch, task)) for task in runs])
    found = [each for task in straights if isinstance(each := batch.done.get(task), Straight)]
    straight, margins = output.stability(found), output.margins(found)
    histories = {
        runs[task][0].name: done.history
        for task, done in batch.done.items()
        if isinstance(done, Finished) and done.history is not None
    }
    failed = {task: reason for task, reason in batch.failed.items() if task in runs}
    failed |= {t: done.outcome for t, done in batch.done.items() if isinstance(done, Finished) and not done.assessment}
    output.write(folder, compared, cases, output.Tables(table, straight, margins), histories, failed)
    elapsed = time.perf_counter() - started
    output.show(screen, table, straight, folder, elapsed)
    if batch.interrupted:
        made = len(runs) - len(failed)
        raise KeyboardInterrupt(f"{made} of {len(runs)} runs are kept in {folder}")
    return Comparison(folder, table, straight, margins, failed, elapsed)


def history_case(cases: list[Case]) -> Case:
    """The curve of Fig. 15: that of the paper's if it is there, else the middle one."""
    wanted = [case for case in cases if math.isclose(case.radius, HISTORY_RADIUS)]
    return wanted[0] if wanted else cases[len(cases) // 2]


def _came_out(batch: Batch[Finished | Straight], task: str) -> tuple[Assessment | None, str]:
    """The figures of a run, if there are any, and how it ended."""
    done = batch.done.get(task)
    return (done.assessment, done.outcome) if isinstance(done, Finished) else (None, f"no run: {batch.failed[task]}")
