"""Equivalent conicity of the nine reference cases of EN 15302, at every amplitude of the standard's tables.
Wheels A, B, H, I on rail A: equal wheels, a left wheel 2 mm smaller in diameter, and two different wheels."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from klingel.contact import Profile, WheelRailPair
from validation.common import Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Equivalent conicity: the nine cases of EN 15302"
ABOUT = """
Wheels A, B, H and I on rail A of EN 15302 (UIC 519), r0 460 mm, at 66 amplitudes from 1 to 7.5 mm: equal wheels (E1 to
E4), the left one 2 mm smaller in diameter (E5 to E8), two different ones (E9). Profiles, conicities and their bands as
tabulated by the standard, from github.com/criogenox (A_WRCC, B_ECC; MIT licence). The band is the standard's: the
smaller of 0.05 and half the conicity, widened by what 0.1 mm of amplitude changes. A row is the largest part of its
band, at any amplitude, that a case uses. The standard leaves out the roll of the wheelset; here it is included, which
costs up to 0.01.
"""

DATA = Path(__file__).parent / "data"

GAUGE = 1.4352
"""[m] The standard's 1435 mm are measured 14 mm below the origin of the rail's table, 0.49 mm below the top of
the rail; 14 mm below the top the same track is 1435.2 mm wide."""


@dataclass(frozen=True)
class Wheels:
    """One case: profiles of the left and the right wheel, and how much less the left one's radius is [m]."""

    left: str
    right: str
    smaller: float = 0.0


CASES: Mapping[str, Wheels] = {
    "E1": Wheels("A", "A"),
    "E2": Wheels("B", "B"),
    "E3": Wheels("H", "H"),
    "E4": Wheels("I", "I"),
    "E5": Wheels("A", "A", 1e-3),
    "E6": Wheels("B", "B", 1e-3),
    "E7": Wheels("H", "H", 1e-3),
    "E8": Wheels("I", "I", 1e-3),
    "E9": Wheels("B", "A"),
}


@dataclass(frozen=True)
class Point:
    """A conicity of the standard at an amplitude [m], with its band."""

    amplitude: float
    conicity: float
    least: float
    most: float


def reference(case: str) -> list[Point]:
    """The standard's conicities of a case."""
    lines = [line for line in (DATA / "conicity.csv").read_text().splitlines() if not line.startswith("#")]
    rows = [row for row in csv.DictReader(lines) if row["case"] == case]
    return [Point(*(float(row[name]) for name in ("amplitude_m", "tan_ge", "lo2", "hi2"))) for row in rows]


def computed(case: str, amplitudes: Sequence[float]) -> list[float]:
    """Our conicities of a case at amplitudes [m]."""
    wheels = CASES[case]
    rail = Profile.read(DATA / "rail_A.csv")

    def pair(wheel: str, radius: float) -> WheelRailPair:
        profile = Profile.read(DATA / f"wheel_{wheel}.csv")
        return WheelRailPair(profile, rail, rail_inclination=0.0, gauge=GAUGE, flange_back=1.36, radius=radius)

    left, right = pair(wheels.left, 0.46 - wheels.smaller), pair(wheels.right, 0.46)
    unequal = wheels.smaller > 0.0 or wheels.left != wheels.right
    return [float(v) for v in np.atleast_1d(right.equivalent_conicity(amplitudes, left=left if unequal else None))]


def used(point: Point, conicity: float) -> float:
    """Part of the band on our side of the reference that a conicity uses: 1 at its edge."""
    off = conicity - point.conicity
    width = point.most - point.conicity if off > 0.0 else point.conicity - point.least
    return abs(off) / width if width > 0.0 else 0.0 if off == 0.0 else np.inf


def run() -> Iterator[Row]:
    """One row a case: the largest part of its band that it uses."""
    for case, wheels in CASES.items():
        points = reference(case)
        found = computed(case, [p.amplitude for p in points])
        parts = [used(p, v) for p, v in zip(points, found, strict=True)]
        at = points[int(np.argmax(parts))].amplitude
        smaller = f", left one {2e3 * wheels.smaller:g} mm less in diameter" if wheels.smaller else ""
        quantity = f"{case}: wheels {wheels.left} and {wheels.right}{smaller}; most of the band, at {at * 1e3:.1f} mm"
        yield Row.at_most(quantity, "EN 15302", 100 * max(parts), 100.0, "%")


def figure() -> Figure:
    """Conicity over amplitude with the bands, one panel a case."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from klingel.plot.style import INK, styled

    with styled():
        drawn = Figure(figsize=(7.0, 6.2))
        FigureCanvasAgg(drawn)
        axes = drawn.subplots(3, 3, sharex=True, sharey=True)
        for axis, (case, wheels) in zip(axes.flat, CASES.items(), strict=True):
            points = reference(case)
            amplitude = [1e3 * p.amplitude for p in points]
            least, most = [p.least for p in points], [p.most for p in points]
            axis.fill_between(amplitude, least, most, color="#dcdcdc", lw=0, label="band of EN 15302")
            axis.plot(amplitude, [p.conicity for p in points], color=INK, lw=1.0, ls="--", label="EN 15302")
            axis.plot(
                amplitude, computed(case, [p.amplitude for p in points]), color="#D55E00", lw=1.4, label="Klingel"
            )
            smaller = ", left \u22122 mm" if wheels.smaller else ""
            axis.set_title(f"{case}: {wheels.left} and {wheels.right}{smaller}", size=9)
        for axis in axes[-1]:
            axis.set_xlabel("amplitude  [mm]")
        for axis in axes[:, 0]:
            axis.set_ylabel("tan γe")
        drawn.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawn
