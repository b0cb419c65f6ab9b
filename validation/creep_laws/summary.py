"""The errors of the laws as a compact table for docs/theory/creep_table.md; a test holds the page to it.
Print it: python -m validation.creep_laws.summary"""

from __future__ import annotations

from validation.creep_curves.laws import LAWS
from validation.creep_laws.case import BANDS, bands
from validation.creep_table.points import points
from validation.exact_theory.scaled import off, rms


def summary() -> str:
    """Root mean square and largest |dF| in percent of mu N of each law, over all points and in each band of a/b."""
    rows = points()
    parts = {"all": slice(None)} | bands(rows)
    lines = [
        "| law | all | " + " | ".join(f"a/b {name}" for name, _, _ in BANDS) + " |",
        "|---" * (len(parts) + 1) + "|",
    ]
    for law, label, options, _, _ in LAWS:
        error = 100 * off(rows, law, **options)
        cells = (f"{_short(rms(error[part]))}, {_short(error[part].max())}" for part in parts.values())
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _short(percent: float) -> str:
    """Two digits, none of them behind the point of a large number."""
    return f"{percent:.0f}" if percent >= 10 else f"{percent:.2g}"


if __name__ == "__main__":
    print(summary())
