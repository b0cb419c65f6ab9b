"""Discrete filters and responses of block diagrams against closed forms; whether a diagram is what the core accepts.
The laws of the blocks are tested beside the core."""

from __future__ import annotations

import numpy as np
import pytest

from klingel.control.diagram import Diagram
from klingel.control.discrete import bilinear, lead, low_pass, notch, slope_low_pass, transfer_function
from klingel.control.response import controller_response
from klingel.errors import InputError

TS = 1e-3
SLOW = 2.0 * np.pi * np.array([0.1, 1.0, 5.0])


def test_low_pass_has_unit_gain_at_rest_and_its_corner_where_it_is_designed() -> None:
    section = low_pass(4.0, sample_time=TS)
    corner = section.response(np.array([2.0 * np.pi * 4.0]), TS)[0]
    assert sum(section.b) / (1.0 + sum(section.a)) == pytest.approx(1.0)
    assert corner == pytest.approx(1.0 / (2.0 * 0.7 * 1j), rel=1e-9)


def test_slope_low_pass_differentiates_the_low_pass() -> None:
    ratio = slope_low_pass(4.0, sample_time=TS).response(SLOW, TS) / low_pass(4.0, sample_time=TS).response(SLOW, TS)
    np.testing.assert_allclose(ratio, 1j * SLOW, rtol=1e-3)


def test_notch_and_lead() -> None:
    section = notch(55.0, depth=0.1, width=0.5, sample_time=TS)
    assert abs(section.response(np.array([2.0 * np.pi * 55.0]), TS)[0]) == pytest.approx(0.1, rel=1e-9)
    shape = lead(0.02, 0.002, sample_time=TS).response(SLOW, TS)
    np.testing.assert_allclose(shape, (1.0 + 0.02j * SLOW) / (1.0 + 0.002j * SLOW), rtol=1e-3)


def test_bilinear_of_a_gain_is_the_gain() -> None:
    section = bilinear((3.0, 0.0, 0.0), (1.0, 0.0, 0.0), sample_time=TS)
    np.testing.assert_allclose(section.response(SLOW, TS), 3.0)


@pytest.mark.parametrize(
    ("numerator", "denominator"),
    [
        ([3.0], [2.0]),
        ([1.0, 2.0], [0.1, 1.0]),
        ([1.0, 0.0], [1e-4, 0.02, 0.3, 1.0]),
        ([2.0], [1e-6, 3e-4, 0.02, 0.2, 1.0]),
    ],
)
def test_a_transfer_function_of_any_order_is_a_chain_of_sections(
    numerator: list[float], denominator: list[float]
) -> None:
    chain = transfer_function(numerator, denominator, sample_time=TS)
    response = np.prod([section.response(SLOW, TS) for section in chain], axis=0)
    # the bilinear rule is exact at the frequency that it takes for another one
    s = 2j / TS * np.tan(0.5 * SLOW * TS)
    np.testing.assert_allclose(response, np.polyval(numerator, s) / np.polyval(denominator, s), rtol=1e-9)


@pytest.mark.parametrize(
    ("numerator", "denominator", "word"),
    [([1.0], [1.0, 0.0], "pole at s = 0"), ([1.0, 0.0], [2.0], "lower order"), ([0.0], [1.0], "is nil")],
)
def test_bad_transfer_functions_are_refused(numerator: list[float], denominator: list[float], word: str) -> None:
    with pytest.raises(InputError, match=word):
        transfer_function(numerator, denominator, sample_time=TS)


def test_response_of_a_scheduled_pi_with_delay() -> None:
    d = Diagram(sample_time=TS)
    speed, error = d.measure("speed"), d.measure("error")
    gain = d.lookup("gain", speed, [10.0, 20.0], [4.0, 2.0])
    integral = d.sum("integral", {gain: 2.0})
    out = d.pi("out", error, proportional=gain, integral=integral, limit=100.0)
    d.command("plant", d.delay("sent", out, 2))
    response = controller_response(d.spec(), {"speed": 15.0}, SLOW)
    assert response.shape == (3, 1, 2)
    expected = 3.0 * (1.0 + 2.0 / (1j * SLOW)) * np.exp(-2j * SLOW * TS)
    np.testing.assert_allclose(response[:, 0, 1], expected, rtol=1e-4)
    np.testing.assert_allclose(response[:, 0, 0], 0.0, atol=1e-12)


def test_response_linearises_products_and_quotients_about_the_operating_point() -> None:
    d = Diagram(sample_time=TS)
    x, y = d.measure("x"), d.measure("y")
    d.command("product", d.product("xxy", x, x, y))
    d.command("quotient", d.quotient("x/y", x, y, floor=0.1))
    response = controller_response(d.spec(), {"x": 3.0, "y": 2.0}, SLOW)[0]
    np.testing.assert_allclose(response.real, [[12.0, 9.0], [0.5, -0.75]])


def test_a_number_of_samples_of_zero_needs_no_block() -> None:
    d = Diagram(sample_time=TS)
    assert d.delay("none", d.measure("x"), 0) == "x"
    assert d.spec()["blocks"] == []


def test_rounding_and_noise_are_nil_in_a_response_and_a_hold_is_its_mean() -> None:
    d = Diagram(sample_time=TS)
    rounded = d.quantise("rounded", d.measure("x"), 0.5)
    noisy = d.sum("noisy", {rounded: 2.0, d.noise("noise", 0.1, 3): 1.0})
    d.command("plant", d.hold("held", noisy, 20))
    response = controller_response(d.spec(), {}, SLOW)[:, 0, 0]
    # a mean over 20 samples lags by half of the 19 intervals between them
    width = 0.5 * SLOW * TS
    expected = 2.0 * np.sin(20.0 * width) / (20.0 * np.sin(width)) * np.exp(-19j * width)
    np.testing.assert_allclose(response, expected, rtol=1e-12)


def test_a_state_space_of_two_outputs_responds_as_its_matrices_say() -> None:
    d = Diagram(sample_time=TS)
    inputs = [d.sum("twice", {d.measure("x"): 2.0}), d.measure("y")]
    lag, direct = d.state_space(
        "both", inputs, ["lag", "direct"], [[0.9]], [[0.1, 0.0]], [[1.0], [0.0]], [[0.0, 0.0], [0.0, 3.0]]
    )
    d.command("lag", lag)
    d.command("product", d.product("product", lag, direct))
    response = controller_response(d.spec(), {"x": 1.0, "y": 5.0}, SLOW)
    expected = 0.2 / (np.exp(1j * SLOW * TS) - 0.9)
    np.testing.assert_allclose(response[:, 0, 0], expected, rtol=1e-12)
    np.testing.assert_allclose(response[:, 1, 0], 15.0 * expected, rtol=1e-12)
    np.testing.assert_allclose(response[:, 1, 1], 6.0, rtol=1e-12)


def test_a_state_space_without_states_is_its_matrix() -> None:
    d = Diagram(sample_time=TS)
    (out,) = d.state_space("gains", [d.measure("x"), d.measure("y")], ["out"], [], [], [[]], [[2.0, -1.0]])
    d.command("plant", out)
    np.testing.assert_allclose(controller_response(d.spec(), {}, SLOW)[:, 0], np.tile([2.0, -1.0], (3, 1)))
