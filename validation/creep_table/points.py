"""Random creepages off every grid and their exact forces, on which the table and the laws are judged.
Writes exact.csv: python -m validation.creep_table.points (some minutes; it gives the same file again)."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from validation.exact_theory.scaled import HALF, read, scales, solved, write

FILE = Path(__file__).parent / "exact.csv"
SEED, COUNT, PART = 36, 4000, 100
"""Seed and number of the points; so many are solved between two lines of progress."""
ENDS = (1 / 36, 36.0)
"""a/b of the table."""
ABOUT = (
    "Creep forces at random creepages by Klingel's own solver of the exact theory, 40 x 40 elements, nu 0.28.",
    f"python -m validation.creep_table.points: seed {SEED}; ln(a/b) uniform from 1/36 to 36, directions of the scaled",
    "creepage v uniform, |v| = 1.5 t/(1 - t) with t uniform from 0 to 1. aob is a/b; xi, eta, phi are xi*, eta*, phi*,",
    "forces over mu N, moment over mu N sqrt(a b), on the wheel, as in docs/theory/exact.md.",
)


def drawn() -> pd.DataFrame:
    """The points in the digits that the file has, so that what is solved is what is written."""
    chance = np.random.default_rng(SEED)
    ratio = np.exp(chance.uniform(np.log(ENDS[0]), np.log(ENDS[1]), COUNT))
    t, direction = chance.uniform(size=COUNT), chance.normal(size=(COUNT, 3))
    v = (HALF * t / (1.0 - t) / np.linalg.norm(direction, axis=1))[:, None] * direction
    columns = {"aob": ratio} | {name: v[:, i] / s for i, (name, s) in enumerate(zip(NAMES, scales(ratio), strict=True))}
    return pd.DataFrame({name: [float(f"{x:.4g}") for x in values] for name, values in columns.items()})


NAMES = ("xi", "eta", "phi")


def points() -> pd.DataFrame:
    """The file's rows with |v| (`size`), the spin's angle above the plane of xi and eta in degrees (`lift`)."""
    rows = read(FILE)
    v = np.stack([s * rows[name] for name, s in zip(NAMES, scales(rows["aob"]), strict=True)])
    size = np.linalg.norm(v, axis=0)
    return rows.assign(size=size, lift=np.degrees(np.arcsin(np.abs(v[2]) / size)))


def main() -> None:
    """Solve every point; write the file."""
    rows = drawn()
    parts = []
    for start in range(0, COUNT, PART):
        parts.append(solved(rows.iloc[start : start + PART]))
        print(f"{min(start + PART, COUNT)} of {COUNT}", file=sys.stderr)
    write(FILE, pd.concat(parts), ABOUT)


if __name__ == "__main__":
    main()
