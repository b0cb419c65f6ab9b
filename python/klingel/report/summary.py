"""The study's summary table as questions of the report: one value, or one quantity over all curves.
Missing runs answer NaN, so that a report of an interrupted study can still be written."""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

ACTIVE = ("solid_like", "irw_like")
SEVERAL = 3
"""So many curves at least make a statement about every curve."""

SHORT = {"passive": "passive", "solid_like": "S", "irw_like": "I"}


@dataclass(frozen=True)
class Summary:
    """Reads the summary table.

    Attributes:
        table: one row a run, columns of `klingel.assess.COLUMNS`.
    """

    table: pd.DataFrame

    @cached_property
    def _rows(self) -> dict[tuple[str, float], dict[Hashable, Any]]:
        return {(row["vehicle"], float(row["radius_m"])): row for row in self.table.to_dict("records")}

    @property
    def radii(self) -> list[float]:
        """Radii of the curves, sharpest first [m]."""
        return sorted(float(radius) for radius in self.table["radius_m"].unique())

    def value(self, vehicle: str, radius: float, column: str) -> float:
        """One figure of one run, NaN if that run is missing."""
        row = self._rows.get((vehicle, radius))
        return math.nan if row is None else float(row[column])

    def text(self, vehicle: str, radius: float, column: str) -> str:
        """One word of one run, empty if that run is missing."""
        row = self._rows.get((vehicle, radius))
        return "" if row is None else str(row[column])

    def made(self, vehicle: str, radius: float) -> bool:
        """Whether a run is in the table."""
        return (vehicle, radius) in self._rows

    def contact(self, vehicle: str, radius: float) -> str:
        """`root`, `flange` or `none`, and a dash if that run is missing."""
        return (self.text(vehicle, radius, "flange_contact") or "none") if self.made(vehicle, radius) else "–"

    @property
    def several(self) -> bool:
        """Whether there are curves enough for a statement about every curve."""
        return len(self.radii) >= SEVERAL

    def over_radii(self, vehicle: str, column: str) -> np.ndarray:
        """One figure of one vehicle in every curve, sharpest first."""
        return np.array([self.value(vehicle, radius, column) for radius in self.radii])

    def ratio(self, column: str, vehicle: str, to: str) -> np.ndarray:
        """One figure of one vehicle over that of another, in every curve."""
        return np.asarray(self.over_radii(vehicle, column) / self.over_radii(to, column))

    def list(self, vehicle: str, column: str, digits: int) -> str:
        """One figure of one vehicle in every curve, as `6.3 / 6.2 / ...`."""
        return joined(self.over_radii(vehicle, column), digits)


def joined(numbers: np.ndarray, digits: int) -> str:
    """Numbers between slashes; a dash where there is none.

    Example:
        >>> joined(np.array([1.25, np.nan]), 1)
        '1.2 / –'
    """
    return " / ".join("–" if math.isnan(number) else f"{number:.{digits}f}" for number in numbers)
