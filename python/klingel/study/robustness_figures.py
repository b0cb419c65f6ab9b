"""What many runs say: probabilities with confidence intervals, percentiles, which inputs explain the figures.
Pure functions of the tables of runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import binomtest, rankdata

from klingel.result import COMPLETED
from klingel.study.robustness_effects import EFFECTS

if TYPE_CHECKING:
    from klingel.study.robustness_inputs import Inputs

Y_LIMIT = 6.0
"""Lateral displacement of a wheelset that no run should exceed [mm]; flange contact is near."""

CONFIDENCE = 0.95
"""Of the intervals."""

PERCENTILES = (5, 25, 50, 75, 95, 99)

MERITS = ("y_max_mm", "lateral_force_max_kN", "attack_angle_max_mrad", "wear_index_N", "actuator_force_max_kN")
"""Figures of merit: the smaller the better."""

BINS = 10
"""Of equal numbers of runs, over one input, for the share of the spread that it explains."""

FAILED = "failed"


def failed(table: pd.DataFrame) -> NDArray[np.bool_]:
    """Runs with |y| over 6 mm, and those that did not get to the end, or did not begin."""
    return np.asarray((table["y_max_mm"] > Y_LIMIT) | (table["outcome"] != COMPLETED), dtype=bool)


def probabilities(table: pd.DataFrame) -> pd.DataFrame:
    """Share of the runs in which something happened, with the interval of Clopper and Pearson at 95 %.

    Columns event, runs, of, probability, low, high.

    >>> rows = pd.DataFrame({"y_max_mm": [1.0, 7.0], "flange_contact": ["", "root"], "outcome": [COMPLETED] * 2})
    >>> float(probabilities(rows)["probability"][0])
    0.5
    """
    events: dict[str, Any] = {
        f"|y| over {Y_LIMIT:g} mm, or not at the end": failed(table),
        f"|y| over {Y_LIMIT:g} mm": table["y_max_mm"] > Y_LIMIT,
        "contact in the flange root or on the flange": table["flange_contact"] != "",
        "contact on the flange": table["flange_contact"] == "flange",
        "not at the end": table["outcome"] != COMPLETED,
    }
    rows = []
    for event, happened in events.items():
        count, of = int(np.count_nonzero(happened)), len(table)
        interval = binomtest(count, of).proportion_ci(CONFIDENCE, method="exact")
        rows.append((event, count, of, count / of, float(interval.low), float(interval.high)))
    return pd.DataFrame(rows, columns=["event", "runs", "of", "probability", "low", "high"])


def percentiles(table: pd.DataFrame, figures: tuple[str, ...] = MERITS) -> pd.DataFrame:
    """Percentiles of figures over the runs that have them: a row a figure, columns p5 to p99, runs in front."""
    rows = []
    for figure in figures:
        found = table[figure].dropna().to_numpy(dtype=np.float64)
        if len(found):
            rows.append((figure, len(found), *np.percentile(found, PERCENTILES)))
    return pd.DataFrame(rows, columns=["figure", "runs", *(f"p{p}" for p in PERCENTILES)])


def amounts(table: pd.DataFrame, chosen: Inputs) -> dict[str, NDArray[np.float64]]:
    """Values of each input by its name; by its amount where errors to both sides do alike."""
    return {
        name: np.abs(values) if two_sided(name, chosen) else values
        for name in chosen
        for values in [table[name].to_numpy(dtype=np.float64)]
    }


def two_sided(name: str, chosen: Inputs) -> bool:
    """Whether an input errs to both sides of its nominal value of zero."""
    return EFFECTS[name].nominal == 0.0 and chosen[name].low < 0.0 < chosen[name].high


def correlations(table: pd.DataFrame, chosen: Inputs, figures: tuple[str, ...] = MERITS) -> pd.DataFrame:
    """Which inputs explain what: a row an input, columns the rank correlation with each figure and with failing.

    Spearman's; of the amount of an input that errs to both sides; NaN for what never varies. `explained` is the share
    of the spread of the ranks of y_max that the input explains alone (correlation ratio over ten bins, the part that
    chance explains taken off).
    """
    columns: Mapping[str, NDArray[np.float64]] = {
        **{figure: table[figure].to_numpy(dtype=np.float64) for figure in figures},
        FAILED: failed(table).astype(np.float64),
    }
    y_max, rows = table["y_max_mm"].to_numpy(dtype=np.float64), []
    for name, values in amounts(table, chosen).items():
        found = [rank_correlation(values, column) for column in columns.values()]
        rows.append((name, *found, explained(values, y_max)))
    made = pd.DataFrame(rows, columns=["input", *columns, "explained"])
    return made.sort_values("explained", ascending=False, kind="stable", ignore_index=True)


def rank_correlation(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Spearman's rank correlation of the pairs without NaN; NaN where one of them never varies.

    >>> round(rank_correlation(np.array([1.0, 2.0, 3.0]), np.array([1.0, 4.0, 9.0])), 12)
    1.0
    """
    both = ~(np.isnan(a) | np.isnan(b))
    first, second = rankdata(a[both]), rankdata(b[both])
    if len(first) < 3 or not np.ptp(first) or not np.ptp(second):
        return float("nan")
    return float(np.corrcoef(first, second)[0, 1])


def explained(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Share of the variance of the ranks of `b` between ten bins of `a`, less what chance puts there; NaN for few runs.

    >>> x = np.linspace(-1.0, 1.0, 200)
    >>> round(explained(x, x**2), 2), rank_correlation(x, x**2) < 0.01
    (0.96, True)
    """
    both = ~(np.isnan(a) | np.isnan(b))
    first, second = a[both], rankdata(b[both])
    if len(first) < 5 * BINS or not np.ptp(second):
        return float("nan")
    bins = np.array_split(np.argsort(first, kind="stable"), BINS)
    inside = sum(float(np.sum((second[part] - second[part].mean()) ** 2)) for part in bins)
    total = float(np.sum((second - second.mean()) ** 2))
    return max(0.0, 1.0 - inside / (len(first) - BINS) / (total / (len(first) - 1)))


def least_significant(runs: int) -> float:
    """Amount of a rank correlation of that many runs that chance exceeds once in twenty.

    >>> round(least_significant(401), 3)
    0.098
    """
    return 1.96 / float(np.sqrt(max(runs - 1, 1)))


def ranges(alone: pd.DataFrame, nominal: pd.Series, figure: str) -> pd.DataFrame:
    """What each input alone does to a figure: columns input, at_low, at_high, least, most; widest first.

    Rows whose run has no such figure are left out; an input that has none left is too.
    """
    rows = []
    for name, tried in alone.groupby("input", sort=False):
        found = tried.sort_values(str(name), kind="stable")[figure]
        seen = [*found.dropna(), nominal[figure]]
        if found.notna().any():
            rows.append((name, found.iloc[0], found.iloc[-1], min(seen), max(seen)))
    made = pd.DataFrame(rows, columns=["input", "at_low", "at_high", "least", "most"])
    order = (made["least"] - made["most"]).argsort(kind="stable")
    return made.iloc[order].reset_index(drop=True)


def worst(table: pd.DataFrame, count: int = 6) -> pd.DataFrame:
    """The worst runs first: those that did not get to the end, then by y_max."""
    ended = table["outcome"] != COMPLETED
    order = table.assign(ended=ended).sort_values(["ended", "y_max_mm"], ascending=[False, False], kind="stable")
    return order.drop(columns="ended").head(count).reset_index(drop=True)
