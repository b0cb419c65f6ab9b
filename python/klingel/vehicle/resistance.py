"""What a vehicle's file says about its running resistance: a formula and what it needs of the train, or coefficients.
The formulas are in `klingel.drives`."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from klingel.records import Sourced
from klingel.units import (
    LinearResistance,
    NotNegativeForce,
    PositiveArea,
    PositiveLength,
    PositiveNumber,
    QuadraticResistance,
)

Formula = Literal[
    "davis",
    "sncf_general",
    "sauthoff",
    "strahl",
    "tgv",
    "x2000",
    "osrd_high_speed",
    "shinkansen_200",
    "ave_s100",
    "crh2",
    "crh380a",
]

NEEDED: dict[str, tuple[str, ...]] = {
    "davis": ("constant", "linear", "quadratic"),
    "sncf_general": ("stock", "car_length", "front_area", "partial_perimeter"),
    "strahl": ("stock",),
}
"""Keys that a formula cannot do without."""

STOCK: dict[str, tuple[str, ...]] = {
    "sncf_general": ("tgv", "passenger", "freight"),
    "strahl": ("block", "loaded", "empty"),
}
"""Rows of the constants of a formula."""


class RunningResistance(Sourced):
    """What the train that this vehicle runs in feeds into its running-resistance formula.

    formula: name of an empirical formula of `klingel.drives`, or "davis" for R = constant + linear v + quadratic v^2 of
    this vehicle alone; cars: number of such vehicles in the train; stock: row of the formula's constants; front_area,
    partial_perimeter: of the train's cross-section.
    """

    formula: Formula
    stock: Literal["tgv", "passenger", "freight", "block", "loaded", "empty"] | None = None
    cars: PositiveNumber = 1.0
    car_length: PositiveLength | None = None
    front_area: PositiveArea | None = None
    partial_perimeter: PositiveLength | None = None
    constant: NotNegativeForce | None = None
    linear: LinearResistance | None = None
    quadratic: QuadraticResistance | None = None

    def given(self, key: str) -> float:
        """A number that the formula needs, so that it is there."""
        return float(getattr(self, key))

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for key in NEEDED.get(self.formula, ()):
            if getattr(self, key) is None:
                raise _wrong(f"formula {self.formula} needs {key}", f"add {key}")
        rows = STOCK.get(self.formula)
        if rows is not None and self.stock not in rows:
            raise _wrong(f"formula {self.formula} has no stock {self.stock}", f"give one of {', '.join(rows)}")
        return self


def _wrong(message: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("inconsistent", "{message}", {"message": message, "remedy": remedy})
