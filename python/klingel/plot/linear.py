"""Figures of linear analysis: modes by frequency and damping, root loci.
Every mark is named where it stands; colours run from dark to light with the parameter, so that grey prints keep it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from klingel.plot.scale import labelled, readable, valued
from klingel.plot.style import BAND, INK, PALE, panels, styled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from klingel.linear.locus import RootLocus
    from klingel.linear.modes import Mode

HIGHEST = 30.0
"""Frequencies that figures show [Hz]: what people feel and hear of a bogie; contact and shaft modes lie above."""

FURTHEST = -60.0
"""Left edge of that plane [1/s]; what decays faster does not matter to anybody."""

TICKS = (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 50.0, 100.0, 200.0)

SLOWEST = 0.2
"""Least frequency in the plane of root loci [Hz]."""

LINES: Sequence[tuple[str, str | tuple[int, tuple[float, ...]], str]] = (
    ("#000000", "-", "o"),
    ("#0072B2", (0, (5, 1.8)), "s"),
    ("#D55E00", (0, (4, 1.4, 1, 1.4)), "^"),
    ("#009E73", (0, (1.2, 1.0)), "D"),
    ("#CC79A7", (0, (7, 1.5, 1, 1.5, 1, 1.5)), "v"),
    ("#56B4E9", "-", "P"),
)
"""Colour, line and marker of branches that are named."""

KINDS = {
    "body": ("#000000", "o", "mostly car body"),
    "bogie": ("#0072B2", "s", "mostly bogies"),
    "wheelset": ("#D55E00", "^", "mostly wheelsets"),
    "": ("#009E73", "D", "other"),
}
"""Colour, marker and words of a mode by what moves most."""

SAME = 0.02
"""Relative distance of eigenvalues below which they are drawn as one."""


def modes_figure(found: Sequence[Mode], *, title: str, highest: float = HIGHEST) -> Figure:
    """Oscillations by frequency, one row each: name, frequency, damping ratio.

    Args:
        found: modes; those that do not swing or are faster than `highest` are not drawn.
        title: above the figure, such as the vehicle and its speed.
        highest: frequency [Hz].

    Returns:
        The figure. Unstable modes lie left of the line at zero.
    """
    drawn = _rows(found, highest)[::-1]
    with styled():
        figure, (axis,) = panels(1, width=7.2, height=1.7 + 0.21 * max(len(drawn), 4))
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        ratios = 100.0 * np.array([mode.damping for mode, _ in drawn])
        places = np.arange(len(drawn))
        axis.hlines(places, 0.0, ratios, color=PALE, lw=1.0)
        for kind, (color, marker, label) in KINDS.items():
            of = [i for i, (mode, _) in enumerate(drawn) if _kind(mode) == kind]
            if of:
                axis.plot(ratios[of], places[of], marker, color=color, ms=5.5, label=label, zorder=3)
        axis.axvline(0.0, color=INK, lw=0.9)
        left = 1.3 * min(ratios.min(initial=0.0), 0.0)
        if left < 0.0:
            axis.axvspan(left, 0.0, facecolor=BAND, edgecolor="none", zorder=0, label="unstable")
        axis.set_xlim(left=left)
        axis.set_yticks(
            places, [f"{_named(mode, many)}   {mode.frequency:6.2f} Hz" for mode, many in drawn], fontsize=7.6
        )
        axis.set_ylim(-0.8, len(drawn) - 0.2)
        axis.grid(visible=False, axis="y")
        axis.set_xlabel("damping ratio  [%]")
        figure.legend(loc="outside lower center", ncols=5, handletextpad=0.4)
        return figure


def _rows(found: Sequence[Mode], highest: float) -> list[tuple[Mode, int]]:
    """What swings up to a frequency [Hz]; modes of one name and nearly one eigenvalue are one row that counts them."""
    rows: list[tuple[Mode, int]] = []
    for mode in found:
        if not mode.swings or mode.frequency > highest:
            continue
        same = [i for i, (other, _) in enumerate(rows) if other.name == mode.name and _near(mode, other)]
        if same:
            rows[same[0]] = (rows[same[0]][0], rows[same[0]][1] + 1)
        else:
            rows.append((mode, 1))
    return rows


def _near(mode: Mode, other: Mode) -> bool:
    return abs(mode.eigenvalue - other.eigenvalue) < SAME * abs(mode.eigenvalue)


def _named(mode: Mode, many: int) -> str:
    return mode.name if many == 1 else f"{mode.name} ({many})"


def _kind(mode: Mode) -> str:
    if not mode.bodies:
        return ""
    shares = {"body": 0.0, "bogie": 0.0, "wheelset": 0.0}
    for name, share in mode.bodies.items():
        kind = "wheelset" if "wheelset" in name else "bogie" if "bogie" in name else "body"
        shares[kind] += share
    return max(shares, key=lambda kind: shares[kind])


def locus_figure(locus: RootLocus, *, title: str, highest: float = HIGHEST) -> Figure:
    """Eigenvalues over a parameter: their plane, and the damping of the least damped branches over the parameter.

    Args:
        locus: to draw.
        title: above the figure, such as the vehicle.
        highest: frequency [Hz].

    Returns:
        The figure. The plane is drawn about the imaginary axis; a ring marks the first value of the parameter, as its
        legend says; units take prefixes, so that numbers are short.
    """
    unit, per = readable(locus.unit, locus.values)
    values, label = locus.values * per, labelled(locus.parameter, unit)
    with styled():
        figure = Figure(figsize=(9.6, 4.6))
        plane, ratio = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        _plane(figure, plane, locus, values, highest, label)
        _ratios(ratio, locus, values, highest)
        ratio.set_xlabel(label)
        marks = _marks(valued(values[0], unit), valued(values[-1], unit))
        figure.legend(handles=marks, loc="outside lower left", ncols=1, handletextpad=0.4)
        figure.legend(
            *ratio.get_legend_handles_labels(), loc="outside lower right", ncols=2, handlelength=2.8, columnspacing=1.2
        )
        return figure


def _marks(first: str, last: str) -> list[Artist]:
    """What the marks of the plane mean."""
    middle = matplotlib.colormaps["viridis"](0.5)
    return [
        Line2D([], [], ls="", marker="o", ms=4.2, mfc="white", mec=INK, mew=0.8, label=f"at {first}"),
        Line2D([], [], color="#c9c9c9", lw=0.8, marker="o", ms=3.0, mfc=middle, mec=middle, label=f"on to {last}"),
        Patch(facecolor=BAND, edgecolor=PALE, lw=0.4, label="unstable"),
    ]


def least_damped(locus: RootLocus, count: int, highest: float = HIGHEST) -> list[int]:
    """Branches with the smallest damping ratios anywhere, the smallest first: up to `highest` [Hz], twins once."""
    damping = np.where((locus.frequency > 0.05) & (locus.frequency <= highest), locus.damping, np.nan)
    seen = [i for i in range(damping.shape[1]) if np.isfinite(damping[:, i]).any()]
    chosen: list[int] = []
    for branch in sorted(seen, key=lambda i: float(np.nanmin(damping[:, i]))):
        if len(chosen) < count and not any(_together(locus, branch, other) for other in chosen):
            chosen.append(branch)
    return chosen


def _together(locus: RootLocus, branch: int, other: int) -> bool:
    """Whether two branches would cover each other, as those of the two bogies do."""
    s, t = locus.eigenvalues[:, branch], locus.eigenvalues[:, other]
    both = np.isfinite(s) & np.isfinite(t)
    return bool(both.any() and (np.abs(s - t)[both] < SAME * np.abs(s)[both]).all())


def _plane(
    figure: Figure, axis: Axes, locus: RootLocus, values: NDArray[np.float64], highest: float, label: str
) -> None:
    s, frequency = locus.eigenvalues, locus.frequency
    left = _left_edge(s, frequency, highest)
    axis.plot(s.real, frequency, color="#c9c9c9", lw=0.8, zorder=1)
    places = np.broadcast_to(values[:, None], s.shape)
    shown = axis.scatter(s.real, frequency, c=places, cmap="viridis", s=5, zorder=2, linewidths=0)
    axis.plot(s.real[0], frequency[0], "o", ms=4.2, mfc="white", mec=INK, mew=0.8, zorder=3)
    axis.axvline(0.0, color=INK, lw=0.9)
    right = max(float(np.nanmax(s.real[frequency <= highest], initial=0.0)), 0.04 * -left)
    axis.axvspan(0.0, 1.15 * right, color=BAND, zorder=0)
    axis.set_xlim(left, 1.15 * right)
    axis.set_yscale("log")
    axis.set_ylim(SLOWEST, highest)
    axis.set_yticks([f for f in TICKS if f <= highest], [f"{f:g}" for f in TICKS if f <= highest])
    axis.yaxis.set_minor_formatter("")
    axis.set_xlabel("real part  [1/s]")
    axis.set_ylabel("frequency  [Hz]")
    figure.colorbar(shown, ax=axis, label=label, pad=0.02, aspect=30)


def _left_edge(s: NDArray[np.complex128], frequency: NDArray[np.float64], highest: float) -> float:
    """Far enough to the left for oscillations with a damping ratio of half, not for what decays at once."""
    oscillating = (frequency > 0.05) & (frequency <= highest) & (np.abs(s.real) < 0.6 * np.abs(s))
    return float(np.clip(1.15 * np.nanmin(s.real[oscillating], initial=0.0), FURTHEST, -5.0))


def _ratios(axis: Axes, locus: RootLocus, values: NDArray[np.float64], highest: float) -> None:
    for (color, line, _), branch in zip(LINES, least_damped(locus, len(LINES), highest), strict=False):
        damping = np.where(locus.frequency[:, branch] > 0.05, 100.0 * locus.damping[:, branch], np.nan)
        middle = float(np.nanmedian(locus.frequency[:, branch]))
        axis.plot(values, damping, color=color, ls=line, lw=1.5, label=f"{locus.names[branch]} ({middle:.1f} Hz)")
    axis.axhline(0.0, color=INK, lw=0.9)
    bottom, top = axis.get_ylim()
    if bottom < 0.0:
        axis.axhspan(bottom, 0.0, color=BAND, zorder=0)
    axis.set_ylim(min(bottom, 0.0), top)
    axis.set_ylabel("damping ratio of the least damped  [%]")
