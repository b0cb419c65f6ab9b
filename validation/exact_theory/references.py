"""Exact forces and Kalker's coefficients on 10 to 80 elements each way, too slow (80 x 80: a second each) for a test.
Writes forces.csv and coefficients.csv: python -m validation.exact_theory.references (two minutes)."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from validation.contact_creep.rows import STEEL, references
from validation.exact_theory.scaled import POISSON, forces, scales, solved, write

DATA = Path(__file__).parent
RATIOS = (0.2, 1.0, 5.0)
GRIDS = (10, 20, 40, 80)
SHARE = 5
"""One in so many of the reference creepages of `contact_creep`: prime to how often their kinds return."""
SMALL = 1e-6
"""Linear force over mu N at which the coefficients are read: slip is confined to nothing."""
MADE = (
    "made by python -m validation.exact_theory.references with Klingel's own solver of the exact theory; aob is a/b,",
    f"n the number of elements each way, nu {POISSON}.",
)


def creepages() -> pd.DataFrame:
    """Every fifth creepage of `contact_creep` without units, and CONTACT's forces (40 x 40) where there are any."""
    rows = references()
    rows = rows[rows["aob"].isin(RATIOS)]
    rows = rows[rows.groupby("aob").cumcount() % SHARE == 0].sort_values("aob", kind="stable", ignore_index=True)
    unit = STEEL["shear_modulus"] * rows["a"] * rows["b"] / (rows["mu"] * rows["FN_N"])
    out = rows[["aob", "kind"]].assign(xi=unit * rows["xi"], eta=unit * rows["eta"])
    out = out.assign(phi=unit * (rows["a"] * rows["b"]) ** 0.5 * rows["phi"]).round(6)
    known = rows["source"] == "contact"
    return out.assign(contact_fx=rows["fx_rel"].where(known), contact_fy=rows["fy_rel"].where(known))


def coefficients_on(n: int, ratio: float) -> tuple[float, float, float]:
    """C11, C22 and C23 of the solver on n x n elements."""
    s1, s2, s3 = (float(s) for s in scales(ratio))
    fx, _, _ = forces("exact", ratio, (-SMALL / s1, 0.0, 0.0), elements=(n, n))
    _, across, _ = forces("exact", ratio, (0.0, -SMALL / s2, 0.0), elements=(n, n))
    _, spin, _ = forces("exact", ratio, (0.0, 0.0, -SMALL / s3), elements=(n, n))
    return float(fx) * s1 / SMALL, float(across) * s2 / SMALL, float(spin) * s3 / SMALL


def main() -> None:
    """Solve everything; write both files."""
    at = creepages()[["aob", "kind", "xi", "eta", "phi"]]
    found = [solved(at, (n, n)).assign(n=n) for n in GRIDS]
    about = "Exact forces over mu N and moments over mu N sqrt(a b) at creepages without units (docs/theory/exact.md),"
    write(DATA / "forces.csv", pd.concat(found), (about, *MADE))
    rows = [(ratio, n, *(round(c, 5) for c in coefficients_on(n, ratio))) for ratio in RATIOS for n in GRIDS]
    about = "Kalker's coefficients, forces at a vanishing creepage,"
    write(DATA / "coefficients.csv", pd.DataFrame(rows, columns=["aob", "n", "C11", "C22", "C23"]), (about, *MADE))


if __name__ == "__main__":
    main()
