"""The picture of the case: every law along every curve, the exact theory's points upon them.
The abscissa is compressed, v/(1.5 + |v|), so that rest and full sliding are both in sight."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from klingel.plot.style import INK, styled
from validation.creep_curves.curves import CURVES, FILE, LAST, RATIOS, Curve
from validation.creep_curves.laws import LAWS, MOMENT_LAWS
from validation.exact_theory.scaled import FORCES, HALF, forces, read

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = (
    ("xi", "fx"),
    ("eta", "fy"),
    ("phi", "fy"),
    ("phi", "mz"),
    ("eta at spin", "fy"),
    ("xi at spin", "fx"),
    ("xi at spin", "fy"),
)
"""Curve and force of each row of the picture."""
ORDINATE = {"fx": "Fx/(μN)", "fy": "Fy/(μN)", "mz": "Mz/(μN c)"}
ABSCISSA = ("longitudinal  S₁ξ*", "lateral  S₂η*", "spin  S₃φ*")
TICKS = (0.0, 0.5, 1.0, 2.0, 5.0, 30.0)
TICKS_BOTH = (-30.0, -3.0, -1.0, 0.0, 1.0, 3.0, 30.0)


def drawn() -> Figure:
    """Seven rows of curves, one column for each a/b."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    rows, by_name = read(FILE), {curve.name: curve for curve in CURVES}
    with styled():
        figure = Plain(figsize=(7.4, 12.4))
        FigureCanvasAgg(figure)
        axes = figure.subplots(len(PANELS), len(RATIOS), sharey="row")
        for line, (name, force) in zip(axes, PANELS, strict=True):
            for axis, ratio in zip(line, RATIOS, strict=True):
                part = rows[(rows["curve"] == name) & (rows["aob"] == ratio)]
                _panel(axis, by_name[name], ratio, force, part)
            line[0].set_ylabel(ORDINATE[force])
            line[1].set_title(_title(by_name[name], force), fontsize=8.5, loc="center")
        for axis, ratio in zip(axes[0], RATIOS, strict=True):
            axis.annotate(f"a/b {ratio:g}", (1.0, 0.95), xycoords="axes fraction", ha="right", va="top", weight="bold")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncol=3)
    return figure


def _title(curve: Curve, force: str) -> str:
    held = f", spin S₃φ* {curve.spin:g} held" if curve.spin else ""
    what = {"fx": "longitudinal force", "fy": "lateral force", "mz": "moment"}[force]
    return f"{what} over {ABSCISSA[curve.over].split()[0]} creepage{held}".replace("spin creepage", "spin")


def _panel(axis: Axes, curve: Curve, ratio: float, force: str, exact: pd.DataFrame) -> None:
    t, place = curve.places(181), FORCES.index(force)
    for law, label, options, color, line in LAWS:
        if force == "mz" and law not in MOMENT_LAWS:
            continue
        found = forces(law, ratio, curve.creepage(ratio, t), **options)
        axis.plot(t, found[place], color=color, ls=line, lw=0.8 if law == "table" else 1.4, label=label)
    axis.plot(exact["t"], exact[force], "o", color=INK, mfc="none", ms=3.2, mew=0.8, label="exact, 40 × 40")
    ticks = np.array(TICKS_BOTH if curve.both else TICKS)
    axis.set_xticks(ticks / (HALF + np.abs(ticks)), [f"{tick:g}" for tick in ticks])
    axis.tick_params(labelsize=7)
    axis.set_xlim(-1.02 * LAST if curve.both else -0.02, 1.02 * LAST)
    axis.set_xlabel(ABSCISSA[curve.over], fontsize=8, labelpad=1)
