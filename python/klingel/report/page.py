"""Pages from templates: the report of a study, and the short one of single assessments.
Figures are inlined as SVG; a page refers to nothing outside itself."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from klingel.assess import COLUMNS, Assessment
from klingel.report.claims import paper_claims
from klingel.report.columns import HEADINGS, cell, plain
from klingel.report.files import write_whole
from klingel.report.parameters import strategy_rows, vehicle_rows
from klingel.report.summary import Summary
from klingel.report.targets import targets

if TYPE_CHECKING:
    import pandas as pd

    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Report:
    """One self-contained HTML page. In a notebook it shows itself.

    Attributes:
        html: the page.
    """

    html: str

    def save(self, path: str | Path) -> Path:
        """Write the page, whole or not at all.

        Args:
            path: of the file.

        Returns:
            That path.

        Raises:
            OSError: the folder is missing or not writable.
        """
        return write_whole(Path(path), self.html.encode())

    def _repr_html_(self) -> str:
        return self.html


@dataclass(frozen=True)
class StudyPage:
    """What the report of a study shows.

    Attributes:
        summary: main runs, columns of `klingel.assess.COLUMNS`.
        variants: runs beside the main ones, with the columns `variant` and `friction` in front.
        figures: `fig15` ... to the bytes of an SVG file.
        captions: of the figures, by the same names.
        operating_points: Table 1, one row a speed; headings carry the units.
        operating_note: the formula and constants behind Table 1.
        vehicles: whose parameters are listed.
        strategies: name to the strategy whose settings are listed.
        static_wheel_loads: vehicle to wheel to load at rest [N].
        method: name of a setting to its value, in words.
        radius_of_history: radius of the curve that Fig. 15 shows [m].
        version: of Klingel.
        missing: runs that failed or were not made, with the reason.
    """

    summary: pd.DataFrame
    variants: pd.DataFrame
    figures: Mapping[str, bytes]
    captions: Mapping[str, str]
    operating_points: pd.DataFrame
    operating_note: str
    vehicles: Sequence[Vehicle]
    strategies: Mapping[str, Any]
    static_wheel_loads: Mapping[str, Mapping[str, float]]
    method: Mapping[str, str]
    radius_of_history: float
    version: str
    missing: Mapping[str, str]


def report(*assessments: Assessment, title: str = "Curving assessment") -> Report:
    """A short report: the figures of one or several assessments in one table.

    Args:
        assessments: rows of the table.
        title: of the page.

    Returns:
        The page.
    """
    rows = [{name: cell(name, value) for name, value in a.row().items()} for a in assessments]
    shares = [(a.vehicle, name, share) for a in assessments for name, share in a.wheelsets.items()]
    return Report(template("assessment.html").render(title=title, rows=rows, headings=HEADINGS, shares=shares))


def study_report(page: StudyPage) -> Report:
    """The report of the curving study.

    Args:
        page: everything that it shows.

    Returns:
        The page; the same input gives the same page.
    """
    summary = Summary(page.summary)
    claims = paper_claims(summary, page.radius_of_history, page.variants) if len(page.summary) else []
    active = [vehicle for vehicle in page.vehicles if vehicle.drive is not None and vehicle.steering is not None]
    return Report(
        template("study.html").render(
            page=page,
            claims=claims,
            differing=[c for c in claims if c.verdict in ("differs", "agrees in part")],
            agreeing=[c for c in claims if c.verdict == "agrees"],
            operating_note=plain(page.operating_note),
            targets=targets(summary, active[0]) if len(page.summary) and active else [],
            headings=HEADINGS,
            summary_rows=_cells(page.summary, COLUMNS),
            variant_tables=_variant_tables(page.variants),
            figures={name: inline_svg(svg, name) for name, svg in page.figures.items()},
            points=[list(page.operating_points.columns), *page.operating_points.astype(str).to_numpy().tolist()],
            parameters={vehicle.name: vehicle_rows(vehicle) for vehicle in page.vehicles},
            strategies={name: strategy_rows(strategy) for name, strategy in page.strategies.items()},
            loads=_loads(page.static_wheel_loads),
        )
    )


def inline_svg(svg: bytes, name: str) -> str:
    """An SVG file as an element for a page: no prolog, no metadata, identifiers made its own.

    Args:
        svg: content of the file.
        name: prefix of its identifiers, unique in the page.

    Returns:
        The `<svg>` element.

    Example:
        >>> inline_svg(b'<?xml version="1.0"?><svg><path id="a"/><use href="#a"/></svg>', "f")
        '<svg role="img" aria-labelledby="caption-f"><path id="f-a"/><use href="#f-a"/></svg>'
    """
    text = svg.decode()
    text = text[text.index("<svg") :].strip()
    text = re.sub(r"\s*<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'(\bid=")', rf"\g<1>{name}-", text)
    text = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", text)
    return text.replace("<svg", f'<svg role="img" aria-labelledby="caption-{name}"', 1)


def template(name: str) -> Any:
    from jinja2 import DictLoader, Environment, StrictUndefined  # only a report needs it

    folder = resources.files(__package__) / "templates"
    files = {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir() if file.name.endswith(".html")}
    environment = Environment(
        loader=DictLoader(files), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template(name)


def _cells(table: pd.DataFrame, columns: Sequence[str]) -> list[dict[str, str]]:
    return [{name: cell(name, row[name]) for name in columns} for row in table.to_dict("records")]


def _variant_tables(variants: pd.DataFrame) -> list[dict[str, Any]]:
    """One table a variant, its rows in the order of the summary."""
    if not len(variants):
        return []
    return [
        {"name": str(name), "rows": _cells(rows, COLUMNS)} for name, rows in variants.groupby("variant", sort=False)
    ]


def _loads(static_wheel_loads: Mapping[str, Mapping[str, float]]) -> list[dict[str, Any]]:
    """Wheel loads at rest as rows of (vehicle, wheelset, left, right) in kN."""
    rows: list[dict[str, Any]] = []
    for vehicle, loads in static_wheel_loads.items():
        pairs: dict[str, dict[str, float]] = {}
        for wheel, load in loads.items():
            wheelset, side = wheel.rsplit(".", 1)
            pairs.setdefault(wheelset, {})[side] = load
        for wheelset, pair in pairs.items():
            left, right = pair.get("left", np.nan), pair.get("right", np.nan)
            rows.append({"vehicle": vehicle, "wheelset": wheelset, "left": left / 1e3, "right": right / 1e3})
    return rows
