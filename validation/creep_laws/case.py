"""How much every law errs against the exact theory over random creepages, round and slender patches.
The points are those on which the table is judged; `creep_curves` shows how the laws err."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from validation.common import Row
from validation.creep_curves.laws import LAWS
from validation.creep_table.points import COUNT, points
from validation.exact_theory.scaled import off, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Creep force laws: exact theory"
ABOUT = f"""
{COUNT} random creepages at random a/b: ln(a/b) uniform from 1/36 to 36, the direction of the scaled creepage v uniform,
its size 1.5 t/(1 - t) with t uniform from 0 to 1, so that all between rest and full sliding counts alike. Spin has the
same share as either other creepage, which is more than a tread sees and what a flange sees. Reference: our own solver
of the exact theory with 40 x 40 elements; its own distance from the limit of fine grids is in the case of grid
convergence (hollow in the picture). Figures are root mean squares of |dF| over mu N; FASTSIM has 16 x 16 elements.
The limits hold the laws to what the case of creep forces holds them to.
"""

BANDS = (
    ("1/36 to 1/6", 0.0, 1 / 6),
    ("1/6 to 1", 1 / 6, 1.0),
    ("1 to 6", 1.0, 6.0),
    ("6 to 36", 6.0, 40.0),
)
LIMITS: Mapping[str, float] = {"FASTSIM, blended": 0.035, "table": 0.005}
"""Of the root mean square over all points."""


def run() -> Iterator[Row]:
    """Each law over all points, then in each band of a/b."""
    rows = points()
    for law, label, options, _, _ in LAWS:
        error = off(rows, law, **options)
        if label in LIMITS:
            yield Row.at_most(f"{label}, all", "exact 40 x 40", rms(error), LIMITS[label])
        else:
            yield Row.shown(f"{label}, all", "exact 40 x 40", rms(error))
        for name, inside in bands(rows).items():
            yield Row.shown(f"{label}, a/b {name}", "exact 40 x 40", rms(error[inside]))
        yield Row.shown(f"{label}, largest", "exact 40 x 40", float(error.max()))


def bands(rows: pd.DataFrame) -> dict[str, NDArray[np.bool_]]:
    """Which rows lie in each band of a/b."""
    return {name: ((rows["aob"] > low) & (rows["aob"] <= high)).to_numpy() for name, low, high in BANDS}


def figure() -> Figure:
    """Root mean squares over a/b, size and kind of the creepage, and how the errors are distributed."""
    from validation.creep_laws.picture import drawn

    return drawn()
