"""Figures of a wheel on a rail: the pair in contact, contact points, rolling radii, conicity, contact angle, pressure.
Functions of a `WheelRailPair` that return matplotlib figures; positions in mm, y of the wheelset to the right."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.plot.style import BAND, INK, PALE, panels, styled

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from klingel.contact import Profile, WheelRailPair

Values = NDArray[np.float64]
Draw = Callable[["Axes", "Views"], None]

REACH = 8e-3
"""Largest displacement of the wheelset that is drawn [m]."""
STEPS = 321
AMPLITUDES = np.arange(0.5e-3, 8.01e-3, 0.1e-3)
"""Amplitudes of the conicity [m]."""
LITTLE = 0.02
"""Share of the load under which a patch is drawn hollow."""
NOMINAL = 3e-3
"""Amplitude at which a conicity is usually quoted [m]."""


@dataclass(frozen=True)
class Mark:
    """How the patches of a zone are drawn: colours for every eye, shapes for grey prints."""

    label: str
    color: str
    marker: str


MARKS: Mapping[str, Mark] = {
    "tread": Mark("tread", "#0072B2", "o"),
    "root": Mark("root", "#E69F00", "^"),
    "flange": Mark("flange", "#CC3311", "s"),
    "": Mark("rigid contact", INK, "o"),
}


class Views:
    """What the figures of one pair share: its patches over the displacement, computed once.

    wheel_load: of each wheel [N], None for rigid contact.
    """

    def __init__(self, pair: WheelRailPair, wheel_load: float | None) -> None:
        self.pair, self.wheel_load = pair, wheel_load
        self.y = np.linspace(-REACH, REACH, STEPS)
        table = pair.contact(self.y, wheel_load=wheel_load)
        self.right: pd.DataFrame = table[table["side"] == "right"]

    @property
    def how(self) -> str:
        """The load in words."""
        return _how(self.wheel_load)


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
        title = f"{_names(pair)}, wheelset {place}{turned}, {_how(wheel_load)}"
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=10)
        for axis, side in zip(axes, ("left", "right"), strict=True):
            _section(axis, pair, table, side)
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
    return _single(pair, wheel_load, "Difference of the rolling radii", _radius)


def conicity(pair: WheelRailPair) -> Figure:
    """Equivalent conicity (EN 15302) over the amplitude, the usual 3 mm marked."""
    return _single(pair, None, "Equivalent conicity (EN 15302)", _conicity)


def contact_angle(pair: WheelRailPair, *, wheel_load: float | None = None) -> Figure:
    """Angle of the contact plane of the right wheel over the displacement, every patch by its zone."""
    return _single(pair, wheel_load, "Contact angle of the right wheel", _angle)


def contact_points(pair: WheelRailPair, *, wheel_load: float | None = None) -> Figure:
    """Where the right wheel touches: places on wheel and rail, joined, one line a displacement."""
    return _single(pair, wheel_load, "Contact points of the right wheel", _points)


def pressure(pair: WheelRailPair, *, wheel_load: float) -> Figure:
    """Largest pressure in every patch of the right wheel over the displacement."""
    return _single(pair, wheel_load, "Largest contact pressure of the right wheel", _pressure)


def figures(pair: WheelRailPair, wheel_load: float) -> dict[str, tuple[Figure, str]]:
    """Every figure of a pair with its caption, by name, in the order of a page.

    Args:
        pair: the wheel on the rail.
        wheel_load: of each wheel [N].
    """
    views = Views(pair, wheel_load)
    load = f"{wheel_load / 1e3:g} kN on each wheel"
    made = {"section": (_both_sides(pair, 0.0, 0.0, wheel_load), f"The centred wheelset on its rails, {load}.")}
    for name, (title, draw, caption) in _PANELS.items():
        made[name] = (_drawn(views, title, draw), caption.format(load=load))
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
        title = f"{_names(pair)} {lean}, gauge {pair.gauge * 1e3:g} mm, {views.how}"
        figure.suptitle(title, x=0.01, ha="left", weight="bold", size=11)
        axes[0].set_title("Right wheel of the centred wheelset")
        _section(axes[0], pair, pair.contact(0.0, wheel_load=wheel_load), "right")
        axes[0].legend(loc="lower center", bbox_to_anchor=(0.46, 0.02))
        for axis, (title, draw, _) in zip(axes[1:], _PANELS.values(), strict=True):
            axis.set_title(title)
            draw(axis, views)
        return figure


def _section(axis: Axes, pair: WheelRailPair, table: pd.DataFrame, side: str) -> None:
    """The wheel of one side on its rail, seen from behind: y to the right, up is up."""
    patches = table[table["side"] == side]
    mirror = -1.0 if side == "left" else 1.0
    rail_y, rail_z = _leaning(pair)
    # The patch that bears most fits wheel and rail together; it lies on both.
    seat = patches.iloc[int(np.argmax(patches["normal_force"].fillna(1.0)))]
    roll = mirror * float(seat["roll"])
    wheel_y, wheel_z = pair.wheel.y - seat["y_wheel"], pair.wheel.z - seat["z_wheel"]
    wheel_y, wheel_z = (
        seat["y_rail"] + wheel_y * np.cos(roll) - wheel_z * np.sin(roll),
        seat["z_rail"] + wheel_y * np.sin(roll) + wheel_z * np.cos(roll),
    )
    axis.fill_between(1e3 * mirror * rail_y, -1e3 * rail_z, -40.0, color=BAND, lw=0, zorder=1)
    axis.plot(1e3 * mirror * rail_y, -1e3 * rail_z, color=PALE, lw=1.6, label=f"rail {_short(pair.rail)}", zorder=2)
    axis.plot(1e3 * mirror * wheel_y, -1e3 * wheel_z, color=INK, lw=1.2, label=f"wheel {_short(pair.wheel)}", zorder=3)
    for zone, mark in MARKS.items():
        found = patches[patches["zone"] == zone]
        if not len(found):
            continue
        y, z = mirror * found["y_rail"].to_numpy(), found["z_rail"].to_numpy()
        angle = found["angle"].to_numpy()
        axis.plot(
            1e3 * y, -1e3 * z, ls="", marker=mark.marker, ms=6, color=mark.color, mec="white", mew=0.6, zorder=5,
            label=mark.label if not zone else f"contact: {mark.label}",
        )  # fmt: skip
        # The normal into the rail is (sin, cos) of the angle, to the field side and down.
        for y0, z0, turn in zip(y, z, angle, strict=True):
            across, down = mirror * np.sin(turn), np.cos(turn)
            ends = [[1e3 * y0 - s * 9.0 * across, -1e3 * z0 + s * 9.0 * down] for s in (-1.0, 1.0)]
            axis.plot(*np.transpose(ends), color=mark.color, lw=1.0, ls=(0, (3, 1.5)), zorder=4)
    axis.set_aspect("equal")
    axis.set_ylim(-32.0, 16.0)
    axis.set_xlim(*sorted((-mirror * 74.0, mirror * 58.0)))
    axis.set_xlabel(f"{side} rail: across the track, to the right  [mm]")
    axis.set_ylabel("above top of rail  [mm]")


def _leaning(pair: WheelRailPair) -> tuple[Values, Values]:
    """The right rail as it lies [m], from its highest point, its upper 32 mm."""
    angle = np.arctan(pair.rail_inclination)
    y = pair.rail.y * np.cos(angle) + pair.rail.z * np.sin(angle)
    z = pair.rail.z * np.cos(angle) - pair.rail.y * np.sin(angle)
    top = int(np.argmin(z))
    y, z = y - y[top], z - z[top]
    return y[z < 0.032], z[z < 0.032]


def _points(axis: Axes, views: Views) -> None:
    """Wheel below rail would be unreadable: two lines of places, joined where they touch."""
    pair, table = views.pair, views.right
    rail_y, rail_z = _leaning(pair)
    on_top = rail_z < 0.016
    lift = 14.0
    tread = (pair.wheel.y > -0.046) & (pair.wheel.y < 0.03)
    axis.plot(1e3 * pair.wheel.y[tread], lift - 1e3 * pair.wheel.z[tread], color=INK, lw=1.2)
    axis.plot(1e3 * rail_y[on_top], -1e3 * rail_z[on_top], color=PALE, lw=1.6)
    for zone, mark in MARKS.items():
        found = table[(table["zone"] == zone) & _whole_half(table["y"])]
        if len(found):
            wheel = np.array([1e3 * found["y_wheel"], lift - 1e3 * found["z_wheel"]])
            rail = np.array([1e3 * found["y_rail"], -1e3 * found["z_rail"]])
            axis.plot([wheel[0], rail[0]], [wheel[1], rail[1]], color=mark.color, lw=0.7, alpha=0.8)
            axis.plot(*rail, ls="", marker=mark.marker, ms=3.5, color=mark.color, label=mark.label)
            axis.plot(*wheel, ls="", marker=mark.marker, ms=3.5, color=mark.color)
    axis.annotate("wheel", (26.0, lift + 1.6), size=8.5, color=INK, ha="right")
    axis.annotate("rail", (17.0, -4.4), size=8.5, color="#555555", ha="right")
    axis.set_ylim(-17.0, lift + 4.0)
    axis.set_xlabel("place on wheel (from the tape circle) and rail (from its top)  [mm]")
    axis.set_ylabel("profile  [mm], wheel lifted")
    title = f"wheelset every 0.5 mm, {views.how}"
    axis.legend(loc="lower center", bbox_to_anchor=(0.52, 0.0), title=title, title_fontsize=8.5)


def _whole_half(y: pd.Series[float]) -> Values:
    """Which displacements are whole multiples of half a millimetre."""
    halves = y.to_numpy() / 0.5e-3
    return np.asarray(np.abs(halves - np.round(halves)) < 1e-6)


def _radius(axis: Axes, views: Views) -> None:
    pair, y = views.pair, views.y
    axis.plot(1e3 * y, 1e3 * pair.rolling_radius_difference(y), color=INK, lw=1.2, ls=(0, (4, 1.5)), label="rigid")
    if views.wheel_load is not None:
        loaded = pair.rolling_radius_difference(y, wheel_load=views.wheel_load)
        axis.plot(1e3 * y, 1e3 * np.asarray(loaded), color="#0072B2", label=views.how)
    axis.axhline(0.0, color=INK, lw=0.6, zorder=1)
    axis.set_xlabel("displacement of the wheelset to the right  [mm]")
    axis.set_ylabel("Δr, right less left  [mm]")
    axis.legend(loc="upper left")


def _conicity(axis: Axes, views: Views) -> None:
    found = np.asarray(views.pair.equivalent_conicity(AMPLITUDES))
    axis.plot(1e3 * AMPLITUDES, found, color="#0072B2")
    nominal = float(np.interp(NOMINAL, AMPLITUDES, found))
    axis.plot([1e3 * NOMINAL], [nominal], "o", color=INK, ms=5)
    axis.annotate(
        f"{nominal:.3f} at {1e3 * NOMINAL:g} mm", (1e3 * NOMINAL, nominal), (6, 8), textcoords="offset points", size=8.5
    )
    axis.set_ylim(bottom=0.0)
    axis.set_xlim(0.0, 1e3 * AMPLITUDES[-1])
    axis.set_xlabel("amplitude of the lateral motion  [mm]")
    axis.set_ylabel("tan γe  [–]")


def _angle(axis: Axes, views: Views) -> None:
    _by_zone(axis, views, np.degrees(views.right["angle"].to_numpy()))
    axis.set_ylabel("contact angle  [°]")


def _pressure(axis: Axes, views: Views) -> None:
    _by_zone(axis, views, 1e-6 * views.right["pressure"].to_numpy())
    axis.set_ylim(bottom=0.0)
    axis.set_ylabel("largest pressure  [MPa]")


def _by_zone(axis: Axes, views: Views, values: Values) -> None:
    """Every patch of the right wheel by its zone, hollow where it bears little."""
    table = views.right
    share = np.ones(len(table))
    if views.wheel_load is not None:
        share = table["normal_force"].to_numpy() / views.wheel_load
    for zone, mark in MARKS.items():
        of_zone = table["zone"].to_numpy() == zone
        for bears, face in ((True, mark.color), (False, "none")):
            rows = of_zone & ((share >= LITTLE) == bears)
            if rows.any():
                axis.plot(
                    1e3 * table["y"].to_numpy()[rows], values[rows], ls="", marker=mark.marker, ms=3, mew=0.6,
                    color=mark.color, mfc=face, label=mark.label if bears else None,
                )  # fmt: skip
    if (share < LITTLE).any():
        axis.plot(
            [], [], "o", ms=3, mew=0.6, color=INK, mfc="none", label=f"hollow: under {100 * LITTLE:g} % of the load"
        )
    axis.set_xlabel("displacement of the wheelset to the right  [mm]")
    axis.legend(loc="upper left", title=views.how, title_fontsize=8.5)


_PANELS: Mapping[str, tuple[str, Draw, str]] = {
    "points": (
        "Contact points of the right wheel",
        _points,
        "Places where the right wheel touches, joined, for displacements of the wheelset from −8 to 8 mm; {load}.",
    ),
    "radius": (
        "Difference of the rolling radii",
        _radius,
        "Right less left rolling radius, roll of the wheelset included; {load}, at the load-weighted middle.",
    ),
    "conicity": (
        "Equivalent conicity (EN 15302)",
        _conicity,
        "Slope of the cone whose wheelset swings with the same wavelength; rigid contact.",
    ),
    "angle": (
        "Contact angle of the right wheel",
        _angle,
        "Angle of the contact plane in the track, positive on the flange; {load}.",
    ),
    "pressure": (
        "Largest contact pressure of the right wheel",
        _pressure,
        "Largest pressure in every patch, elastic steel; {load}.",
    ),
}


def _single(pair: WheelRailPair, wheel_load: float | None, title: str, draw: Draw) -> Figure:
    return _drawn(Views(pair, wheel_load), title, draw)


def _drawn(views: Views, title: str, draw: Draw) -> Figure:
    with styled():
        figure, (axis,) = panels(1)
        axis.set_title(title, pad=8)
        draw(axis, views)
        return figure


def _names(pair: WheelRailPair) -> str:
    return f"{_short(pair.wheel)} on {_short(pair.rail)}"


def _short(profile: Profile) -> str:
    """A profile's name, of a file without its folders."""
    return profile.name.replace("\\", "/").rsplit("/", 1)[-1]


def _how(wheel_load: float | None) -> str:
    """The load in words."""
    return "rigid contact" if wheel_load is None else f"{wheel_load / 1e3:g} kN a wheel"


def _grid(rows: int, columns: int, *, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """Panels row by row, each with its own axes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)
