"""The traction study, end to end: launch, stop, traction and braking in curves, patches of low adhesion, both drives.
Simulate, assess and save in threads; then tables, figures and the report."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from klingel import result
from klingel.assess.header import header_of
from klingel.assess.traction import PatchFigures, TractionFigures, patch, traction
from klingel.errors import InputError
from klingel.study import traction_output as output
from klingel.study.folder import conclude, study_folder
from klingel.study.runner import Batch, run_all
from klingel.study.screen import console as terminal
from klingel.study.traction_cases import GROUPS, PARTS, STRATEGIES, TractionRun, traction_runs
from klingel.study.traction_drives import DriveRun, curves_section, drive_runs, rig_section

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from klingel._core import Progress

DRAWN_RATE = 100.0
"""Of the series that figures are drawn from [Hz]."""


@dataclass(frozen=True)
class Finished:
    """What is kept in memory of one run: its figures and a thinned series; the whole one is on disk."""

    run: TractionRun
    figures: TractionFigures
    patch: PatchFigures | None
    series: xr.Dataset


@dataclass(frozen=True)
class TractionStudy:
    """The study's results.

    Attributes:
        out: folder with everything that was written.
        summary: one row a run, columns of `TractionFigures`.
        failed: run to the reason why it is missing.
        elapsed: wall time of the whole study [s].
    """

    out: Path
    summary: pd.DataFrame
    failed: Mapping[str, str] = field(default_factory=dict)
    elapsed: float = 0.0


def run(
    out: str | Path,
    *,
    jobs: int | None = None,
    parts: Iterable[str] = PARTS,
    strategies: Iterable[str] = STRATEGIES,
    console: Console | None = None,
) -> TractionStudy:
    """Run the study and write its folder.

    Writes `summary.csv`, one figure a run as SVG and PNG, `report.html`, and `runs/<run>.nc`; each file whole or not at
    all. Finished runs are kept if another fails or Ctrl-C comes: tables, figures and report are then made of these.

    Args:
        out: folder to write to; made if missing.
        jobs: runs at a time; one a processor if not given.
        parts: of the study, of `launch`, `stop`, `curve`, `patch`, `drives` (the five curves with DC and induction
            motors), `rig` (equations of the drives on the roller rig).
        strategies: of `solid_like`, `irw_like`.
        console: to print on.

    Returns:
        The table and what failed.

    Raises:
        InputError: the folder cannot be made, or an unknown part or strategy.
        SimulationError: some runs failed; the message names them, the rest is written.
        KeyboardInterrupt: after Ctrl-C, once the finished runs are written.
    """
    started = time.perf_counter()
    console = console or terminal(200)
    wanted, chosen = list(parts), list(strategies)
    unknown = [part for part in wanted if part not in PARTS]
    if unknown:
        raise InputError.single("parts", unknown, "not in this study", remedy=f"choose from {', '.join(PARTS)}")
    runs: dict[str, TractionRun | DriveRun] = {
        each.name: each for each in traction_runs([g for g in GROUPS if g in wanted], strategies=chosen)
    }
    if "drives" in wanted:
        runs |= {each.name: each for each in drive_runs(chosen)}
    folder = study_folder(out)

    def work(name: str, progress: Progress) -> Finished | float:
        one = runs[name]
        if isinstance(one, DriveRun):
            series = result.simulate(one.scenario(), progress=progress, strict=True)
            result.save(series, folder / "runs" / f"{name}.nc")
            return largest_displacement(series)
        series = result.simulate_spec(one.spec(), progress=progress)
        figures = traction(series, name=name, radius=one.scenario.vehicle.geometry.wheel_radius)
        passed = patch(series, *one.patch) if one.patch else None
        result.save(series, folder / "runs" / f"{name}.nc")
        interval = float(series["time"][1] - series["time"][0])
        thinned = series.isel(time=slice(None, None, max(1, round(1.0 / (DRAWN_RATE * interval)))))
        return Finished(one, figures, passed, thinned.copy(deep=True))

    batch: Batch[Finished | float] = run_all(list(runs), work, result.progress, jobs=jobs, console=console)
    done = [each for each in batch.done.values() if isinstance(each, Finished)]
    largest = {name: each for name, each in batch.done.items() if isinstance(each, float)}
    sections = [curves_section(largest)] if largest else []
    if "rig" in wanted and not batch.interrupted:
        with console.status("roller rig: equations of the drives"):
            sections.append(rig_section())
    table = output.summary(done)
    output.write(folder, done, table, sections, failed=batch.failed)
    study = TractionStudy(folder, table, batch.failed, time.perf_counter() - started)
    output.show(console, table, folder, study.elapsed)
    conclude(batch, folder)
    return study


def largest_displacement(series: xr.Dataset) -> float:
    """Of any wheelset in a run [m]."""
    return max(float(np.abs(series[f"{w.name}.y"]).max()) for w in header_of(series).wheelsets)
