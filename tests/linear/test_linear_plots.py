"""Figures of root loci: units that people read, marks that a legend names, every drawn branch with its own name."""

import numpy as np
import pytest

import klingel as kl
from klingel.linear.locus import RootLocus, root_locus
from klingel.plot.linear import locus_figure
from klingel.plot.scale import readable
from klingel.plot.style import render


@pytest.fixture(scope="module")
def locus() -> RootLocus:
    coach = kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("1 km"), speed=40.0)
    return root_locus(coach, "vehicle.yaw_damper.damping", ["100 kN s/m", "200 kN s/m", "400 kN s/m"])


def test_large_numbers_have_their_unit_in_the_label(locus: RootLocus) -> None:
    figure = locus_figure(locus, title="coach")
    render(figure, "svg", name="locus")
    plane, ratio, bar = figure.axes
    assert bar.get_ylabel() == ratio.get_xlabel() == "vehicle.yaw_damper.damping  [kN s/m]"
    assert max(np.asarray(ratio.lines[0].get_xdata())) == pytest.approx(400.0)
    for axis in (plane.xaxis, ratio.xaxis, bar.yaxis):
        assert axis.get_offset_text().get_text() == ""


def test_marks_and_branches_are_named(locus: RootLocus) -> None:
    marks, branches = locus_figure(locus, title="coach").legends
    assert [text.get_text() for text in marks.get_texts()] == ["at 100 kN s/m", "on to 400 kN s/m", "unstable"]
    names = [text.get_text() for text in branches.get_texts()]
    assert len(names) == len(set(names)) == 6


@pytest.mark.parametrize(
    ("unit", "value", "word", "factor"),
    [
        ("N/m", 3.1e7, "MN/m", 1e-6),
        ("kg", 3.2e4, "t", 1e-3),
        ("kg m2", 1.97e6, "10⁶ kg m²", 1e-6),
        ("m", 2e-3, "mm", 1e3),
        ("1", 5e-3, "10⁻³", 1e3),
        ("Hz", 0.0, "Hz", 1.0),
        ("m/s2", 9.81, "m/s²", 1.0),
    ],
)
def test_readable_units(unit: str, value: float, word: str, factor: float) -> None:
    found, per = readable(unit, [-value, 0.5 * value])
    assert (found, per) == (word, pytest.approx(factor))
