"""What commands write and print: files whole or not at all, tables as wide as the terminal, in a pipe as they are.
Files that cannot be written are refused before anything is computed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from rich.status import Status
    from rich.table import Table

TableFile = Annotated[Path | None, typer.Option("--table", help="Also write the table (.csv).", dir_okay=False)]

UNBOUNDED = 10_000
"""Characters: more than any table needs."""

ENDS = {"page": (".html", ".htm"), "picture": (".png", ".svg")}


def check(out: Path, *kinds: Literal["page", "picture"]) -> None:
    """Refuses a file that cannot be written before anything is computed."""
    from klingel.errors import InputError

    ends = [end for kind in kinds for end in ENDS[kind]]
    if out.suffix not in ends:
        raise InputError.single("out", str(out), f"is no {' or '.join(kinds)}", remedy=f"end it in {', '.join(ends)}")
    if not out.parent.is_dir():
        raise InputError.single("out", str(out), "has no folder to be written to", remedy="make it, or choose another")


def check_table(table: Path | None) -> None:
    from klingel.errors import InputError

    if table is not None and not table.parent.is_dir():
        raise InputError.single("table", str(table), "has no folder to be written to", remedy="make it first")


@contextmanager
def working(what: str) -> Iterator[Status]:
    """Something that moves while the core works."""
    from rich.console import Console

    with Console(stderr=True).status(what) as status:
        yield status


@contextmanager
def kept() -> Iterator[None]:
    """A study that Ctrl-C ends says what of it is kept."""
    from klingel.errors import RunCancelledError

    try:
        yield
    except KeyboardInterrupt as ended:
        cancelled = RunCancelledError("the study was cancelled")
        for words in ended.args:
            cancelled.add_note(words)
        raise cancelled from None


def draw(figure: Figure, out: Path) -> None:
    from klingel.plot.style import render
    from klingel.report.files import write_whole

    form: Literal["svg", "png"] = "svg" if out.suffix == ".svg" else "png"
    write_whole(out, render(figure, form, name=out.stem))


def print_rows(rows: pd.DataFrame, heads: dict[str, str], *, title: str) -> None:
    """Columns of a table under their heads, the first one words, the others numbers."""
    from rich.markup import escape
    from rich.table import Table

    shown = Table(title=escape(title), show_header=any(heads.values()), title_justify="left")
    for i, head in enumerate(heads.values()):
        shown.add_column(escape(head), justify="left" if i == 0 else "right")
    for row in rows[list(heads)].itertuples(index=False):
        shown.add_row(*(escape(str(value)) for value in row))
    print_table(shown)


def print_table(table: Table) -> None:
    """A table: folded into the width of a terminal, with every column whole in a file or pipe."""
    from rich.console import Console

    for column in table.columns:
        column.overflow = "fold"
    console = Console()
    if not console.is_terminal:
        wide = console.options.update(max_width=UNBOUNDED)
        console.width = max(console.measure(table, options=wide).maximum, console.measure(table.title or "").maximum)
    console.print(table)


def write(rows: pd.DataFrame, path: Path | None) -> None:
    from klingel.report.files import write_whole

    if path is not None:
        write_whole(path, rows.to_csv(index=False).encode())
