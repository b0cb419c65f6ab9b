"""The picture of the case: error of every law over a/b, over size and kind of the creepage, and its distribution.
All ordinates are logarithmic: the laws differ by orders of magnitude."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from klingel.plot.style import INK, styled
from validation.creep_curves.laws import LAWS
from validation.creep_table.points import ENDS, points
from validation.exact_theory.case import grid_error
from validation.exact_theory.references import DATA, RATIOS
from validation.exact_theory.scaled import HALF, Values, off, read, rms

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PLACES = (0.0, 0.5, 1.0, 2.0, 5.0, 30.0)
"""Sizes |v| marked on the compressed axis."""
LABEL = "root mean square of |ΔF|/(μN)"


def drawn() -> Figure:
    """Four panels."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    rows = points()
    ratio, lift = rows["aob"].to_numpy(), rows["lift"].to_numpy()
    place = (rows["size"] / (HALF + rows["size"])).to_numpy()
    with styled():
        figure = Plain(figsize=(7.4, 6.6))
        FigureCanvasAgg(figure)
        axes = figure.subplots(2, 2)
        over_ratio, over_size, over_lift, share = axes.flat
        for law, label, options, color, line in LAWS:
            error = off(rows, law, **options)
            edges = np.geomspace(*ENDS, 13)
            _binned(over_ratio, np.sqrt(edges[1:] * edges[:-1]), edges, ratio, error, color, line)
            for axis, edges, x in ((over_size, np.linspace(0, 1, 13), place), (over_lift, LIFTS, lift)):
                _binned(axis, (edges[1:] + edges[:-1]) / 2, edges, x, error, color, line)
            above = 1.0 - np.arange(len(error)) / len(error)
            share.loglog(np.sort(error), above, color=color, ls=line, lw=1.4, label=label)
        forces = read(DATA / "forces.csv")
        own = [rms(grid_error(forces, g, 40)) for g in RATIOS]
        over_ratio.plot(RATIOS, own, "D", color=INK, mfc="none", ms=4.5, label="grid error of the reference")
        _finish(over_ratio, over_size, over_lift, share)
        handles, labels = share.get_legend_handles_labels()
        extra = over_ratio.get_legend_handles_labels()
        figure.legend(handles + extra[0], labels + extra[1], loc="outside upper center", ncol=3)
    return figure


LIFTS: Values = np.degrees(np.arcsin(np.linspace(0.0, 1.0, 11)))
"""Edges of the bands of the spin's angle: equally many points in each."""


def _binned(axis: Axes, middles: Values, edges: Values, x: Values, error: Values, color: str, line: Any) -> None:
    inside = np.clip(np.digitize(x, edges) - 1, 0, len(middles) - 1)
    axis.semilogy(middles, [rms(error[inside == k]) for k in range(len(middles))], color=color, ls=line, lw=1.4)


def _finish(over_ratio: Axes, over_size: Axes, over_lift: Axes, share: Axes) -> None:
    over_ratio.set_xscale("log")
    over_ratio.set_xticks([1 / 36, 0.1, 0.3, 1, 3, 10, 36], ["1/36", "0.1", "0.3", "1", "3", "10", "36"])
    over_ratio.minorticks_off()
    over_ratio.set_xlabel("a/b")
    sizes = np.array(PLACES)
    over_size.set_xticks(sizes / (HALF + sizes), [f"{size:g}" for size in sizes])
    over_size.set_xlabel("size of the scaled creepage |v|")
    over_lift.set_xticks([0, 15, 30, 45, 60, 75, 90])
    over_lift.set_xlabel("0: creepage only,  90: spin only  [°]")
    share.set_ylim(1e-3, 1.2)
    share.set_xlim(1e-5, 2.0)
    share.set_xlabel("|ΔF|/(μN)")
    share.set_ylabel("share of creepages with more")
    for axis in (over_ratio, over_size, over_lift):
        axis.set_ylabel(LABEL, fontsize=8)
        axis.set_ylim(1e-4, 1.0)
