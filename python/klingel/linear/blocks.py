"""Eigenvalues of a vehicle's model, fast and clean: the free arc length taken out, left and right halves apart.
Those of a sampled model are given as of a continuous one, and the bare memory of its controllers is told apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from klingel.linear.halves import Halves, Part, parts
from klingel.linear.model import LinearModel

Matrix = NDArray[np.float64]
Complex = NDArray[np.complex128]

GONE = 1e-3
"""Sampled eigenvalues below this magnitude are memory of delays, gone within a few samples."""


class Eigen(NamedTuple):
    """Eigenvalues s [1/s] (for a sampled model ln(z)/T, -inf for z = 0), left and right eigenvectors as columns.

    The free position along the track is not among them.
    """

    values: Complex
    left: Complex
    right: Complex


def eigen(model: LinearModel) -> Eigen:
    """Eigenvalues and eigenvectors of a model, in no order.

    Right vectors have unit length in balanced states, left ones are their inverse: left^H right = 1.
    """
    free = _Free.of(model)
    found = [(part, *_vectors(part)) for part in free.parts]
    values = np.concatenate([values for _, values, _ in found])
    right = free.whole_right([(part, vectors) for part, _, vectors in found], values)
    left = free.whole_left([(part, _inverse(vectors).conj().T) for part, _, vectors in found])
    return Eigen(continuous(values, model.sample_time), left, right)


def live(model: LinearModel) -> tuple[Complex, Complex]:
    """Of the vehicle's own eigenvalues (`lives`) one of each conjugate pair [1/s] (k), and their right vectors (n x k).

    They are what is followed over a parameter; in no order, in half the time of `eigen`.
    """
    free = _Free.of(model)
    found = []
    for part in free.parts:
        values, vectors = _vectors(part)
        upper = lives(continuous(values, model.sample_time), model.sample_time) & (values.imag >= 0.0)
        found.append((part, values[upper], vectors[:, upper]))
    values = np.concatenate([values for _, values, _ in found])
    right = free.whole_right([(part, vectors) for part, _, vectors in found], values)
    return continuous(values, model.sample_time), right


def eigenvalues(model: LinearModel) -> Complex:
    """The eigenvalues alone, in a third of the time of `eigen`."""
    values = np.concatenate([np.linalg.eigvals(part.matrix) for part in _Free.of(model).parts])
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


@dataclass(frozen=True)
class _Free:
    """A model's states, folded, without the arc length of the first body.

    parts: that do not meet; along: places of all arc lengths; first: the row of A that the first of these had, which
    was dropped; value: its eigenvalue in A.
    """

    parts: list[Part]
    halves: Halves
    along: list[int]
    first: Matrix
    value: float

    @classmethod
    def of(cls, model: LinearModel) -> _Free:
        names = [state.name for state in model.states]
        along = [i for i, name in enumerate(names) if name.endswith(".s")]
        value = 0.0 if model.sample_time is None else 1.0
        halves = Halves.of(names)
        if not _slides(model.A, along, value):
            return cls(parts(halves.folded(model.A)), halves, [], np.zeros(len(names)), value)
        A, first = model.A.copy(), model.A[along[0]]
        A[along] -= first
        A[:, along[0]] = 0.0
        apart = [part for part in parts(halves.folded(A)) if along[0] not in part.at]
        return cls(apart, halves, along, first, value)

    def whole_left(self, vectors: Sequence[tuple[Part, Complex]]) -> Complex:
        """Left vectors over the model's states: those of the dropped arc length take what is subtracted from others."""
        whole = self._side_by_side([(part.at, own / part.scale[:, None]) for part, own in vectors])
        if self.along:
            whole[self.along[0]] = -whole[self.along].sum(axis=0)
        return whole

    def whole_right(self, vectors: Sequence[tuple[Part, Complex]], values: Complex) -> Complex:
        """Right vectors over the model's states: the dropped arc length follows from its own equation."""
        whole = self._side_by_side([(part.at, own * part.scale[:, None]) for part, own in vectors])
        if self.along:
            whole[self.along] += (self.first @ whole) / (values - self.value)
        return whole

    def _side_by_side(self, vectors: Sequence[tuple[NDArray[np.intp], Complex]]) -> Complex:
        whole = np.zeros((len(self.first), sum(own.shape[1] for _, own in vectors)), dtype=complex)
        column = 0
        for at, own in vectors:
            whole[at, column : column + own.shape[1]] = own
            column += own.shape[1]
        self.halves.fold(whole)
        return whole


def _vectors(part: Part) -> tuple[Complex, Complex]:
    values, vectors = np.linalg.eig(part.matrix)
    return values.astype(np.complex128), vectors.astype(np.complex128)


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
