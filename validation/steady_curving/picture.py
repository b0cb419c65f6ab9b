"""The picture of the case: shift and attack angle of the wheelsets over the radius, solved for and settled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.plot.style import INK, LOOKS, styled
from validation.steady_curving.case import VEHICLES, WHEELSETS, settled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PANELS = (("y", "shift  [mm]"), ("yaw", "attack angle  [mrad]"))


def drawn() -> Figure:
    """First and second wheelset of the front bogie: circles and squares; crosses are settled runs."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    with styled():
        figure = Plain(figsize=(7.6, 3.6))
        FigureCanvasAgg(figure)
        axes = figure.subplots(1, 2)
        for axis, (quantity, label) in zip(axes, PANELS, strict=True):
            for vehicle in VEHICLES:
                look = LOOKS[vehicle]
                rows = [each for each in settled() if each.vehicle == vehicle]
                radius = [each.radius for each in rows]
                for wheelset, width, what in zip(WHEELSETS[:2], (1.6, 0.8), ("leading", "trailing"), strict=True):
                    name = f"{wheelset}.{quantity}"
                    solved = [1e3 * each.steady.values[name] for each in rows]
                    text = f"{look.label}, {what}" if quantity == "y" else None
                    axis.plot(radius, solved, color=look.color, ls=look.line, lw=width, label=text)
                    axis.plot(radius, [1e3 * each.run[name] for each in rows], "x", color=INK, ms=5)
            axis.set_xlabel("radius  [m]")
            axis.set_ylabel(label)
        axes[0].plot([], [], "x", color=INK, ms=5, label="settled run")
        figure.legend(loc="outside lower center", ncols=3, fontsize=7.5)
        figure.set_layout_engine("constrained")
    return figure
