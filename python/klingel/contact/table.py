"""The table of creep forces in this build: what it was made of, and how near it is to exact theory at random points.
`klingel contact-table` makes it; docs/theory/creep_table.md derives it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from klingel.contact.creep import CreepLaw, Values, creep_force
from klingel.core import core

if TYPE_CHECKING:
    import pandas as pd

HALF_WAY = 1.5
"""Size of scaled creepages that half of the random points exceed, about half way to full sliding."""
SPINS = (0.3, 150.0)
"""Least and largest scaled spin of the lines of pure spin."""
COLUMNS = ("ratio", "xi", "eta", "phi", "fx", "fy", "mz", "fx_exact", "fy_exact", "mz_exact")


@dataclass(frozen=True)
class CreepTable:
    """What a table was made of.

    ratios: least and largest a/b; poisson: of both bodies; elements: of a patch, along and across rolling; intervals:
    of the three creepages, from none to full sliding, and of a/b; check_sum: SHA-256 of the rest of its file; solver:
    SHA-256 of the solver's sources that made it; by_this_solver: whether they are those of this build.

    >>> table = creep_table()
    >>> table.poisson, len(table.check_sum)
    (0.28, 64)
    """

    ratios: tuple[float, float]
    poisson: float
    elements: tuple[int, int]
    intervals: tuple[int, int, int, int]
    check_sum: str
    solver: str
    by_this_solver: bool

    def __str__(self) -> str:
        along, across = self.elements
        low, high = self.ratios
        range_ = f"a/b 1/{1.0 / low:.0f} to {high:.0f}"
        return f"{range_}, {along} x {across} elements, Poisson's ratio {self.poisson:g}"


def creep_table() -> CreepTable:
    """The table that `law="table"` reads, its check sum found right."""
    info = core().creep_table()
    return CreepTable(
        ratios=tuple(info["ratios"]),
        poisson=info["poisson"],
        elements=tuple(info["fine"]),
        intervals=tuple(info["intervals"]),
        check_sum=info["checksum"],
        solver=info["solver"],
        by_this_solver=info["by_this_solver"],
    )


def header(content: bytes) -> dict[str, str]:
    """The lines at the head of a table's file: what it was made of, as text.

    content: of the file, or its first 2000 bytes.

    >>> header(b"klingel creep table 1\\npoisson: 0.28\\nfine: 40 40\\n\\n...")
    {'poisson': '0.28', 'fine': '40 40'}
    """
    lines = content[:2000].split(b"\n\n")[0].decode(errors="replace").splitlines()
    return dict(line.split(": ", 1) for line in lines if ": " in line)


def compare_with_exact(points: int, seed: int = 0) -> pd.DataFrame:
    """Forces of the table and of exact theory with the table's elements at random points of all its range.

    Logarithms of a/b are spread evenly, so are the directions of the scaled creepages, whose size m gives an even
    m/(1.5 + m). Takes some 50 ms a point and core.

    points: how many; seed: of the random numbers.
    Returns a row a point: ratio (a/b); xi, eta, phi (times G a b/(mu N), spin also times sqrt(a b)); fx, fy of the
    table and fx_exact, fy_exact (over mu N); mz, mz_exact (over mu N (a + b)/2); error, the size of the difference of
    the two forces (over mu N); error_mz.

    >>> rows = compare_with_exact(2)
    >>> bool((np.hypot(rows.fx, rows.fy) < 1.0 + 1e-12).all())
    True
    """
    random = np.random.default_rng(seed)
    low, high = np.log(creep_table().ratios)
    ratio = np.exp(random.uniform(low, high, points))
    direction = random.normal(size=(3, points))
    depth = random.uniform(0.0, 1.0, points)
    return _compared(ratio, direction / np.linalg.norm(direction, axis=0) * HALF_WAY * depth / (1.0 - depth))


def compare_pure_spin(ratios: Iterable[float], points: int) -> pd.DataFrame:
    """The same along lines of spin alone, from a third of the linear range to far into full sliding.

    Random points hardly meet the sharp peak of the lateral force that spin makes in a slender patch.

    ratios: a/b of the lines; points: of each, their scaled spins in equal ratios from 0.3 to 150.
    Returns rows as `compare_with_exact`, line by line.

    >>> rows = compare_pure_spin([1.0], 2)
    >>> rows.xi.tolist(), bool((rows.error < 0.02).all())
    ([0.0, 0.0], True)
    """
    lines = np.array(list(ratios), dtype=np.float64)
    spin = np.tile(np.geomspace(*SPINS, points), len(lines))
    return _compared(np.repeat(lines, points), np.stack([np.zeros_like(spin), np.zeros_like(spin), spin]))


def _compared(ratio: Values, scaled: Values) -> pd.DataFrame:
    """Table and exact theory at a/b and scaled creepages, by row."""
    import pandas as pd

    table = creep_table()
    creepages = scaled / _scales(ratio, table.poisson)
    found = _forces("table", ratio, creepages, table.poisson)
    exact = _forces("exact", ratio, creepages, table.poisson, table.elements)
    differences = np.abs(found - exact)
    columns = dict(zip(COLUMNS, (ratio, *creepages, *found, *exact), strict=True))
    return pd.DataFrame(columns | {"error": np.hypot(*differences[:2]), "error_mz": differences[2]})


def _forces(
    law: CreepLaw, ratio: Values, creepages: Values, poisson: float, elements: tuple[int, int] | None = None
) -> Values:
    """Fx and Fy over mu N and Mz over mu N (a + b)/2, by row, at normalised creepages, also by row."""
    xi, eta, phi = creepages
    # With G = mu = N = a b = 1, creepages and forces are the normalised ones.
    root = np.sqrt(ratio)
    fx, fy, mz = creep_force(
        law, a=root, b=1.0 / root, xi=xi, eta=eta, phi=phi, normal_force=1.0, friction=1.0, shear_modulus=1.0,
        poisson=poisson, elements=elements,
    )  # fmt: skip
    return np.stack([fx, fy, mz / (0.5 * (root + 1.0 / root))])


def _scales(ratio: Values, poisson: float) -> Values:
    """Sizes of the linear theory's forces at normalised creepages of 1, by row; for spin, slip at the rim too."""
    along, across, spin = np.eye(3)[:, :, None] * np.ones_like(ratio)
    c11 = -_forces("linear", ratio, along, poisson)[0]
    c22, c23 = (-_forces("linear", ratio, creepages, poisson)[1] for creepages in (across, spin))
    root = np.sqrt(ratio)
    fourth = c23**4 + (0.5 * c11 / root) ** 4 + (0.5 * c22 * root) ** 4
    return np.stack([c11, c22, np.sqrt(np.sqrt(fourth))])
