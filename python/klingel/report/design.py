"""The page of `klingel design`: margins of every loop against what they shall be, Bode and Nyquist diagrams, the map of
stability, and what the strategy was made of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pandas as pd

from klingel import __version__
from klingel.design.limits import limits
from klingel.plot.design import loop_bode, nyquist, stability_map
from klingel.plot.style import render
from klingel.report.page import Report
from klingel.report.parameters import strategy_rows
from klingel.report.sections import Listed, Picture, Section, sections_report

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from klingel.design.bench import Bench

HEADS = {
    "loop": "loop",
    "speed": "km/h",
    "crossover": "crossover Hz",
    "gain": "gain up",
    "gain_down": "gain down",
    "phase": "phase °",
    "delay": "delay ms",
    "disk": "disk α",
    "sensitivity": "largest |S|",
    "missed": "falls short",
}
"""Headings of the table of margins."""

SCALES = {"speed": 3.6, "phase": 180.0 / math.pi, "delay": 1e3}
DIGITS = {"speed": 0, "phase": 0, "delay": 1}


def design_report(bench: Bench, *, title: str, subtitle: str) -> Report:
    """The page of a strategy on the bench.

    Args:
        bench: what was examined.
        title: of the page, such as the strategy and the vehicle.
        subtitle: under it, such as where it was examined.

    Returns:
        The page; the same input gives the same page.
    """
    sections = [_summary(bench), *_loops(bench), _stability(bench), _settings(bench)]
    return sections_report(sections, title=title, subtitle=subtitle, version=__version__)


def readable_margins(table: pd.DataFrame) -> pd.DataFrame:
    """A judged table of `klingel.design.margins` as it is to be read: km/h, degrees, ms, few digits.

    Args:
        table: with the column `missed`.

    Returns:
        Rows of text, headings as columns.
    """
    rows = table.to_dict("records")
    return pd.DataFrame([{head: _cell(name, row[name]) for name, head in HEADS.items()} for row in rows])


def _cell(name: str, value: object) -> str:
    if isinstance(value, str):
        return value or "-"
    assert isinstance(value, float)
    if math.isnan(value):
        return "-"
    if math.isinf(value):
        return "any"
    return f"{value * SCALES.get(name, 1.0):.{DIGITS.get(name, 2)}f}"


def _summary(bench: Bench) -> Section:
    """The verdict first, then the least margins of every kind of loop at every speed."""
    table = bench.table
    short = table[table["missed"] != ""]
    if not len(table):
        told = "The strategy closes no loop."
    elif len(short):
        told = f"{len(short)} of {len(table)} loops fall short of what they shall have."
    else:
        told = f"All {len(table)} loops have the margins that they shall have."
    rows = []
    for _, group in table.groupby(["kind", "speed"], sort=False):
        kind, speed = str(group["kind"].iloc[0]), float(group["speed"].iloc[0])
        wanted = limits(bench.scenario, kind, speed)
        rows.append(
            {
                "loops": kind,
                "km/h": f"{3.6 * speed:.0f}",
                "gain": _of("gain", group, wanted.gain),
                "phase °": _of("phase", group, wanted.phase),
                "delay ms": _of("delay", group, wanted.delay),
                "disk α": _cell("disk", float(group["disk"].min())),
                "verdict": "unstable" if not group["stable"].all() else "short" if group["missed"].any() else "kept",
            }
        )
    text = (
        told,
        *bench.check.words(),
        "Every loop is opened alone where its commands enter the vehicle, all others closed, on the exact sampled"
        " linear model of the whole vehicle. The delay is the one that may come to those that the strategy has.",
    )
    caption = "Least margins of all loops of a kind, and of what where one is demanded"
    return Section("Verdict", text, (Listed(caption, pd.DataFrame(rows)),) if rows else ())


def _of(name: str, group: pd.DataFrame, wanted: float) -> str:
    """The least margin of a kind, and of what where something is demanded."""
    least = _cell(name, float(group[name].min()))
    return f"{least} of {wanted * SCALES.get(name, 1.0):g}" if wanted > 0.0 else least


def _loops(bench: Bench) -> list[Section]:
    """A section a kind: its table, and diagrams of its worst loop."""
    sections = []
    for kind, shown in bench.worst.items():
        name = shown[0].name
        rows = readable_margins(bench.table[bench.table["kind"] == kind])
        pictures = (
            _picture(
                f"bode-{kind}", loop_bode(shown, title=f"{name}: L"), f"Bode diagram of {name}, the least robust."
            ),
            _picture(
                f"nyquist-{kind}",
                nyquist(shown, title=f"{name}: L"),
                f"Nyquist diagram of {name} near -1; hatched is what the least disk margin keeps free,"
                " dotted the circle of the largest sensitivity.",
            ),
        )
        caption = "A gain down of 0 means that the loop may be cut; any: no margin is met"
        sections.append(Section(f"Loops: {kind}", (), (Listed(caption, rows),), pictures))
    return sections


def _stability(bench: Bench) -> Section:
    text = (
        "Eigenvalues of the closed full vehicle on straight track with its own profiles and with coned wheels, and in"
        " the steady curves of the study with its own profiles. Steep cones run on gauge 5 mm wider.",
    )
    figure = stability_map(bench.check, title="Least damping ratio of any oscillation above 0.1 Hz")
    caption = "Where the strategy is stable: damping ratio in %, speed over conicity and friction."
    return Section("Stability", text, (), (_picture("stability", figure, caption),))


def _settings(bench: Bench) -> Section:
    if bench.scenario.control is None:
        return Section("Settings", ("No strategy.",))
    rows = pd.DataFrame([{"parameter": r["key"], "value": r["value"]} for r in strategy_rows(bench.scenario.control)])
    return Section("Settings", (), (Listed("Parameters of the strategy, SI and Hz", rows),))


def _picture(name: str, figure: Figure, caption: str) -> Picture:
    return Picture(name, render(figure, "svg", name=name), caption)
