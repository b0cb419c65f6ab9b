"""What the study of single errors leaves behind: one table, one figure, one page, and a summary on the screen.
Every file is written whole or not at all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import pandas as pd
from rich import box
from rich.table import Table

import klingel
from klingel.plot.errors import errors_figure
from klingel.report.sections import Listed, Picture, Section, sections_report
from klingel.study.folder import write_figure, write_table

if TYPE_CHECKING:
    from rich.console import Console

    from klingel.study.errors import Withstood

COLUMNS = (
    "strategy", "error", "curve", "radius_m", "touched", "y_max_mm", "y_curve_mm", "attack_angle_max_mrad",
    "lateral_force_max_kN", "flange_contact", "outcome",
)  # fmt: skip

ABOUT = (
    "Every strategy goes through every curve with one error at a time. A cell is the largest displacement of any "
    "wheelset; contact of the root or the flank of the flange is named. An error that touches nothing that a strategy "
    "measures leaves it as it is: its cells stand in brackets.",
    "The strategy is designed for the vehicle without the error. Delay is that of all measurements that steer, beside "
    "the samples that the strategy itself has; currents are measured inside the drives and come in time.",
)


def table(rows: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """The rows, columns `COLUMNS`."""
    return pd.DataFrame(list(rows), columns=list(COLUMNS))


def write(made: Withstood, errors: Iterable[str]) -> None:
    """Table, figure and page of what is finished."""
    write_table(made.out / "summary.csv", made.table)
    if made.table.empty:
        return
    svg = write_figure(made.out, "errors", errors_figure(made.table))
    listed = [Listed("Strategies without flange contact in any of the curves", _robust(made))]
    listed += [Listed(str(name), _wide(rows)) for name, rows in made.table.groupby("strategy", sort=False)]
    caption = "Largest displacement by error and curve; bold and underlined: the flange carries; ×: not completed."
    section = Section(
        "What each strategy withstands", ABOUT, tables=tuple(listed), pictures=(Picture("errors", svg, caption),)
    )
    page = sections_report(
        [section],
        title="Each error alone",
        subtitle="Unequal wheels, delay, curvature, position, noise",
        version=klingel.__version__,
    )
    page.save(made.out / "report.html")


def show(screen: Console, made: Withstood) -> None:
    """Print who withstands what."""
    shown = Table(
        title="Without flange contact in any curve", title_justify="left", title_style="bold", box=box.SIMPLE_HEAD
    )
    for name in ("error", "strategies"):
        shown.add_column(name)
    for row in _robust(made).itertuples(index=False):
        shown.add_row(*row)
    screen.print(shown)
    screen.print(f"{len(made.table)} results in {made.elapsed:.0f} s; {made.out / 'report.html'}", highlight=False)


def _robust(made: Withstood) -> pd.DataFrame:
    rows = [(error, "; ".join(names) or "none") for error, names in made.robust().items()]
    return pd.DataFrame(rows, columns=["error", "strategies"])


def _wide(rows: pd.DataFrame) -> pd.DataFrame:
    """Errors down, curves across; cells in words."""
    made: dict[str, list[str]] = {"error": list(dict.fromkeys(rows["error"]))}
    for curve, column in rows.groupby("curve", sort=False):
        cells = {row.error: _cell(row) for row in column.itertuples()}
        made[f"{curve} [mm]"] = [cells.get(error, "-") for error in made["error"]]
    return pd.DataFrame(made)


def _cell(row: Any) -> str:
    words = f"{row.y_max_mm:.2f}"
    if row.outcome != "completed":
        words = str(row.outcome)
    elif row.flange_contact:
        words += f" {row.flange_contact}"
    return words if row.touched else f"({words})"
