"""The picture of the case: maps of the table's error, and its spread over a/b against the limits.
Maps show the largest error of each field; darker is worse in colour and in grey."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from klingel.plot.style import INK, PALE, styled
from validation.creep_table import spin
from validation.creep_table.case import MOST, RMS_LIMIT
from validation.creep_table.points import ENDS, points
from validation.exact_theory.scaled import HALF, Values, off, off_moment, rms

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

SIZES = (0.0, 0.5, 1.0, 2.0, 5.0, 30.0)
"""|v| marked on the compressed axis."""
RATIOS: Values = np.geomspace(*ENDS, 13)
LIFTS: Values = np.degrees(np.arcsin(np.linspace(0.0, 1.0, 11)))
"""Edges of the fields: in a/b, and in the spin's angle (equally many points in each)."""
PLACES: Values = np.linspace(0.0, 1.0, 13)
"""Edges on the compressed axis."""


def drawn() -> Figure:
    """Two maps above, spread of forces and moments below."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    rows = points()
    error, moment = 100 * off(rows, "table"), 100 * np.abs(off_moment(rows, "table"))
    place = (rows["size"] / (HALF + rows["size"])).to_numpy()
    ratio, lift = rows["aob"].to_numpy(), rows["lift"].to_numpy()
    with styled():
        figure = Plain(figsize=(7.4, 6.4))
        FigureCanvasAgg(figure)
        (kinds, ratios), (force, turning) = figure.subplots(2, 2)
        _map(kinds, LIFTS, lift, place, error)
        kinds.set_xticks([0, 15, 30, 45, 60, 90])
        kinds.set_xlabel("0: creepage only,  90: spin only  [°]")
        mesh = _map(ratios, RATIOS, ratio, place, error)
        figure.colorbar(mesh, ax=[kinds, ratios], label="largest |ΔF|/(μN)  [%]", pad=0.01, extend="max")
        _spread(force, ratio, error, "|ΔF|/(μN)  [%]")
        _, lines = spin.points()
        alone = lines.assign(error=100 * off(lines, "table")).groupby("aob")["error"].max()
        force.semilogy(alone.index, alone, "D", color=INK, mfc="none", ls="", ms=3.5, label="largest, spin alone")
        force.axhline(100 * MOST, color=INK, lw=0.8, ls=(0, (5, 1.8)), label="limit of the largest")
        force.axhline(100 * RMS_LIMIT, color=INK, lw=0.8, ls=(0, (1, 1.5)), label="limit of the mean square")
        _spread(turning, ratio, moment, "|ΔMz|/(μN c)  [%]")
        for axis in (ratios, force, turning):
            axis.set_xscale("log")
            axis.set_xticks([1 / 36, 0.1, 0.3, 1, 3, 10, 36], ["1/36", "0.1", "0.3", "1", "3", "10", "36"])
            axis.minorticks_off()
            axis.set_xlabel("a/b")
        force.legend(loc="lower right", ncol=2, fontsize=6.2, handlelength=1.5, columnspacing=0.7, borderaxespad=0.2)
    return figure


def _map(axis: Axes, edges: Values, x: Values, place: Values, error: Values) -> QuadMesh:
    """The largest error of each field over the size of the creepage."""
    most = np.zeros((len(PLACES) - 1, len(edges) - 1))
    row = np.clip(np.digitize(place, PLACES) - 1, 0, most.shape[0] - 1)
    column = np.clip(np.digitize(x, edges) - 1, 0, most.shape[1] - 1)
    np.maximum.at(most, (row, column), error)
    mesh = axis.pcolormesh(edges, PLACES, most, cmap="cividis_r", vmin=0.0, vmax=100 * MOST)
    axis.grid(visible=False)
    sizes = np.array(SIZES)
    axis.set_yticks(sizes / (HALF + sizes), [f"{size:g}" for size in sizes])
    axis.set_ylabel("size of the scaled creepage |v|")
    return mesh


def _spread(axis: Axes, ratio: Values, error: Values, label: str) -> None:
    """Root mean square, 95th percentile and largest in each band of a/b."""
    band = np.clip(np.digitize(ratio, RATIOS) - 1, 0, len(RATIOS) - 2)
    middles = np.sqrt(RATIOS[1:] * RATIOS[:-1])
    parts = [error[band == k] for k in range(len(middles))]
    axis.semilogy(
        middles, [part.max() for part in parts], "v", color="#D55E00", ls=(0, (5, 1.8)), ms=4, label="largest"
    )
    ninety = [np.quantile(part, 0.95) for part in parts]
    axis.semilogy(middles, ninety, "s", color=PALE, ls=(0, (4, 1.4, 1, 1.4)), ms=3.5, label="95 of 100 are below")
    axis.semilogy(middles, [rms(part) for part in parts], "o", color="#0072B2", ls="-", ms=4, label="root mean square")
    axis.set_ylim(0.005, 10.0)
    axis.set_ylabel(label)
