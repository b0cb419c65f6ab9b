"""The picture of the case: creep forces over one creepage by every law, and CONTACT's rows upon them.
Circles are CONTACT; what it shows under spin is where the laws part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from klingel.contact import creep_force
from klingel.plot.style import INK, styled
from validation.contact_creep.case import SPEED, WHEEL_LOAD, series_rows, traction
from validation.contact_creep.rows import STEEL, references

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LAWS: tuple[tuple[str, str, dict[str, Any], str, Any], ...] = (
    ("shen_hedrick_elkins", "Shen, Hedrick & Elkins", {}, "#999999", (0, (1, 1.5))),
    ("polach", "Polach", {}, "#009E73", (0, (4, 1.4, 1, 1.4))),
    ("fastsim", "FASTSIM, plain", {"blended": False}, "#0072B2", (0, (5, 1.8))),
    ("fastsim", "FASTSIM, blended", {"blended": True}, "#D55E00", "-"),
)


def drawn() -> Figure:
    """Six panels: one creepage alone (a/b 1), lateral creepage with spin (a/b 0.5), yaw with spin, traction curves."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Plain

    rows = references()
    one, half = rows[rows["aob"] == 1.0], rows[rows["aob"] == 0.5]
    spins = np.sort(half.loc[half["kind"] == "eta+phi", "phi"].unique())
    with styled():
        figure = Plain(figsize=(7.4, 8.2))
        FigureCanvasAgg(figure)
        axes = figure.subplots(3, 2)
        _panel(axes[0, 0], one[one["kind"] == "xi"], "xi", "fx_rel", "longitudinal creepage, a/b 1")
        _panel(axes[0, 1], one[one["kind"] == "phi"], "phi", "fy_rel", "spin, a/b 1")
        for axis, spin in zip((axes[1, 0], axes[1, 1]), spins[1:], strict=True):
            part = half[(half["kind"] == "eta+phi") & (half["phi"] == spin)]
            _panel(axis, part, "eta", "fy_rel", f"lateral creepage at spin {spin:.3g} 1/m, a/b 0.5")
        spin = one.loc[one["kind"] == "xi+phi", "phi"].median()
        part = one[(one["kind"] == "xi+phi") & (one["phi"] == spin)]
        _panel(axes[2, 0], part, "xi", "fy_rel", f"longitudinal creepage at spin {spin:.3g} 1/m, a/b 1")
        _traction(axes[2, 1])
        axes[0, 0].legend(loc="upper right", fontsize=7.5)
    return figure


def _panel(axis: Axes, rows: pd.DataFrame, over: str, force: str, title: str) -> None:
    row, x = rows.iloc[0], np.linspace(rows[over].min(), rows[over].max(), 201)
    scale = 1.0 if over == "phi" else 1e3
    fixed = {key: float(row[key]) for key in ("a", "b", "xi", "eta", "phi")}
    for law, label, options, color, line in LAWS:
        patch: dict[str, Any] = {**fixed, over: x}
        fx, fy, _ = creep_force(law, **patch, normal_force=row["FN_N"], friction=row["mu"], **STEEL, **options)  # type: ignore[call-overload]
        axis.plot(
            scale * x, (fx if force == "fx_rel" else fy) / (row["FN_N"] * row["mu"]), color=color, ls=line, label=label
        )
    axis.plot(scale * rows[over], rows[force], "o", color=INK, mfc="none", ms=4.5, label="CONTACT")
    axis.set_title(title, fontsize=8.5)
    axis.set_xlabel({"xi": "ξ  [10⁻³]", "eta": "η  [10⁻³]", "phi": "φ  [1/m]"}[over])
    axis.set_ylabel({"fx_rel": "Fx / (μ Fn)", "fy_rel": "Fy / (μ Fn)"}[force])


def _traction(axis: Axes) -> None:
    xi = np.geomspace(1e-5, 0.25, 201)
    for series, label, color, line in ((3, "FASTSIM", "#0072B2", (0, (5, 1.8))), (4, "modified", "#D55E00", "-")):
        axis.plot(100 * xi, traction(xi, series) * 1e-3, color=color, ls=line, label=label)
        reference_xi, reference = series_rows(series)
        axis.plot(100 * reference_xi, reference * 1e-3, "o", color=INK, mfc="none", ms=4.0)
    axis.set_xlim(-0.2, 10.2)
    axis.set_title(f"traction, {WHEEL_LOAD / 1e3:g} kN, {SPEED:g} m/s", fontsize=8.5)
    axis.set_xlabel("ξ  [%]")
    axis.set_ylabel("Fx  [kN]")
    axis.legend(loc="upper right", fontsize=7.5)
