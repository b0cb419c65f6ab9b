"""Rows of a study that are kept as they come: one line of a CSV file a run, written at once; a batch can go on.
Beside it the plan says which study the rows belong to."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from klingel.errors import InputError
from klingel.report.files import write_whole

ROWS, PLAN = "runs.csv", "plan.json"

Row = Mapping[str, float | str]


class Rows:
    """Finished runs of a study in its folder, by name; safe to use from several threads.

    folder: exists; plan: JSON data that say what is studied, all that the rows depend on; columns: of the table behind
    the name; fresh: begin anew whatever the folder holds.
    Errors: InputError where the folder holds the rows of another plan.
    """

    def __init__(self, folder: Path, plan: Mapping[str, Any], columns: tuple[str, ...], *, fresh: bool = False) -> None:
        self._path, self._columns = folder / ROWS, ("run", *columns)
        self._lock = threading.Lock()
        text = json.dumps(plan, sort_keys=True, allow_nan=False)
        key = hashlib.sha256(text.encode()).hexdigest()
        self._known: dict[str, dict[str, str]] = {}
        if fresh or not self._path.is_file():
            self._path.write_text(self._line(self._columns))
        elif _key_of(folder) != key:
            remedy = "choose another folder, or begin anew with --fresh (fresh=True)"
            raise InputError.single("out", str(folder), "holds the runs of another study", remedy=remedy)
        else:
            self._known = self._read()
        write_whole(folder / PLAN, (json.dumps({"key": key, **plan}, indent=1, sort_keys=True) + "\n").encode())

    def __contains__(self, name: object) -> bool:
        """Whether the run of that name is finished."""
        return name in self._known

    def __len__(self) -> int:
        """How many runs are finished."""
        return len(self._known)

    def add(self, name: str, row: Row) -> None:
        """Keep a finished run, in the file too, with one write."""
        cells = (name, *(_text(row[column]) for column in self._columns[1:]))
        line = self._line(cells).encode()
        with self._lock:
            descriptor = os.open(self._path, os.O_WRONLY | os.O_APPEND)
            try:
                os.write(descriptor, line)
            finally:
                os.close(descriptor)
            self._known[name] = dict(zip(self._columns, cells, strict=True))

    def table(self, names: list[str]) -> pd.DataFrame:
        """The rows of these runs, as far as they are finished, in this order: numbers as numbers, nothing as NaN."""
        found = [self._known[name] for name in names if name in self._known]
        frame = pd.DataFrame(found, columns=list(self._columns), dtype=object)
        return pd.read_csv(io.StringIO(frame.to_csv(index=False)), keep_default_na=False, na_values=["nan"])

    def sort(self, names: list[str]) -> None:
        """Write the file anew in this order, so that it does not tell which thread was quicker; others go behind."""
        order = [name for name in names if name in self._known]
        order += sorted(set(self._known) - set(order))
        lines = [self._line(tuple(self._known[name].values())) for name in order]
        write_whole(self._path, "".join([self._line(self._columns), *lines]).encode())

    def _read(self) -> dict[str, dict[str, str]]:
        """Whole lines of the file; one that an interruption cut off is left out, and cut off."""
        text = self._path.read_text()
        whole = text[: text.rfind("\n") + 1]
        if whole != text:
            write_whole(self._path, whole.encode())
        return {row["run"]: dict(row) for row in csv.DictReader(io.StringIO(whole))}

    @staticmethod
    def _line(cells: tuple[str, ...]) -> str:
        target = io.StringIO()
        csv.writer(target, lineterminator="\n").writerow(cells)
        return target.getvalue()


def _key_of(folder: Path) -> str:
    try:
        return str(json.loads((folder / PLAN).read_text())["key"])
    except (OSError, ValueError, KeyError):
        return ""


def _text(cell: float | str) -> str:
    """A cell in the file: words on one line, numbers with all their digits."""
    return " ".join(cell.split()) if isinstance(cell, str) else repr(float(cell))
