"""Eigenvalues of a vehicle's model, fast and clean: the free arc length taken out, left and right halves apart.
On straight track what is symmetric and what is antisymmetric do not meet: two problems of half the order each."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
import scipy.linalg
import scipy.sparse
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from klingel.linear.model import LinearModel

Matrix = NDArray[np.float64]
Complex = NDArray[np.complex128]

Number = TypeVar("Number", np.float64, np.complex128)

GONE = 1e-3
"""Sampled eigenvalues below this magnitude are memory of delays, gone within a few samples."""

MEETS = 1e-10
"""Entries of the balanced matrix below this share of its largest one are rounding: its parts do not meet there."""

SIDE = re.compile(r"(?<![a-z])(left|right)(?![a-z])")


class Eigen(NamedTuple):
    """Eigenvalues s [1/s] (for a sampled model ln(z)/T, -inf for z = 0), left and right eigenvectors as columns.

    The free position along the track is not among them.
    """

    values: Complex
    left: Complex
    right: Complex


def eigen(model: LinearModel, *, left: bool = True) -> Eigen:
    """Eigenvalues and eigenvectors of a model, in no order.

    Right vectors have unit length in balanced states, left ones are their inverse: left^H right = 1; without `left`
    there are none of those (no columns), which saves a third of the time.
    """
    reduced = _Reduced.of(model)
    parts = [_part(block, left) for block in reduced.blocks()]
    values = np.concatenate([p.values for p in parts])
    back, right = (np.zeros((reduced.A.shape[0], len(values)), dtype=complex) for _ in range(2))
    column = 0
    for p in parts:
        columns = slice(column, column + len(p.values))
        right[p.at, columns] = p.right
        if left:
            back[p.at, columns] = p.left
        column += len(p.values)
    lefts = reduced.whole_left(back) if left else np.zeros((len(model.states), 0), dtype=complex)
    return Eigen(continuous(values, model.sample_time), lefts, reduced.whole_right(right, values))


def eigenvalues(model: LinearModel) -> Complex:
    """The eigenvalues alone, in a third of the time."""
    reduced = _Reduced.of(model)
    values = np.concatenate([np.linalg.eigvals(block.matrix) for block in reduced.blocks()])
    return continuous(values, model.sample_time)


def lives(values: Complex, sample_time: float | None) -> NDArray[np.bool_]:
    """Which eigenvalues s [1/s] are of the vehicle, not of the bare memory of the controllers of a sampled model.

    Memory is z = 0, gone after a sample or a few (|z| < 0.001), and z = -1 to rounding, which a bilinear filter has
    where its pole at infinity was and which no feedback has moved.
    """
    if sample_time is None:
        return np.isfinite(values)
    finite = np.isfinite(values)
    z = np.zeros(values.shape, dtype=np.complex128)
    z[finite] = np.exp(values[finite] * sample_time)
    return np.asarray((np.abs(z) >= GONE) & (np.abs(z + 1.0) > GONE**2))


def continuous(values: Complex, sample_time: float | None) -> Complex:
    """Eigenvalues of a sampled model as those of a continuous one, s = ln(z)/T; unchanged for a continuous model.

    >>> continuous(np.array([1.0, np.exp(-0.1)]), 0.1).round(12)
    array([ 0.+0.j, -1.+0.j])
    """
    values = np.asarray(values, dtype=np.complex128)
    if sample_time is None:
        return values
    s = np.full(values.shape, -np.inf, dtype=np.complex128)
    remembered = values != 0.0
    s[remembered] = np.log(values[remembered]) / sample_time
    return s


class _Block(NamedTuple):
    """States that meet no others; scale: of the balanced ones in the states' own."""

    at: NDArray[np.intp]
    matrix: Matrix
    scale: Matrix


class _Part(NamedTuple):
    at: NDArray[np.intp]
    values: Complex
    left: Complex
    right: Complex


@dataclass(frozen=True)
class _Reduced:
    """A on sums and differences of left and right states, without the arc length of the first body.

    `pairs`: places of left and right states; `along`: of all arc lengths; `first`: the row of A that the first of
    these had, which was dropped; `free`: its eigenvalue in A.
    """

    A: Matrix
    pairs: tuple[list[int], list[int]]
    along: tuple[int, ...]
    first: Matrix
    free: float

    @classmethod
    def of(cls, model: LinearModel) -> _Reduced:
        names = [state.name for state in model.states]
        along = tuple(i for i, name in enumerate(names) if name.endswith(".s"))
        free = 0.0 if model.sample_time is None else 1.0
        A, first = model.A, np.zeros(len(names))
        if not _slides(A, along, free):
            along = ()
        if along:
            first = A[along[0]]
            A = A.copy()
            A[list(along)] -= first
            keep = [i for i in range(len(names)) if i != along[0]]
            A, names = A[np.ix_(keep, keep)], [names[i] for i in keep]
        pairs = _pairs(names)
        return cls(_folded(_folded(A, pairs).T, pairs).T, pairs, along, first, free)

    def blocks(self) -> Iterator[_Block]:
        balanced, (scale, _) = scipy.linalg.matrix_balance(self.A, permute=False, separate=True)
        meets = np.abs(balanced) > MEETS * np.abs(balanced).max()
        count, label = connected_components(scipy.sparse.csr_array(meets), directed=False)
        for k in range(count):
            at = np.flatnonzero(label == k)
            yield _Block(
                at, np.asarray(balanced[np.ix_(at, at)], dtype=np.float64), np.asarray(scale[at], dtype=np.float64)
            )

    def whole_left(self, left: Complex) -> Complex:
        """Left vectors over the model's states: those of the dropped arc length take what is subtracted from others."""
        own = _folded(left, self.pairs)
        if not self.along:
            return np.asarray(own)
        whole = np.insert(own, self.along[0], 0.0, axis=0)
        whole[self.along[0]] = -whole[list(self.along)].sum(axis=0)
        return np.asarray(whole)

    def whole_right(self, right: Complex, values: Complex) -> Complex:
        """Right vectors over the model's states: the dropped arc length follows from its own equation."""
        own = _folded(right, self.pairs)
        if not self.along:
            return np.asarray(own)
        whole = np.insert(own, self.along[0], 0.0, axis=0)
        whole[list(self.along)] += (self.first @ whole) / (values - self.free)
        return np.asarray(whole)


def _part(block: _Block, left: bool) -> _Part:
    values, vectors = np.linalg.eig(block.matrix)
    values, vectors = values.astype(np.complex128), vectors.astype(np.complex128)
    inverse = _inverse(vectors) if left else np.zeros((0, len(values)), dtype=np.complex128)
    scale = block.scale[:, None]
    return _Part(
        block.at, values, np.asarray(inverse.conj().T / scale), np.asarray(vectors * scale, dtype=np.complex128)
    )


def _inverse(vectors: Complex) -> Complex:
    """Of the matrix of eigenvectors; the least-squares one where delays make it singular."""
    try:
        return np.asarray(np.linalg.inv(vectors))
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.pinv(vectors))


def _slides(A: Matrix, along: Sequence[int], free: float) -> bool:
    """Whether all bodies can move along the track together at no cost."""
    if not along:
        return False
    moved = A[:, list(along)].sum(axis=1)
    moved[list(along)] -= free
    return bool(np.abs(moved).max() <= 1e-9 * max(np.abs(A[:, list(along)]).max(), 1.0))


def _pairs(names: Sequence[str]) -> tuple[list[int], list[int]]:
    """Places of left states and of the right ones that differ from them in the side alone."""
    places = {name: i for i, name in enumerate(names)}
    both = [(i, places.get(SIDE.sub("right", name), i)) for name, i in places.items() if "left" in name]
    return [i for i, j in both if i != j], [j for i, j in both if i != j]


def _folded(rows: NDArray[Number], pairs: tuple[list[int], list[int]]) -> NDArray[Number]:
    """(left + right)/sqrt 2 and (left - right)/sqrt 2 in the rows of both; done twice it changes nothing."""
    left, right = pairs
    folded = rows.copy()
    folded[left] = (rows[left] + rows[right]) * np.sqrt(0.5)
    folded[right] = (rows[left] - rows[right]) * np.sqrt(0.5)
    return folded
