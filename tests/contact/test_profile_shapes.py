"""Standard profiles against public points, and what a profile must be to serve as a wheel or a rail."""

import numpy as np
import pytest

from klingel.contact import Profile
from klingel.errors import InputError


def test_heads_have_the_width_of_their_drawing() -> None:
    # EN 13674-1: 72 mm at 14.3 mm, 70 mm at 14.1 mm.
    for rail, width, depth in ((Profile.rail_60e1(), 72.0, 14.3), (Profile.rail_54e1(), 70.0, 14.1)):
        field = rail.y > 0.0
        half = np.interp(depth * 1e-3, rail.z[field], rail.y[field])
        assert 2e3 * half == pytest.approx(width, abs=1e-3)


def test_uic60_is_close_to_60e1() -> None:
    y = np.linspace(-0.0355, 0.0355, 500)
    apart = np.abs(Profile.rail_uic60().depth(y) - Profile.rail_60e1().depth(y))
    assert 0.03e-3 < apart.max() < 0.05e-3


@pytest.mark.parametrize("slope", [0.0, 1 / 40, 1 / 20, 0.1])
def test_cones(slope: float) -> None:
    cone = Profile.cone(slope)
    y = np.linspace(-0.02, 0.055, 50)
    np.testing.assert_allclose(cone.depth(y), -slope * y, atol=1e-12)
    np.testing.assert_allclose(cone.depth(-0.05), Profile.s1002().depth(-0.05), atol=1e-9)
    assert cone.kind == "wheel"


def test_cones_that_are_none() -> None:
    with pytest.raises(InputError, match="1/20"):
        Profile.cone(20.0)


@pytest.mark.parametrize(
    "profile", [Profile.s1002(), Profile.cone(0.05), Profile.rail_60e1(), Profile.rail_54e1(), Profile.rail_uic60()]
)
def test_kinds(profile: Profile) -> None:
    kind, other = ("wheel", "rail") if profile.y[-1] > 0.05 else ("rail", "wheel")
    assert profile.kind == kind
    profile.check(profile.kind)
    with pytest.raises(InputError, match=f"this is a {kind} profile; give a {other} profile"):
        profile.check("rail" if kind == "wheel" else "wheel")


WHEEL, RAIL = Profile.s1002(), Profile.rail_60e1()


@pytest.mark.parametrize(
    ("y", "z", "wanted", "said"),
    [
        (WHEEL.y, 0.3 * WHEEL.z, "wheel", "its height"),
        (WHEEL.y - 0.02, WHEEL.z, "wheel", "its tip"),
        (WHEEL.y + 0.02, WHEEL.z, "wheel", "tape circle"),
        (WHEEL.y[WHEEL.y > -0.041], WHEEL.z[WHEEL.y > -0.041], "wheel", "without a rounded tip"),
        (WHEEL.y[WHEEL.y < 0.01], WHEEL.z[WHEEL.y < 0.01], "wheel", "give the whole tread"),
        (WHEEL.y, WHEEL.z + 0.009, "wheel", "off the tape circle"),
        (RAIL.y[RAIL.y > -0.03], RAIL.z[RAIL.y > -0.03], "rail", "does not reach its gauge point"),
        (RAIL.y[RAIL.y < 0.003], RAIL.z[RAIL.y < 0.003], "rail", "give the whole crown"),
        (RAIL.y[RAIL.y < 0.0], RAIL.z[RAIL.y < 0.0], "rail", "at the end"),
    ],
)
def test_what_is_missing_is_said(y: np.ndarray, z: np.ndarray, wanted: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        Profile("odd", y, z).check("wheel" if wanted == "wheel" else "rail", key="pair")


def test_every_problem_of_points_at_once() -> None:
    y = np.linspace(0.0, 60.0, 15)
    y[5] = y[4]
    with pytest.raises(InputError) as caught:
        Profile("bad", y, np.zeros(15))
    text = str(caught.value)
    assert all(said in text for said in ("too few", "y does not rise", "look like millimetres"))
