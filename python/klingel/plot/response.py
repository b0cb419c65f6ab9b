"""Figures of linear responses: Bode diagrams with what the simulator answered, spectra on irregular track, and which
parameters move a value most."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, MultipleLocator, NullFormatter
from numpy.typing import NDArray

from klingel.plot.scale import labelled, raised, readable
from klingel.plot.style import INK, PALE, panels, styled

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from klingel.linear.measured import Measured
    from klingel.linear.random import RandomResponse

LINES: Sequence[tuple[str, str | tuple[int, tuple[float, ...]]]] = (
    ("#000000", "-"),
    ("#0072B2", (0, (5, 1.8))),
    ("#009E73", (0, (4, 1.4, 1, 1.4))),
    ("#CC79A7", (0, (1.2, 1.2))),
    ("#56B4E9", (0, (8, 2))),
)
"""Colours of Okabe and Ito, each with its own line style."""

SIMULATED = "#D55E00"
"""Of points that the simulator answered."""

KIND_LOOKS: Mapping[str, tuple[str, str | tuple[int, tuple[float, ...]]]] = {
    "vertical": ("#0072B2", (0, (5, 1.8))),
    "alignment": ("#D55E00", (0, (4, 1.4, 1, 1.4))),
    "crosslevel": ("#009E73", (0, (1.2, 1.2))),
    "gauge": ("#CC79A7", (0, (8, 2))),
}
"""Of the irregularities, the same in every figure."""

POINTS = 24.0
"""Measured frequencies that are drawn in a decade."""

DECADES = 6.0
"""Of a spectrum that are shown below its largest value."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A response to draw: label; frequencies (f) [Hz]; values (f), complex."""

    label: str
    frequencies: NDArray[np.float64]
    values: NDArray[np.complex128]


def bode(
    curves: Sequence[Curve],
    *,
    title: str,
    unit: str,
    measured: Measured | None = None,
    output: str = "",
) -> Figure:
    """Bode diagram: magnitude and phase over frequency, and coherence with the simulator if there is a measurement.

    curves: one to five, each with frequencies above 0 Hz; title: one or two lines; unit: of the magnitude, output over
    input; measured: response measured on the simulator, drawn as points for its channel `output` (the first if none is
    given).
    """
    with styled():
        figure, axes = panels(2 if measured is None else 3, height=4.4 if measured is None else 5.4)
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        size, phase = axes[0], axes[1]
        for curve, (color, line) in zip(curves, LINES, strict=False):
            size.loglog(curve.frequencies, np.abs(curve.values), color=color, ls=line, label=curve.label)
            phase.semilogx(curve.frequencies, _degrees(curve.values), color=color, ls=line)
        if measured is not None:
            _measured(axes, measured, output, curves)
        size.set_ylabel(f"magnitude  [{unit}]")
        phase.set_ylabel("phase  [°]")
        phase.yaxis.set_major_locator(_quarter_turns(phase))
        size.legend(loc="best", handlelength=3.0)
        above = [each.frequencies[each.frequencies > 0.0] for each in curves]  # 0 Hz has no place on such an axis
        axes[-1].set_xlim(min(f[0] for f in above), max(f[-1] for f in above))
        _plain_ticks(axes[-1].xaxis, *axes[-1].get_xlim())
        _plain_ticks(size.yaxis, *size.get_ylim())
        axes[-1].set_xlabel("frequency  [Hz]")
        return figure


def _degrees(values: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Continuous phase that begins between -180 and 180 degrees."""
    return np.asarray(np.degrees(np.unwrap(np.angle(values))))


def _measured(axes: Sequence[Axes], measured: Measured, output: str, curves: Sequence[Curve]) -> None:
    """Points of the measurement in all panels, thinned where they crowd; phase in the turn of the first curve."""
    column = measured.outputs.index(output) if output else 0
    some = _thinned(measured.frequencies)
    f, values = measured.frequencies[some], measured.response[some, column]
    phase = np.degrees(np.angle(values))
    near = np.interp(f, curves[0].frequencies, _degrees(curves[0].values))
    phase = phase + 360.0 * np.round((near - phase) / 360.0)
    look: dict[str, Any] = {
        "ls": "",
        "marker": "o",
        "ms": 3.0,
        "mfc": "white",
        "mec": SIMULATED,
        "mew": 0.9,
        "zorder": 3,
    }
    axes[0].plot(f, np.abs(values), label="simulated", **look)
    axes[1].plot(f, phase, **look)
    axes[2].semilogx(f, measured.coherence[some, column], **look)
    axes[2].set_ylabel("coherence  [-]")
    axes[2].set_ylim(0.0, 1.05)


def _thinned(f: NDArray[np.float64]) -> NDArray[np.int64]:
    """Places of at most `POINTS` frequencies a decade."""
    cells = np.floor(np.log10(f) * POINTS)
    return np.flatnonzero(np.diff(cells, prepend=cells[0] - 1.0) > 0.0)


def _plain_ticks(axis: Axis, low: float, high: float) -> None:
    """Numbers without exponents on a logarithmic axis, with 2 and 5 between the powers of ten where it is short."""
    short = high < 300.0 * low
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if short else (1.0,)))
    axis.set_minor_formatter(NullFormatter())
    if low > 1e-3 and high < 1e5:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _quarter_turns(axis: Axes) -> MultipleLocator:
    low, high = axis.get_ylim()
    step = next((step for step in (45.0, 90.0, 180.0, 360.0) if (high - low) / step <= 7.0), 720.0)
    return MultipleLocator(step)


def spectrum(
    response: RandomResponse,
    output: str,
    *,
    simulated: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> Figure:
    """Power spectral density of one output on irregular track, with the share of every kind of irregularity.

    output: its name; simulated: frequencies [Hz] and one-sided densities of a simulation, drawn beside.
    """
    column = [signal.name for signal in response.outputs].index(output)
    unit = raised(response.outputs[column].unit)
    with styled():
        figure, (axis,) = panels(1)
        rms = response.rms()[output]
        figure.suptitle(f"{output} on irregular track", x=0.01, ha="left", weight="bold", size=10)
        place = f"{response.quality}, {response.speed * 3.6:.0f} km/h"
        axis.set_title(f"{place}: r.m.s. {rms:.3g} {unit} over these frequencies", weight="normal", size=9)
        f, total = response.frequencies, response.psd[:, column]
        if simulated is not None:
            axis.loglog(*simulated, color=PALE, lw=1.0, label="simulated", zorder=1)
        axis.loglog(f, total, color=INK, lw=1.9, label="all", zorder=3)
        for kind, share in response.shares.items():
            if len(response.shares) > 1 and share[:, column].max() > 10.0**-DECADES * total.max():
                color, line = KIND_LOOKS[kind]
                axis.loglog(f, share[:, column], color=color, ls=line, lw=1.3, label=kind, zorder=4)
        axis.set_xlim(f[0], f[-1])
        axis.set_ylim(total.max() * 10.0**-DECADES, 3.0 * total.max())
        axis.set_xlabel("frequency  [Hz]")
        _plain_ticks(axis.xaxis, f[0], f[-1])
        axis.set_ylabel(f"density  [({unit})²/Hz]")
        axis.legend(loc="best", handlelength=3.0)
        return figure


def effects(table: pd.DataFrame, column: str, *, title: str, unit: str, count: int = 12) -> Figure:
    """The parameters that move a value most, as bars: its change for a parameter 1 % larger.

    table: one eigenvalue or channel of a sensitivity table; column: `frequency_effect`, `damping_effect` or `effect`
    (real); title, unit: of the value; count: how many parameters. Blue with hatching lowers, orange raises.
    """
    values = table[column].to_numpy(dtype=np.float64)
    first = np.argsort(-np.abs(values), kind="stable")[:count]
    unit, per = readable(unit, 0.01 * values)
    shown, labels = 0.01 * per * values[first], [table["parameter"].iloc[i] for i in first]
    with styled():
        figure, (axis,) = panels(1, height=1.2 + 0.27 * len(first))
        axis.set_title(title, pad=10)
        places = np.arange(len(first))[::-1]
        for raised, color, hatch in ((True, "#D55E00", ""), (False, "#56B4E9", "////")):
            some = (shown > 0.0) == raised
            axis.barh(places[some], shown[some], color=color, hatch=hatch, edgecolor=INK, lw=0.6, height=0.72)
        axis.set_yticks(places, labels)
        axis.axvline(0.0, color=INK, lw=0.7)
        axis.xaxis.set_major_locator(MaxNLocator(6))
        axis.grid(axis="y", visible=False)
        axis.set_xlabel(labelled("change for a parameter 1 % larger", unit))
        return figure
