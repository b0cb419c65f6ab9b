"""Units at the border: strings carry units, plain numbers are SI, wrong dimensions are refused with key and remedy."""

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from klingel.errors import InputError, nearest
from klingel.units import to_si


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("108 km/h", "m/s", 30.0),
        ("31.391 MN/m", "N/m", 31.391e6),
        ("1435 mm", "m", 1.435),
        ("10.5 kN m/rad", "N m/rad", 10.5e3),
        ("0.4646 V s/(rad A)", "V s/rad/A", 0.4646),
        ("32 t", "kg", 32e3),
        ("30 %", "1", 0.3),
        ("200 kN/s", "N/s", 2e5),
        ("4 kN s/m", "N s/m", 4e3),
    ],
)
def test_strings_carry_units(text: str, unit: str, value: float) -> None:
    assert to_si(text, unit, key="x") == value


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        ("3 kg", "m", "is a mass"),
        ("12", "m", "has no unit"),
        ("", "m", "cannot be read"),
        ("twelve m", "m", "cannot be read"),
        ("1/0 m", "m", "cannot be read"),
        ("5 m", "1", "wanted a pure number"),
        (math.nan, "m", "is not finite"),
        ("inf m", "m", "is not finite"),
        (True, "m", "is no quantity"),
        (None, "m", "is no quantity"),
    ],
)
def test_refusals_name_key_value_and_remedy(value: object, unit: str, said: str) -> None:
    with pytest.raises(InputError) as refused:
        to_si(value, unit, key="cant")  # type: ignore[arg-type]
    (problem,) = refused.value.problems
    assert problem.key == "cant"
    assert said in str(refused.value)
    assert problem.remedy


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_plain_numbers_are_si(value: float) -> None:
    assert to_si(value, "N/m", key="k") == value


@given(st.floats(min_value=1e-6, max_value=1e9))
def test_a_unit_scales_and_keeps_fifteen_digits(value: float) -> None:
    assert to_si(f"{value!r} mm", "m", key="x") == pytest.approx(value * 1e-3, rel=1e-14)


@given(st.text(max_size=20))
def test_any_text_is_a_quantity_or_an_input_error(text: str) -> None:
    with suppress(InputError):
        assert math.isfinite(to_si(text, "m", key="x"))


def test_nearest_word() -> None:
    assert nearest("stifness", ["stiffness", "damping"]) == "did you mean 'stiffness'?"
