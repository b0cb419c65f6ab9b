"""House style of the figures: colours for every eye, marks that survive a grey print, bytes that repeat.
One look a vehicle, used in every figure, so that a curve is recognised before its legend is read."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from klingel.errors import InputError

INK = "#1a1a1a"
PALE = "#8a8a8a"
GRID = "#e3e3e3"
BAND = "#f2f2f2"


@dataclass(frozen=True)
class Look:
    """How one vehicle is drawn.

    Attributes:
        label: in legends and tables.
        color: from the palette of Okabe and Ito, which every common colour vision separates.
        marker: matplotlib's code; differs in shape.
        line: matplotlib's line style; differs too.
        filled: false for a hollow marker.
    """

    label: str
    color: str
    marker: str
    line: str | tuple[int, tuple[float, ...]]
    filled: bool = True


LOOKS: Mapping[str, Look] = {
    "passive": Look("passive", "#000000", "o", "-"),
    "solid_like": Look("solid-wheelset-like (S)", "#0072B2", "s", (0, (5, 1.8))),
    "irw_like": Look("IRW-like (I)", "#D55E00", "^", (0, (4, 1.4, 1, 1.4)), filled=False),
}
"""Look of each vehicle of the study."""

SPARE: tuple[Look, ...] = (
    Look("", "#009E73", "D", (0, (1.2, 1.0)), filled=False),
    Look("", "#CC79A7", "v", (0, (8, 1.6, 1, 1.6, 1, 1.6)), filled=False),
    Look("", "#56B4E9", "P", (0, (9, 2.2)), filled=False),
    Look("", "#8C6D00", "X", (0, (3, 1.0)), filled=False),
    Look("", "#4B2E83", "<", (0, (6, 1.4, 2, 1.4)), filled=False),
    Look("", "#E69F00", ">", (0, (2.2, 2.2)), filled=False),
    Look("", "#5c5c5c", "h", (0, (5, 1.2, 1, 1.2, 1, 1.2, 1, 1.2)), filled=False),
    Look("", "#7A0019", "*", (0, (12, 1.6, 2, 1.6)), filled=False),
    Look("", "#00545c", "p", (0, (1.2, 2.6)), filled=False),
)
"""Looks of what is not in `LOOKS`, in the order they are given away."""


def looks_of(labels: Mapping[str, str]) -> dict[str, Look]:
    """A look for each of several strategies: its own where it has one, else the next spare one.

    Args:
        labels: name to what the legend calls it.

    Returns:
        Name to look, in the same order; all differ in marker and line.

    Raises:
        InputError: there are more than marks and lines keep apart.

    Example:
        >>> [look.marker for look in looks_of({"passive": "passive", "mine": "my own"}).values()]
        ['o', 'D']
    """
    spare = [name for name in labels if name not in LOOKS]
    if len(spare) > len(SPARE):
        message = f"no more than {len(SPARE)} strategies beside those of the paper can be told apart in one figure"
        raise InputError.single("strategies", len(labels), message, remedy="compare them in two parts")
    own = dict(zip(spare, SPARE, strict=False))
    return {name: LOOKS[name] if name in LOOKS else replace(own[name], label=label) for name, label in labels.items()}


RC: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.6,
    "lines.markersize": 6.5,
    "path.simplify_threshold": 0.2,
    "svg.fonttype": "path",
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.w_pad": 0.08,
    "figure.constrained_layout.h_pad": 0.07,
}


def styled() -> Any:
    """The house style as a context: figures are made inside it.

    Example:
        >>> with styled():
        ...     figure, axes = panels(1)
        >>> len(axes)
        1
    """
    return matplotlib.rc_context(RC)


def panels(rows: int, *, width: float = 6.6, height: float = 3.9, share_x: bool = True) -> tuple[Figure, list[Axes]]:
    """A figure with panels above each other.

    Args:
        rows: number of panels.
        width: of the figure [inch].
        height: of the figure [inch].
        share_x: panels have a common abscissa.

    Returns:
        The figure, and its panels from top to bottom.
    """
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, 1, sharex=share_x, squeeze=False)
    return figure, list(axes[:, 0])


def render(figure: Figure, form: Literal["svg", "png"], *, name: str) -> bytes:
    """A figure as the bytes of a file; the same figure gives the same bytes on every run.

    Args:
        figure: to draw.
        form: `svg` or `png` (200 dots per inch).
        name: of the figure; it salts the identifiers in an SVG, so that several can stand in one page.

    Returns:
        The file's content, without date or version.

    Example:
        >>> with styled():
        ...     figure, _ = panels(1)
        >>> render(figure, "svg", name="empty") == render(figure, "svg", name="empty")
        True
    """
    target = io.BytesIO()
    metadata = {"Date": None, "Creator": "Klingel", "Title": name} if form == "svg" else {"Software": None}
    with matplotlib.rc_context({**RC, "svg.hashsalt": name}):
        figure.savefig(target, format=form, dpi=200, metadata=metadata)
    return target.getvalue()
