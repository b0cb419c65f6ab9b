"""Creep forces of an ellipse against the full theory: every law, every kind of creepage, round and slender patches.
The exact law and its table against CONTACT; then FASTSIM and its modified form against CONTACT's own, row by row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from klingel.contact import creep_force
from validation.common import Row
from validation.contact_creep.rows import DATA, STEEL, Values, computed, force_error, references, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Creep forces: CONTACT"
ABOUT = """
Ellipses with a b = 36 mm2 under 80 kN, friction 0.3: longitudinal and lateral creepage and spin alone and together,
from adhesion to full sliding, 106 rows for each a/b. Reference: the program CONTACT (github.com/eve70a/CONTACT,
Apache-2.0), full theory, for a/b 0.5 and 1; for the others our own solver of the full theory, which is within 0.0015
(root mean square) of CONTACT on all rows of the first two; every fifth of them, all kinds, is solved here. Figures are
root mean squares of |dF| over mu Fn. Plain FASTSIM has its largest errors where creepage and spin act together: there
three flexibilities give the traction the wrong direction, the more so the more they differ (a/b 0.2). A coarse grid
hides part of the error of the method, so 40 x 40 stands beside. The table has its largest error at a/b 0.1, far into
full sliding under spin, where the grid itself makes steps. The traction curves are CONTACT's example of a locomotive's
wheel: its own FASTSIM counts the first half element of a strip as a whole one, which makes it 3 % stiffer at rest.
"""

ASKED, BEYOND = (0.2, 0.5, 1.0, 2.0, 5.0), (0.1, 10.0, 20.0)
"""a/b that the limits are for, and those that are shown beside: the flange reaches 20."""
FORMS: tuple[tuple[str, float, dict[str, Any]], ...] = (
    ("plain", 0.045, {"blended": False}),
    ("blended", 0.035, {"blended": True}),
)

EXACT_SHARE = 5
"""One in so many of CONTACT's rows is solved exactly: prime to how often the kinds of creepage return."""

SLOPE = (0.54, 0.02, 0.62)
FALLING = (0.38, 0.7)
ELLIPSE = {"a": 6.303597e-3, "b": 12.607194e-3}
"""Hertz's, for A = 0.8 1/m along and a/b = 0.5 under 106.7 kN."""
WHEEL_LOAD, SPEED = 106.7e3, 10.0


def run() -> Iterator[Row]:
    """The exact law, its table, FASTSIM and the closed laws against the full theory; then the traction curves."""
    rows = references()
    yield from _exact(rows[rows["source"] == "contact"].iloc[::EXACT_SHARE])
    yield from _table(rows)
    asked = rows[rows["aob"].isin(ASKED)]
    for form, limit, options in FORMS:
        yield from _fastsim(rows, asked, form, limit, options)
    no_spin = asked[asked["phi"] == 0.0]
    for law in ("polach", "shen_hedrick_elkins"):
        yield Row.at_most(f"{law}, without spin", "full theory", rms(force_error(no_spin, law)), 0.05)
    yield Row.shown("polach, with spin", "full theory", rms(force_error(asked[asked["phi"] != 0.0], "polach")))
    small = no_spin[np.hypot(no_spin["fx_rel"], no_spin["fy_rel"]) < 0.06]
    error = rms(force_error(small, "linear"))
    yield Row.at_most("linear, up to 6 % of mu Fn, without spin", "full theory", error, 0.002)
    yield from _traction()


def _exact(rows: pd.DataFrame) -> Iterator[Row]:
    """Forces and moments on the elements that CONTACT had."""
    fx, fy, mz = computed(rows, "exact", elements=(40, 40))
    error = np.hypot(fx - rows["fx_rel"], fy - rows["fy_rel"]).to_numpy()
    moment = (mz - rows["mz_rel_c"]).to_numpy()
    yield Row.at_most("exact 40 x 40", "CONTACT 40 x 40", rms(error), 0.005)
    yield Row.at_most("exact 40 x 40, largest", "CONTACT 40 x 40", float(error.max()), 0.02)
    yield Row.shown("exact 40 x 40, moment over mu Fn sqrt(ab)", "CONTACT 40 x 40", rms(moment))


def _table(rows: pd.DataFrame) -> Iterator[Row]:
    """Forces for every a/b, moments for all."""
    for ratio in sorted((*ASKED, *BEYOND)):
        error = force_error(rows[rows["aob"] == ratio], "table")
        yield Row.at_most(f"table, a/b {ratio:g}", "full theory", rms(error), 0.005)
        yield Row.at_most(f"table, a/b {ratio:g}, largest", "full theory", float(error.max()), 0.02)
    moment = computed(rows, "table")[2] - rows["mz_rel_c"]
    yield Row.shown("table, moment over mu Fn sqrt(ab)", "full theory", rms(moment.to_numpy()))


def _fastsim(
    rows: pd.DataFrame, asked: pd.DataFrame, form: str, limit: float, options: dict[str, Any]
) -> Iterator[Row]:
    """All a/b together as asked, on the fine grid beside, each a/b by itself, moments."""

    def error(of: pd.DataFrame, n: int = 16) -> float:
        return rms(force_error(of, "fastsim", elements=(n, n), **options))

    yield Row.at_most(f"FASTSIM 16 x 16, {form}, a/b 0.2 to 5", "full theory", error(asked), limit)
    yield Row.shown(f"FASTSIM 40 x 40, {form}, a/b 0.2 to 5", "full theory", error(asked, 40))
    for ratio in (*ASKED, *BEYOND):
        of = rows[rows["aob"] == ratio]
        what, measured = f"FASTSIM 16 x 16, {form}, a/b {ratio:g}", error(of)
        if form == "plain":
            yield Row.shown(what, "full theory", measured)
        else:
            yield Row.at_most(what, "full theory", measured, limit)
    moment = computed(asked, "fastsim", **options)[2] - asked["mz_rel_c"]
    yield Row.shown(f"FASTSIM 16 x 16, {form}, moment over mu Fn sqrt(ab)", "full theory", rms(moment.to_numpy()))


def _traction() -> Iterator[Row]:
    for series, (name, limit, share) in {3: ("FASTSIM", 0.33, 1.0), 4: ("modified FASTSIM", 0.36, 1.0)}.items():
        xi, reference = series_rows(series)
        error = np.abs(traction(xi, series) - reference)
        what = f"traction curve, {name} 40 x 40, largest over mu Fn"
        yield Row.at_most(what, "CONTACT's", 100 * float(error.max()) / (limit * WHEEL_LOAD), share, "%")


def series_rows(number: int) -> tuple[Values, Values]:
    """Creepages and Fx [N] of a series of CONTACT's example."""
    rows = pd.read_csv(DATA / "traction.csv", comment="#")
    rows = rows[rows["series"] == number]
    return rows["xi"].to_numpy(), rows["fx"].to_numpy()


def traction(xi: Values, series: int) -> Values:
    """Fx [N] of the locomotive's wheel, by FASTSIM (series 3) or by modified FASTSIM (4)."""
    options: dict[str, Any] = {"slope": SLOPE, "falling": FALLING, "speed": SPEED} if series == 4 else {}
    friction = 0.36 if series == 4 else 0.33
    patch: dict[str, Any] = {**ELLIPSE, **STEEL, "xi": xi, "normal_force": WHEEL_LOAD, "friction": friction}
    fx, _, _ = creep_force("fastsim", eta=0.0, phi=0.0, elements=(40, 40), **patch, **options)
    return np.asarray(fx)


def figure() -> Figure:
    """Each law over one creepage with CONTACT's rows, and the traction curves."""
    from validation.contact_creep.picture import drawn

    return drawn()
