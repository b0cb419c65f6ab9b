"""Figures of traction and braking: speed, torque, voltages with what is left for steering, currents, displacement;
creepages over a patch of low adhesion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.assess.header import header_of, values
from klingel.plot.response import LINES
from klingel.plot.style import BAND, INK, PALE, panels, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from klingel.vehicle import Drive

RATE = 100.0
"""Points drawn a second at most; a wheelset's displacement and a voltage move slowly against it [Hz]."""

Y_LIMIT = 6.0
"""Where flange contact is near [mm]."""

CREEPAGE_LIMIT = 0.03
"""That slip control keeps to [-]."""

SIDES = ("left", "right")


def run_figure(result: xr.Dataset, *, title: str, drive: Drive) -> Figure:
    """What a run under traction did, over time: five panels.

    result: of a strategy with a traction loop and these DC motors. Errors: InputError for a channel that is missing.
    """
    header = header_of(result)
    sets = [w.name for w in header.wheelsets]
    most, traction_share = drive.armature_voltage_max, drive.traction_share
    rated = {"armature_current": drive.armature_current_rated, "field_current": drive.field_current_rated}
    time, some = _thinned(result)

    def of(channel: str) -> NDArray[np.float64]:
        return values(result, channel)[some]

    def pair(quantity: str, name: str) -> NDArray[np.float64]:
        return 0.5 * (of(f"{name}.left.{quantity}") + of(f"{name}.right.{quantity}"))

    with styled():
        figure, axes = panels(5, height=8.2)
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        speed, torque, voltage, current, place = axes
        _shade_arc(axes, result, time)
        speed.plot(time, 3.6 * of("body.speed"), color=INK)
        speed.set_ylabel("speed\n[km/h]")
        torque.plot(time, of("traction.torque_asked") / 1e3, color=PALE, ls=(0, (1.2, 1.2)), label="asked")
        for name, (color, line) in zip(sets, LINES, strict=False):
            torque.plot(time, pair("shaft_torque", name) / 1e3, color=color, ls=line, label=_short(name))
        torque.set_ylabel("torque per\nwheel [kN m]")
        first = sets[0]
        mean = pair("armature_voltage", first)
        largest = np.max(
            [np.abs(of(f"{s}.{side}.armature_voltage")) for s in sets for side in ("left", "right")], axis=0
        )
        steering = np.max([np.abs(of(f"{s}.steering_voltage")) for s in sets], axis=0)
        headroom = np.min([most - np.abs(pair("armature_voltage", s)) for s in sets], axis=0)
        voltage.axhline(most, color=INK, lw=0.8, label="VaMax")
        voltage.axhline(traction_share * most, color=INK, lw=0.8, ls=(0, (4, 3)), label="x VaMax")
        voltage.plot(time, np.abs(mean), color=LINES[0][0], label="|mean|, first wheelset")
        voltage.plot(time, largest, color=LINES[3][0], ls=LINES[3][1], lw=1.0, label="largest of all motors")
        voltage.plot(time, headroom, color=LINES[2][0], ls=LINES[2][1], label="left for steering")
        voltage.plot(time, steering, color=LINES[1][0], ls=LINES[1][1], label="used by steering")
        voltage.set_ylabel("armature\nvoltage [V]")
        for quantity, (color, line) in zip(("armature_current", "field_current"), LINES, strict=False):
            share = 100.0 * pair(quantity, first) / rated[quantity]
            current.plot(time, share, color=color, ls=line, label=quantity.partition("_")[0])
        current.set_ylabel("currents over\nrated ones [%]")
        for name, (color, line) in zip(sets, LINES, strict=False):
            place.plot(time, 1e3 * of(f"{name}.y"), color=color, ls=line)
        reach = max(1.0, 1.15 * float(np.max([np.abs(1e3 * of(f"{s}.y")).max() for s in sets])))
        for sign in (-1.0, 1.0):
            if reach > 0.7 * Y_LIMIT:
                place.axhline(sign * Y_LIMIT, color=INK, lw=0.8, ls=(0, (4, 3)))
        place.set_ylim(-reach, reach)
        place.set_ylabel("wheelsets to\nthe right [mm]")
        place.set_xlabel("time  [s]")
        for axis in (torque, voltage, current):
            axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.05), handlelength=3.0)
        place.set_xlim(time[0], time[-1])
        return figure


def patch_figure(result: xr.Dataset, *, title: str, begin: float, end: float, radius: float) -> Figure:
    """Passage over a patch of low adhesion between two positions [m]: speeds, creepages, torque, displacement.

    radius: of the wheels [m]. The band is the leading wheelset's time in the patch.
    """
    header = header_of(result)
    sets = [w.name for w in header.wheelsets]
    time, some = _thinned(result)

    def of(channel: str) -> NDArray[np.float64]:
        return values(result, channel)[some]

    with styled():
        figure, axes = panels(4, height=7.0)
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        rim, creep, torque, place = axes
        at = of(f"{sets[0]}.s")
        inside = (at >= begin) & (at <= end)
        if inside.any():
            for axis in axes:
                axis.axvspan(time[inside][0], time[inside][-1], color=BAND, zorder=0)
        rim.plot(time, 3.6 * of("body.speed"), color=INK, label="vehicle")
        for side, (color, line) in zip(("left", "right"), LINES[1:], strict=False):
            rim.plot(
                time, 3.6 * radius * of(f"{sets[0]}.{side}.spin_speed"), color=color, ls=line, label=f"{side} wheel"
            )
        rim.set_ylabel("speed, first\nwheelset [km/h]")
        for name, (color, line) in zip(sets, LINES, strict=False):
            both = [of(f"{name}.{side}.creep_x") for side in ("left", "right")]
            worst = np.where(np.abs(both[0]) > np.abs(both[1]), both[0], both[1])
            creep.plot(time, 100.0 * worst, color=color, ls=line, label=_short(name))
        for sign in (-1.0, 1.0):
            creep.axhline(sign * 100.0 * CREEPAGE_LIMIT, color=INK, lw=0.8, ls=(0, (4, 3)))
        creep.set_ylabel("creepage of the\nworse wheel [%]")
        torque.plot(time, of("traction.torque_asked") / 1e3, color=PALE, ls=(0, (1.2, 1.2)), label="asked")
        for name, (color, line) in zip(sets, LINES, strict=False):
            mean = 0.5 * (of(f"{name}.left.shaft_torque") + of(f"{name}.right.shaft_torque"))
            torque.plot(time, mean / 1e3, color=color, ls=line, label=_short(name))
        torque.set_ylabel("torque per\nwheel [kN m]")
        for name, (color, line) in zip(sets, LINES, strict=False):
            place.plot(time, 1e3 * of(f"{name}.y"), color=color, ls=line)
        reach = max(1.0, 1.15 * float(np.max([np.abs(1e3 * of(f"{s}.y")).max() for s in sets])))
        place.set_ylim(-reach, reach)
        place.set_ylabel("wheelsets to\nthe right [mm]")
        place.set_xlabel("time  [s]")
        for axis in (rim, creep, torque):
            axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.05), handlelength=3.0)
        place.set_xlim(time[0], time[-1])
        return figure


def _thinned(result: xr.Dataset) -> tuple[NDArray[np.float64], slice]:
    time = np.asarray(result["time"].values, dtype=np.float64)
    some = slice(None, None, max(1, round(1.0 / (RATE * float(time[1] - time[0])))))
    return time[some], some


def _short(name: str) -> str:
    """bogie1.wheelset2 as people number wheelsets, 1 to 4 from the front."""
    bogie, _, wheelset = name.partition(".")
    return f"wheelset {2 * (int(bogie[-1]) - 1) + int(wheelset[-1])}"


def _shade_arc(axes: list[Axes], result: xr.Dataset, time: NDArray[np.float64]) -> None:
    """The time that the body spends in curvature."""
    curvature = values(result, "body.curvature")
    clock = np.asarray(result["time"].values, dtype=np.float64)
    curved = np.abs(curvature) > 1e-9
    if curved.any():
        edges = clock[curved][0], clock[curved][-1]
        for axis in axes:
            axis.axvspan(*edges, color=BAND, zorder=0)
