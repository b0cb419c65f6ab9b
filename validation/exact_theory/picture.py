"""The picture of the case: coefficients over the size of the elements and errors of the forces over their number.
First order shows as straight lines in both; CONTACT's own values are hollow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from klingel.plot.style import INK, PALE, styled
from validation.exact_theory.case import (
    NAMES,
    coefficient_limit,
    contact_coefficients,
    contact_error,
    grid_error,
    kept_coefficients,
)
from validation.exact_theory.references import DATA, GRIDS, RATIOS, creepages
from validation.exact_theory.scaled import read, rms

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOOKS = (("#0072B2", "o", "-"), ("#D55E00", "s", (0, (5, 1.8))), ("#009E73", "^", (0, (1, 1.5))))
"""Colour, mark and line of C11, C22 and C23."""


def drawn() -> Figure:
    """Two rows of panels."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    with styled():
        figure = Plain(figsize=(7.4, 5.4))
        FigureCanvasAgg(figure)
        axes = figure.subplots(2, len(RATIOS), sharey="row", sharex="row")
        for ratio, above, below in zip(RATIOS, axes[0], axes[1], strict=True):
            above.set_title(f"a/b {ratio:g}")
            _coefficients(above, ratio)
            _forces(below, ratio)
        axes[0, 0].set_ylabel("off the limit  [%]")
        axes[0, 0].legend(loc="upper left", fontsize=7.5)
        axes[1, 0].set_ylabel("|ΔF|/(μN), 22 creepages")
        handles, labels = axes[1, RATIOS.index(1.0)].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncol=5, fontsize=7.5)
    return figure


def _coefficients(axis: Axes, ratio: float) -> None:
    kept, limit, size = kept_coefficients(ratio), coefficient_limit(ratio), 1 / np.array(GRIDS)
    theirs, error = contact_coefficients(ratio)
    for i, (name, (color, mark, line)) in enumerate(zip(NAMES, LOOKS, strict=True)):
        off = 100 * (kept[:, i] / limit[i] - 1)
        axis.plot([*size, 0.0], [*off, 0.0], color=color, ls=line, lw=1.2)
        axis.plot(size, off, mark, color=color, ms=4.5, label=name)
        value, deviation = 100 * (theirs[i] / limit[i] - 1), 100 * error[i] / limit[i]
        label, beside = "CONTACT's limit" if name == "C23" else None, 0.002 * (i - 3)
        axis.errorbar(beside, value, deviation, fmt=mark, color=color, mfc="none", ms=4.5, lw=0.8, label=label)
    axis.axhline(0.0, color=INK, lw=0.6)
    axis.set_xticks([0.0, *(1 / n for n in GRIDS)], ["0", *(f"1/{n}" if n < 80 else "" for n in GRIDS)])
    axis.tick_params(axis="x", labelsize=7.5)
    axis.set_xlabel("size of the elements 1/n")


def _forces(axis: Axes, ratio: float) -> None:
    rows, n = read(DATA / "forces.csv"), np.array(GRIDS)
    errors = [grid_error(rows, ratio, k) for k in GRIDS]
    axis.loglog(n, [error.max() for error in errors], "v", color="#D55E00", ls=(0, (5, 1.8)), label="largest")
    axis.loglog(n, [rms(error) for error in errors], "o", color="#0072B2", ls="-", label="root mean square")
    axis.loglog(n, 0.04 / n, color=PALE, lw=0.8, ls=(0, (1, 1.5)), label="first order")
    if ratio == 1.0:
        error = contact_error(creepages(), rows)
        axis.loglog(40, error.max(), "v", color=INK, mfc="none", ms=9, label="CONTACT, largest")
        axis.loglog(40, rms(error), "o", color=INK, mfc="none", ms=9, label="CONTACT, r. m. s.")
    axis.set_xticks(n, [f"{k}" for k in n])
    axis.minorticks_off()
    axis.set_xlabel("elements each way n")
