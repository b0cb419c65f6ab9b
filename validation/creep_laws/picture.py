"""The picture of the case: error of every law over a/b, its distribution, and maps over kind and size of the creepage.
Errors are on logarithmic scales, as the laws differ by orders of magnitude; in the maps darker is worse."""

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
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

SIZES = (0.0, 0.5, 1.0, 2.0, 5.0, 30.0)
"""|v| marked on the compressed axis."""
BANDS: Values = np.geomspace(*ENDS, 13)
"""Edges of the bands of a/b."""
LIFTS: Values = np.degrees(np.arcsin(np.linspace(0.0, 1.0, 9)))
PLACES: Values = np.linspace(0.0, 1.0, 11)
"""Edges of the maps' fields: the spin's angle, equally many points in each, and the place on the compressed axis."""
SPREAD = (1e-4, 1.0)
SHADES = (1e-3, 1.0)
"""Errors that are in sight, in the curves and in the maps."""


def drawn() -> Figure:
    """Two panels of curves above one map for each law."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    rows = points()
    errors = [off(rows, law, **options) for law, _, options, _, _ in LAWS]
    with styled():
        figure = Plain(figsize=(7.4, 6.6))
        FigureCanvasAgg(figure)
        halves: Any = figure.subfigures(2, 1, height_ratios=(1.25, 1.0))
        above, below = halves
        over_ratio, share = above.subplots(1, 2)
        _over_ratio(over_ratio, rows["aob"].to_numpy(), errors)
        _share(share, errors)
        handles, labels = over_ratio.get_legend_handles_labels()
        above.legend(handles, labels, loc="outside upper center", ncol=3)
        maps = below.subplots(1, len(LAWS), sharey=True)
        place = (rows["size"] / (HALF + rows["size"])).to_numpy()
        for axis, (_, label, _, _, _), error in zip(maps, LAWS, errors, strict=True):
            mesh = _map(axis, rows["lift"].to_numpy(), place, error)
            axis.set_title(label.replace(" & ", "\n& ").replace(", ", ",\n"), fontsize=8)
        sizes = np.array(SIZES)
        maps[0].set_yticks(sizes / (HALF + sizes), [f"{size:g}" for size in sizes])
        maps[0].set_ylabel("size of the scaled creepage |v|")
        below.supxlabel("0°: creepage only,  90°: spin only", fontsize=9)
        below.colorbar(mesh, ax=list(maps), label="r. m. s. of |ΔF|/(μN)", pad=0.01, extend="min")
    return figure


def _over_ratio(axis: Axes, ratio: Values, errors: list[Values]) -> None:
    """Root mean square of every law in each band of a/b."""
    band, middles = _band(ratio, BANDS), np.sqrt(BANDS[1:] * BANDS[:-1])
    for (_, label, _, color, line), error in zip(LAWS, errors, strict=True):
        values = [rms(error[band == k]) for k in range(len(middles))]
        axis.loglog(middles, values, color=color, ls=line, lw=1.4, label=label)
    forces = read(DATA / "forces.csv")
    own = [rms(grid_error(forces, g, 40)) for g in RATIOS]
    axis.plot(RATIOS, own, "D", color=INK, mfc="none", ms=4.5, label="grid error of the reference")
    axis.set_ylim(*SPREAD)
    axis.set_xticks([1 / 36, 0.1, 0.3, 1, 3, 10, 36], ["1/36", "0.1", "0.3", "1", "3", "10", "36"])
    axis.minorticks_off()
    axis.set_xlabel("a/b")
    axis.set_ylabel("root mean square of |ΔF|/(μN)")


def _share(axis: Axes, errors: list[Values]) -> None:
    """How many creepages have more than an error."""
    for (_, _, _, color, line), error in zip(LAWS, errors, strict=True):
        axis.loglog(np.sort(error), 1.0 - np.arange(len(error)) / len(error), color=color, ls=line, lw=1.4)
    axis.set_xlim(SPREAD[0], 2.0)
    axis.set_ylim(1e-3, 1.2)
    axis.set_xlabel("|ΔF|/(μN)")
    axis.set_ylabel("share of creepages with more")


def _map(axis: Axes, lift: Values, place: Values, error: Values) -> QuadMesh:
    """Root mean square of each field over the kind and the size of the creepage."""
    from matplotlib.colors import LogNorm

    column, row = _band(lift, LIFTS), _band(place, PLACES)
    fields = np.array(
        [[rms(error[(row == i) & (column == k)]) for k in range(len(LIFTS) - 1)] for i in range(len(PLACES) - 1)]
    )
    mesh = axis.pcolormesh(LIFTS, PLACES, fields, cmap="cividis_r", norm=LogNorm(*SHADES))
    axis.grid(visible=False)
    axis.set_xticks([0, 30, 60, 90])
    axis.tick_params(labelsize=7.5)
    return mesh


def _band(x: Values, edges: Values) -> Values:
    """Which band each value is in."""
    return np.asarray(np.clip(np.digitize(x, edges) - 1, 0, len(edges) - 2))
