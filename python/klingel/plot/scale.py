"""Units that people read on an axis: km/h, and prefixes or a power of ten where numbers would be long.
The factor goes into the label, so that no tick label and no corner of a figure hides it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

READ_AS = {"m/s": ("km/h", 3.6)}
"""Units that people read, and how many of them an SI unit is."""

PREFIXES = {-9: "n", -6: "µ", -3: "m", 3: "k", 6: "M", 9: "G"}

PREFIXED = ("N", "V", "A", "W", "J", "Pa", "Hz", "rad", "m", "s", "Ω", "ohm", "H")
"""First words of units that take a prefix; kg and the like take a power of ten."""

LONG, SHORT = 1e4, 1e-2
"""Largest values of an axis from which, and below which, it is scaled."""

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def readable(unit: str, values: ArrayLike) -> tuple[str, float]:
    """The unit to show values in, and how many of it one of the given unit is.

    Args:
        unit: SI, "1" for a pure number.
        values: that the axis shows; the largest amount decides.

    Returns:
        Text of the unit, empty for a pure number, and the factor.

    Example:
        >>> readable("m/s", [30.0]), readable("N s/m", [1e5, 4e5]), readable("kg m2", [2e4]), readable("1", [0.35])
        (('km/h', 3.6), ('kN s/m', 0.001), ('10³ kg m²', 0.001), ('', 1.0))
    """
    if unit in READ_AS:
        return READ_AS[unit]
    word = "" if unit in ("1", "-") else raised(unit)
    most = float(np.max(np.abs(values), initial=0.0))
    if most == 0.0 or SHORT <= most < LONG:
        return word, 1.0
    power = 3 * math.floor(math.log10(most) / 3.0)
    if (word, power) == ("kg", 3):
        return "t", 1e-3
    if power in PREFIXES and word.replace("/", " ").split(" ")[0] in PREFIXED:
        return f"{PREFIXES[power]}{word}", 10.0**-power
    return f"10{str(power).translate(RAISED)} {word}".strip(), 10.0**-power


def raised(unit: str) -> str:
    """A unit with its exponents raised.

    Example:
        >>> raised("kg m2"), raised("m/s2")
        ('kg m²', 'm/s²')
    """
    return unit.replace("2", "²").replace("3", "³")


def valued(value: float, unit: str) -> str:
    """A value with its unit in running text.

    Example:
        >>> valued(20.0, "kN"), valued(20.0, "10³ kg m²"), valued(0.35, "")
        ('20 kN', '20 × 10³ kg m²', '0.35')
    """
    return f"{value:.4g} {'× ' if unit.startswith('10') else ''}{unit}".strip()


def labelled(name: str, unit: str) -> str:
    """Label of an axis: the quantity and its unit, where it has one."""
    return f"{name}  [{unit}]" if unit else name
