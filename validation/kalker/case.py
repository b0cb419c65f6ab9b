"""Kalker's creepage coefficients against his table, against CONTACT and against his asymptotes.
They are read off the linear law, so the whole path from Python to the coefficients is checked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from klingel.contact import creep_force
from validation.common import Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Kalker's coefficients"
ABOUT = """
Reference: table E.3 of Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), as it stands in CONTACT
(Apache-2.0) and OpenRailVehicleDynamics alike; coefficients that were extrapolated to vanishing creepage from runs of
CONTACT at nu 0.28; and Kalker's asymptotes for slender ellipses. The table is met exactly; at nu 0.28 it is itself up
to 1.6 % below CONTACT for slender patches (1/C is quadratic in nu, as CONTACT has it). C33 is not in the table: ours is
that of CONTACT, at every nu. Beyond the table the asymptotes are joined to it without a corner, which our own solver of
the full theory confirms (20, 30 and 40 elements each way, extrapolated; the spread of that is 0.5 %); above a/b = 10
the asymptotes themselves are off by the order of 1/ln^2.
"""

DATA = Path(__file__).parent
EXACT = {0.05: (3.4328, 2.4883, 0.4013), 20.0: (18.94, 21.94, 34.42), 25.0: (22.20, 25.98, 45.45)}
"""C11, C22 and C23 at nu 0.28 beyond the table, by our own solver of the full theory."""
NAMES = ("C11", "C22", "C23", "C33")
SHEAR_MODULUS = 8.2e10

Values = NDArray[np.float64]


def coefficients(ratio: ArrayLike, nu: float) -> dict[str, Values]:
    """C11, C22, C23 and C33 at a/b, from the linear law with G a b = 1 N: forces and moments are the coefficients."""
    g = np.asarray(ratio, dtype=np.float64)
    size = SHEAR_MODULUS**-0.5
    patch: dict[str, Any] = {"a": size * np.sqrt(g), "b": size / np.sqrt(g), "normal_force": 1.0, "friction": 1.0}
    patch |= {"shear_modulus": SHEAR_MODULUS, "poisson": nu}
    along, _, _ = creep_force("linear", xi=-1.0, eta=0.0, phi=0.0, **patch)
    _, across, _ = creep_force("linear", xi=0.0, eta=-1.0, phi=0.0, **patch)
    _, spin, moment = creep_force("linear", xi=0.0, eta=0.0, phi=-1.0 / size, **patch)
    return dict(zip(NAMES, (along, across, spin, moment / size), strict=True))


def run() -> Iterator[Row]:
    """Table, CONTACT, asymptotes."""
    table = pd.read_csv(DATA / "table_e3.csv", comment="#")
    ratio = _ratios(table)
    for nu, column in ((0.0, "nu0"), (0.25, "nu025"), (0.5, "nu05")):
        ours = coefficients(ratio, nu)
        error = max(_percent(ours[name], table[f"{name}_{column}"]) for name in NAMES[:3])
        yield Row.at_most(f"C11, C22, C23 at nu {nu:g}, a/b 0.1 to 10", "table E.3", error, 0.05, "%")
    contact = pd.read_csv(DATA / "contact.csv", comment="#")
    for name in NAMES[:3]:
        for what, part, most in (("0.1 to 1.43", contact[:13], 1.0), ("1.67 to 10", contact[13:], 1.7)):
            error = _percent(coefficients(part["a_over_b"], 0.28)[name], part[name])
            yield Row.at_most(f"{name} at nu 0.28, a/b {what}", "CONTACT", error, most, "%")
    for g, exact in EXACT.items():
        error = max(_percent(coefficients(g, 0.28)[name], c) for name, c in zip(NAMES, exact, strict=False))
        yield Row.at_most(f"C11, C22, C23 at nu 0.28, a/b {g:g}", "full theory", error, 2.0, "%")
    for g, most in ((25.0, 3.0), (1e4, 0.5), (0.05, 4.0), (1e-4, 0.5)):
        ours = coefficients(g, 0.28)
        error = max(
            _percent(ours[name], asymptote) for name, asymptote in zip(NAMES, asymptotes(g, 0.28), strict=False)
        )
        yield Row.at_most(f"C11, C22, C23 at nu 0.28, a/b {g:g}", "asymptotes", error, most, "%")


def _ratios(table: pd.DataFrame) -> Values:
    """a/b without the rounding of the table's column."""
    return np.asarray(np.where(table["which"] == "a/b", table["ratio"], 1.0 / table["ratio"]))


def _percent(ours: Any, reference: Any) -> float:
    return 100 * float(np.max(np.abs(np.asarray(ours) / np.asarray(reference) - 1.0)))


def asymptotes(ratio: float, nu: float) -> tuple[float, float, float]:
    """C11, C22 and C23 of slender ellipses (Kalker 1990; the forms in CONTACT, src/m_hertz.f90)."""
    if ratio < 1.0:
        c23 = math.pi * math.sqrt(ratio) / (3 * (1 - nu)) * (1 + nu * (math.log(16 / ratio) - 5))
        return math.pi**2 / (4 * (1 - nu)), math.pi**2 / 4, c23
    g, rise = 1 / ratio, 3 - math.log(4)
    log = math.log(16 / g**2)
    p, q = log - 2 * nu, (1 - nu) * log + 2 * nu
    c23 = 2 * math.pi / (3 * g**1.5 * ((1 - nu) * log - 2 + 4 * nu))
    return 2 * math.pi / (p * g) * (1 + rise / p), 2 * math.pi / g * (1 + (1 - nu) * rise / q) / q, c23


def figure() -> Figure:
    """How far CONTACT and the asymptotes are from our coefficients over a/b, at nu 0.28."""
    from klingel.plot.style import INK, panels, styled

    contact = pd.read_csv(DATA / "contact.csv", comment="#")
    at_rows, ratio = coefficients(contact["a_over_b"], 0.28), np.geomspace(0.02, 50, 300)
    ours, slender = coefficients(ratio, 0.28), np.array([asymptotes(float(g), 0.28) for g in ratio])
    with styled():
        drawn, axes = panels(3, height=6.4)
        for i, (axis, name) in enumerate(zip(axes, NAMES, strict=False)):
            off = 100 * (contact[name] / at_rows[name] - 1)
            error = 100 * contact[f"{name}_se"] / at_rows[name]
            axis.axhline(0.0, color=INK, lw=0.8)
            axis.axvspan(0.1, 10.0, color="#f2f2f2", lw=0)
            for side, label in ((ratio < 0.15, "asymptotes"), (ratio > 7.0, None)):
                deviation = 100 * (slender[side, i] / ours[name][side] - 1)
                axis.plot(ratio[side], deviation, color="#0072B2", ls=(0, (5, 1.8)), label=label)
            axis.errorbar(contact["a_over_b"], off, error, fmt="o", color="#D55E00", ms=4.5, label="CONTACT")
            beyond = [100 * (exact[i] / float(coefficients(g, 0.28)[name]) - 1) for g, exact in EXACT.items()]
            axis.plot(list(EXACT), beyond, "s", color=INK, mfc="none", ms=5.0, label="own solver of the full theory")
            axis.set_xscale("log")
            axis.set_ylim(-6.0, 4.0)
            axis.set_ylabel(f"{name}  [%]")
        axes[0].set_title("Deviation from Klingel's coefficients, ν 0.28 (shaded: Kalker's table)")
        axes[0].legend(loc="upper left")
        axes[-1].set_xlabel("a/b")
    return drawn
