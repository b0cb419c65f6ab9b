"""Largest displacement of the wheelsets by error and curve, one panel a strategy.
Contact with the flange stands out by shape, not by colour alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure

if TYPE_CHECKING:
    import pandas as pd

LEVELS = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
"""Of the colours [mm]."""

DARK = 3.0
"""Cells above this have white figures [mm]."""

WIDTH_MIN, HEIGHT_MIN = 6.6, 2.4
"""Of the figure [inch]: pages scale it to their width, and the colour bar needs its height."""


def errors_figure(table: pd.DataFrame) -> Figure:
    """One panel a strategy: errors down, curves across, the largest displacement [mm] in colour and figures.

    table: columns `strategy`, `error`, `curve`, `y_max_mm`, `flange_contact`, `outcome`, `touched`.
    """
    names = list(dict.fromkeys(table["strategy"]))
    errors, curves = list(dict.fromkeys(table["error"])), list(dict.fromkeys(table["curve"]))
    columns = min(2, len(names))
    rows = -(-len(names) // columns)
    wide, high = 2.6 + 0.62 * len(curves) * columns + 0.3 * columns, 0.9 + rows * (0.55 + 0.3 * len(errors))
    figure = Figure(figsize=(max(wide, WIDTH_MIN), max(high, HEIGHT_MIN)), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    norm, image = BoundaryNorm(LEVELS, 256, extend="max"), None
    for axis, name in zip(axes.flat, names, strict=False):
        of = table[table["strategy"] == name]
        values = np.full((len(errors), len(curves)), np.nan)
        for row in of.itertuples():
            i, j = errors.index(row.error), curves.index(row.curve)
            failed = row.outcome != "completed"
            values[i, j] = np.nan if failed else row.y_max_mm
            words = "×" if failed else f"{row.y_max_mm:.1f}" if row.touched else f"({row.y_max_mm:.1f})"
            colour = "white" if not failed and row.y_max_mm > DARK else "black"
            weight = "bold" if row.flange_contact else "normal"
            axis.text(j, i, words, ha="center", va="center", color=colour, fontsize=8, fontweight=weight)
            if row.flange_contact:
                axis.plot([j - 0.42, j + 0.42], [i + 0.4, i + 0.4], color=colour, linewidth=1.5)
        image = axis.imshow(values, cmap="cividis_r", norm=norm, aspect="auto")
        axis.set_title(name, fontsize=9, loc="left")
        axis.set_xticks(range(len(curves)), curves)
        axis.set_yticks(range(len(errors)), errors)
        axis.tick_params(length=0, labelsize=8)
        axis.grid(visible=False)
    for axis in axes.flat[len(names) :]:
        axis.set_axis_off()
    for axis in axes[-1]:
        axis.set_xlabel("curve (radius in m)", fontsize=9)
    assert image is not None
    bar = figure.colorbar(image, ax=axes, ticks=list(LEVELS), shrink=0.9)
    bar.set_label("largest displacement [mm]", fontsize=8)
    bar.ax.tick_params(labelsize=8)
    return figure
