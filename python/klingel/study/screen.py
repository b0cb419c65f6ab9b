"""What studies print: tables of runs, and that contact tables are being compiled.
A terminal gets its own width, a file or pipe lines long enough for the tables."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from klingel import result
from klingel.report.columns import HEADINGS, Heading, cell

if TYPE_CHECKING:
    import pandas as pd

    from klingel.contact import Prepared
    from klingel.scenario import Scenario

WORDS = ("vehicle", "flange_contact", "outcome")
"""Columns of words, which stand on the left."""


def console(width: int = 150) -> Console:
    """The terminal; a file or pipe gets lines of that width."""
    made = Console()
    return made if made.is_terminal else Console(width=width)


def prepare(scenarios: Mapping[str, Scenario], screen: Console) -> None:
    """Have the contact tables ready before the threads start, and say what that took; scenarios by their titles.

    Those that cannot be made are passed over: their runs fail for the same reason, and are booked with it.
    """
    with screen.status("contact tables: compiling, some seconds for a new pair"):
        for title, scenario in scenarios.items():
            for table in _prepared(scenario):
                if table.origin != "memory":
                    screen.print(f"{title}: {table}", highlight=False)


def _prepared(scenario: Scenario) -> list[Prepared]:
    try:
        return result.prepare(scenario)
    except Exception:  # whatever a user's strategy does
        return []


def print_runs(
    screen: Console,
    rows: pd.DataFrame,
    title: str,
    columns: Sequence[str],
    *,
    headings: Mapping[str, Heading] = HEADINGS,
    words: Collection[str] = WORDS,
) -> None:
    """A table of runs, with a rule where its first column changes."""
    table = Table(
        title=escape(title), title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0)
    )
    for name in columns:
        heading = headings[name]
        label = f"{heading.name}\n{heading.unit}" if heading.unit else heading.name
        table.add_column(escape(label), justify="left" if name in words else "right")
    previous = None
    for row in rows.to_dict("records"):
        first = row[columns[0]]
        if previous not in (None, first):
            table.add_section()
        previous = first
        table.add_row(*(escape(cell(name, row[name])) for name in columns))
    screen.print(table)
