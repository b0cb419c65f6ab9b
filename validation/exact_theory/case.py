"""Grid convergence of the exact solver: forces and Kalker's coefficients on 10 to 80 elements each way.
Their limit is extrapolated; CONTACT's own coefficients and forces stand beside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from validation.common import Row
from validation.exact_theory.references import DATA, GRIDS, RATIOS, coefficients_on, creepages
from validation.exact_theory.scaled import Values, read, resolved, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Exact theory: grid convergence"
ABOUT = """
Our solver of the exact theory on n x n elements, n = 10, 20, 40 and 80, against the limit that its two finest grids
point to, 2 F(80) - F(40): every fifth creepage of the case of creep forces, 22 for each a/b, all kinds. The solver
is of the first order: the observed order is log2 of |F(20) - F(40)| over |F(40) - F(80)|. The rows of
80 elements take a second each, so all rows are kept in forces.csv and coefficients.csv and some are solved again here.
CONTACT's coefficients (with their own standard error of up to 0.7 %) and its forces on 40 x 40 elements are those of
the cases beside. What the simulator's laws are judged by is 40 x 40, CONTACT's customary grid, which lies as far from
the limit as CONTACT's rows do: that distance, not the solver's residual, is the uncertainty of every figure against
"exact". It is largest at a/b 5, where a lateral creepage works against spin: there the slip turns round within few
elements. Limits: 1 % for coefficients is what was asked of the solver; forces on 40 x 40 elements may be off by half
of what the best law that is no exact theory errs by.
"""

AGAIN = {10: 1, 20: 1, 40: 6}
"""Elements each way, and one in how many of their rows is solved again."""
FORCE_LIMIT = 0.0125
"""Root mean square over mu N: half of blended FASTSIM's in the case of creep forces."""
NAMES = ("C11", "C22", "C23")
FORCES = ["fx", "fy"]


def run() -> Iterator[Row]:
    """The files against the solver; coefficients against CONTACT's; forces of each grid against the limit."""
    at, rows = creepages(), read(DATA / "forces.csv")
    for n, share in AGAIN.items():
        again = resolved(rows[rows["n"] == n].iloc[::share], (n, n))
        yield Row.at_most(f"some forces on {n} x {n} solved again", "forces.csv", again, 2e-5)
    most = max(float(np.abs(kept_coefficients(g)[1] / coefficients_on(20, g) - 1).max()) for g in RATIOS)
    yield Row.at_most("coefficients on 20 x 20 solved again", "coefficients.csv", 100 * most, 0.01, "%")
    for ratio in RATIOS:
        off = 100 * np.abs(coefficient_limit(ratio) / contact_coefficients(ratio)[0] - 1)
        for name, error in zip(NAMES, off, strict=True):
            what = f"{name} at a/b {ratio:g}, limit of 40 and 80"
            yield Row.at_most(what, "CONTACT, extrapolated", float(error), 1.0, "%")
    for ratio in RATIOS:
        for n in GRIDS:
            size = grid_error(rows, ratio, n)
            what = f"forces on {n} x {n}, a/b {ratio:g}"
            if n == 40:
                yield Row.at_most(what, "limit of 40 and 80", rms(size), FORCE_LIMIT)
                yield Row.shown(f"{what}, largest", "limit of 40 and 80", float(size.max()))
            else:
                yield Row.shown(what, "limit of 40 and 80", rms(size))
        yield Row.shown(f"observed order, forces, a/b {ratio:g}", "1", order(rows, ratio))
    size = contact_error(at, rows)
    yield Row.shown("CONTACT's forces on 40 x 40, a/b 1", "our limit of 40 and 80", rms(size))
    yield Row.shown("CONTACT's forces on 40 x 40, a/b 1, largest", "our limit of 40 and 80", float(size.max()))


def contact_coefficients(ratio: float) -> tuple[Values, Values]:
    """CONTACT's C11, C22 and C23 at a/b, and their standard errors."""
    rows = read(DATA.parent / "kalker" / "contact.csv")
    row = rows[rows["a_over_b"] == ratio]
    return row[list(NAMES)].to_numpy()[0], row[[f"{name}_se" for name in NAMES]].to_numpy()[0]


def kept_coefficients(ratio: float) -> Values:
    """C11, C22 and C23 (columns) on 10, 20, 40 and 80 elements each way (rows)."""
    rows = read(DATA / "coefficients.csv")
    return rows.loc[rows["aob"] == ratio, list(NAMES)].to_numpy()


def coefficient_limit(ratio: float) -> Values:
    """C11, C22 and C23 at vanishing element size, linear from the two finest grids."""
    on_40, on_80 = kept_coefficients(ratio)[2:]
    return np.asarray(2 * on_80 - on_40)


def on(rows: pd.DataFrame, ratio: float, n: int) -> Values:
    """Fx and Fy over mu N of every creepage of one a/b on one grid."""
    return rows.loc[(rows["aob"] == ratio) & (rows["n"] == n), FORCES].to_numpy()


def grid_error(rows: pd.DataFrame, ratio: float, n: int) -> Values:
    """|dF| over mu N of every creepage on n x n elements against the limit."""
    return _size(on(rows, ratio, n) - 2 * on(rows, ratio, 80) + on(rows, ratio, 40))


def contact_error(at: pd.DataFrame, rows: pd.DataFrame) -> Values:
    """|dF| over mu N of CONTACT's rows against our limit, at a/b 1."""
    theirs = at.loc[at["aob"] == 1.0, ["contact_fx", "contact_fy"]].to_numpy()
    return _size(theirs - 2 * on(rows, 1.0, 80) + on(rows, 1.0, 40))


def order(rows: pd.DataFrame, ratio: float) -> float:
    """Order of convergence that 20, 40 and 80 elements show."""
    coarse, fine = (rms(_size(on(rows, ratio, n) - on(rows, ratio, 2 * n))) for n in (20, 40))
    return float(np.log2(coarse / fine))


def _size(vectors: Values) -> Values:
    return np.asarray(np.hypot(vectors[:, 0], vectors[:, 1]))


def figure() -> Figure:
    """Coefficients over the elements' size, forces' errors over the number of elements; one column for each a/b."""
    from validation.exact_theory.picture import drawn

    return drawn()
