"""Figure of the energy account of a run: what came in and where it went over time, and the sums at the end.
What is below one per cent of the energy turned over is drawn together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.assess.energy import Account, accounts_of
from klingel.plot.style import INK, PALE, panels, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMALL = 0.01
"""Share below which an account is drawn together with the others."""

LOOKS: dict[str, tuple[str, str]] = {
    "traction": ("#0072B2", ""),
    "hold": ("#56B4E9", "//"),
    "gradient": ("#009E73", "\\\\"),
    "rails": ("#F0E442", "xx"),
    "wind": ("#F0E442", "++"),
    "actuators": ("#000000", ".."),
    "guides": ("#8a8a8a", "oo"),
    "regeneration": ("#56B4E9", ".."),
    "copper_armature": ("#E69F00", "//"),
    "copper_field": ("#E69F00", "\\\\"),
    "copper_stator": ("#E69F00", "xx"),
    "copper_rotor": ("#E69F00", ".."),
    "motor_friction": ("#CC79A7", ""),
    "transmission": ("#CC79A7", "//"),
    "running_resistance": ("#D55E00", ""),
    "contact_friction": ("#E69F00", ""),
    "contact_damping": ("#E69F00", "++"),
    "suspension": ("#CC79A7", "\\\\"),
    "kinetic": ("#009E73", ""),
    "potential": ("#009E73", "//"),
    "elastic": ("#009E73", ".."),
    "contact_elastic": ("#009E73", "xx"),
    "magnetic": ("#009E73", "++"),
    "others": ("#c9c9c9", ""),
}
"""Colour of Okabe and Ito and hatching of an account, so that a grey print tells them apart."""

Values = NDArray[np.float64]


def energy_account(result: xr.Dataset, *, title: str = "") -> Figure:
    """What came in, upwards, and where it went, downwards, over time; below the sums at the end, with shares.

    What is stored is drawn downwards while it grows, upwards once it has shrunk. Errors: InputError for a run without
    energies.
    """
    found = accounts_of(result)
    time = result["time"].to_numpy()
    signed = {a.name: a.sign * result[a.channel].to_numpy() / 1e3 for a in found}
    turned = sum(max(float(values[-1]), 0.0) for values in signed.values())
    parts = _parts(found, signed, turned)
    with styled():
        figure, (over_time, sums) = panels(2, height=5.6, share_x=False)
        figure.suptitle(title or "Energy account", x=0.01, ha="left", weight="bold", size=10)
        _stack(over_time, time, parts)
        over_time.plot(time, result["energy.residual"].to_numpy() / 1e3, color=INK, lw=0.9, ls=":", label="residual")
        over_time.set_ylabel("given / taken [kJ]")
        over_time.set_xlabel("time [s]")
        over_time.set_xlim(time[0], time[-1])
        _bars(sums, parts, turned)
    return figure


def _parts(found: Sequence[Account], signed: dict[str, Values], turned: float) -> dict[str, Values]:
    """Accounts over time in kJ, positive where they give; the small ones in one."""
    large = [a.name for a in found if np.abs(signed[a.name]).max() >= SMALL * turned]
    parts = {name: signed[name] for name in large}
    small = [signed[a.name] for a in found if a.name not in parts]
    if small:
        parts["others"] = np.sum(small, axis=0)
    return parts


def _stack(axes: Axes, time: Values, parts: dict[str, Values]) -> None:
    """Areas on top of each other: what gives upwards, what takes downwards, at every time."""
    up, down = np.zeros_like(time), np.zeros_like(time)
    for name, values in parts.items():
        color, hatch = LOOKS[name]
        for base, part in ((up, np.maximum(values, 0.0)), (down, np.minimum(values, 0.0))):
            if np.any(part != 0.0):
                axes.fill_between(time, base, base + part, fc=color, ec="white", lw=0.3, hatch=hatch)
                base += part
    axes.axhline(0.0, color=INK, lw=0.7)


def _bars(axes: Axes, parts: dict[str, Values], turned: float) -> None:
    """One bar an account, each beginning where the one before ended: up to what was turned over and back to zero."""
    ends = {name: float(values[-1]) for name, values in parts.items()}
    order = sorted(ends, key=lambda name: (ends[name] < 0.0, -abs(ends[name])))
    at = 0.0
    for row, name in enumerate(order):
        color, hatch = LOOKS[name]
        axes.barh(row, ends[name], left=at, fc=color, ec="white", hatch=hatch, height=0.75)
        right = max(at, at + ends[name])
        at += ends[name]
        share = 100.0 * ends[name] / turned if turned else 0.0
        axes.text(right + 0.01 * turned, row, f"{ends[name]:+.1f} kJ, {share:+.1f} %", va="center", size=8)
    axes.set_yticks(range(len(order)), [name.replace("_", " ") for name in order])
    axes.invert_yaxis()
    axes.axvline(0.0, color=PALE, lw=0.7)
    axes.set_xlim(right=1.3 * turned)
    axes.set_xlabel("from what came in to what was lost or stored [kJ]")
    axes.grid(visible=False, axis="y")


__all__ = ["energy_account"]
