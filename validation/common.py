"""What a validation case is made of: rows of measured against reference, each with its tolerance.
A case is a package `validation/<name>` with a module `case`: TITLE, ABOUT, run() and, if there is one, figure();
LONG = True keeps it out of the tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Row:
    """One quantity against its reference.

    quantity: in words, with the conditions; reference: what it is measured against, in words or as a number;
    measured: the number, in `unit`; tolerance: the most it may be; unit: of both; passed: whether it is within;
    asked: false for a figure that is shown beside the ones that were asked for.
    """

    quantity: str
    reference: str
    measured: float
    tolerance: float
    unit: str
    passed: bool
    asked: bool = True

    @classmethod
    def at_most(cls, quantity: str, reference: str, measured: float, tolerance: float, unit: str = "") -> Row:
        """A deviation that passes when it is at most its tolerance."""
        return cls(quantity, reference, float(measured), tolerance, unit, bool(measured <= tolerance))

    @classmethod
    def shown(cls, quantity: str, reference: str, measured: float, unit: str = "") -> Row:
        """A figure that is shown without a limit."""
        return cls(quantity, reference, float(measured), float("nan"), unit, True, asked=False)


class Case(Protocol):
    """The module of a case; `figure` may be missing."""

    TITLE: str
    ABOUT: str
    """What is compared, where the reference comes from and why the tolerances are what they are."""

    def run(self) -> Sequence[Row]:
        """Every row, in the order of the page."""
        ...

    def figure(self) -> Figure:
        """One picture of the comparison."""
        ...
