"""Figures of a wheel on a rail: everything is drawn where it lies, labelled with units, and repeats to the byte."""

import numpy as np
import pytest

from klingel.contact import Profile, WheelRailPair
from klingel.errors import InputError
from klingel.plot import contact
from klingel.plot.style import render


@pytest.fixture(scope="module")
def pair() -> WheelRailPair:
    return WheelRailPair(
        Profile.s1002(), Profile.rail_60e1(), rail_inclination=1 / 40, gauge=1.435, flange_back=1.36, radius=0.46
    )


@pytest.mark.parametrize("y", [-0.0068, -0.003, 0.0, 0.005])
def test_wheel_and_rail_touch_where_the_contact_is_drawn(pair: WheelRailPair, y: float) -> None:
    figure = contact.pair(pair, y)
    assert len(figure.axes) == 2
    for axis in figure.axes:
        lines = {line.get_label(): np.array(line.get_data(), dtype=float) for line in axis.lines}
        point = lines["rigid contact"][:, 0]
        for name in ("rail 60E1", "wheel S1002"):
            across, up = lines[name]
            assert np.hypot(across - point[0], up - point[1]).min() < 0.06
        # Drawn to scale, the wheel nowhere deeper in the rail than a hundredth of a millimetre.
        wheel, rail = lines["wheel S1002"], lines["rail 60E1"]
        order = np.argsort(rail[0])
        over = np.interp(wheel[0], rail[0][order], rail[1][order], left=np.nan, right=np.nan)
        assert np.nanmin(wheel[1] - over) > -0.05
        assert axis.get_aspect() == 1.0


def test_flanges_point_inwards(pair: WheelRailPair) -> None:
    left, right = contact.pair(pair, 0.0).axes
    for axis, inwards in ((left, 1.0), (right, -1.0)):
        wheel = next(line for line in axis.lines if line.get_label() == "wheel S1002")
        across, up = (np.asarray(v) for v in wheel.get_data())
        assert inwards * across[np.argmin(up)] > 40.0


def test_every_figure_has_labels_with_units(pair: WheelRailPair) -> None:
    made = contact.figures(pair, 5e4)
    assert list(made) == ["section", "points", "radius", "conicity", "angle", "pressure"]
    for figure, caption in made.values():
        assert caption.endswith(".")
        for axis in figure.axes:
            assert "[" in axis.get_xlabel()
            assert "[" in axis.get_ylabel() or axis is figure.axes[-1]


def test_single_figures_and_overview(pair: WheelRailPair) -> None:
    for figure in (
        contact.rolling_radius_difference(pair),
        contact.conicity(pair),
        contact.contact_angle(pair),
        contact.contact_points(pair),
        contact.pressure(pair, wheel_load=5e4),
    ):
        assert len(figure.axes) == 1
    overview = contact.overview(pair, 5e4)
    assert len(overview.axes) == 6
    assert render(overview, "png", name="pair") == render(contact.overview(pair, 5e4), "png", name="pair")


def test_off_the_rails_is_refused(pair: WheelRailPair) -> None:
    with pytest.raises(InputError):
        contact.pair(pair, 0.08)
