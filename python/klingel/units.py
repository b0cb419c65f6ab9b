"""Units at the border: strings carry units, plain numbers are SI; past this module everything is SI.
Also the pydantic types of physical quantities that data files are made of."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from klingel.errors import InputError

if TYPE_CHECKING:
    import pint

Quantity = str | float | int
"""What a caller may give for a physical quantity: `"31.4 MN/m"`, or a number in SI."""


@dataclass(frozen=True)
class Unit:
    """SI unit that a field is kept in; annotation of the types below."""

    name: str


@functools.cache
def registry() -> pint.UnitRegistry[Any]:
    """The one pint registry, made on first use (it takes a tenth of a second)."""
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=False)


def to_si(value: Quantity, unit: str, *, key: str) -> float:
    """`value` in `unit` (an SI unit), as a float.

    value: string with a unit, or a number already in `unit`; key: name used in the message of the error.
    Errors: InputError for another dimension, a string without unit, text that is no quantity, NaN or infinity.

    >>> to_si("108 km/h", "m/s", key="speed")
    30.0
    >>> to_si(0.16, "m", key="cant")
    0.16
    >>> to_si("3 kg", "m", key="cant")
    Traceback (most recent call last):
    ...
    klingel.errors.InputError: cant = '3 kg': is a mass [kg], wanted m; give for example '1 m'
    """
    try:
        return _convert(value, unit)
    except _RefusedError as refused:
        raise InputError.single(key, value, refused.message, remedy=refused.remedy) from None


class _RefusedError(Exception):
    """Why a value is no quantity of the wanted unit."""

    def __init__(self, message: str, remedy: str) -> None:
        super().__init__(message)
        self.message = message
        self.remedy = remedy


def _convert(value: object, unit: str) -> float:
    example = f"give for example '1 {unit}'" if unit != "1" else "give a plain number"
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        raise _RefusedError(f"is no quantity [{unit}]", example)
    number = _parse(value, unit, example) if isinstance(value, str) else float(value)
    if not math.isfinite(number):
        raise _RefusedError("is not finite", example)
    return number


@functools.lru_cache(maxsize=4096)
def _parse(text: str, unit: str, example: str) -> float:
    ureg = registry()
    try:
        quantity: pint.Quantity[Any] = ureg.Quantity(text)
        float(quantity.magnitude)
    except Exception:  # pint raises half a dozen unrelated types, tokenizer and attribute errors among them
        raise _RefusedError(f"cannot be read as a quantity [{unit}]", example) from None
    if quantity.unitless and unit != "1":
        raise _RefusedError(f"has no unit, wanted {unit}", example)
    wanted = "" if unit == "1" else unit
    if not quantity.is_compatible_with(wanted):
        raise _RefusedError(f"is {_dimension(quantity)}, wanted {unit if wanted else 'a pure number'}", example)
    return _as_typed(float(quantity.to(wanted).magnitude))


def _as_typed(number: float) -> float:
    """The short decimal next to `number`, if it is but a rounding away: 160 mm is 0.16 m, not 0.16000000000000003."""
    short = float(f"{number:.12g}")
    return short if abs(short - number) <= 2.0 * math.ulp(number) else number


def _dimension(quantity: pint.Quantity[Any]) -> str:
    names = {
        "[mass]": "a mass",
        "[length]": "a length",
        "[time]": "a time",
        "[mass] * [length] / [time] ** 2": "a force",
    }
    unit = f"{quantity.units:~}" or "1"
    name = names.get(str(quantity.dimensionality))
    return f"{name} [{unit}]" if name else f"in {unit}"


def _reader(unit: str) -> BeforeValidator:
    def read(value: object) -> float:
        try:
            return _convert(value, unit)
        except _RefusedError as refused:
            raise PydanticCustomError(
                "quantity", "{message}", {"message": refused.message, "remedy": refused.remedy}
            ) from None

    return BeforeValidator(read)


# A quantity of either sign, one that is not negative, and one that is positive; the unit follows the name.
Length = Annotated[float, _reader("m"), Unit("m")]
PositiveLength = Annotated[float, Field(gt=0.0), _reader("m"), Unit("m")]
Curvature = Annotated[float, _reader("1/m"), Unit("1/m")]
PositiveSpeed = Annotated[float, Field(gt=0.0), _reader("m/s"), Unit("m/s")]
PositiveTime = Annotated[float, Field(gt=0.0), _reader("s"), Unit("s")]
PositiveMass = Annotated[float, Field(gt=0.0), _reader("kg"), Unit("kg")]
PositiveInertia = Annotated[float, Field(gt=0.0), _reader("kg m^2"), Unit("kg m^2")]
PositiveForce = Annotated[float, Field(gt=0.0), _reader("N"), Unit("N")]
Force = Annotated[float, _reader("N"), Unit("N")]
NotNegativeForce = Annotated[float, Field(ge=0.0), _reader("N"), Unit("N")]
LinearResistance = Annotated[float, Field(ge=0.0), _reader("N s/m"), Unit("N s/m")]
QuadraticResistance = Annotated[float, Field(ge=0.0), _reader("N s^2/m^2"), Unit("N s^2/m^2")]
ForceRate = Annotated[float, Field(gt=0.0), _reader("N/s"), Unit("N/s")]
Stiffness = Annotated[float, Field(ge=0.0), _reader("N/m"), Unit("N/m")]
PositiveStiffness = Annotated[float, Field(gt=0.0), _reader("N/m"), Unit("N/m")]
Damping = Annotated[float, Field(ge=0.0), _reader("N s/m"), Unit("N s/m")]
PositiveDamping = Annotated[float, Field(gt=0.0), _reader("N s/m"), Unit("N s/m")]
AngularStiffness = Annotated[float, Field(ge=0.0), _reader("N m/rad"), Unit("N m/rad")]
PositiveAngularStiffness = Annotated[float, Field(gt=0.0), _reader("N m/rad"), Unit("N m/rad")]
AngularDamping = Annotated[float, Field(ge=0.0), _reader("N m s/rad"), Unit("N m s/rad")]
Frequency = Annotated[float, Field(gt=0.0), _reader("Hz"), Unit("Hz")]
Voltage = Annotated[float, Field(gt=0.0), _reader("V"), Unit("V")]
Current = Annotated[float, Field(gt=0.0), _reader("A"), Unit("A")]
Resistance = Annotated[float, Field(gt=0.0), _reader("ohm"), Unit("ohm")]
Inductance = Annotated[float, Field(gt=0.0), _reader("H"), Unit("H")]
EmfConstant = Annotated[float, Field(gt=0.0), _reader("V s/rad/A"), Unit("V s/rad/A")]
Flux = Annotated[float, Field(gt=0.0), _reader("V s"), Unit("V s")]
Rate = Annotated[float, Field(gt=0.0), _reader("1/s"), Unit("1/s")]
Number = Annotated[float, _reader("1"), Unit("1")]
PositiveNumber = Annotated[float, Field(gt=0.0), _reader("1"), Unit("1")]
Ratio = Annotated[float, Field(ge=0.0, le=1.0), _reader("1"), Unit("1")]
PositiveArea = Annotated[float, Field(gt=0.0), _reader("m^2"), Unit("m^2")]
