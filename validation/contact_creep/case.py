"""Creep forces of an ellipse against the full theory: every law, every kind of creepage, round and slender patches.
Then FASTSIM and its modified form against CONTACT's own, creepage by creepage."""

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
Apache-2.0), full theory, for a/b 0.5 and 1; for 0.2, 2 and 5 our own solver of the full theory, which is within 0.0015
(root mean square) of CONTACT on all rows of the first two. Figures are root mean squares of |dF| over mu Fn. Plain
FASTSIM has its largest errors where creepage and spin act together: there three flexibilities give the traction the
wrong direction, the more so the more they differ (a/b 0.2). A coarse grid hides part of the error of the method, so
40 x 40 stands beside. The traction curves are CONTACT's example of a locomotive's wheel: its own FASTSIM counts the
first half element of a strip as a whole one, which makes it 3 % stiffer at rest.
"""

RATIOS = (0.2, 0.5, 1.0, 2.0, 5.0)
PLAIN: dict[str, Any] = {"blended": False}
BLENDED: dict[str, Any] = {"blended": True}

SLOPE = (0.54, 0.02, 0.62)
FALLING = (0.38, 0.7)
ELLIPSE = {"a": 6.303597e-3, "b": 12.607194e-3}
"""Hertz's, for A = 0.8 1/m along and a/b = 0.5 under 106.7 kN."""
WHEEL_LOAD, SPEED = 106.7e3, 10.0


def run() -> Iterator[Row]:
    """The laws against the full theory, then the traction curves."""
    rows = references()
    for name, options, limit in (("plain", PLAIN, 0.045), ("blended flexibility", BLENDED, 0.035)):
        for n in (16, 40):
            error = force_error(rows, "fastsim", elements=(n, n), **options)
            what = f"FASTSIM {n} x {n}, {name}, a/b 0.2 to 5"
            yield (
                Row.at_most(what, "full theory", rms(error), limit)
                if n == 16
                else Row.shown(what, "full theory", rms(error))
            )
        for ratio in RATIOS:
            part = rows[rows["aob"] == ratio]
            what, error = f"FASTSIM 16 x 16, {name}, a/b {ratio:g}", force_error(part, "fastsim", **options)
            if name == "plain":
                yield Row.shown(what, "full theory", rms(error))
            else:
                yield Row.at_most(what, "full theory", rms(error), limit)
        moment = computed(rows, "fastsim", **options)[2] - rows["mz_rel_c"]
        yield Row.shown(f"FASTSIM 16 x 16, {name}, moment over mu Fn sqrt(ab)", "full theory", rms(moment.to_numpy()))
    no_spin = rows[rows["phi"] == 0.0]
    for law in ("polach", "shen_hedrick_elkins"):
        yield Row.at_most(f"{law}, without spin", "full theory", rms(force_error(no_spin, law)), 0.05)
    yield Row.shown("polach, with spin", "full theory", rms(force_error(rows, "polach")))
    small = no_spin[np.hypot(no_spin["fx_rel"], no_spin["fy_rel"]) < 0.06]
    yield Row.at_most(
        "linear, up to 6 % of mu Fn, without spin", "full theory", rms(force_error(small, "linear")), 0.002
    )
    yield from _traction()


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
