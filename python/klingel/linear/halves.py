"""Left and right halves of a model: states as sums and differences of left and right, and which of them meet.
On straight track what is symmetric and what is antisymmetric do not: two problems of half the order each."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
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

    The sum takes the place of the left state, the difference that of the right one.
    kept: places of the states but those left out; left, right: places of the pairs among the kept; states: how many
    there are in all.

    >>> halves = Halves.of(["left.z", "body.z", "right.z"])
    >>> halves.folded(np.array([[5.0, 1.0, 2.0], [1.0, 7.0, 1.0], [2.0, 1.0, 5.0]])).round(3)
    array([[7.   , 1.414, 0.   ],
           [1.414, 7.   , 0.   ],
           [0.   , 0.   , 3.   ]])
    """

    kept: Places
    left: Places
    right: Places
    states: int

    @classmethod
    def of(cls, names: Sequence[str], *, without: Collection[int] = ()) -> Halves:
        """Of states with these names: left and right ones differ in the side alone. `without`: places to leave out."""
        kept = [i for i in range(len(names)) if i not in without]
        places = {names[i]: k for k, i in enumerate(kept)}
        both = [(k, places.get(SIDE.sub("right", name), k)) for name, k in places.items() if "left" in name]
        left, right = np.array([(i, j) for i, j in both if i != j], dtype=np.intp).reshape(-1, 2).T
        return cls(np.array(kept, dtype=np.intp), left, right, len(names))

    def folded(self, A: Matrix) -> Matrix:
        """The matrix A (n x n) of a model, folded."""
        folded = A[np.ix_(self.kept, self.kept)]
        self._turn(folded)
        self._turn(folded.T)
        return folded

    def folded_rows(self, B: Matrix) -> Matrix:
        """The matrix B (n x m) of a model, folded."""
        folded = B[self.kept]
        self._turn(folded)
        return folded

    def unfolded(self, A: Matrix) -> Matrix:
        """A folded matrix (n x n) as that of the model."""
        return self.unfolded_rows(self.unfolded_rows(A).T).T

    def unfolded_rows(self, rows: NDArray[Number]) -> NDArray[Number]:
        """Folded rows (n x m), such as eigenvectors as columns, over the model's states; what was left out is 0."""
        own = rows.copy()
        self._turn(own)
        whole = np.zeros((self.states, rows.shape[1]), dtype=rows.dtype)
        whole[self.kept] = own
        return whole

    def _turn(self, rows: NDArray[Number]) -> None:
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
