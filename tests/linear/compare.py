"""Eigenvalues of the package's linear models beside those of the textbook, paired one to one."""

from __future__ import annotations

import json

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from tests.linear.specs import Spec
from tests.linear.textbook import Complex, Matrix, oscillations

from klingel.core import core


def plant(spec: Spec) -> Matrix:
    """A of a spec about its steady state."""
    a: Matrix = core().linearise(json.dumps(spec))["a"]
    return a


def pairs(ours: Matrix, book: Matrix, slowest: float = 1.0) -> tuple[Complex, Complex]:
    """Every oscillation of the textbook [1/s], and the one of ours that belongs to it."""
    wanted, found = oscillations(book, slowest), oscillations(ours, 0.5 * slowest)
    off = np.abs(found[None, :] - wanted[:, None]) / np.abs(wanted[:, None])
    rows, columns = linear_sum_assignment(off)
    return wanted[rows], found[columns]


def distance(ours: Matrix, book: Matrix, slowest: float = 1.0) -> NDArray[np.float64]:
    """|ours - textbook|/|textbook| of every oscillation, from the slowest."""
    wanted, found = pairs(ours, book, slowest)
    return np.asarray(np.abs(found - wanted) / np.abs(wanted))
