"""The folder that a study leaves behind: made at the start, its tables and figures whole or not at all.
Also how a study ends: what is missing is said, what is finished stays."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from klingel.assess.header import Course, header_of
from klingel.errors import InputError, SimulationError
from klingel.plot import FIGURES, LOOKS, Look, displacement_history, per_radius, render
from klingel.report.files import write_whole

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from klingel.study.runner import Batch

HISTORY_INTERVAL = 5e-3
"""Between the samples of a history [s]; the motion of wheelsets has nothing faster to show."""


@dataclass(frozen=True)
class History:
    """What Fig. 15 needs of one run: displacement and position of the wheelsets, the curve, and the speed [m/s]."""

    displacement: xr.Dataset
    wheelsets: tuple[str, ...]
    course: Course
    speed: float


def history_of(series: xr.Dataset) -> History:
    """The displacements of a run, thinned to 200 Hz."""
    header = header_of(series)
    names = tuple(wheelset.name for wheelset in header.wheelsets)
    channels = [f"{name}.{quantity}" for name in names for quantity in ("y", "s")]
    interval = float(series["time"][1] - series["time"][0])
    stride = max(1, round(HISTORY_INTERVAL / interval))
    return History(series[channels].isel(time=slice(None, None, stride)).copy(), names, header.course, header.speed)


def study_folder(out: str | Path) -> Path:
    """The folder of a study with `runs` inside, made if missing; errors: InputError where it cannot be made."""
    folder = Path(out)
    try:
        (folder / "runs").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError.single(
            "out", str(out), f"cannot be made a folder ({error.strerror})", remedy="choose another folder"
        ) from None
    return folder


def write_table(path: Path, table: pd.DataFrame) -> Path:
    """A table as CSV with six digits."""
    return write_whole(path, table.to_csv(index=False, float_format="%.6g", lineterminator="\n").encode())


def write_figure(folder: Path, name: str, figure: Figure) -> bytes:
    """A figure as SVG and PNG; returns the SVG."""
    svg = render(figure, "svg", name=name)
    write_whole(folder / f"{name}.svg", svg)
    write_whole(folder / f"{name}.png", render(figure, "png", name=name))
    return svg


def write_curving_figures(
    folder: Path,
    table: pd.DataFrame,
    histories: Mapping[str, History],
    *,
    looks: Mapping[str, Look] = LOOKS,
    by: str = "vehicle",
    apart: Collection[str] = ("passive",),
) -> dict[str, bytes]:
    """`fig15` to `fig19` as SVG and PNG, as far as their runs exist; returns the SVG files by name.

    table: one row a run, columns of `klingel.assess.COLUMNS`; by: its column with what is compared; looks: how each of
    these is drawn; histories: of the curve of Fig. 15; apart: those of them with a scale of their own.
    """
    figures = {}
    if histories:
        one = next(iter(histories.values()))
        figures["fig15"] = displacement_history(
            {name: history.displacement for name, history in histories.items()},
            one.wheelsets,
            one.course,
            caption=f"R = {1.0 / abs(one.course.curvature):.0f} m, {3.6 * one.speed:.0f} km/h",
            looks=looks,
            apart=apart,
        )
    if len(table):
        figures |= {name: per_radius(table, name, looks=looks, by=by) for name in FIGURES}
    return {name: write_figure(folder, name, figure) for name, figure in figures.items()}


def conclude(batch: Batch[Any], folder: Path) -> None:
    """Raises what ended a study early, or what is missing in it.

    Errors: KeyboardInterrupt after Ctrl-C, saying how many runs are kept and where; SimulationError with every failure.
    """
    asked = len(batch.done) + len(batch.failed)
    if batch.interrupted:
        raise KeyboardInterrupt(f"{len(batch.done)} of {asked} runs are kept in {folder}")
    if batch.failed:
        listed = "\n".join(f"  {name}: {reason}" for name, reason in batch.failed.items())
        raise SimulationError(f"{len(batch.failed)} of {asked} runs failed, the rest is in {folder}\n{listed}")
