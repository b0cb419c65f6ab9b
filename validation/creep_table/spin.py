"""Creepages in which spin leads, off every grid, and their exact forces: where a spline has most to bend.
Writes spin.csv: python -m validation.creep_table.spin (some minutes; it gives the same file again)."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from validation.creep_table.points import ENDS, NAMES
from validation.exact_theory.scaled import HALF, Values, read, scales, solved, write

FILE = Path(__file__).parent / "spin.csv"
SEED, COUNT, PART = 37, 1600, 100
"""Seed and number of the random points; so many are solved between two lines of progress."""
LINES = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 8.0, 12.0, 20.0, 25.0)
"""a/b of the lines of pure spin."""
SIZES: Values = np.geomspace(0.3, 150.0, 48)
"""|v| along each."""
ABOUT = (
    "Creep forces by Klingel's own solver of the exact theory, 40 x 40 elements, nu 0.28, where spin leads.",
    f"python -m validation.creep_table.spin: seed {SEED}; {COUNT} random creepages, ln(a/b) uniform from 1/36 to 36,",
    "the angle of the scaled creepage v above the plane of xi and eta uniform, so that half of them have more spin",
    "than creepage, |v| = 1.5 t/(1 - t) with t uniform from 0 to 1; then lines of pure spin, |v| from 0.3 to 150.",
    "Columns and units as in exact.csv.",
)


def drawn() -> pd.DataFrame:
    """The points in the digits that the file has, so that what is solved is what is written."""
    chance = np.random.default_rng(SEED)
    ratio = np.exp(chance.uniform(np.log(ENDS[0]), np.log(ENDS[1]), COUNT))
    t, turn, lift = (
        chance.uniform(low, high, COUNT) for low, high in ((0, 1), (0, 2 * np.pi), (-np.pi / 2, np.pi / 2))
    )
    v = HALF * t / (1.0 - t) * np.stack([np.cos(lift) * np.cos(turn), np.cos(lift) * np.sin(turn), np.sin(lift)])
    alone = np.stack([np.zeros(len(LINES) * len(SIZES))] * 2 + [np.tile(SIZES, len(LINES))])
    ratio, v = np.append(ratio, np.repeat(LINES, len(SIZES))), np.hstack([v, alone])
    columns = {"aob": ratio} | {name: part / s for name, part, s in zip(NAMES, v, scales(ratio), strict=True)}
    return pd.DataFrame({name: [float(f"{x:.4g}") for x in values] for name, values in columns.items()})


def points() -> tuple[pd.DataFrame, pd.DataFrame]:
    """The file's rows: random ones, and those of the lines, with |v| (`size`)."""
    rows = read(FILE)
    v = np.stack([s * rows[name] for name, s in zip(NAMES, scales(rows["aob"]), strict=True)])
    rows = rows.assign(size=np.linalg.norm(v, axis=0))
    return rows.iloc[:COUNT], rows.iloc[COUNT:]


def main() -> None:
    """Solve every point; write the file."""
    rows = drawn()
    parts = []
    for start in range(0, len(rows), PART):
        parts.append(solved(rows.iloc[start : start + PART]))
        print(f"{min(start + PART, len(rows))} of {len(rows)}", file=sys.stderr)
    write(FILE, pd.concat(parts), ABOUT)


if __name__ == "__main__":
    main()
