"""What a comparison leaves behind: three tables as CSV, figures as SVG and PNG, one page, tables on the screen.
Every file is written whole or not at all; the same results give the same bytes, measured run times apart."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from rich import box
from rich.markup import escape
from rich.table import Table

import klingel
from klingel.assess import COLUMNS, Assessment
from klingel.plot.style import looks_of
from klingel.report.compare import HEADINGS, ComparePage, Curve, Entry, compare_report, shown, straight_cells
from klingel.study.compare_straight import COLUMNS as STRAIGHT_COLUMNS
from klingel.study.compare_straight import MARGINS, Row, Straight
from klingel.study.folder import History, write_curving_figures, write_table
from klingel.study.screen import WORDS, print_runs

if TYPE_CHECKING:
    from rich.console import Console

    from klingel.study.compare_cases import Contender
    from klingel.track.cases import Case

SHOWN = (
    "strategy", "curve", "speed_kmh", "y_max_mm", "y_curve_mm", "attack_angle_max_mrad", "lateral_force_max_kN",
    "lateral_force_floor_kN", "wear_index_N", "actuator_force_max_kN", "contact_angle_max_deg", "flange_contact",
    "outcome", "realtime_factor",
)  # fmt: skip
"""Columns on the screen; the file has all."""

OUT_OF_SCALE = 2.0
"""A history larger than so many times the median of all has a scale of its own."""

CAPTIONS = {
    "fig15": "Lateral displacement of the wheelsets from the track centre line. Grey: transitions, and darker the arc, "
    "as the leading wheelset passes them. What runs out much further than the others has its own scale.",
    "fig16": "Largest lateral displacement of any wheelset, from 1 s before the curve to 3 s after it.",
    "fig17": "Largest attack angle of any wheelset, its yaw to the local tangent of the track.",
    "fig18": "Largest lateral force of any wheelset on the track. Dotted: the least achievable, a wheelset's share of "
    "the vehicle's mass times the unbalanced lateral acceleration in the arc.",
    "fig19": "Wear index, the mean over all wheels of |Fx ξ| + |Fy η| in the arc.",
}
"""Below the figures."""


def comparison(rows: Iterable[tuple[Contender, Case, Assessment | None, str]]) -> pd.DataFrame:
    """One row a strategy and curve: `strategy`, `curve`, then the columns of `klingel.assess.COLUMNS`.

    rows: contender, curve, its assessment if there is one, and its outcome.
    """
    records = []
    for contender, case, assessment, outcome in rows:
        row: Row = {"strategy": contender.name, "curve": case.track.name}
        if assessment is None:
            row |= dict.fromkeys(COLUMNS, float("nan"))
            row |= {"flange_contact": "", "notes": "", "outcome": outcome}
        else:
            row |= assessment.row()
        row |= {"vehicle": contender.scenario.vehicle.name, "radius_m": case.radius}
        records.append(row | {"speed_kmh": round(3.6 * case.speed, 6)})
    return pd.DataFrame(records, columns=["strategy", "curve", *COLUMNS])


@dataclass(frozen=True)
class Tables:
    """runs: one row a strategy and curve; straight, margins: stability and margins on straight track."""

    runs: pd.DataFrame
    straight: pd.DataFrame
    margins: pd.DataFrame


def stability(found: Iterable[Straight]) -> pd.DataFrame:
    """The least damped modes of all strategies on straight track."""
    return pd.DataFrame([row for each in found for row in each.stability], columns=list(STRAIGHT_COLUMNS))


def margins(found: Iterable[Straight]) -> pd.DataFrame:
    """The least margins of all strategies on straight track."""
    return pd.DataFrame([row for each in found for row in each.margins], columns=list(MARGINS))


def write(
    folder: Path,
    contenders: Sequence[Contender],
    cases: Sequence[Case],
    tables: Tables,
    histories: Mapping[str, History],
    failed: Mapping[str, str],
) -> None:
    """`summary.csv`, `straight.csv`, `margins.csv`, the figures and `report.html`."""
    for name, table in (("summary", tables.runs), ("straight", tables.straight), ("margins", tables.margins)):
        write_table(folder / f"{name}.csv", table)
    looks = looks_of({c.name: c.label for c in contenders})
    ordered = {c.name: histories[c.name] for c in contenders if c.name in histories}
    drawn = tables.runs[tables.runs["y_max_mm"].notna()]
    figures = write_curving_figures(folder, drawn, ordered, looks=looks, by="strategy", apart=far_out(ordered))
    page = ComparePage(
        entries=[Entry(c.name, looks[c.name].label, c.scenario) for c in contenders],
        curves=[Curve(case.track, case.radius, case.speed) for case in cases],
        table=tables.runs,
        straight=tables.straight,
        margins=tables.margins,
        figures=figures,
        captions=CAPTIONS,
        failed=failed,
        version=klingel.__version__,
    )
    compare_report(page).save(folder / "report.html")


def far_out(histories: Mapping[str, History]) -> set[str]:
    """Those whose displacements would dwarf the others in a common scale."""
    largest = {
        name: max(float(np.abs(history.displacement[f"{w}.y"]).max()) for w in history.wheelsets)
        for name, history in histories.items()
    }
    usual = statistics.median_low(largest.values()) if largest else 0.0
    return {name for name, y in largest.items() if not y <= OUT_OF_SCALE * usual}


def show(screen: Console, table: pd.DataFrame, straight: pd.DataFrame, folder: Path, elapsed: float) -> None:
    """Print both tables."""
    table = table.assign(outcome=[shown("outcome", outcome) for outcome in table["outcome"]])
    print_runs(screen, table, "Comparison", SHOWN, headings=HEADINGS, words=("strategy", "curve", *WORDS))
    rows, heads = straight_cells(straight)
    screen.print("Least damping on straight track, of modes that the controllers change", style="bold")
    made = Table(box=box.SIMPLE_HEAD)
    for i, head in enumerate(heads):
        made.add_column(escape(head), justify="right" if i else "left")
    for row in rows:
        made.add_row(*(escape(cell) for cell in row))
    screen.print(made)
    screen.print(
        f"{len(table)} {'run' if len(table) == 1 else 'runs'} in {elapsed:.1f} s, written to {folder}", highlight=False
    )
