"""One page about a wheel on a rail: where it touches, rolling radii, conicity, contact angle, pressure.
Made of the pair's own tables; the same pair gives the same page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from klingel.contact import WheelRailPair
from klingel.plot.contact import figures
from klingel.plot.style import render, styled
from klingel.report.page import Report, inline_svg, template

PLACES = tuple(y * 1e-3 for y in range(-8, 9))
"""Displacements of the table [m]."""

AMPLITUDES = (1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3)
"""Amplitudes at which the conicity is tabulated [m]."""


def contact_report(pair: WheelRailPair, wheel_load: float) -> Report:
    """The page of a pair whose wheels carry `wheel_load` [N] each.

    Errors: InputError if the wheelset cannot be moved by 8 mm on these rails, or for a load that is too large.
    """
    with styled():
        drawn = {
            name: (inline_svg(render(figure, "svg", name=name), name), caption)
            for name, (figure, caption) in figures(pair, wheel_load).items()
        }
    conicity = np.atleast_1d(pair.equivalent_conicity(AMPLITUDES))
    return Report(
        template("contact.html").render(
            pair=pair,
            wheel_load=wheel_load / 1e3,
            figures=drawn,
            conicity=[(1e3 * a, c) for a, c in zip(AMPLITUDES, conicity, strict=True)],
            rows=list(_rows(pair, wheel_load)),
        )
    )


def _rows(pair: WheelRailPair, wheel_load: float) -> Iterator[tuple[str, ...]]:
    """The right wheel's patches as people read them."""
    table = pair.contact(PLACES, wheel_load=wheel_load)
    for row in table[table["side"] == "right"].to_dict("records"):
        yield (
            f"{row['y'] * 1e3:+.0f}",
            row["zone"],
            f"{row['y_wheel'] * 1e3:.2f}",
            f"{row['y_rail'] * 1e3:.2f}",
            f"{np.degrees(row['angle']):.2f}",
            f"{row['rolling_radius'] * 1e3:.3f}",
            f"{row['a'] * 1e3:.2f}",
            f"{row['b'] * 1e3:.2f}",
            f"{row['area'] * 1e6:.1f}",
            f"{row['pressure'] * 1e-6:.0f}",
            f"{row['normal_force'] * 1e-3:.2f}",
            f"{row['penetration'] * 1e6:.1f}",
        )
