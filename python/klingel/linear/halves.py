"""Left and right halves of a model: states as sums and differences of left and right, and which of them meet.
On straight track what is symmetric and what is antisymmetric do not: two problems of half the order each."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Places = NDArray[np.intp]

Number = TypeVar("Number", np.float64, np.complex128)

MEETS = 1e-10
"""Entries of the balanced matrix below this share of its largest one are rounding: its parts do not meet there."""

SIDE = re.compile(r"(?<![a-z])(left|right)(?![a-z])")


@dataclass(frozen=True)
class Halves:
    """Folds states into (left + right)/sqrt 2 and (left - right)/sqrt 2; folded back, they are what they were.

    left, right: places of the states that differ in the side alone; the sum takes the place of the left one, the
    difference that of the right one.

    >>> halves = Halves.of(["left.z", "body.z", "right.z"])
    >>> halves.folded(np.array([[5.0, 1.0, 2.0], [1.0, 7.0, 1.0], [2.0, 1.0, 5.0]])).round(3)
    array([[7.   , 1.414, 0.   ],
           [1.414, 7.   , 0.   ],
           [0.   , 0.   , 3.   ]])
    """

    left: Places
    right: Places

    @classmethod
    def of(cls, names: Sequence[str]) -> Halves:
        """Of states with these names."""
        places = {name: i for i, name in enumerate(names)}
        both = [(i, places.get(SIDE.sub("right", name), i)) for name, i in places.items() if "left" in name]
        left, right = np.array([(i, j) for i, j in both if i != j], dtype=np.intp).reshape(-1, 2).T
        return cls(left, right)

    def folded(self, A: Matrix) -> Matrix:
        """The matrix A (n x n) of a model, folded, or a folded one as that of the model."""
        folded = A.copy()
        self.fold(folded)
        self.fold(folded.T)
        return folded

    def fold(self, rows: NDArray[Number]) -> None:
        """Folds rows (n x m) in place, such as the matrix B of a model or eigenvectors, or folds them back."""
        left, right = rows[self.left], rows[self.right]
        rows[self.left] = (left + right) * np.sqrt(0.5)
        rows[self.right] = (left - right) * np.sqrt(0.5)


class Part(NamedTuple):
    """States that meet no others: their places, their balanced matrix, the scale of its states in the given ones."""

    at: Places
    matrix: Matrix
    scale: Matrix


def parts(A: Matrix) -> list[Part]:
    """The parts of a matrix that do not meet."""
    scaled, (scales, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    balanced, scale = np.asarray(scaled, dtype=np.float64), np.asarray(scales, dtype=np.float64)
    size = np.abs(balanced)
    meets = size > MEETS * size.max(initial=0.0)
    return [Part(at, balanced[np.ix_(at, at)], scale[at]) for at in _connected(meets | meets.T)]


def _connected(meets: NDArray[np.bool_]) -> Iterator[Places]:
    """Places that meet each other directly or through others, group by group."""
    left = np.ones(len(meets), dtype=bool)
    while left.any():
        group = np.zeros(len(meets), dtype=bool)
        group[left.argmax()] = True
        new = group
        while new.any():
            new = meets[new].any(axis=0) & ~group
            group = group | new
        left &= ~group
        yield np.flatnonzero(group)
