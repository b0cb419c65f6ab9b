"""The five figures of the curving study, after Figs 15 to 19 of Perez et al. 2004.
One history of the wheelsets in a curve, and four quantities over the curve radius."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.plot.style import BAND, INK, LOOKS, PALE, Look, panels, styled

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

FEW = 4
"""Up to so many lines have their legend inside the axes; more have it below, hollow marks and sizes that differ."""

WHEELSET_LINES: Sequence[tuple[str, float, str | tuple[int, tuple[float, ...]]]] = (
    (INK, 1.7, "-"),
    ("#0072B2", 0.95, (0, (5, 1.5))),
    ("#009E73", 0.95, (0, (4, 1.2, 1, 1.2))),
    ("#CC79A7", 0.95, (0, (1.2, 1.0))),
)
"""Colour, width and line style of the wheelsets, the leading one first."""


def displacement_history(
    runs: Mapping[str, xr.Dataset],
    wheelsets: Sequence[str],
    course: Course,
    *,
    caption: str,
    looks: Mapping[str, Look] = LOOKS,
    apart: Collection[str] = ("passive",),
) -> Figure:
    """Fig. 15: lateral displacement of every wheelset over time, one panel a vehicle or strategy.

    Args:
        runs: vehicle to its run through the same curve; channels `<wheelset>.y` and `<wheelset>.s` in m.
        wheelsets: their names, the leading one first.
        course: where the curve lies; transitions and arc are shaded by the passage of the leading wheelset.
        caption: which curve, for the title.
        looks: how each vehicle is drawn and called.
        apart: vehicles that have a scale of their own, as their titles say; all others share one.

    Returns:
        The figure.
    """
    with styled():
        figure, axes = panels(len(runs), height=0.9 + (1.75 if len(runs) <= FEW else 1.3) * len(runs))
        figure.suptitle(f"Lateral displacement of the wheelsets, {caption}", x=0.01, ha="left", weight="bold", size=10)
        for axis, (vehicle, run) in zip(axes, runs.items(), strict=True):
            time = run["time"].to_numpy()
            _shade(axis, run[f"{wheelsets[0]}.s"].to_numpy(), time, course, name_zones=axis is axes[0])
            drawn = list(zip(wheelsets, WHEELSET_LINES, strict=False))
            for order, (wheelset, (color, width, line)) in enumerate(reversed(drawn)):
                y = 1e3 * run[f"{wheelset}.y"].to_numpy()
                axis.plot(time, y, color=color, lw=width, ls=line, zorder=2 + order, label=_rank(len(drawn) - order))
            title = looks[vehicle].label if vehicle in looks else vehicle
            own = vehicle in apart and len(runs) > 1
            axis.set_title(f"{title}, on a scale of its own" if own else title, weight="normal")
            axis.set_ylabel("y  [mm]")
            axis.set_xlim(time[0], time[-1])
            axis.axhline(0.0, color=INK, lw=0.6, zorder=1)
        reaches = [max(map(abs, axis.get_ylim())) for axis in axes]
        common = max((r for r, vehicle in zip(reaches, runs, strict=True) if vehicle not in apart), default=1.0)
        for axis, vehicle, reached in zip(axes, runs, reaches, strict=True):
            reach = reached if vehicle in apart else common
            axis.set_ylim(-reach, reach)
        axes[-1].set_xlabel("time  [s]")
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=4, handlelength=2.8)
        return figure


def per_radius(table: pd.DataFrame, name: str, *, looks: Mapping[str, Look] = LOOKS, by: str = "vehicle") -> Figure:
    """Figs 16 to 19: one quantity over the radius of the curve, one line a vehicle or strategy.

    Args:
        table: the summary: `radius_m`, `speed_kmh`, `outcome`, the column `by` and the figure's own; `curve` too where
            several curves have one radius: these stand side by side, at equal distances.
        name: `fig16` ... `fig19`.
        looks: how each vehicle is drawn and called, in the order of the legend.
        by: column that says which vehicle a row is of.

    Returns:
        The figure. Runs that did not complete are crossed out.

    Raises:
        KeyError: there is no such figure.
    """
    quantity = FIGURES[name]
    with styled():
        drawn = [vehicle for vehicle in looks if (table[by] == vehicle).any()]
        few = len(drawn) <= FEW
        figure, (axis,) = panels(1, height=3.9 if few else 4.2 + 0.2 * math.ceil(len(drawn) / 2))
        axis.set_title(quantity.title, pad=10)
        table, ticks = _placed(table)
        if quantity.floor:
            _floors(axis, table, quantity)
        for order, vehicle in enumerate(drawn):
            look = looks[vehicle]
            rows = table[table[by] == vehicle].sort_values("place")
            axis.plot(
                rows["place"],
                rows[quantity.column],
                color=look.color,
                ls=look.line,
                marker=look.marker,
                markerfacecolor=look.color if look.filled else "none" if not few else "white",
                markeredgewidth=1.4,
                markersize=6.5 if few else 9.5 - 0.5 * order,
                label=look.label,
                zorder=4,
            )
        broken = table[(table["outcome"] != "completed") & table[quantity.column].notna()]
        if len(broken):
            x, y = broken["place"], broken[quantity.column]
            axis.plot(x, y, ls="", marker="x", ms=12, mew=1.6, color=PALE, zorder=5, label="run did not complete")
        axis.set_xticks(list(ticks), list(ticks.values()))
        axis.set_xlabel("curve radius  [m]   /   speed  [km/h]")
        axis.set_ylabel(quantity.label)
        axis.set_ylim(bottom=0.0, top=_headroom(table, quantity))
        if few:
            axis.legend(loc="best", handlelength=3.4)
        else:
            figure.legend(loc="outside lower center", ncols=2, handlelength=4.2)
        return figure


def _placed(table: pd.DataFrame) -> tuple[pd.DataFrame, dict[float, str]]:
    """The table with the abscissa of its rows as `place`, and the labels there: radii, or one curve after the other."""
    keys = [key for key in ("radius_m", "speed_kmh", "curve") if key in table]
    curves = table.drop_duplicates(keys).sort_values(keys, kind="stable")
    labels = [f"{r:.0f}\n{v:.0f}" for r, v in zip(curves["radius_m"], curves["speed_kmh"], strict=True)]
    if curves["radius_m"].is_unique:
        return table.assign(place=table["radius_m"]), dict(zip(curves["radius_m"], labels, strict=True))
    places = {key: float(i) for i, key in enumerate(curves[keys].itertuples(index=False, name=None))}
    place = [places[key] for key in table[keys].itertuples(index=False, name=None)]
    return table.assign(place=place), dict(zip(places.values(), labels, strict=True))


def _floors(axis: Axes, table: pd.DataFrame, quantity: RadiusFigure) -> None:
    """The least achievable value, dotted: one line for all vehicles of the same mass."""
    groups: dict[tuple[tuple[float, float], ...], list[str]] = {}
    known = table[table[quantity.floor].notna()].sort_values("place", kind="stable")
    for vehicle, rows in known.drop_duplicates(["vehicle", "place"]).groupby("vehicle", sort=False):
        floor = tuple(zip(rows["place"], rows[quantity.floor].round(6), strict=True))
        groups.setdefault(floor, []).append(str(vehicle))
    for behind, (floor, vehicles) in zip(reversed(range(len(groups))), groups.items(), strict=True):
        axis.plot(
            *zip(*floor, strict=True),
            ls=":",
            lw=max(0.8, 2.0 - 0.8 * behind),
            color=PALE if behind else INK,
            label=_floor_label(quantity.floor_label, vehicles) if len(groups) > 1 else quantity.floor_label,
            zorder=3,
        )


def _floor_label(label: str, vehicles: Sequence[str]) -> str:
    """Whose floor it is: the study's vehicles by their kind, others by their names."""
    if set(vehicles) <= set(LOOKS):
        return f"{label}, {'passive' if list(vehicles) == ['passive'] else 'active'}"
    return textwrap.fill(f"least of {', '.join(vehicles)}".replace("_", " "), 36)


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
