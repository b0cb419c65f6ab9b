"""The table of creep forces against the exact solver on random creepages off its grid, and against CONTACT.
Its error map: over the size and kind of the creepage and over the slenderness of the patch."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from validation.common import Row
from validation.contact_creep.rows import force_error, references
from validation.creep_laws.case import bands
from validation.creep_table import spin
from validation.creep_table.points import COUNT, NAMES, points
from validation.exact_theory.scaled import Values, forces, off, off_moment, resolved, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Table of creep forces: exact theory"
ABOUT = f"""
The {COUNT} random creepages of the case of the laws, now for the table alone: ln(a/b) uniform from 1/36 to 36,
directions of the scaled creepage uniform, its size from rest to full sliding (seed and all in exact.csv). Reference:
the solver that the table is made with, on its 40 x 40 elements, some points solved again here; so this is the error of
the table itself, and the solver's distance from the limit of fine grids comes on top (case of grid convergence).
{spin.COUNT} more creepages have the angle of spin above the other two uniform, so that half of them have more spin than
creepage, and {len(spin.LINES)} lines of spin alone go from |v| 0.3 to 150 (spin.csv): there lie the sharpest peaks.
CONTACT's rows are those of the case of creep forces. Limits are what was asked of the table: 0.5 % of mu N (root mean
square) and for a/b 0.05 to 25, where wheels on rails are, 2 % (largest); that no force exceeds mu N, that mirror images
agree to the last bit. Moments are over mu N sqrt(ab).
"""

RMS_LIMIT, MOST, ASKED = 0.005, 0.02, (0.05, 25.0)
"""Limits of the forces' error, and a/b that the second one is for: no wheel on a rail is more slender."""
SHARE = 160
"""One in so many points is solved again."""
TURNS = {"Fx with xi": (-1, 1, 1), "Fy and Mz with eta, phi": (1, -1, -1)}
"""Signs of xi, eta, phi in the two mirror images."""


def run() -> Iterator[Row]:
    """Forces and moments on the points, bounds, mirror images, CONTACT."""
    rows = points()
    yield Row.at_most("some points solved again", "exact.csv", resolved(rows.iloc[::SHARE]), 2e-5)
    error, moment = off(rows, "table"), np.abs(off_moment(rows, "table"))
    asked = ((rows["aob"] >= ASKED[0]) & (rows["aob"] <= ASKED[1])).to_numpy()
    yield Row.at_most("forces, a/b 0.05 to 25", "exact 40 x 40", rms(error[asked]), RMS_LIMIT)
    yield Row.at_most("forces, a/b 0.05 to 25, largest", "exact 40 x 40", float(error[asked].max()), MOST)
    yield from _spin()
    for name, inside in bands(rows).items():
        yield Row.at_most(f"forces, a/b {name}", "exact 40 x 40", rms(error[inside]), RMS_LIMIT)
        yield Row.shown(f"forces, a/b {name}, largest", "exact 40 x 40", float(error[inside].max()))
    yield Row.shown("moments, all", "exact 40 x 40", rms(moment))
    yield Row.shown("moments, all, largest", "exact 40 x 40", float(moment.max()))
    fx, fy, mz = _table(rows)
    yield Row.at_most("force beyond mu N, largest", "Coulomb", float((np.hypot(fx, fy) - 1.0).clip(0.0).max()), 0.0)
    for name, turn in TURNS.items():
        mirrored = _table(rows, turn)
        signs = (turn[0], turn[1], turn[1])
        most = max(float(np.abs(m - s * f).max()) for m, s, f in zip(mirrored, signs, (fx, fy, mz), strict=True))
        yield Row.at_most(f"{name}: mirror image, largest difference", "itself", most, 0.0)
    known = references()
    known = known[known["source"] == "contact"]
    error = force_error(known, "table")
    yield Row.at_most("forces, 212 rows at a/b 0.5 and 1", "CONTACT 40 x 40", rms(error), RMS_LIMIT)
    yield Row.at_most("forces, the same, largest", "CONTACT 40 x 40", float(error.max()), MOST)


def _spin() -> Iterator[Row]:
    """Where spin leads, and where it is alone."""
    random, lines = spin.points()
    solved = pd.concat([random.iloc[::SHARE], lines.iloc[::SHARE]])
    yield Row.at_most("some points with spin solved again", "spin.csv", resolved(solved), 2e-5)
    error, asked = off(random, "table"), random["aob"].between(*ASKED).to_numpy()
    yield Row.at_most("forces where spin leads, a/b 0.05 to 25", "exact 40 x 40", rms(error[asked]), RMS_LIMIT)
    yield Row.at_most(
        "forces where spin leads, a/b 0.05 to 25, largest", "exact 40 x 40", float(error[asked].max()), MOST
    )
    yield Row.shown("forces where spin leads, all, largest", "exact 40 x 40", float(error.max()))
    for ratio, line in lines.groupby("aob"):
        yield Row.at_most(f"spin alone, a/b {ratio:g}, largest", "exact 40 x 40", float(off(line, "table").max()), MOST)


def _table(rows: pd.DataFrame, turn: tuple[int, int, int] = (1, 1, 1)) -> tuple[Values, Values, Values]:
    """The table's forces and moment, of the points or of their mirror images."""
    xi, eta, phi = (sign * rows[name] for sign, name in zip(turn, NAMES, strict=True))
    return forces("table", rows["aob"], (xi, eta, phi))


def figure() -> Figure:
    """Maps of the error over kind, size and a/b, and its spread over a/b."""
    from validation.creep_table.picture import drawn

    return drawn()
