"""A wheel-rail pair: columns and units, mirror image, equilibrium, yaw, rigid against light contact, refusals."""

import logging
from typing import Any

import numpy as np
import pytest

from klingel.contact import Profile, WheelRailPair
from klingel.errors import InputError

USUAL: dict[str, Any] = {"rail_inclination": 1 / 40, "gauge": 1.435, "flange_back": 1.36, "radius": 0.46}


@pytest.fixture(scope="module")
def pair() -> WheelRailPair:
    return WheelRailPair(Profile.s1002(), Profile.rail_60e1(), **USUAL)


Y = np.linspace(-8e-3, 8e-3, 33)


def test_columns_carry_units(pair: WheelRailPair) -> None:
    frame = pair.contact([0.0, 5e-3], wheel_load=5e4)
    assert list(frame.columns) == list(frame.attrs["units"])
    assert set(frame["side"]) == {"left", "right"}
    assert set(frame["zone"]) <= {"tread", "root", "flange"}
    assert frame.attrs["units"]["pressure"] == "Pa"
    assert np.isfinite(frame.drop(columns=["side", "zone"]).to_numpy(dtype=float)).all()


def test_left_is_the_mirror_image_of_right(pair: WheelRailPair) -> None:
    one, other = pair.contact(Y, yaw=4e-3, wheel_load=5e4), pair.contact(-Y, yaw=-4e-3, wheel_load=5e4)
    other = other.assign(y=-other["y"], roll=-other["roll"], side=other["side"].map({"left": "right", "right": "left"}))
    keys = ["y", "side", "zone"]
    one, other = (f.sort_values(keys).reset_index(drop=True) for f in (one, other))
    numbers = [c for c in one.columns if c not in keys]
    np.testing.assert_allclose(one[numbers], other[numbers], rtol=1e-6, atol=1e-9)


def test_each_wheel_carries_its_load(pair: WheelRailPair) -> None:
    frame = pair.contact(Y, wheel_load=6e4)
    vertical = (frame["normal_force"] * np.cos(frame["angle"])).groupby([frame["y"], frame["side"]]).sum()
    np.testing.assert_allclose(vertical, 6e4, rtol=1e-5)


def test_mean_pressure_is_below_the_largest(pair: WheelRailPair) -> None:
    frame = pair.contact(Y, wheel_load=5e4)
    mean = frame["normal_force"] / frame["area"]
    assert ((mean < frame["pressure"]) & (frame["pressure"] < 3.2 * mean)).all()


def test_difference_of_rolling_radii_is_odd_and_positive_to_the_right(pair: WheelRailPair) -> None:
    for load in (None, 5e4):
        difference = pair.rolling_radius_difference(Y, wheel_load=load)
        assert isinstance(difference, np.ndarray)
        assert (difference[Y > 0] > 0).all()
        np.testing.assert_allclose(difference, -difference[::-1], atol=1e-7)
        single = pair.rolling_radius_difference(3e-3, wheel_load=load)
        assert isinstance(single, float)
        assert single == pytest.approx(difference[22], rel=1e-9)


def test_a_light_load_touches_where_rigid_bodies_do(pair: WheelRailPair) -> None:
    y = np.array([-3e-3, 1e-3, 2e-3, 3e-3, 6e-3])
    rigid, light = pair.contact(y), pair.contact(y, wheel_load=300.0)
    assert rigid[["a", "pressure", "normal_force"]].isna().to_numpy().all()
    main = light.sort_values("normal_force").groupby(["y", "side"], sort=True).last().reset_index()
    rigid = rigid.sort_values(["y", "side"]).reset_index(drop=True)
    assert np.abs(main["y_wheel"] - rigid["y_wheel"]).max() < 3e-4
    assert np.abs(main["rolling_radius"] - rigid["rolling_radius"]).max() < 3e-5


def test_yaw_carries_the_flange_contact_ahead_of_the_axle(pair: WheelRailPair) -> None:
    for load in (None, 5e4):
        flange = pair.contact(7.5e-3, yaw=8e-3, wheel_load=load).query("side == 'right'").iloc[-1]
        expected = flange["rolling_radius"] * np.tan(flange["angle"]) * 8e-3
        assert flange["angle"] > 1.0
        assert flange["x"] == pytest.approx(expected, rel=1e-3)
        assert flange["x"] > 5e-3


def test_hertz_and_kik_piotrowski_agree_where_curvature_is_even(pair: WheelRailPair) -> None:
    hertz = WheelRailPair(Profile.s1002(), Profile.rail_60e1(), **USUAL, normal="hertz")
    one, other = (p.contact(-6e-3, wheel_load=5e4).query("side == 'right'").iloc[0] for p in (pair, hertz))
    for quantity in ("area", "pressure", "penetration"):
        assert one[quantity] == pytest.approx(other[quantity], rel=0.05)


def test_units_may_be_said(pair: WheelRailPair) -> None:
    said = WheelRailPair(
        Profile.s1002(),
        Profile.rail_60e1(),
        rail_inclination=0.025,
        gauge="1435 mm",
        flange_back="136 cm",
        radius="46 cm",
    )
    assert said.equivalent_conicity(3e-3) == pytest.approx(float(pair.equivalent_conicity(3e-3)))
    assert str(said) == "S1002 on 60E1 1:40, gauge 1435 mm"


def test_what_a_table_took_is_logged(pair: WheelRailPair, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, logger="klingel"):
        assert pair.prepare().seconds >= 0.0
    assert "S1002 on 60E1" in caplog.text
    assert "contact table" in caplog.text


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda p: p.contact(float("nan")), "y = nan: is not finite"),
        (lambda p: p.contact(0.0, yaw=float("inf")), "yaw = inf: is not finite"),
        (lambda p: p.contact("left"), "y = 'left': is no number"),
        (lambda p: p.contact(0.0, wheel_load=-5e4), "wheel_load = -50000.0: must be positive"),
        (lambda p: p.contact(0.0, wheel_load=5e8), "load"),
        (lambda p: p.contact(0.03, wheel_load=5e4), "rail"),
        (lambda p: p.contact(0.05), "rail"),
        (lambda p: p.rolling_radius_difference([0.0, float("nan")]), "is not finite"),
        (lambda p: p.equivalent_conicity(-1e-3), "amplitude"),
        (lambda p: p.equivalent_conicity(0.0), "amplitude"),
    ],
)
def test_bad_questions_get_one_clear_message(pair: WheelRailPair, ask: Any, message: str) -> None:
    with pytest.raises(InputError, match=message.replace("(", r"\(")):
        ask(pair)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gauge": 1.35}, "flange-back distance|gauge"),
        ({"gauge": float("nan")}, "gauge"),
        ({"flange_back": 1.43}, "flange-back distance"),
        ({"radius": 460.0}, "radius"),
        ({"rail_inclination": 40.0}, "inclination"),
        ({"normal": "hertzian"}, "did you mean 'hertz'"),
    ],
)
def test_pairs_that_cannot_be_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        WheelRailPair(Profile.s1002(), Profile.rail_60e1(), **(USUAL | change))
