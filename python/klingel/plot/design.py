"""Figures of a design: Bode and Nyquist diagrams of a loop at several speeds with its margins, and where it is stable.
What is beyond a limit is hatched as well as coloured, so that grey prints keep it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Rectangle

from klingel.plot.response import LINES, Curve, bode
from klingel.plot.style import BAND, INK, PALE, styled

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from klingel.design.check import Check
    from klingel.design.margins import Shown

LOWEST, HIGHEST = 0.05, 200.0
"""Frequencies of Bode diagrams [Hz]."""

REACH = (-3.2, 1.4, 2.1)
"""Part of the plane that Nyquist diagrams show: real part from, to, imaginary part up and down."""

MOST_DAMPING = 20.0
"""Damping ratio [%] from which a place is as good as any other."""

DARK = 5.0
"""Damping ratio [%] below which a cell is so dark that its number is white."""


def loop_bode(shown: Sequence[Shown], *, title: str) -> Figure:
    """Bode diagram of a loop at up to five speeds, with |L| = 1, -180 degrees and the frequencies of its margins.

    shown: responses, one a speed; title: above the figure.
    """
    curves = []
    for each in shown:
        some = (each.frequencies >= LOWEST) & (each.frequencies <= HIGHEST)
        curves.append(Curve(_speed(each), each.frequencies[some], each.response[some]))
    figure = bode(curves, title=title, unit="-")
    with styled():
        size, phase = figure.axes[:2]
        size.axhline(1.0, color=INK, lw=0.9)
        low = min(float(np.abs(curve.values).min()) for curve in curves)
        size.set_ylim(bottom=max(low, 2e-3))
        _in_one_turn(phase, shown)
        for turn in (-540.0, -180.0, 180.0, 540.0):
            if phase.get_ylim()[0] - 5.0 <= turn <= phase.get_ylim()[1] + 5.0:
                phase.axhline(turn, color=INK, lw=0.9)
        for each, curve, line, (color, _) in zip(shown, curves, phase.lines, LINES, strict=False):
            at = [(each.margins.gain_frequency, size, np.abs(curve.values), "v")]
            at += [(each.margins.phase_frequency, phase, np.asarray(line.get_ydata()), "o")]
            for frequency, axis, values, marker in at:
                if LOWEST <= frequency <= HIGHEST:
                    y = float(np.interp(frequency, curve.frequencies, values))
                    axis.plot(frequency, y, marker, color=color, mfc="white", ms=5.0, mew=1.2, zorder=4)
        handle = matplotlib.lines.Line2D
        marks = [
            handle([], [], ls="", marker="v", mfc="white", mec=INK, ms=5.0, label="gain margin"),
            handle([], [], ls="", marker="o", mfc="white", mec=INK, ms=5.0, label="phase margin"),
        ]
        phase.legend(handles=marks, loc="lower left", handletextpad=0.3)
    return figure


def _in_one_turn(phase: Axes, shown: Sequence[Shown]) -> None:
    """Moves the phases by whole turns to between -360 and 0 degrees at their phase margins, so that they compare."""
    for line, each in zip(phase.lines, shown, strict=True):
        f, degrees = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        at = each.margins.phase_frequency if LOWEST <= each.margins.phase_frequency <= HIGHEST else 1.0
        line.set_ydata(degrees - 360.0 * math.ceil(float(np.interp(at, f, degrees)) / 360.0))
    phase.relim()
    phase.autoscale_view()


def nyquist(shown: Sequence[Shown], *, title: str) -> Figure:
    """Nyquist diagram of a loop at up to five speeds near -1, with the disk that its least disk margin keeps free and
    the circle of its largest sensitivity.

    shown: responses, one a speed; title: above the figure.
    """
    with styled():
        figure = Figure(figsize=(6.6, 5.9))
        axis = figure.subplots()
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        turn = np.linspace(0.0, 2.0 * np.pi, 361)
        axis.plot(np.cos(turn), np.sin(turn), color=PALE, lw=0.9, label="|L| = 1")
        stable = [each.margins for each in shown if each.margins.stable]
        if stable:
            _kept_free(axis, min(m.disk for m in stable), max(m.sensitivity for m in stable))
        for each, (color, line) in zip(shown, LINES, strict=False):
            axis.plot(each.response.real, each.response.imag, color=color, ls=line, lw=1.5, label=_speed(each))
        axis.plot(-1.0, 0.0, "P", color=INK, ms=8.0, zorder=5)
        axis.annotate("-1", (-1.0, 0.0), xytext=(-19, 9), textcoords="offset points")
        axis.axhline(0.0, color=INK, lw=0.6)
        axis.axvline(0.0, color=INK, lw=0.6)
        axis.set_xlim(REACH[0], REACH[1])
        axis.set_ylim(-REACH[2], REACH[2])
        axis.set_aspect("equal")
        axis.set_xlabel("real part of L  [-]")
        axis.set_ylabel("imaginary part of L  [-]")
        figure.legend(loc="outside lower center", ncols=3, handlelength=3.0)
        return figure


def _kept_free(axis: Axes, alpha: float, sensitivity: float) -> None:
    """The disk of a margin alpha, through -(2 + alpha)/(2 - alpha) and its inverse, and the circle 1/S about -1."""
    if alpha < 2.0:
        inner = (2.0 - alpha) / (2.0 + alpha)
        outer = 1.0 / inner
        disk = Circle((-0.5 * (inner + outer), 0.0), 0.5 * (outer - inner), fc=BAND, ec=PALE, hatch="///", lw=0.8)
        disk.set_label(f"kept free: disk margin {alpha:.2f}")
        axis.add_patch(disk)
    circle = Circle((-1.0, 0.0), 1.0 / sensitivity, fill=False, ec=INK, ls=":", lw=1.3)
    circle.set_label(f"sensitivity {sensitivity:.2f}")
    axis.add_patch(circle)


def _speed(each: Shown) -> str:
    unstable = "" if each.margins.stable else ", unstable"
    return f"{3.6 * each.speed:.0f} km/h{unstable}"


def stability_map(check: Check, *, title: str) -> Figure:
    """Least damping of every place of a check, one panel a friction: speed over conicity, and the curves.

    Cells show the damping ratio [%]; unstable ones the growth [1/s], hatched.
    """
    frictions = sorted(check.table["friction"].unique())
    straight = check.table[np.isinf(check.table["radius"])]
    columns: list[float | str] = [*_conicities(straight), *(["curve"] if len(straight) < len(check.table) else [])]
    speeds = sorted(check.table["speed"].unique())
    with styled():
        width = 1.6 + len(frictions) * (0.3 + 0.6 * len(columns))
        figure = Figure(figsize=(max(width, 5.0), 1.8 + 0.55 * len(speeds)))
        axes = figure.subplots(1, len(frictions), sharey=True, squeeze=False)[0]
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        for axis, friction in zip(axes, frictions, strict=True):
            _cells(axis, check.table[check.table["friction"] == friction], columns, speeds)
            axis.set_title(f"friction {friction:g}", weight="normal", size=9)
            axis.set_xlabel(f"own profiles, cones of a conicity{', curves' if 'curve' in columns else ''}")
        axes[0].set_yticks(range(len(speeds)), [f"{3.6 * v:.0f}" for v in speeds])
        axes[0].set_ylabel("speed  [km/h]")
        marks = [
            Patch(facecolor=_shade(1.0), edgecolor=INK, lw=0.4, label="damping ratio in %, dark where it is small"),
            Patch(facecolor="white", edgecolor="#D55E00", hatch="////", label="unstable: growth in 1/s"),
        ]
        figure.legend(handles=marks, loc="outside lower center", ncols=2)
        return figure


def _conicities(straight: pd.DataFrame) -> list[float]:
    """Columns of the straight track: NaN, the profiles as they are, first."""
    values = straight["conicity"].unique()
    own = [math.nan] if np.isnan(values).any() else []
    return [*own, *sorted(v for v in values if not math.isnan(v))]


def _cells(axis: Axes, rows: pd.DataFrame, columns: Sequence[float | str], speeds: Sequence[float]) -> None:
    axis.set_xlim(-0.5, len(columns) - 0.5)
    axis.set_ylim(-0.5, len(speeds) - 0.5)
    axis.grid(visible=False)
    labels = [c if isinstance(c, str) else "profiles" if math.isnan(c) else f"{c:g}" for c in columns]
    axis.set_xticks(range(len(columns)), labels, fontsize=8.0)
    axis.tick_params(length=0.0)
    for row in rows.to_dict("records"):
        if not math.isinf(row["radius"]):
            i = columns.index("curve")
        else:
            same = (k for k, c in enumerate(columns) if not isinstance(c, str) and _same(c, row["conicity"]))
            i = next(same)
        _cell(axis, i, speeds.index(row["speed"]), row)


def _same(one: float, other: float) -> bool:
    return one == other or (math.isnan(one) and math.isnan(other))


def _cell(axis: Axes, i: int, j: int, row: Mapping[Any, Any]) -> None:
    outcome, damping, growth = row["outcome"], 100.0 * row["damping"], row["growth"]
    box = Rectangle((i - 0.5, j - 0.5), 1.0, 1.0, ec="white", lw=1.0)
    color = INK
    if outcome == "stable":
        box.set_facecolor(_shade(damping))
        words, color = f"{damping:.1f}", "white" if damping < DARK else INK
    else:
        box.set(facecolor="white", edgecolor="#D55E00", hatch="////", lw=0.6)
        words = f"{growth:.2g}" if outcome == "unstable" else "none"
    axis.add_patch(box)
    frame = {"facecolor": "white", "edgecolor": "none", "pad": 0.8} if outcome != "stable" else None
    axis.text(i, j, words, ha="center", va="center", size=9.0, color=color, bbox=frame)


def _shade(damping: float) -> tuple[float, float, float, float]:
    """Of a damping ratio [%]: dark for little."""
    red, green, blue, alpha = matplotlib.colormaps["cividis"](min(damping / MOST_DAMPING, 1.0) ** 0.5)
    return float(red), float(green), float(blue), float(alpha)
