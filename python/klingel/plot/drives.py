"""Figures of the drives: operating characteristic, responses measured on the rig, design plants on the whole vehicle.
What limits is grey or dashed, what runs is coloured, what the simulator answered is a hollow point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MultipleLocator, NullFormatter

from klingel.plot.response import LINES, SIMULATED
from klingel.plot.style import INK, PALE, styled

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from klingel.linear.rig import PlantDeparture, RigResponses

LINE = "#0072B2"
"""Of the line that is run along."""
FIELD = "#D55E00"
"""Of the field, beside the armature."""
POINTS = 14
"""Measured points that are drawn in a decade."""


def characteristic(table: pd.DataFrame, *, title: str, points: Sequence[float] = ()) -> Figure:
    """Fig. 6: voltages, field current, torque at the wheel and power over the motor's speed.

    table: of `klingel.drives.operating_characteristic`; points: speeds [m/s] to mark on the line of the running
    resistance.
    """
    with styled():
        figure = _figure(7.4, 5.6)
        axes = figure.subplots(2, 2, sharex=True)
        (voltage, torque), (field, power) = axes
        speed = table["motor_speed"].to_numpy()
        marks = np.interp(points, table["speed"], speed)
        for panel, limit, line, unit in (
            (voltage, "limit_armature_voltage", "armature_voltage", 1.0),
            (torque, "limit_torque", "torque", 1e-3),
            (field, "limit_field_current", "field_current", 1.0),
            (power, "limit_power", "power", 1e-3),
        ):
            panel.plot(speed, unit * table[limit], color=INK, label="rated currents, x VaMax")
            panel.plot(speed, unit * table[line], color=LINE, ls=(0, (5, 1.8)), label="running resistance")
            at = np.interp(marks, speed, unit * table[line])
            panel.plot(marks, at, ls="", marker="o", ms=4.5, mfc="white", mec=LINE, mew=1.2)
            panel.set_ylim(0.0, None)
        total = float((table["armature_voltage"] + table["steering_voltage"]).iloc[0])
        voltage.axhline(total, color=PALE, lw=1.0, ls=(0, (1.2, 1.2)))
        voltage.annotate("VaMax", (speed[-1], total), ha="right", va="bottom", color=PALE, fontsize=8.0)
        share = float(table["limit_armature_voltage"].max())
        voltage.fill_between(speed, share, total, color=FIELD, alpha=0.15, lw=0)
        voltage.annotate("left for steering", (speed[2], 0.5 * (share + total)), va="center", color=FIELD, fontsize=8.0)
        torque.set_ylim(0.0, 1.3e-3 * float(table["limit_torque"].max()))
        voltage.set_ylim(0.0, 1.14 * total)
        voltage.set_ylabel("armature voltage  [V]")
        field.set_ylabel("field current  [A]")
        torque.set_ylabel("torque at the wheel  [kN m]")
        power.set_ylabel("power of one motor  [kW]")
        torque.legend(loc="upper right", handlelength=3.0)
        for panel in (field, power):
            panel.set_xlabel("motor speed  [rad/s]")
        voltage.set_xlim(0.0, float(speed[-1]))
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        return figure


def rig(responses: RigResponses, *, title: str) -> Figure:
    """Magnitude and phase of every equation, with what the simulator answered on the rig."""
    with styled():
        figure = _figure(7.4, 5.2)
        size, phase = figure.subplots(2, 1, sharex=True)
        f = responses.frequencies
        for (name, stated), (color, line) in zip(responses.stated.items(), LINES, strict=True):
            size.loglog(f, np.abs(stated), color=color, ls=line, label=f"Eq. {name}")
            turned = _phase(stated)
            phase.semilogx(f, turned, color=color, ls=line)
            some, measured = _some(f), responses.measured[name]
            look: dict[str, Any] = {"ls": "", "marker": "o", "ms": 3.2, "mfc": "white", "mec": color, "mew": 0.9}
            size.loglog(f[some], np.abs(measured[some]), **look)
            angle = np.degrees(np.angle(measured))
            phase.semilogx(f[some], (angle + 360.0 * np.round((turned - angle) / 360.0))[some], **look)
        size.set_ylabel("magnitude  [SI]")
        size.legend(loc="lower left", ncols=5, handlelength=3.0)
        _finish(figure, size, phase, f, title)
        return figure


def departure(found: PlantDeparture, *, title: str) -> Figure:
    """wd/u and Td/u of the first bogie's wheelsets in the whole vehicle beside Eqs (29) and (27), zeros marked."""
    with styled():
        figure = _figure(7.4, 5.6)
        axes = figure.subplots(2, 2, sharex=True)
        f = found.frequencies
        wheelsets = [name for name in found.exact if name.startswith("bogie1")]
        for column, (equation, unit, what) in enumerate((("(27)", "N m/V", "Td/u"), ("(29)", "rad/s/V", "wd/u"))):
            size, phase = axes[0][column], axes[1][column]
            size.loglog(f, np.abs(found.stated[equation]), color=INK, label=f"Eq. {equation}")
            stated = _phase(found.stated[equation])
            phase.semilogx(f, stated, color=INK)
            for name, (color, line) in zip(wheelsets, ((LINE, LINES[1][1]), (FIELD, LINES[2][1])), strict=True):
                values = found.exact[name][equation]
                size.loglog(f, np.abs(values), color=color, ls=line, label=name.rpartition(".")[2])
                # both agree at the highest frequency, so the turns are counted from there
                turned = _phase(values)
                phase.semilogx(f, turned + 360.0 * np.round((stated[-1] - turned[-1]) / 360.0), color=color, ls=line)
                if equation == "(29)":
                    zeros = [z for z, _ in found.zeros[name]]
                    at = np.exp(np.interp(np.log(zeros), np.log(f), np.log(np.abs(values))))
                    size.plot(zeros, at, ls="", marker="v", ms=5.0, mfc="white", mec=color, mew=1.1)
            size.set_ylabel(f"{what}  [{unit}]")
            _finish(figure, size, phase, f, title)
        axes[0][1].plot([], [], ls="", marker="v", ms=5.0, mfc="white", mec=SIMULATED, label="zeros")
        axes[0][0].legend(loc="best", handlelength=3.0)
        axes[0][1].legend(*[part[-1:] for part in axes[0][1].get_legend_handles_labels()], loc="best")
        return figure


def torque_answers(answers: Mapping[str, tuple[NDArray[np.float64], NDArray[np.complex128]]], *, title: str) -> Figure:
    """Shaft torque over commanded torque of several drives: label to frequencies [Hz] and responses."""
    with styled():
        figure = _figure(7.4, 4.2)
        size, phase = figure.subplots(2, 1, sharex=True)
        for (label, (f, values)), (color, line) in zip(answers.items(), LINES, strict=False):
            size.semilogx(f, 20.0 * np.log10(np.abs(values)), color=color, ls=line, label=label)
            phase.semilogx(f, _phase(values), color=color, ls=line)
        size.set_ylabel("torque  [dB]")
        size.legend(loc="best", handlelength=3.0)
        _finish(figure, size, phase, f, title)
        return figure


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _phase(values: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.asarray(np.degrees(np.unwrap(np.angle(values))))


def _some(f: NDArray[np.float64]) -> NDArray[np.intp]:
    """Places of about `POINTS` frequencies a decade."""
    wanted = np.geomspace(f[0], f[-1], int(POINTS * np.log10(f[-1] / f[0])) + 1)
    return np.unique(np.abs(f[:, None] - wanted).argmin(axis=0))


def _finish(figure: Figure, size: Axes, phase: Axes, f: NDArray[np.float64], title: str) -> None:
    figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
    phase.set_ylabel("phase  [°]")
    span = float(np.ptp(phase.get_ylim()))
    phase.yaxis.set_major_locator(MultipleLocator(90.0 if span > 150.0 else 30.0 if span > 45.0 else 5.0))
    phase.set_xlabel("frequency  [Hz]")
    phase.set_xlim(f[0], f[-1])
    phase.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    phase.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    phase.xaxis.set_minor_formatter(NullFormatter())
