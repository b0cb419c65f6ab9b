"""The picture of the case: critical speed over conicity, and the way from the reference model to ours in steps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from klingel.plot.style import INK, PALE, styled
from klingel.scenario import CreepLaw
from validation.critical_speed.case import ASKED
from validation.critical_speed.speeds import REFERENCE, S1002, STEPS, WHEELS, contact, equivalent, ours, steps

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
LINES = ("-", (0, (5, 1.8)), (0, (4, 1.4, 1, 1.4)), (0, (1, 1.2)))
LAWS: tuple[CreepLaw, ...] = ("linear", "table")
MARKERS = ("o", "s", "^", "D")


def drawn() -> Figure:
    """Speeds over conicity on the left, steps on the right."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    with styled():
        figure = Plain(figsize=(7.6, 3.9))
        FigureCanvasAgg(figure)
        over, along = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
        _speeds(over)
        _steps(along)
        over.set_ylim(35.0, 105.0)
        along.set_ylim(35.0, 105.0)
    return figure


def _speeds(axis: Axes) -> None:
    """Reference points, textbook and ours over conicity."""
    reference = pd.read_csv(REFERENCE, comment="#")
    at = [equivalent(contact(running)) for running in WHEELS.values()]
    axis.plot(reference["conicity"], reference["speed"], "o", color=INK, ms=6, label="17-degree model")
    curves = [steps(conicity) for conicity in WHEELS]
    axis.plot(list(WHEELS), [c[0] for c in curves], color=PALE, ls=LINES[1], label="textbook, its assumptions")
    axis.plot(at, [c[-2] for c in curves], color=GREEN, ls=LINES[2], label="textbook")
    axis.plot(at, [c[-1] for c in curves], color=ORANGE, ls="-", lw=3.2, alpha=0.45, label="textbook, shift of load")
    axis.plot(
        at, [ours(w, "linear") for w in WHEELS.values()], "s-", color=BLUE, ms=4, lw=1.2, label="ours, linear creep"
    )
    table = [ours(w, "table") for w in WHEELS.values()]
    axis.plot(at, table, "^", color=BLUE, ls=LINES[3], ms=4.5, mfc="white", label="ours, table")
    middle = equivalent(contact(S1002))
    axis.plot(middle, ours(S1002, "linear"), "P", color=BLUE, ms=8, mec="white", ls="", label="ours, S1002, linear")
    axis.plot(middle, ours(S1002, "table"), "P", color="white", ms=7, mec=BLUE, ls="", label="ours, S1002, table")
    axis.set_xlabel("equivalent conicity")
    axis.set_ylabel("linear critical speed  [m/s]")
    axis.legend(loc="lower left", fontsize=7.5, handlelength=2.4)


def _steps(axis: Axes) -> None:
    """What each kind of term does, for four conicities."""
    names = (*STEPS, "ours", "ours, table")
    for conicity, line, marker in zip(ASKED, LINES, MARKERS, strict=True):
        speeds = (*steps(conicity), *(ours(WHEELS[conicity], law) for law in LAWS))
        axis.plot(range(len(names)), speeds, marker, color=INK, ls=line, ms=4, lw=1.1, label=f"conicity {conicity:.2f}")
        axis.annotate(
            f"{conicity:.2f}", (len(names) - 1, speeds[-1]), (5, -3), textcoords="offset points", fontsize=7.5
        )
    axis.set_xticks(range(len(names)), names, rotation=38, ha="right", rotation_mode="anchor", fontsize=7.5)
    axis.set_xlim(-0.3, len(names) - 0.3)
    axis.set_title("what each term does, at four conicities", fontsize=9)
