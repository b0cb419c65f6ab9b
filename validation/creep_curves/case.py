"""Creep curves by every law against the exact theory, from rest to full sliding, round and slender patches.
Where the random creepages of `creep_laws` say how much a law errs, the curves say how."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from validation.common import Row
from validation.creep_curves.curves import CURVES, FILE, SPIN
from validation.creep_curves.laws import LAWS
from validation.exact_theory.scaled import off, read, resolved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Creep curves: exact theory"
ABOUT = f"""
One creepage grows from rest to full sliding, alone or while the scaled spin S3 phi* stays at {SPIN:g}, at a/b 0.2, 1
and 5. Reference: our own solver of the exact theory with 40 x 40 elements (kept in exact.csv; some points are solved
again here). Creepages have no units and are scaled by Kalker's coefficients, so that 1 is where the linear force is
mu N (docs/theory/creep_table.md defines S1, S2, S3); forces over mu N, moments over mu N c with c = sqrt(ab). Figures
are the largest |dF| over mu N along a curve at any of the three a/b. The table's limit is what was asked of it.
"""

SHARE = 17
"""One in so many points is solved again."""
TABLE_MOST = 0.02


def run() -> Iterator[Row]:
    """The file against the solver; then each law along each curve."""
    rows = read(FILE)
    yield Row.at_most("some points solved again", "exact.csv", resolved(rows.iloc[::SHARE]), 2e-5)
    for law, label, options, _, _ in LAWS:
        for curve in CURVES:
            most = float(off(rows[rows["curve"] == curve.name], law, **options).max())
            if law == "table":
                yield Row.at_most(f"{label}, {curve.name}, largest", "exact 40 x 40", most, TABLE_MOST)
            else:
                yield Row.shown(f"{label}, {curve.name}, largest", "exact 40 x 40", most)


def figure() -> Figure:
    """Every law along every curve."""
    from validation.creep_curves.picture import drawn

    return drawn()
