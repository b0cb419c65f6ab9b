"""Creep forces of the reference rows by our laws, and their deviation.
Forces over mu Fn, moments over mu Fn sqrt(a b), as the references have them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from klingel.contact import creep_force

DATA = Path(__file__).parent
STEEL = {"shear_modulus": 8.2e10, "poisson": 0.28}

Values = NDArray[np.float64]


def references() -> pd.DataFrame:
    """All rows in SI, with the column `source`: contact or exact."""
    parts = [pd.read_csv(DATA / f"{name}.csv", comment="#").assign(source=name) for name in ("contact", "exact")]
    rows = pd.concat(parts, ignore_index=True)
    return rows.assign(a=rows["a_mm"] * 1e-3, b=rows["b_mm"] * 1e-3, phi=rows["phi_1permm"] * 1e3)


def computed(rows: pd.DataFrame, law: str, **options: Any) -> tuple[Values, Values, Values]:
    """Fx, Fy and Mz of the rows by a law, normalised as the references are."""
    patch = {key: rows[key].to_numpy() for key in ("a", "b", "xi", "eta", "phi")}
    normal_force, friction = rows["FN_N"].to_numpy(), rows["mu"].to_numpy()
    fx, fy, mz = creep_force(law, **patch, normal_force=normal_force, friction=friction, **STEEL, **options)  # type: ignore[call-overload]
    limit = friction * normal_force
    return fx / limit, fy / limit, mz / (limit * np.sqrt(patch["a"] * patch["b"]))


def force_error(rows: pd.DataFrame, law: str, **options: Any) -> Values:
    """|dF| / (mu Fn) of each row."""
    fx, fy, _ = computed(rows, law, **options)
    return np.asarray(np.hypot(fx - rows["fx_rel"], fy - rows["fy_rel"]))


def rms(values: Values) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
