"""`klingel contact-table --check`: the built-in table of creep forces against freshly solved points.
Fails where the table is further from exact theory than it may be."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd

from klingel.contact.table import compare_pure_spin, compare_with_exact, creep_table
from klingel.errors import InputError, Problem, SimulationError

POINTS = 160
"""Random ones; with the lines of pure spin about ten seconds on two cores."""
LINES = (0.05, 0.2, 1.0, 5.0, 10.0, 25.0)
"""a/b of the lines of pure spin."""
LINE_POINTS = 20
SHOWN = 8
"""Points with the largest differences."""
HEADER = ["a/b", "xi*", "eta*", "phi*", "Fx/mu N", "Fy/mu N", "Mz*", "differ [%]", "Mz* [%]"]
LARGEST = 0.02
"""Allowed difference of forces, part of mu N."""


def refuse(options: Mapping[str, object]) -> None:
    """Options of making a table do not go with the check. Errors: InputError with all that are given."""
    remedy = "leave it out: the table is checked as it was made"
    given = {key: value for key, value in options.items() if value is not None}
    if given:
        raise InputError(Problem(key, str(value), "does not go with --check", remedy) for key, value in given.items())


def check_built_in(say: Callable[[str], object], points: int = POINTS) -> None:
    """Print of what the table was made and its differences from exact theory: at random points, under spin alone.

    say: prints a line; points: random ones to solve. Errors: SimulationError if a difference is too large.
    """
    table = creep_table()
    say(f"table of creep forces: {table}; intervals {' x '.join(map(str, table.intervals))}")
    say(f"check sum (SHA-256): {table.check_sum}, right")
    sources = "those of this build" if table.by_this_solver else "older than those of this build"
    say(f"SHA-256 of its solver's sources: {table.solver}, {sources}")
    random, spin = compare_with_exact(points), compare_pure_spin(LINES, LINE_POINTS)
    rows = pd.concat([random, spin]).sort_values("error", ascending=False)
    worst = rows.head(SHOWN)
    percent = 100.0 * worst[["error", "error_mz"]]
    shown = worst[["ratio", "xi", "eta", "phi", "fx", "fy", "mz"]].assign(**percent)
    say(f"exact theory solved at {len(rows)} points; where the table differs most:")
    say(shown.to_string(index=False, header=HEADER, float_format="{:.3f}".format))
    say(f"at {len(random)} random points: {_differences(random)}")
    for ratio, line in spin.groupby("ratio"):
        say(f"spin alone, a/b {ratio:g}: {_differences(line)}")
    largest = float(rows["error"].max())
    if largest > LARGEST:
        message = f"the built-in table differs from exact theory by {100.0 * largest:.1f} % of mu N, allowed are"
        remedy = "make it anew with `klingel contact-table` and `make build`"
        raise SimulationError(f"{message} {100.0 * LARGEST:g} %; {remedy}")


def _differences(rows: pd.DataFrame) -> str:
    rms, largest = float(np.sqrt((rows["error"] ** 2).mean())), float(rows["error"].max())
    return f"differences RMS {100.0 * rms:.2f} %, largest {100.0 * largest:.2f} % of mu N"
