"""`klingel contact-table --check`: the built-in table of creep forces against freshly solved points.
Fails where the table is further from exact theory than it may be."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from klingel.contact.table import compare_with_exact, creep_table
from klingel.errors import SimulationError

POINTS = 16
HEADER = ["a/b", "xi*", "eta*", "phi*", "Fx/mu N", "Fy/mu N", "Mz*", "differ [%]", "Mz* [%]"]
LARGEST = 0.02
"""Allowed difference of forces, part of mu N."""


def check_built_in(say: Callable[[str], object], points: int = POINTS) -> None:
    """Print of what the table was made and its differences from exact theory.

    say: prints a line; points: to solve. Errors: SimulationError if a difference is too large.
    """
    table = creep_table()
    say(f"table of creep forces: {table}; intervals {' x '.join(map(str, table.intervals))}")
    say(f"check sum (SHA-256): {table.check_sum}, right")
    sources = "those of this build" if table.by_this_solver else "older than those of this build"
    say(f"SHA-256 of its solver's sources: {table.solver}, {sources}")
    rows = compare_with_exact(points)
    percent = 100.0 * rows[["error", "error_mz"]]
    shown = rows[["ratio", "xi", "eta", "phi", "fx", "fy", "mz"]].join(percent)
    say(shown.to_string(index=False, header=HEADER, float_format="{:.3f}".format))
    rms, largest = float(np.sqrt((rows.error**2).mean())), float(rows.error.max())
    say(f"differences at {points} points: RMS {100.0 * rms:.2f} %, largest {100.0 * largest:.2f} % of mu N")
    if largest > LARGEST:
        message = f"the built-in table differs from exact theory by {100.0 * largest:.1f} % of mu N, allowed are"
        remedy = "make it anew with `klingel contact-table` and `make build`"
        raise SimulationError(f"{message} {100.0 * LARGEST:g} %; {remedy}")
