"""Eigenvalues of the package's linear models beside those of the textbook, paired one to one."""

from __future__ import annotations

import json

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from tests.linear.modes import Complex, oscillations
from tests.linear.specs import Spec
from tests.linear.textbook import Matrix

from klingel.core import core


def plant(spec: Spec) -> Matrix:
    """A of a spec about its steady state."""
    a: Matrix = core().linearise(json.dumps(spec))["a"]
    return a


def pairs(ours: Matrix, book: Matrix) -> tuple[Complex, Complex]:
    """Every mode of the textbook that swings [1/s], and the one of ours that belongs to it.

    Left out: modes slower than 1 rad/s and those damped by 0.9 or more. The latter are nearly double and real, where a
    small change of a matrix moves an eigenvalue by the root of it.
    """
    wanted, found = oscillations(book), oscillations(ours, 0.5)
    wanted = wanted[-wanted.real < 0.9 * np.abs(wanted)]
    off = np.abs(found[None, :] - wanted[:, None]) / np.abs(wanted[:, None])
    rows, columns = linear_sum_assignment(off)
    return wanted[rows], found[columns]


def distance(ours: Matrix, book: Matrix) -> NDArray[np.float64]:
    """|ours - textbook|/|textbook| of these, from the slowest."""
    wanted, found = pairs(ours, book)
    return np.asarray(np.abs(found - wanted) / np.abs(wanted))
