"""Creepages along which the laws are drawn, from rest to full sliding, and their exact forces.
Writes exact.csv: python -m validation.creep_curves.curves (half a minute)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from validation.exact_theory.scaled import HALF, Values, scales, solved, write

FILE = Path(__file__).parent / "exact.csv"
RATIOS = (0.2, 1.0, 5.0)
SPIN = 1.0
"""Scaled spin v3 that is held while another creepage grows: at a/b 1 that of a contact angle of 15 degrees (80 kN)."""
LAST = 0.96
"""Last place on the compressed axis: 36 times the linear limit."""
NAMES = ("xi", "eta", "phi")
ABOUT = (
    "Exact creep forces along curves by Klingel's own solver, 40 x 40 elements, nu 0.28: python -m",
    "validation.creep_curves.curves. aob is a/b; xi, eta, phi are xi*, eta*, phi*, forces over mu N, moment over",
    "mu N sqrt(a b), on the wheel, as in docs/theory/exact.md; t is the place on the compressed axis, v/(1.5 + |v|).",
)


@dataclass(frozen=True)
class Curve:
    """One creepage that grows while the spin stays.

    name: in the file; over: which of xi, eta, phi grows; spin: v3 that stays; both: negative creepages too.
    """

    name: str
    over: int
    spin: float = 0.0
    both: bool = False

    def places(self, count: int) -> Values:
        """So many places on the compressed axis from rest (or from the other end) on."""
        return np.linspace(-LAST if self.both else 0.0, LAST, count)

    def creepage(self, ratio: float, t: Values) -> tuple[Values, Values, Values]:
        """xi*, eta*, phi* at places on the compressed axis."""
        v = np.zeros((3, len(t)))
        v[2] = self.spin
        v[self.over] = HALF * t / (1.0 - np.abs(t))
        xi, eta, phi = (row / s for row, s in zip(v, scales(ratio), strict=True))
        return xi, eta, phi


CURVES = (
    Curve("xi", 0),
    Curve("eta", 1),
    Curve("phi", 2),
    Curve("eta at spin", 1, SPIN, both=True),
    Curve("xi at spin", 0, SPIN),
)


def rows() -> pd.DataFrame:
    """Every curve at every a/b, in the digits of the file; rest itself is left out."""
    parts = []
    for ratio in RATIOS:
        for curve in CURVES:
            t = curve.places(33 if curve.both else 25)
            t = t if curve.spin else t[t != 0.0]
            part = dict(zip(NAMES, curve.creepage(ratio, t), strict=True))
            parts.append(pd.DataFrame({"aob": ratio, "curve": curve.name, "t": t.round(4)} | part))
    found = pd.concat(parts, ignore_index=True)
    return found.assign(**{name: [float(f"{x:.6g}") for x in found[name]] for name in NAMES})


if __name__ == "__main__":
    write(FILE, solved(rows()), ABOUT)
