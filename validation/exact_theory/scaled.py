"""Contact patches by the numbers that matter: a/b and the creepages without units (docs/theory/exact.md).
Every case about exact creep forces asks the laws through this page, so that all mean the same patch."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from klingel.contact import creep_force
from validation.kalker.case import coefficients

Values = NDArray[np.float64]

POISSON = 0.28
SHEAR_MODULUS = 8.2e10
MEAN = 6e-3
"""sqrt(a b) [m]; with the load and the friction it drops out of every result."""
LIMIT = 0.3 * 80e3
"""mu N [N]"""
REFERENCE = (40, 40)
"""Elements of the reference, CONTACT's customary grid."""
HALF = 1.5
"""|v| at half way from rest to full sliding on the compressed axis v/(1.5 + |v|) of pictures and random points."""


def scales(ratio: ArrayLike) -> tuple[Values, Values, Values]:
    """S1, S2 and S3 of a/b: v = (S1 xi*, S2 eta*, S3 phi*) has about the size of the linear force over mu N.

    S1 and S2 are Kalker's C11 and C22. S3 is the fourth-power mean of C23, which is how spin makes a force, and of
    C11 sqrt(b/a)/2 and C22 sqrt(a/b)/2, which are the slip of spin at the ends of the patch.

    >>> [round(float(s), 2) for s in scales(1.0)]
    [4.23, 3.7, 2.46]
    """
    g = np.asarray(ratio, dtype=np.float64)
    c = coefficients(g, POISSON)
    ends = (c["C23"], c["C11"] / np.sqrt(g) / 2, c["C22"] * np.sqrt(g) / 2)
    return c["C11"], c["C22"], sum((end**4 for end in ends), np.zeros_like(g)) ** 0.25


def forces(law: str, ratio: ArrayLike, creepage: Iterable[ArrayLike], **options: Any) -> tuple[Values, Values, Values]:
    """Fx and Fy over mu N and Mz over mu N sqrt(a b) for the creepages xi*, eta*, phi* at a/b.

    >>> fx, fy, mz = forces("linear", 1.0, (0.1, 0.0, 0.0))
    >>> round(float(fx), 3)
    -0.423
    """
    xi, eta, phi = (np.asarray(part, dtype=np.float64) for part in creepage)
    g, unit = np.asarray(ratio, dtype=np.float64), LIMIT / (SHEAR_MODULUS * MEAN**2)
    patch: dict[str, Any] = {"a": MEAN * np.sqrt(g), "b": MEAN / np.sqrt(g), "normal_force": LIMIT, "friction": 1.0}
    patch |= {"xi": unit * xi, "eta": unit * eta, "phi": unit / MEAN * phi}
    fx, fy, mz = creep_force(law, **patch, shear_modulus=SHEAR_MODULUS, poisson=POISSON, **options)  # type: ignore[call-overload]
    return np.asarray(fx) / LIMIT, np.asarray(fy) / LIMIT, np.asarray(mz) / (LIMIT * MEAN)


def solved(rows: pd.DataFrame, elements: tuple[int, int] = REFERENCE) -> pd.DataFrame:
    """The rows (aob, xi, eta, phi: without units) with fx, fy and mz of the exact theory in the file's digits."""
    found = forces("exact", rows["aob"], (rows["xi"], rows["eta"], rows["phi"]), elements=elements)
    return rows.assign(**{name: force.round(DIGITS) + 0.0 for name, force in zip(FORCES, found, strict=True)})


FORCES = ("fx", "fy", "mz")
DIGITS = 5
"""Of forces over mu N in our reference files: far below every difference that is looked at."""


def off(rows: pd.DataFrame, law: str, **options: Any) -> Values:
    """|dF| over mu N of a law at every row of a reference file."""
    fx, fy, _ = forces(law, rows["aob"], (rows["xi"], rows["eta"], rows["phi"]), **options)
    return np.asarray(np.hypot(fx - rows["fx"], fy - rows["fy"]))


def off_moment(rows: pd.DataFrame, law: str, **options: Any) -> Values:
    """dMz over mu N sqrt(a b) of a law at every row of a reference file."""
    _, _, mz = forces(law, rows["aob"], (rows["xi"], rows["eta"], rows["phi"]), **options)
    return np.asarray(mz - rows["mz"])


def resolved(rows: pd.DataFrame, elements: tuple[int, int] = REFERENCE) -> float:
    """Most that a force or moment solved now differs from the file's: a file tells what the present solver gives."""
    again = solved(rows, elements)
    return max(float((again[name] - rows[name]).abs().max()) for name in FORCES)


def rms(values: Values) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def read(path: Path) -> pd.DataFrame:
    """A reference file."""
    return pd.read_csv(path, comment="#")


def write(path: Path, rows: pd.DataFrame, about: Iterable[str]) -> None:
    """A reference file with what it is on top."""
    head = "".join(f"# {line}\n" for line in about)
    path.write_text(head + rows.to_csv(index=False, lineterminator="\n"), encoding="utf-8")
