"""A page of sections, each with words, figures and tables: reports whose parts are a list and not a form.
One file, opens offline; the same input gives the same page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from klingel.report.page import Report, inline_svg, template

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Picture:
    """An SVG with a name, unique in the page, and its caption."""

    name: str
    svg: bytes
    caption: str


@dataclass(frozen=True)
class Listed:
    """A table with a caption; cells as they are to be read, headings with units."""

    caption: str
    rows: pd.DataFrame


@dataclass(frozen=True)
class Section:
    """A part of a page: title, paragraphs, then tables and figures."""

    title: str
    text: tuple[str, ...] = ()
    tables: tuple[Listed, ...] = ()
    pictures: tuple[Picture, ...] = ()
    facts: Mapping[str, str] = field(default_factory=dict)


def sections_report(sections: Iterable[Section], *, title: str, subtitle: str, version: str) -> Report:
    """The page of sections, with a list of contents."""
    parts = [
        {
            "id": f"part{i}",
            "title": section.title,
            "text": section.text,
            "facts": section.facts,
            "tables": [
                {
                    "caption": table.caption,
                    "headings": [str(heading) for heading in table.rows.columns],
                    "rows": table.rows.astype(str).to_numpy().tolist(),
                }
                for table in section.tables
            ],
            "pictures": [
                {"name": p.name, "svg": inline_svg(p.svg, p.name), "caption": p.caption} for p in section.pictures
            ],
        }
        for i, section in enumerate(sections, start=1)
    ]
    return Report(template("sections.html").render(title=title, subtitle=subtitle, version=version, parts=parts))
