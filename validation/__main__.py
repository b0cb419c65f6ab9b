"""Runs the cases named on the command line, or all of them, and writes docs/validation.md.
Ends with 1 if a figure is not reached."""

from __future__ import annotations

import sys
from pathlib import Path

from klingel.plot.style import render
from klingel.report.files import write_whole
from validation.page import CASES, case, page

DOCS = Path(__file__).parents[1] / "docs"


def main(names: list[str]) -> int:
    """Run the cases; print every row; write the page if all were run."""
    unknown = sorted(set(names) - set(CASES))
    if unknown:
        print(f"unknown: {', '.join(unknown)}; cases: {', '.join(CASES)}", file=sys.stderr)
        return 2
    results, pictures = {}, {}
    for name in names or CASES:
        module = case(name)
        results[name] = list(module.run())
        print(module.TITLE)
        for row in results[name]:
            print(
                f"  {'ok' if row.passed else 'NO'}  {row.quantity}: {row.measured:.4g} {row.unit}"
                f" (limit {row.tolerance:.4g})"
            )
        if hasattr(module, "figure"):
            pictures[name] = f"validation/{name}.svg"
            (DOCS / "validation").mkdir(exist_ok=True)
            write_whole(DOCS / pictures[name], render(module.figure(), "svg", name=name))
    if not names:
        write_whole(DOCS / "validation.md", page(results, pictures).encode())
    return 0 if all(row.passed for rows in results.values() for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
