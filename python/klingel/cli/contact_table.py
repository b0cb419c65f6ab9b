"""`klingel contact-table`: solves the table of creep forces part by part and writes its file.
Finished parts are kept under a hash of all that shapes them: a second start goes on where the first one ended."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from klingel.cli.table_parts import Parts
from klingel.contact.table import header
from klingel.core import core
from klingel.errors import InputError, RunCancelledError, SimulationError
from klingel.report.files import write_whole

if TYPE_CHECKING:
    from klingel._core import CreepTableMaker

Say = Callable[[str], object]

REMEDY = "the same command goes on with them"
EXAMPLE = ("12", "16", "40", "22")
HOUR = 3600.0


@dataclass(frozen=True)
class Shape:
    """What a table is made with, as on the command line.

    poisson: ratio of both bodies; elements: of a patch, along and across; intervals: of the three creepages and of the
    semi-axes' ratio, those of the table in the package unless given.
    """

    poisson: float
    elements: str
    intervals: str | None

    def maker(self) -> CreepTableMaker:
        """What solves it. Errors: InputError."""
        elements = _numbers("elements", self.elements, 2)
        intervals = None if self.intervals is None else _numbers("intervals", self.intervals, 4)
        try:
            maker: CreepTableMaker = core().CreepTableMaker(
                poisson=self.poisson, elements=elements, intervals=intervals
            )
        except core().CoreError as error:
            raise InputError.single("", None, str(error)) from None
        return maker


def make(out: Path, work: Path | None, shape: Shape, say: Say) -> Path:
    """Solve what is missing in the work folder and write the table.

    out: file to write; work: folder for finished parts, the user's cache unless given; shape: as on the command line;
    say: prints a line. Errors: InputError for options and folders; RunCancelledError for Ctrl-C, with a note on what is
    kept; SimulationError for a patch that was not solved.
    """
    began = time.monotonic()
    _check_writable(out)
    maker = shape.maker()
    folder = (work if work is not None else _cache()) / maker.key
    try:
        parts = Parts(maker, folder)
        points = sum(map(maker.part_len, range(maker.parts)))
        say(f"table of creep forces: {points} points in {maker.parts} parts, kept in {folder}")
        _say_found(parts, say)
        try:
            _solve(parts)
        except KeyboardInterrupt:
            cancelled = RunCancelledError("the table was cancelled")
            cancelled.add_note(f"{len(parts.solved)} of {maker.parts} parts are kept in {folder}; {REMEDY}")
            raise cancelled from None
        content = parts.finish()
        write_whole(out, content)
    except core().CoreError as error:
        raise SimulationError(str(error)) from None
    except OSError as error:
        remedy = f"make room or choose others with --work and --out; finished parts are kept, {REMEDY}"
        raise InputError.single("", None, str(error), remedy=remedy) from None
    made, seconds = header(content), time.monotonic() - began
    say(f"{out}: {len(content) / 1e6:.2f} MB, check sum (SHA-256) {made['checksum']}, {seconds:.0f} s")
    return out


def _solve(parts: Parts) -> None:
    """Solve what is missing, with a bar; whatever ends it, finished parts are kept."""
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn(),
    )  # fmt: skip
    maker = parts.maker
    # The time left follows from all parts of this start: slender patches take longer than round ones.
    with Progress(*columns, console=Console(stderr=True), transient=True, speed_estimate_period=HOUR) as bar:
        task = bar.add_task("", total=maker.parts, completed=len(parts.solved))
        for part in parts.missing():
            bar.update(task, description=maker.describe(part))
            try:
                parts.solve(part)
            except core().CoreError as error:
                raise SimulationError(f"{maker.describe(part)}: {error}") from None
            bar.advance(task)


def _say_found(parts: Parts, say: Say) -> None:
    if parts.solved:
        say(f"{len(parts.solved)} of {parts.maker.parts} parts found there, solved before")
    if parts.damaged:
        names = ", ".join(parts.path(part).name for part in parts.damaged)
        say(f"{len(parts.damaged)} damaged, to be solved anew: {names}")


def _check_writable(out: Path) -> None:
    """Before the work, not after it."""
    if out.is_dir():
        raise InputError.single("out", str(out), "is a folder", remedy="give the name of a file")
    if not os.access(out.absolute().parent, os.W_OK | os.X_OK):
        raise InputError.single("out", str(out), "has no folder to be written to", remedy="make it, or choose another")


def _cache() -> Path:
    folder = core().cache_folder()
    if folder is None:
        remedy = "give a folder, or leave KLINGEL_CACHE unset"
        raise InputError.single("work", None, "there is no cache folder to keep parts in", remedy=remedy)
    return Path(folder) / "creep-table"


def _numbers(key: str, text: str, count: int) -> list[int]:
    """Whole numbers with an x between.

    >>> _numbers("elements", "40x40", 2)
    [40, 40]
    """
    number = r"[0-9]{1,4}"
    if not re.fullmatch("x".join([number] * count), text):
        remedy = f"give them as {'x'.join(EXAMPLE[:count])}"
        raise InputError.single(key, text, f"is not {count} whole numbers of up to four digits", remedy=remedy)
    return [int(n) for n in text.split("x")]
