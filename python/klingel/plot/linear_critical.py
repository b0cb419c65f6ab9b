"""Figures of critical speeds: growth of the least stable mode over speed, and how far a vehicle hunts over speed.
Both speeds are drawn as named lines, the linear one dashed, the nonlinear one solid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from klingel.plot.style import BAND, INK, panels, styled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from klingel.linear.critical import CriticalSpeed
    from klingel.linear.limit_cycle import Bifurcation

KMH = 3.6
LINEAR, NONLINEAR, RUN = "#D55E00", "#0072B2", "#8a8a8a"


def critical_figure(critical: CriticalSpeed, *, title: str, bifurcation: Bifurcation | None = None) -> Figure:
    """The least stable mode over speed, and below it the amplitude of the limit cycle, if that was looked for.

    Args:
        critical: the linear critical speed with its sweep.
        title: above the figure, such as the vehicle.
        bifurcation: adds the lower panel.

    Returns:
        The figure. What is unstable is shaded.
    """
    with styled():
        figure, axes = panels(1 if bifurcation is None else 2, width=7.0, height=3.6 if bifurcation is None else 6.6)
        axes[0].set_title(title)
        _growth(axes[0], critical)
        if bifurcation is not None:
            _amplitudes(axes[1], bifurcation)
            _mark(axes[1], critical.speed, "linear", LINEAR, "--")
            for axis in axes:
                _mark(axis, bifurcation.speed, "nonlinear", NONLINEAR, "-")
            axes[1].legend(loc="upper left")
        _mark(axes[0], critical.speed, "linear", LINEAR, "--")
        axes[0].legend(*_own(axes[0], bifurcation is not None), loc="upper left")
        axes[-1].set_xlabel("speed  [km/h]")
        return figure


def _own(axis: Axes, repeated: bool) -> tuple[list[Artist], list[str]]:
    """Entries of a legend, without the critical speeds if the panel below repeats them."""
    entries = zip(*axis.get_legend_handles_labels(), strict=True)
    kept = [(handle, label) for handle, label in entries if not (repeated and "critical speed" in label)]
    return [handle for handle, _ in kept], [label for _, label in kept]


def _growth(axis: Axes, critical: CriticalSpeed) -> None:
    speeds = KMH * critical.speeds
    oscillates = critical.frequencies > 0.05
    axis.plot(speeds, critical.growth, color=INK, marker="o", ms=4.0, lw=1.3, label="least stable mode")
    axis.plot(speeds[~oscillates], critical.growth[~oscillates], "o", ms=4.0, mfc="white", mec=INK, ls="")
    if (~oscillates).any():
        axis.plot([], [], "o", ms=4.0, mfc="white", mec=INK, ls="", label="not an oscillation")
    axis.axhline(0.0, color=INK, lw=0.9)
    bottom, top = axis.get_ylim()
    top = max(top, 0.1 * (top - bottom))
    axis.axhspan(0.0, top, color=BAND, zorder=0)
    axis.annotate("unstable", (0.01, 0.0), (0, 3), xycoords=("axes fraction", "data"), textcoords="offset points")
    axis.set_ylim(bottom, top)
    axis.set_ylabel("growth  [1/s]")


def _amplitudes(axis: Axes, bifurcation: Bifurcation) -> None:
    axis.plot(KMH * bifurcation.speeds, 1e3 * bifurcation.amplitudes, color=RUN, lw=1.4, label="run that slows down")
    _rest(axis, bifurcation)
    held = bifurcation.table()
    for hunts, face, label in ((True, INK, "constant speed: hunts for ever"), (False, "white", "comes to rest")):
        rows = held[held["hunts"] == hunts]
        speeds, amplitudes = KMH * rows["speed"].to_numpy(), 1e3 * rows["amplitude"].to_numpy()
        axis.plot(speeds, amplitudes, "o", ms=5.5, mfc=face, mec=INK, ls="", label=label, zorder=4)
    axis.set_ylim(bottom=-0.04 * max(1e3 * float(np.max(bifurcation.amplitudes)), 1e-3))
    axis.set_ylabel("largest amplitude of a wheelset  [mm]")


def _rest(axis: Axes, bifurcation: Bifurcation) -> None:
    """Rest as a state of its own: stable up to the linear critical speed, unstable beyond."""
    begin, end = KMH * float(bifurcation.speeds.min()), KMH * float(bifurcation.linear.speeds[-1])
    edge = bifurcation.linear.speed
    change = end if edge is None else KMH * edge
    axis.plot(
        [min(begin, KMH * float(bifurcation.linear.speeds[0])), change],
        [0.0, 0.0],
        color=INK,
        lw=1.8,
        label="rest, stable",
    )
    if edge is not None:
        axis.plot([change, end], [0.0, 0.0], color=INK, lw=1.2, ls=(0, (3, 2)), label="rest, unstable")


def _mark(axis: Axes, speed: float | None, word: str, color: str, line: str) -> None:
    if speed is not None:
        axis.axvline(KMH * speed, color=color, ls=line, lw=1.3, label=f"{word} critical speed {KMH * speed:.1f} km/h")
