"""The errors of the table and of the laws as tables in docs/theory/creep_table.md; a test holds the page to them.
Puts them there: python -m validation.creep_laws.summary"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from validation.creep_curves.laws import LAWS
from validation.creep_laws.case import BANDS, bands
from validation.creep_table.points import points
from validation.exact_theory.scaled import Values, off, off_moment, rms

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "creep_table.md"


def laws() -> str:
    """Root mean square and largest |dF| in percent of mu N of each law, over all points and in each band of a/b."""
    return _table("law", {label: 100 * off(points(), law, **options) for law, label, options, _, _ in LAWS})


def table() -> str:
    """The same of the law `table` with its moments, in percent of mu N sqrt(a b)."""
    moment = 100 * np.abs(off_moment(points(), "table"))
    return _table("table", {"force": 100 * off(points(), "table"), "moment": moment})


def _table(head: str, errors: Mapping[str, Values]) -> str:
    parts = {"all": slice(None)} | bands(points())
    lines = [[head, "all", *(f"a/b {name}" for name, _, _ in BANDS)], ["---"] * (len(parts) + 1)]
    for name, error in errors.items():
        lines.append([name, *(f"{_short(rms(error[part]))}, {_short(error[part].max())}" for part in parts.values())])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _short(percent: float) -> str:
    """Two digits, none of them behind the point of a large number."""
    return f"{percent:.0f}" if percent >= 10 else f"{percent:.2g}"


def renewed(page: str, tables: Iterable[str]) -> str:
    """The page with its tables of the same heads replaced."""
    paragraphs = page.split("\n\n")
    for new in tables:
        head = new.split("\n", 1)[0]
        paragraphs = [new if old.startswith(head) else old for old in paragraphs]
    return "\n\n".join(paragraphs)


if __name__ == "__main__":
    PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8"), (laws(), table())), encoding="utf-8")
