"""Figures of a wheel on a rail: the pair in contact, contact points, rolling radii, conicity, contact angle, pressure.
Functions of a `WheelRailPair` that return matplotlib figures; positions in mm, y of the wheelset to the right."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.plot.contact_panels import PANELS, Views, how_loaded, names, section
from klingel.plot.style import panels, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from klingel.contact import WheelRailPair


def pair(pair: WheelRailPair, y: float = 0.0, *, yaw: float = 0.0, wheel_load: float | None = None) -> Figure:
    """Both wheels on their rails as seen from behind, with their contacts and contact normals.

    Args:
        pair: the wheel on the rail.
        y: displacement of the wheelset to the right [m].
        yaw: of the wheelset, positive to the right [rad].
        wheel_load: of each wheel [N], None for rigid contact.

    Returns:
        The figure: left rail, right rail, drawn to scale, the wheels rolled as they lie.

    Raises:
        InputError: the wheelset is off its rails there, or the load cannot be borne.

    Example:
        >>> from klingel.contact import Profile, WheelRailPair
        >>> made = WheelRailPair(Profile.s1002(), Profile.rail_60e1(), rail_inclination=1 / 40, gauge="1435 mm",
        ...                      flange_back="1360 mm", radius="460 mm")
        >>> len(pair(made, 0.005).axes)
        2
    """
    return _both_sides(pair, y, yaw, wheel_load)


def _both_sides(pair: WheelRailPair, y: float, yaw: float, wheel_load: float | None) -> Figure:
    table = pair.contact(y, yaw=yaw, wheel_load=wheel_load)
    with styled():
        figure, axes = _grid(1, 2, width=9.0, height=2.65)
        place = f"{abs(y) * 1e3:.3g} mm to the {'right' if y > 0.0 else 'left'}" if y else "centred"
        turned = f", yaw {yaw * 1e3:+.3g} mrad" if yaw else ""
        title = f"{names(pair)}, wheelset {place}{turned}, {how_loaded(wheel_load)}"
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        for axis, side in zip(axes, ("left", "right"), strict=True):
            section(axis, pair, table, side)
        axes[1].set_ylabel("")
        named = {
            label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)
        }
        figure.legend(list(named.values()), list(named), loc="outside lower center", ncols=5)
        return figure


def rolling_radius_difference(pair: WheelRailPair, *, wheel_load: float | None = None) -> Figure:
    """Rolling radius of the right wheel less that of the left one over the displacement, rigid and under load.

    Args:
        pair: the wheel on the rail.
        wheel_load: of each wheel [N], None for rigid contact alone.
    """
    return _drawn(Views(pair, wheel_load), "radius")


def conicity(pair: WheelRailPair) -> Figure:
    """Equivalent conicity (EN 15302) over the amplitude, the usual 3 mm marked."""
    return _drawn(Views(pair, None), "conicity")


def contact_angle(pair: WheelRailPair, *, wheel_load: float | None = None) -> Figure:
    """Angle of the contact plane of the right wheel over the displacement, every patch by its zone."""
    return _drawn(Views(pair, wheel_load), "angle")


def contact_points(pair: WheelRailPair, *, wheel_load: float | None = None) -> Figure:
    """Where the right wheel touches: places on wheel and rail, joined, one line a displacement."""
    return _drawn(Views(pair, wheel_load), "points")


def pressure(pair: WheelRailPair, *, wheel_load: float) -> Figure:
    """Largest pressure in every patch of the right wheel over the displacement."""
    return _drawn(Views(pair, wheel_load), "pressure")


def figures(pair: WheelRailPair, wheel_load: float) -> dict[str, tuple[Figure, str]]:
    """Every figure of a pair with its caption, by name, in the order of a page.

    Args:
        pair: the wheel on the rail.
        wheel_load: of each wheel [N].
    """
    views = Views(pair, wheel_load)
    load = f"{wheel_load / 1e3:g} kN on each wheel"
    made = {"section": (_both_sides(pair, 0.0, 0.0, wheel_load), f"The centred wheelset on its rails, {load}.")}
    for name, (_, _, caption) in PANELS.items():
        made[name] = (_drawn(views, name), caption.format(load=load))
    return made


def overview(pair: WheelRailPair, wheel_load: float) -> Figure:
    """One picture of a pair: wheel on rail, contact points, radii, conicity, angle and pressure.

    Args:
        pair: the wheel on the rail.
        wheel_load: of each wheel [N].
    """
    views = Views(pair, wheel_load)
    with styled():
        figure, axes = _grid(3, 2, width=10.0, height=10.6)
        lean = f"1:{1 / pair.rail_inclination:g}" if pair.rail_inclination else "not inclined"
        title = f"{names(pair)} {lean}, gauge {pair.gauge * 1e3:g} mm, {views.how}"
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=11)
        axes[0].set_title("Right wheel of the centred wheelset")
        section(axes[0], pair, pair.contact(0.0, wheel_load=wheel_load), "right")
        axes[0].legend(loc="lower center", bbox_to_anchor=(0.46, 0.02))
        for axis, (title, draw, _) in zip(axes[1:], PANELS.values(), strict=True):
            axis.set_title(title)
            draw(axis, views)
        return figure


def _drawn(views: Views, name: str) -> Figure:
    """The figure of one panel."""
    title, draw, _ = PANELS[name]
    with styled():
        figure, (axis,) = panels(1)
        axis.set_title(title, pad=8)
        draw(axis, views)
        return figure


def _grid(rows: int, columns: int, *, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """Panels row by row, each with its own axes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)
