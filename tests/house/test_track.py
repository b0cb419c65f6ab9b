"""Track: shapes, checks, mirror, and the five curves of the study."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from klingel.errors import InputError
from klingel.track import Segment, Track, cases


def curve(**changes: object) -> Track:
    values: dict[str, object] = {"radius": "300 m", "cant": "160 mm", "transition": "120 m", "arc": "180 m"}
    return Track.curve(**{**values, **changes})  # type: ignore[arg-type]


def test_curve_has_clothoids_with_cant_ramps() -> None:
    track = curve(straight_before=100, straight_after=50)
    assert track.length == 570.0
    assert track.starts == (0.0, 100.0, 220.0, 400.0, 520.0)
    np.testing.assert_allclose(track.curvature([50.0, 160.0, 300.0, 460.0, 560.0]) * 300.0, [0, 0.5, 1, 0.5, 0])
    np.testing.assert_allclose(track.cant([50.0, 160.0, 300.0, 460.0, 560.0]), [0, 0.08, 0.16, 0.08, 0])


def test_left_is_the_mirror_of_right() -> None:
    assert curve(hand="left") == curve().mirrored()
    assert float(curve(hand="left").curvature(300.0)) < 0.0


@given(st.floats(min_value=0.0, max_value=1.0))
def test_curvature_and_cant_go_together_along_the_curve(share: float) -> None:
    track = curve()
    s = share * track.length
    assert float(track.cant(s)) == pytest.approx(0.16 * 300.0 * float(track.curvature(s)), abs=1e-15)


def test_five_curves_have_300_mm_deficiency() -> None:
    five = cases.perez2004()
    assert [case.radius for case in five] == [300.0, 500.0, 800.0, 1200.0, 1800.0]
    for case in five:
        deficiency = 1.5 * case.speed**2 / (9.81 * case.radius) - 0.16
        assert deficiency == pytest.approx(0.300, abs=0.006)
        arc = case.track.segments[2]
        assert arc.length / case.speed == pytest.approx(6.0, rel=0.04)
        ramp = case.track.segments[1].length / case.speed
        assert 0.16 / ramp <= 0.050
        assert deficiency / ramp <= 0.0765


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"radius": "120 m"}, "too tight"),
        ({"radius": 0.0}, "must be positive"),
        ({"radius": "-300 m"}, "must be positive"),
        ({"cant": "250 mm"}, "too high"),
        ({"cant": 160}, "too high"),
        ({"transition": "20 m"}, "too steep"),
        ({"transition": 0.0, "cant": 0.0}, "curvature jumps"),
        ({"transition": 0.0}, "cant jumps"),
        ({"radius": "300 kg"}, "is a mass"),
        ({"hand": "up"}, "is no hand"),
    ],
)
def test_bad_curves(changes: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        curve(**changes)


def test_empty_track_and_places_outside() -> None:
    with pytest.raises(InputError, match="no segment"):
        Track(())
    with pytest.raises(InputError, match="outside the track"):
        Track.straight(100).curvature(101.0)
    with pytest.raises(InputError, match="must be positive"):
        Track((Segment(0.0),))
