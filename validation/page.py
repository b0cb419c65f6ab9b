"""The cases by name, and their page: a table of figures asked for and measured, pictures, what each case compares.
The page is Markdown in docs/, so that it reads in the repository; pictures are SVG beside it."""

from __future__ import annotations

import importlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import cast

from validation.common import Case, Row

ROOT = Path(__file__).parent
CASES = tuple(sorted(path.parent.name for path in ROOT.glob("*/case.py")))
"""Names of the folders with a case."""


def case(name: str) -> Case:
    """The module of a case."""
    return cast(Case, importlib.import_module(f"validation.{name}.case"))


def page(results: Mapping[str, Sequence[Row]], pictures: Mapping[str, str]) -> str:
    """The Markdown of all cases; `pictures` maps a case to the path of its picture from the page."""
    parts = [
        "# Validation",
        "References that nobody here wrote, and how near Klingel comes to them. Made by `make validate`;\n"
        "the rows with a limit are tests. Data and their sources lie in `validation/` beside each case.",
    ]
    for name, rows in results.items():
        module = case(name)
        parts += [f"## {module.TITLE}", module.ABOUT.strip(), table(rows)]
        if name in pictures:
            parts.append(f"![{module.TITLE}]({pictures[name]})")
    return "\n\n".join(parts) + "\n"


def table(rows: Sequence[Row]) -> str:
    """Rows as a Markdown table."""
    lines = ["| quantity | reference | limit | measured | |", "|---|---|---|---|---|"]
    for row in rows:
        limit = "" if math.isnan(row.tolerance) else f"{row.tolerance:.4g} {row.unit}".strip()
        mark = ("yes" if row.passed else "**no**") if row.asked else ""
        measured = f"{row.measured:.4g} {row.unit}".strip()
        lines.append(f"| {row.quantity} | {row.reference} | {limit} | {measured} | {mark} |")
    return "\n".join(lines)
