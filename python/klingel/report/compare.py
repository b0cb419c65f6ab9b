"""The page of a comparison: which strategies, through which curves, five figures, one table, stability, settings.
One file, opens offline; the same input gives the same page."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.report.columns import HEADINGS as OF_ASSESSMENT
from klingel.report.columns import Heading, cell
from klingel.report.page import Report, inline_svg, template
from klingel.report.parameters import strategy_rows, vehicle_rows
from klingel.track import CANT_BASE

if TYPE_CHECKING:
    import pandas as pd

    from klingel.scenario import Scenario
    from klingel.track import Track
    from klingel.vehicle import Vehicle

HEADINGS: Mapping[str, Heading] = {
    "strategy": Heading("strategy", "", 0, "as it was named"),
    "curve": Heading("curve", "", 0, "name of the curve"),
    **OF_ASSESSMENT,
    "vehicle": Heading("vehicle", "", 0, "that the strategy is run on"),
}
"""Heading of every column of the table."""

SHOWN = tuple(name for name in HEADINGS if name not in ("vehicle", "radius_m", "speed_kmh", "notes"))
"""Columns of the results on the page; vehicles and curves stand in what was run, notes below."""

WORDS = ("strategy", "curve", "vehicle", "flange_contact", "outcome")
"""Columns of words, which stand on the left."""

GRAVITY = 9.81


@dataclass(frozen=True)
class Entry:
    """One of those compared: its name in the table, its label in the figures, vehicle and settings."""

    name: str
    label: str
    scenario: Scenario


@dataclass(frozen=True)
class Curve:
    """A curve: its track, radius [m] and speed [m/s]."""

    track: Track
    radius: float
    speed: float


@dataclass(frozen=True)
class ComparePage:
    """What the page shows.

    Attributes:
        entries: those compared, in the order of the table.
        curves: that they ran through.
        table: `strategy`, `curve` and the columns of `klingel.assess.COLUMNS`.
        straight: `strategy`, `speed_kmh`, `stable`, `growth_per_s`, `damping`, `frequency_Hz`, `mode`.
        margins: `strategy`, `speed_kmh`, `kind`, `gain_margin`, `phase_margin_deg`, `delay_margin_ms`.
        figures: `fig15` ... to the bytes of an SVG file.
        captions: of the figures, by the same names.
        failed: runs without figures, with the reason.
        version: of Klingel.
    """

    entries: Sequence[Entry]
    curves: Sequence[Curve]
    table: pd.DataFrame
    straight: pd.DataFrame
    margins: pd.DataFrame
    figures: Mapping[str, bytes]
    captions: Mapping[str, str]
    failed: Mapping[str, str]
    version: str


def compare_report(page: ComparePage) -> Report:
    """The page of a comparison."""
    straight, heads = straight_cells(page.straight)
    entries, common = parted([_entry(entry) for entry in page.entries])
    vehicles: dict[str, Vehicle] = {entry.scenario.vehicle.name: entry.scenario.vehicle for entry in page.entries}
    return Report(
        template("compare.html").render(
            page=page,
            entries=entries,
            common=common,
            curves=[_curve(curve) for curve in page.curves],
            headings={name: HEADINGS[name] for name in SHOWN},
            definitions_of=HEADINGS,
            words=WORDS,
            rows=[{name: shown(name, row[name]) for name in SHOWN} for row in page.table.to_dict("records")],
            notes=notes(page.table),
            straight_heads=heads,
            straight_rows=straight,
            margin_rows=margin_cells(page.margins, list(dict.fromkeys(page.straight["speed_kmh"]))),
            unknown=unknown(page.straight),
            figures={name: inline_svg(svg, name) for name, svg in page.figures.items()},
            vehicles=list(vehicles.values()),
            parameters={name: vehicle_rows(vehicle) for name, vehicle in vehicles.items()},
            strategies={entry.name: _settings(entry.scenario.control) for entry in page.entries},
        )
    )


def straight_cells(straight: pd.DataFrame) -> tuple[list[list[str]], list[str]]:
    """Stability on straight track as rows of text, a column a speed, and the heads of the columns.

    A cell is the least damping ratio in percent with the frequency of its mode in Hz, or what is unstable.
    """
    speeds = list(dict.fromkeys(straight["speed_kmh"]))
    rows = [
        [str(name), *(_damping(rows[rows["speed_kmh"] == speed]) for speed in speeds)]
        for name, rows in straight.groupby("strategy", sort=False)
    ]
    return rows, ["strategy", *(f"{speed:.0f} km/h" for speed in speeds)]


def _damping(rows: pd.DataFrame) -> str:
    if not len(rows) or rows["stable"].iloc[0] == "unknown":
        return "unknown"
    damping, frequency = float(rows["damping"].iloc[0]), float(rows["frequency_Hz"].iloc[0])
    swings = f"{100.0 * damping:.1f} % at {frequency:.2f} Hz"
    if damping >= 0.0:
        return swings
    return f"unstable: {swings}" if frequency > 0.0 else f"unstable: grows by {rows['growth_per_s'].iloc[0]:.2g} 1/s"


def margin_cells(margins: pd.DataFrame, speeds: Sequence[float]) -> list[list[str]]:
    """Least margins as rows of text: strategy, kind of loop, then gain, phase and delay at every speed [km/h]."""
    rows = []
    for (name, kind), each in margins.groupby(["strategy", "kind"], sort=False):
        found = {row["speed_kmh"]: row for row in each.to_dict("records")}
        rows.append([str(name), str(kind), *(_margins(found.get(speed)) for speed in speeds)])
    return rows


def _margins(row: Mapping[Hashable, Any] | None) -> str:
    if row is None:
        return "–"
    gain, phase, delay = (float(row[key]) for key in ("gain_margin", "phase_margin_deg", "delay_margin_ms"))
    parts = ((gain, f"× {gain:.2f}"), (phase, f"{phase:.0f}°"), (delay, f"{delay:.0f} ms"))
    return ", ".join("any" if math.isinf(value) else text for value, text in parts)


def notes(table: pd.DataFrame) -> dict[str, list[str]]:
    """What a reader of the numbers should know, to the runs it holds for."""
    found: dict[str, list[str]] = {}
    for row in table.to_dict("records"):
        if row["notes"]:
            found.setdefault(str(row["notes"]), []).append(f"{row['strategy']}, {row['curve']}")
    return found


def unknown(straight: pd.DataFrame) -> dict[str, str]:
    """Strategies without a linear model, with the reason."""
    rows = straight[straight["stable"] == "unknown"].drop_duplicates("strategy")
    return {str(name): str(reason) for name, reason in zip(rows["strategy"], rows["mode"], strict=True)}


def _settings(steering: object) -> list[dict[str, str]]:
    """Settings of a strategy; none of a user's own that is no dataclass, or of no control."""
    return strategy_rows(steering) if dataclasses.is_dataclass(steering) else []


def _entry(entry: Entry) -> dict[str, str]:
    scenario = entry.scenario
    rail = scenario.rail if isinstance(scenario.rail, str) else scenario.rail.name
    friction = "along the track" if scenario.adhesion is not None else f"{scenario.friction:g}"
    steering = "none" if scenario.control is None else type(scenario.control).__name__
    return {
        "strategy": entry.name,
        "drawn as": entry.label,
        "vehicle": scenario.vehicle.name,
        "control": steering,
        "friction": friction,
        "rail": f"{rail} at {scenario.rail_inclination:g}, gauge {1e3 * scenario.gauge:.1f} mm",
        "contact": f"{scenario.contact}, creep forces {scenario.creep_law}",
        "step": f"{1e3 * scenario.step:g} ms",
    }


def shown(column: str, value: object) -> str:
    """One value of the table as text; the reason for a missing run stands elsewhere.

    >>> shown("outcome", "no run: it failed"), shown("y_max_mm", 1.234)
    ('no run', '1.23')
    """
    return "no run" if str(value).startswith("no run") else cell(column, value)


def parted(rows: Sequence[Mapping[str, str]]) -> tuple[list[dict[str, str]], dict[str, str]]:
    """Rows without what is the same in all of them, and that; name and vehicle stay.

    >>> parted([{"strategy": "a", "friction": "0.3"}, {"strategy": "b", "friction": "0.3"}])
    ([{'strategy': 'a'}, {'strategy': 'b'}], {'friction': '0.3'})
    """
    stay = ("strategy", "drawn as", "vehicle")
    common = {
        key: value for key, value in rows[0].items() if key not in stay and all(row[key] == value for row in rows)
    }
    return [{key: value for key, value in row.items() if key not in common} for row in rows], common


def _curve(curve: Curve) -> dict[str, str]:
    cant = max((abs(h) for segment in curve.track.segments for h in segment.cant), default=0.0)
    acceleration = curve.speed**2 / curve.radius * math.sqrt(1.0 - (cant / CANT_BASE) ** 2) - GRAVITY * cant / CANT_BASE
    return {
        "curve": curve.track.name,
        "R [m]": f"{curve.radius:g}",
        "V [km/h]": f"{3.6 * curve.speed:.4g}",
        "cant [mm]": f"{1e3 * cant:.0f}",
        "unbalanced acceleration [m/s²]": f"{acceleration:.2f}",
        "length [m]": f"{curve.track.length:.0f}",
    }
