"""What the readers of profiles share: points, what a file says of them, and numbers in text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from klingel.contact.checks import Kind
from klingel.errors import InputError

Values = NDArray[np.float64]


class Points(NamedTuple):
    """Coordinates [m], y rising."""

    y: Values
    z: Values


@dataclass(frozen=True, eq=False)
class Drawn:
    """What a file draws.

    y, z: [m], in the file's order and axes; kind: what the file says it is, None if nothing; sided: whether its format
    says where the field side is; outline: whether it may go on over upright ends, which are then cut; origins: places
    of a wheel's tape circle [m] that the format knows, of which the content tells the right one.
    """

    y: Values
    z: Values
    kind: Kind | None
    sided: bool
    outline: bool
    origins: tuple[float, ...] = (0.0,)


def number(row: Sequence[str], index: int) -> tuple[float, float]:
    """The two numbers that begin a row; errors: InputError with the point's place."""
    try:
        return float(row[0]), float(row[1])
    except (ValueError, IndexError):
        remedy = "give two numbers in a row"
        raise InputError.single(f"point {index}", ",".join(row), "is no point", remedy=remedy) from None
