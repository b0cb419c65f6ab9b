"""`klingel profile`: a wheel on a rail as one page or one picture.
Names of standard profiles or files of measured ones; what the contact table took is said."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Literal

from klingel.contact import WheelRailPair, profile_of
from klingel.errors import InputError
from klingel.report.contact import contact_report
from klingel.report.files import write_whole
from klingel.units import to_si

PAGES = (".html", ".htm")
PICTURES = (".png", ".svg")


def draw(
    wheel: str,
    rail: str,
    out: Path,
    inclination: str,
    gauge: str,
    flange_back: str,
    radius: str,
    *,
    load: str,
    normal: str,
    units: str | None,
    say: Callable[[object], None],
) -> Path:
    """Write the page or picture of a pair; arguments as on the command line. Errors: InputError."""
    if out.suffix not in (*PAGES, *PICTURES):
        remedy = f"end it in {', '.join((*PAGES, *PICTURES))}"
        raise InputError.single("out", str(out), "is no page or picture", remedy=remedy)
    if not out.parent.is_dir():
        raise InputError.single("out", str(out), "has no folder to be written to", remedy="make it, or choose another")
    pair = WheelRailPair(
        profile_of(wheel, "wheel", units=units),
        profile_of(rail, "rail", units=units),
        rail_inclination=slope(inclination),
        gauge=gauge,
        flange_back=flange_back,
        radius=radius,
        normal=normal,  # type: ignore[arg-type]  # it refuses other words
    )
    say(f"{pair}: {pair.prepare()}")
    wheel_load = to_si(load, "N", key="load")
    if out.suffix in PAGES:
        return contact_report(pair, wheel_load).save(out)
    from klingel.plot.contact import overview
    from klingel.plot.style import render

    form: Literal["svg", "png"] = "svg" if out.suffix == ".svg" else "png"
    return write_whole(out, render(overview(pair, wheel_load), form, name=out.stem))


def slope(text: str) -> float:
    """The slope of a rail: 1:40, 1/40 or a number.

    >>> slope("1:40"), slope("0.05"), slope("0")
    (0.025, 0.05, 0.0)
    """
    try:
        return float(Fraction(text.replace(":", "/")))
    except (ValueError, ZeroDivisionError):
        raise InputError.single("inclination", text, "is no slope", remedy="give it as 1:40 or 0.025") from None
