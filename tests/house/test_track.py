"""Track: shapes, checks, mirror, and the five curves of the study."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from klingel.errors import InputError
from klingel.track import Adhesion, Segment, Track, cases


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


def test_a_grade_is_linear_inside_a_segment_and_must_not_jump() -> None:
    climb = Track((Segment(100.0), Segment(50.0, grade=(0.0, 0.02)), Segment(100.0, grade=(0.02, 0.02))))
    np.testing.assert_allclose(climb.grade([50.0, 125.0, 200.0]), [0.0, 0.01, 0.02])
    assert climb.mirrored().segments == climb.segments
    np.testing.assert_allclose(curve(grade="2 %").grade([0.0, 300.0]), 0.02)
    assert Track.straight(100.0, grade=0.01).segments[0].grade == (0.01, 0.01)
    for grade, said in (((0.02, 0.02), "grade jumps"), ((0.0, 0.2), "too steep")):
        with pytest.raises(InputError, match=said):
            Track((Segment(100.0), Segment(50.0, grade=grade)))


def test_adhesion_is_linear_in_the_transitions_and_held_elsewhere() -> None:
    adhesion = Adhesion(base=0.3, patches=[(100.0, 300.0, 0.08), ("320 m", "350 m", 0.1, "right")], transition=10.0)
    np.testing.assert_allclose(
        adhesion.left([-50.0, 90.0, 95.0, 100.0, 300.0, 305.0, 340.0]), [0.3, 0.3, 0.19, 0.08, 0.08, 0.19, 0.3]
    )
    np.testing.assert_allclose(adhesion.right([310.0, 340.0, 900.0]), [0.3, 0.1, 0.3])
    places, left, right = adhesion.points()
    assert places.tolist() == [90.0, 100.0, 300.0, 310.0, 320.0, 350.0, 360.0]
    s = np.linspace(0.0, 500.0, 1001)
    np.testing.assert_allclose(np.interp(s, places, left), adhesion.left(s), atol=1e-15)
    np.testing.assert_allclose(np.interp(s, places, right), adhesion.right(s), atol=1e-15)
    np.testing.assert_array_equal(adhesion.mirrored().left(s), adhesion.right(s))


@pytest.mark.parametrize(
    ("patches", "said"),
    [
        ([(0.0, 10.0, 0.0)], "no coefficient of friction"),
        ([(10.0, 0.0, 0.1)], "before the start"),
        ([(0.0, 10.0)], "is no patch"),
        ([(0.0, 10.0, 0.1, "middle")], "not known"),
        ([(0.0, 10.0, 0.1), (15.0, 20.0, 0.1, "left")], "another patch of the left rail"),
    ],
)
def test_bad_adhesion_is_refused(patches: list[tuple[float, ...]], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Adhesion(patches=patches)


def test_mistakes_in_a_database() -> None:
    track = curve()
    s = np.linspace(0.0, track.length, 701)
    more = track.mistaken(curvature_scale=1.1)
    np.testing.assert_allclose(more.curvature(s), 1.1 * track.curvature(s))
    np.testing.assert_array_equal(more.cant(s), track.cant(s))
    missing = track.mistaken(curvature_scale=0, cant_scale=0, only=1)
    assert not missing.curvature(s).any()
    assert not missing.cant(s).any()
    assert track.mistaken(curvature_scale=-1, cant_scale=-1) == track.mirrored()
    assert track.mistaken() == track


@given(st.floats(min_value=-600.0, max_value=600.0))
def test_a_shifted_track_has_everything_so_much_farther_along(by: float) -> None:
    track = curve(straight_before="40 m", straight_after="200 m")
    moved = track.mistaken(shift=by)
    assert moved.length == pytest.approx(track.length)
    s = np.linspace(0.0, min(track.length, moved.length), 200)
    for name in ("curvature", "cant", "grade"):
        expected = getattr(track, name)(np.clip(s - by, 0.0, track.length))
        np.testing.assert_allclose(getattr(moved, name)(s), expected, atol=1e-9)


def test_one_of_several_curves_is_wrong() -> None:
    first, second = curve(), curve(radius="400 m", hand="left")
    track = Track(first.segments + second.segments)
    wrong = track.mistaken(curvature_scale=0.5, only=2)
    s = np.linspace(0.0, track.length, 500)
    factor = np.where(s < first.length, 1.0, 0.5)
    np.testing.assert_allclose(wrong.curvature(s), factor * track.curvature(s))
    with pytest.raises(InputError, match="give 1 to 2"):
        track.mistaken(curvature_scale=0.5, only=3)
    with pytest.raises(InputError, match="straight"):
        Track.straight(100).mistaken(only=1)
    with pytest.raises(InputError, match="beyond"):
        track.mistaken(shift="10 km")


def test_curves_that_meet_where_there_is_no_curvature_are_two() -> None:
    segments = [
        Segment(100.0, (0.0, 1e-3)),
        Segment(100.0, (1e-3, 0.0)),
        Segment(100.0, (0.0, -1e-3)),
        Segment(100.0, (-1e-3, 0.0)),
    ]
    wrong = Track(tuple(segments)).mistaken(curvature_scale=0, only=2)
    np.testing.assert_allclose(wrong.curvature([100.0, 300.0]), [1e-3, 0.0])
