"""Figures of a study of robustness: what inputs do alone (tornado), how often what is exceeded, runs over each input.
Functions of plain tables; the words of inputs are given with them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

from klingel.plot.style import GRID, INK, PALE, styled

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

LOW, HIGH, BAD = "#0072B2", "#E69F00", "#D55E00"
"""Of the palette of Okabe and Ito."""

WHOLE_BAR, HALF_BAR = 0.62, 0.31
"""Heights of the bars of a tornado over the distance of its lines."""


@dataclass(frozen=True)
class InputWords:
    """How an input is written: title, unit that people read with how many of it make one SI unit, ends of its range."""

    title: str
    unit: str
    factor: float
    low: str
    high: str

    @property
    def label(self) -> str:
        """Of an axis."""
        return f"{self.title}  [{self.unit}]" if self.unit else self.title


def tornado(
    rows: pd.DataFrame, nominal: float, words: Mapping[str, InputWords], *, title: str, label: str, limit: float | None
) -> Figure:
    """What each input does alone to one figure of merit, widest first.

    rows: columns input, at_low, at_high, least, most, as `klingel.study.robustness_figures.ranges` makes them; nominal:
    the figure with all inputs nominal; label: of the axis; limit: drawn where the axis reaches it, None for none. Bars
    reach from the nominal value to those at both ends of the range; the line behind spans what lies between, too.
    """
    lines = len(rows)
    with styled():
        figure = Figure(figsize=(6.6, 1.5 + 0.36 * max(lines, 1)))
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        axes.grid(visible=False, axis="y")
        for i, row in enumerate(rows.to_dict("records")):
            axes.plot([row["least"], row["most"]], [i, i], color=PALE, lw=1.2, solid_capstyle="butt", zorder=2)
            sides = (
                (float(row["at_low"]), LOW, "", -0.5 * HALF_BAR),
                (float(row["at_high"]), HIGH, "////", 0.5 * HALF_BAR),
            )
            for value, color, hatch, up in sides:
                if not math.isnan(value):
                    axes.barh(
                        i + up,
                        value - nominal,
                        HALF_BAR,
                        left=nominal,
                        color=color,
                        hatch=hatch,
                        ec=INK,
                        lw=0.4,
                        zorder=3,
                    )
        axes.axvline(nominal, color=INK, lw=0.8, zorder=4)
        reach = axes.get_xlim()
        if limit is not None and reach[0] <= limit <= reach[1] * 1.02:
            axes.axvline(limit, color=BAD, lw=1.0, ls=(0, (4, 3)), zorder=4)
        named = [words[name] for name in rows["input"]]
        axes.set_yticks(range(lines), [f"{each.title}\n{each.low} to {each.high}" for each in named])
        axes.set_ylim(lines - 0.5, -0.5)
        axes.set_xlabel(label)
        axes.set_title(title)
        handles = [
            Patch(facecolor=LOW, edgecolor=INK, linewidth=0.4, label="at the low end"),
            Patch(facecolor=HIGH, edgecolor=INK, linewidth=0.4, hatch="////", label="at the high end"),
            Line2D([], [], color=PALE, lw=1.2, label="anywhere between"),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=3)
        return figure


def exceedance(values: Mapping[str, NDArray[np.float64]], limits: Mapping[str, float], *, title: str) -> Figure:
    """Share of the runs that reach a value, over the value, down to one run: a panel a figure.

    values: of all runs by the label of their axis, NaN where a run has none; limits: to draw, by the same labels.
    """
    with styled():
        figure = Figure(figsize=(6.6, 1.2 + 1.9 * math.ceil(len(values) / 2)))
        FigureCanvasAgg(figure)
        panels = figure.subplots(math.ceil(len(values) / 2), 2, squeeze=False, sharey=True).ravel()
        for axes, (label, found) in zip(panels, values.items(), strict=False):
            ordered = np.sort(found[~np.isnan(found)])
            axes.step(ordered, 100.0 * (1.0 - np.arange(len(ordered)) / len(ordered)), where="pre", color=LOW)
            if label in limits:
                axes.axvline(limits[label], color=BAD, lw=1.0, ls=(0, (4, 3)))
            axes.set_yscale("log")
            axes.yaxis.set_major_formatter(FuncFormatter(lambda share, _: f"{share:g}"))
            axes.yaxis.set_minor_formatter(NullFormatter())
            axes.set_xlabel(label)
        for axes in panels[len(values) :]:
            axes.set_visible(False)
        for axes in panels[::2]:
            axes.set_ylabel("runs at or above  [%]")
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        return figure


def over_inputs(
    table: pd.DataFrame, names: Sequence[str], words: Mapping[str, InputWords], *, figure_name: str, label: str,
    failed: NDArray[np.bool_], limit: float | None, title: str,
) -> Figure:  # fmt: skip
    """Every run as a point over each input: one small panel an input, failing runs with another mark."""
    columns = 3
    rows = math.ceil(len(names) / columns)
    with styled():
        figure = Figure(figsize=(6.6, 0.6 + 1.75 * rows))
        FigureCanvasAgg(figure)
        panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
        found = table[figure_name].to_numpy(dtype=np.float64)
        top = float(np.nanmax(found)) if np.any(~np.isnan(found)) else 1.0
        height = np.where(np.isnan(found), 1.05 * top, found)
        for axes, name in zip(panels, names, strict=False):
            x = table[name].to_numpy(dtype=np.float64) * words[name].factor
            axes.scatter(x[~failed], height[~failed], s=5.0, color=LOW, lw=0.0, alpha=0.6, rasterized=False)
            axes.scatter(x[failed], height[failed], s=12.0, color=BAD, marker="x", lw=0.8)
            if limit is not None:
                axes.axhline(limit, color=INK, lw=0.8, ls=(0, (4, 3)))
            axes.set_xlabel(words[name].label)
            axes.xaxis.set_major_locator(MaxNLocator(4))
            axes.grid(color=GRID)
        for axes in panels[len(names) :]:
            axes.set_visible(False)
        for axes in panels[::columns]:
            axes.set_ylabel(label)
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        return figure
