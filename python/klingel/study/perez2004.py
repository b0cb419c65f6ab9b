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
from klingel.assess.header import Course, header_of
from klingel.errors import InputError, SimulationError
from klingel.study import output
from klingel.study.cases import MAIN, VEHICLES, Run, study_runs
from klingel.study.runner import Batch, run_all

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from klingel._core import Progress

HISTORY_RADIUS = 800.0
"""The curve of Fig. 15 [m]."""


@dataclass(frozen=True)
class History:
    """What Fig. 15 needs of one run: displacement and position of the wheelsets, the curve, and the speed [m/s]."""

    displacement: xr.Dataset
    wheelsets: tuple[str, ...]
    course: Course
    speed: float


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
    console = console or _console()
    runs = {
        each.name: each
        for each in study_runs(
            radii, vehicles=vehicles, friction_variants=friction_variants, database_variant=database_variant
        )
    }
    folder = _folder(Path(out))

    def work(name: str, progress: Progress) -> Finished:
        one = runs[name]
        series = result.simulate(one.scenario(), progress=progress)
        assessment = curving(series, vehicle=one.vehicle)
        result.save(series, folder / "runs" / f"{name}.nc")
        return Finished(one, assessment, _history(series, one))

    _prepare(runs, console)
    batch = run_all(list(runs), work, result.progress, jobs=jobs, console=console)
    study = _written(folder, runs, batch, started, console)
    if batch.interrupted:
        raise KeyboardInterrupt(f"{len(batch.done)} of {len(runs)} runs are kept in {folder}")
    if batch.failed:
        listed = "\n".join(f"  {name}: {reason}" for name, reason in batch.failed.items())
        raise SimulationError(f"{len(batch.failed)} of {len(runs)} runs failed, the rest is in {folder}\n{listed}")
    return study


def _prepare(runs: Mapping[str, Run], console: Console) -> None:
    """Have the contact tables ready before the threads start, and say what that took."""
    with console.status("contact tables: compiling, some seconds for a new pair"):
        for one in runs.values():
            for table in result.prepare(one.scenario()):
                if table.origin != "memory":
                    console.print(f"{one.vehicle}: {table}", highlight=False)


def _console() -> Console:
    """The terminal; a file or pipe gets lines long enough for the tables."""
    console = Console()
    return console if console.is_terminal else Console(width=150)


def _folder(out: Path) -> Path:
    """The folder of the study, with its `runs` inside."""
    try:
        (out / "runs").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError.single(
            "out", str(out), f"cannot be made a folder ({error.strerror})", remedy="choose another folder"
        ) from None
    return out


def _history(series: xr.Dataset, one: Run) -> History | None:
    """The displacements of a main run through the curve of Fig. 15, thinned to 200 Hz."""
    if one.variant != MAIN or one.case.radius != HISTORY_RADIUS:
        return None
    header = header_of(series)
    names = tuple(wheelset.name for wheelset in header.wheelsets)
    channels = [f"{name}.{quantity}" for name in names for quantity in ("y", "s")]
    interval = float(series["time"][1] - series["time"][0])
    stride = max(1, round(5e-3 / interval))
    return History(series[channels].isel(time=slice(None, None, stride)).copy(), names, header.course, header.speed)


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
    figures = output.write_figures(folder, summary, {v: histories[v] for v in VEHICLES if v in histories})
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
