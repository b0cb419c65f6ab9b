"""Figures of responses: what they show, units, marks that a grey print keeps apart, bytes that repeat."""

import numpy as np
import pandas as pd
import pytest
from tests.linear.masses import chain, on_two_axles

from klingel.linear.measured import Measured
from klingel.linear.random import random_response
from klingel.linear.response import frequency_response
from klingel.plot.response import KIND_LOOKS, LINES, Curve, bode, effects, spectrum
from klingel.plot.style import render
from klingel.track.irregularity import Quality
from klingel.track.spectra import erri_b176

F = np.geomspace(0.1, 40.0, 300)
TWO = chain([1.0, 3.0], [400.0, 300.0], [2.0, 1.0])


def measured() -> Measured:
    f = np.arange(1.0, 30.0, 0.05)
    values = frequency_response(TWO, "u0", ["y0", "y1"], f)
    return Measured("u0", ("y0", "y1"), f, values, np.full(values.shape, 0.9), 1e-3)


def curves() -> list[Curve]:
    return [Curve(name, F, frequency_response(TWO, "u0", name, F)) for name in ("y0", "y1")]


def test_bode_lays_the_measurement_on_the_line() -> None:
    figure = bode(curves()[::-1], title="u0 to y1", unit="m/N", measured=measured(), output="y1")
    size, phase, coherence = figure.axes
    lines = {line.get_label(): line for line in size.lines}
    points = lines["simulated"]
    f, values = np.asarray(points.get_xdata()), np.asarray(points.get_ydata())
    assert 20 < len(f) < 60  # thinned out of 580
    np.testing.assert_allclose(values, np.abs(frequency_response(TWO, "u0", "y1", f)))
    angle = phase.lines[-1]
    drawn = np.interp(np.asarray(angle.get_xdata()), F, np.asarray(phase.lines[0].get_ydata()))
    assert np.abs(np.asarray(angle.get_ydata()) - drawn).max() < 10.0  # the same turn
    assert np.asarray(coherence.lines[0].get_ydata()).max() == 0.9
    assert size.get_ylabel() == "magnitude  [m/N]"
    assert [axis.get_ylabel() for axis in (phase, coherence)] == ["phase  [°]", "coherence  [-]"]


def test_bode_without_measurement_has_two_panels() -> None:
    assert len(bode(curves(), title="two", unit="m/N").axes) == 2


def test_lines_differ_without_colour() -> None:
    assert len({str(line) for _, line in LINES}) == len(LINES)
    assert len({str(line) for _, line in KIND_LOOKS.values()}) == 4


@pytest.mark.parametrize("form", ["svg", "png"])
def test_spectrum_shows_the_sum_and_the_simulation(form: str) -> None:
    model = on_two_axles(mass=4e4, inertia=2e6, stiffness=1e6, damping=4e4, half_base=9.0, speed=40.0)
    quality = erri_b176("low")
    found = random_response(model, Quality(quality.name, {"vertical": quality.spectra["vertical"]}), outputs=["z"])
    beside = np.array([1.0, 2.0]), np.array([1e-6, 1e-7])

    def draw():
        return spectrum(found, "z", simulated=beside)

    (axis,) = draw().axes
    labels = [line.get_label() for line in axis.lines]
    assert labels == ["simulated", "all"]  # one kind alone is the sum
    np.testing.assert_allclose(axis.lines[1].get_ydata(), found.psd[:, 0])
    assert "ORE B176 low, 144 km/h" in axis.get_title(loc="left")
    assert render(draw(), form, name="s") == render(draw(), form, name="s")  # type: ignore[arg-type]


def test_effects_are_ranked_and_signed() -> None:
    table = pd.DataFrame({"parameter": ["a", "b", "c"], "damping_effect": [0.01, -0.5, 0.2]})
    (axis,) = effects(table, "damping_effect", title="damping", unit="-", count=2).axes
    assert [tick.get_text() for tick in axis.get_yticklabels()] == ["b", "c"]
    widths = {round(float(bar.get_width()), 6): str(bar.get_hatch() or "") for bar in axis.patches}
    assert widths == {-5.0: "////", 2.0: ""}
    assert axis.get_xlabel() == "change for a parameter 1 % larger  [10⁻³]"


def test_bode_of_a_list_that_begins_at_0_hz() -> None:
    f = np.append(0.0, F)
    figure = bode([Curve("y0", f, frequency_response(TWO, "u0", "y0", f))], title="one", unit="m/N")
    assert figure.axes[-1].get_xlim() == pytest.approx((F[0], F[-1]))
