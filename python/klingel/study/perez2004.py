"""The curving study of Perez et al. 2004, end to end: three vehicles, five curves, one folder of results.
Simulate, assess and save in threads; then tables, figures and the report."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from klingel import library, result
from klingel.assess import Assessment, curving
from klingel.study import output
from klingel.study.cases import MAIN, VEHICLES, Run, study_runs
from klingel.study.folder import History, conclude, history_of, study_folder, write_curving_figures
from klingel.study.runner import Batch, run_all
from klingel.study.screen import console as terminal
from klingel.study.screen import prepare

if TYPE_CHECKING:
    import pandas as pd

    from klingel._core import Progress

HISTORY_RADIUS = 800.0
"""The curve of Fig. 15 [m]."""


@dataclass(frozen=True)
class Finished:
    """What is kept in memory of one run; its time series are on disk."""

    run: Run
    assessment: Assessment
    history: History | None


@dataclass(frozen=True)
class Study:
    """The study's results.

    Attributes:
        out: folder with everything that was written.
        summary: main runs, columns of `klingel.assess.COLUMNS`.
        variants: the runs beside them, with `variant` and `friction` in front.
        failed: run to the reason why it is missing.
        elapsed: wall time of the whole study [s].
    """

    out: Path
    summary: pd.DataFrame
    variants: pd.DataFrame
    failed: Mapping[str, str] = field(default_factory=dict)
    elapsed: float = 0.0


def run(
    out: str | Path,
    *,
    jobs: int | None = None,
    radii: Iterable[float] | None = None,
    vehicles: Iterable[str] = VEHICLES,
    friction_variants: bool = True,
    database_variant: bool = True,
    console: Console | None = None,
) -> Study:
    """Run the study and write its folder.

    Writes `summary.csv`, `summary_variants.csv`, `table1.csv`, `fig15` to `fig19` as SVG and PNG, `report.html`, and
    `runs/<run>.nc` for every run; each file whole or not at all. Finished runs are kept if another fails or Ctrl-C
    comes: tables, figures and report are then made of what there is.

    Args:
        out: folder to write to; made if missing.
        jobs: runs at a time; one a processor if not given.
        radii: curves to run, all five if not given [m].
        vehicles: to run, of `passive`, `solid_like`, `irw_like`.
        friction_variants: also run at friction 0.30 and 0.25.
        database_variant: also run `irw_like` with the curvature from the track database.
        console: to print on.

    Returns:
        The tables and what failed.

    Raises:
        InputError: the folder cannot be made, or an unknown radius or vehicle.
        SimulationError: some runs failed; the message names them, the rest is written.
        KeyboardInterrupt: after Ctrl-C, once the finished runs are written, saying how many and where.
    """
    started = time.perf_counter()
    console = console or terminal()
    runs = {
        each.name: each
        for each in study_runs(
            radii, vehicles=vehicles, friction_variants=friction_variants, database_variant=database_variant
        )
    }
    folder = study_folder(out)

    def work(name: str, progress: Progress) -> Finished:
        one = runs[name]
        series = result.simulate(one.scenario(), progress=progress)
        assessment = curving(series, vehicle=one.vehicle)
        result.save(series, folder / "runs" / f"{name}.nc")
        shown = one.variant == MAIN and one.case.radius == HISTORY_RADIUS
        return Finished(one, assessment, history_of(series) if shown else None)

    prepare({name: one.scenario() for name, one in runs.items()}, console)
    batch = run_all(list(runs), work, result.progress, jobs=jobs, console=console)
    study = _written(folder, runs, batch, started, console)
    conclude(batch, folder)
    return study


def _written(folder: Path, runs: Mapping[str, Run], batch: Batch[Finished], started: float, console: Console) -> Study:
    """Tables, figures and report of the finished runs, written and printed."""
    done = list(batch.done.values())
    if not done:
        return Study(folder, output.summary([]), output.variants([]), batch.failed)
    summary = output.summary([(f.run, f.assessment) for f in done if f.run.variant == MAIN])
    variants = output.variants([(f.run, f.assessment) for f in done if f.run.variant != MAIN])
    speeds = sorted({each.case.speed for each in runs.values()})
    points = output.operating_points(library.vehicle("mechatronic_irw"), speeds)
    histories = {f.run.vehicle: f.history for f in done if f.history is not None}
    loads = {f.run.vehicle: f.assessment.static_wheel_loads for f in done if f.run.variant == MAIN}
    output.write_tables(folder, summary, variants, points)
    figures = write_curving_figures(folder, summary, {v: histories[v] for v in VEHICLES if v in histories})
    output.write_report(
        folder,
        summary=summary,
        variants=variants,
        figures=figures,
        points=points,
        loads={v: loads[v] for v in VEHICLES if v in loads},
        scenario=done[0].run.scenario(),
        failed=batch.failed,
        runs=len(runs),
        history_radius=HISTORY_RADIUS,
    )
    elapsed = time.perf_counter() - started
    output.show(console, summary, variants, points, folder, elapsed)
    return Study(folder, summary, variants, batch.failed, elapsed)
