"""The five figures of the curving study, after Figs 15 to 19 of Perez et al. 2004.
One history of the wheelsets in a curve, and four quantities over the curve radius."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.plot.style import BAND, INK, LOOKS, PALE, panels, styled

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from klingel.assess.header import Course


@dataclass(frozen=True)
class RadiusFigure:
    """One quantity over the curve radius.

    Attributes:
        column: of the summary table.
        title: above the figure.
        label: of the ordinate, with unit.
        floor: column of the least achievable value, drawn dotted; empty for none.
        floor_label: its name in the legend.
    """

    column: str
    title: str
    label: str
    floor: str = ""
    floor_label: str = ""


FIGURES: Mapping[str, RadiusFigure] = {
    "fig16": RadiusFigure("y_max_mm", "Largest lateral displacement of the wheelsets", "max |y|  [mm]"),
    "fig17": RadiusFigure("attack_angle_max_mrad", "Largest attack angle of the wheelsets", "max |yaw|  [mrad]"),
    "fig18": RadiusFigure(
        "lateral_force_max_kN",
        "Largest lateral force of a wheelset on the track",
        "max |ΣY|, 20 Hz low-pass  [kN]",
        "lateral_force_floor_kN",
        "own mass / 4 × unbalanced acceleration",
    ),
    "fig19": RadiusFigure("wear_index_N", "Mean wear index of the wheels in the arc", "mean |Fx ξ| + |Fy η|  [N]"),
}
"""Figs 16 to 19 by their names."""

WHEELSET_LINES: Sequence[tuple[str, float, str | tuple[int, tuple[float, ...]]]] = (
    (INK, 1.7, "-"),
    ("#0072B2", 0.95, (0, (5, 1.5))),
    ("#009E73", 0.95, (0, (4, 1.2, 1, 1.2))),
    ("#CC79A7", 0.95, (0, (1.2, 1.0))),
)
"""Colour, width and line style of the wheelsets, the leading one first."""


def displacement_history(
    runs: Mapping[str, xr.Dataset], wheelsets: Sequence[str], course: Course, *, caption: str
) -> Figure:
    """Fig. 15: lateral displacement of every wheelset over time, one panel a vehicle.

    Args:
        runs: vehicle to its run through the same curve; channels `<wheelset>.y` and `<wheelset>.s` in m.
        wheelsets: their names, the leading one first.
        course: where the curve lies; transitions and arc are shaded by the passage of the leading wheelset.
        caption: which curve, for the title.

    Returns:
        The figure. The active vehicles share one scale; the passive one has its own, as its label says.
    """
    with styled():
        figure, axes = panels(len(runs), height=0.9 + 1.75 * len(runs))
        figure.suptitle(f"Lateral displacement of the wheelsets, {caption}", x=0.01, ha="left", weight="bold", size=10)
        for axis, (vehicle, run) in zip(axes, runs.items(), strict=True):
            time = run["time"].to_numpy()
            _shade(axis, run[f"{wheelsets[0]}.s"].to_numpy(), time, course, name_zones=axis is axes[0])
            drawn = list(zip(wheelsets, WHEELSET_LINES, strict=False))
            for order, (wheelset, (color, width, line)) in enumerate(reversed(drawn)):
                y = 1e3 * run[f"{wheelset}.y"].to_numpy()
                axis.plot(time, y, color=color, lw=width, ls=line, zorder=2 + order, label=_rank(len(drawn) - order))
            axis.set_title(LOOKS[vehicle].label if vehicle in LOOKS else vehicle, weight="normal")
            axis.set_ylabel("y  [mm]")
            axis.set_xlim(time[0], time[-1])
            axis.axhline(0.0, color=INK, lw=0.6, zorder=1)
        active = [axis for axis, vehicle in zip(axes, runs, strict=True) if vehicle != "passive"]
        reach = max((abs(limit) for axis in active for limit in axis.get_ylim()), default=1.0)
        for axis in active:
            axis.set_ylim(-reach, reach)
        axes[-1].set_xlabel("time  [s]")
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=4, handlelength=2.8)
        return figure


def per_radius(table: pd.DataFrame, name: str) -> Figure:
    """Figs 16 to 19: one quantity over the radius of the curve, one line a vehicle.

    Args:
        table: the summary: `vehicle`, `radius_m`, `speed_kmh`, `outcome` and the figure's own columns.
        name: `fig16` ... `fig19`.

    Returns:
        The figure. Runs that did not complete are crossed out.

    Raises:
        KeyError: there is no such figure.
    """
    quantity = FIGURES[name]
    with styled():
        figure, (axis,) = panels(1)
        axis.set_title(quantity.title, pad=10)
        radii = table.drop_duplicates("radius_m").sort_values("radius_m")
        if quantity.floor:
            _floors(axis, table, quantity)
        for vehicle, look in LOOKS.items():
            rows = table[table["vehicle"] == vehicle].sort_values("radius_m")
            if len(rows):
                axis.plot(
                    rows["radius_m"],
                    rows[quantity.column],
                    color=look.color,
                    ls=look.line,
                    marker=look.marker,
                    markerfacecolor=look.color if look.filled else "white",
                    markeredgewidth=1.4,
                    label=look.label,
                    zorder=4,
                )
        broken = table[table["outcome"] != "completed"]
        if len(broken):
            x, y = broken["radius_m"], broken[quantity.column]
            axis.plot(x, y, ls="", marker="x", ms=12, mew=1.6, color=PALE, zorder=5, label="run did not complete")
        axis.set_xticks(
            radii["radius_m"],
            [f"{r:.0f}\n{v:.0f}" for r, v in zip(radii["radius_m"], radii["speed_kmh"], strict=True)],
        )
        axis.set_xlabel("curve radius  [m]   /   speed  [km/h]")
        axis.set_ylabel(quantity.label)
        axis.set_ylim(bottom=0.0, top=_headroom(table, quantity))
        axis.legend(loc="best", handlelength=3.4)
        return figure


def _floors(axis: Axes, table: pd.DataFrame, quantity: RadiusFigure) -> None:
    """The least achievable value, dotted: one line for all vehicles of the same mass."""
    groups: dict[tuple[float, ...], list[str]] = {}
    for vehicle, rows in table.sort_values("radius_m").groupby("vehicle", sort=False):
        groups.setdefault(tuple(rows[quantity.floor].round(6)), []).append(str(vehicle))
    for floor, vehicles in groups.items():
        radii = table[table["vehicle"] == vehicles[0]].sort_values("radius_m")["radius_m"]
        passive = vehicles == ["passive"]
        axis.plot(
            radii,
            floor,
            ls=":",
            lw=1.2 if passive else 2.0,
            color=PALE if passive else INK,
            label=quantity.floor_label + ("" if len(groups) == 1 else ", passive" if passive else ", active"),
            zorder=3,
        )


def _headroom(table: pd.DataFrame, quantity: RadiusFigure) -> float:
    """Upper end of the ordinate: all values and room for the legend above."""
    columns = [quantity.column, *([quantity.floor] if quantity.floor else [])]
    highest = float(np.nanmax(table[columns].to_numpy(dtype=float), initial=0.0))
    return 1.12 * highest if highest > 0.0 else 1.0


def _shade(axis: Axes, s: np.ndarray, time: np.ndarray, course: Course, *, name_zones: bool) -> None:
    """Shade transitions and arc by the time at which a wheelset passes them."""
    edges = np.interp([course.begin, course.arc_begin, course.arc_end, course.end], s, time)
    zones = (
        (edges[0], edges[1], BAND, "transition"),
        (edges[1], edges[2], "#e4e4e4", "arc"),
        (edges[2], edges[3], BAND, "transition"),
    )
    for begin, end, color, zone in zones:
        axis.axvspan(begin, end, color=color, lw=0, zorder=0)
        if name_zones and end > begin:
            axis.annotate(
                zone, (0.5 * (begin + end), 0.985), xycoords=("data", "axes fraction"), ha="center", va="top",
                size=8, color="#555555",
            )  # fmt: skip


def _rank(number: int) -> str:
    """A wheelset by its place in the vehicle, 1 leads."""
    return "wheelset 1 (leading)" if number == 1 else f"wheelset {number}"
