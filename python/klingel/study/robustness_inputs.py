"""What a study of robustness varies: each input with its unit, its distribution and the reason for it.
The distributions are a table in `robustness.toml` beside this module; a file of the same form replaces some of them."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

from klingel.errors import InputError, Problem, nearest
from klingel.records import Record, Status, read_toml, validated
from klingel.study.robustness_effects import EFFECTS
from klingel.units import Quantity, to_si

SHIPPED = "robustness.toml"


class _Table(Record):
    """One table of the file, before its numbers are read in their unit."""

    distribution: Literal["uniform", "triangular", "normal"]
    low: Quantity
    high: Quantity
    mode: Quantity | None = None
    mean: Quantity | None = None
    deviation: Quantity | None = None
    status: Status = "design"
    reason: str


@dataclass(frozen=True)
class Distribution:
    """Of one input in SI, between `low` and `high`; `numbers` beside them: the mode, or mean and deviation.

    status, reason: where the numbers come from, and why these.
    """

    kind: Literal["uniform", "triangular", "normal"]
    low: float
    high: float
    numbers: tuple[float, ...] = ()
    status: Status = "design"
    reason: str = ""

    def quantile(self, share: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """The value that `share` (0 to 1) of all draws lie below.

        >>> Distribution("triangular", 0.0, 4.0, (1.0,)).quantile(0.25)
        array(1.)
        """
        u, width = np.asarray(share, dtype=np.float64), self.high - self.low
        match self.kind:
            case "uniform":
                return np.asarray(self.low + u * width)
            case "triangular":
                rising = self.numbers[0] - self.low
                below = self.low + np.sqrt(u * width * rising)
                above = self.high - np.sqrt((1.0 - u) * width * (width - rising))
                return np.asarray(np.where(u * width <= rising, below, above))
            case "normal":
                mean, deviation = self.numbers
                ends = ndtr((np.array([self.low, self.high]) - mean) / deviation)
                return np.asarray(mean + deviation * ndtri(ends[0] + u * (ends[1] - ends[0])))

    @property
    def words(self) -> str:
        """The kind with its numbers between the ends, in SI.

        >>> Distribution("triangular", 0.0, 4.0, (1.0,)).words
        'triangular, mode 1'
        """
        names = {"uniform": (), "triangular": ("mode",), "normal": ("mean", "deviation")}[self.kind]
        return ", ".join([self.kind, *(f"{name} {x:g}" for name, x in zip(names, self.numbers, strict=True))])


Inputs = Mapping[str, Distribution]
"""Distribution of each input, by its name in `klingel.study.robustness_effects.EFFECTS`."""


def inputs(path: str | Path | None = None, *, only: Iterable[str] | None = None) -> dict[str, Distribution]:
    """The shipped distributions, those of a file in their place, and of these only some.

    Errors: InputError with every problem of the file, for unknown names and for distributions without width.

    >>> inputs(only=["friction"])["friction"].low
    0.08
    """
    text = (resources.files("klingel.study") / SHIPPED).read_text(encoding="utf-8")
    tables = tomllib.loads(text)
    if path is not None:
        tables |= read_toml(path)
    chosen = list(tables) if only is None else list(only)
    known = list(EFFECTS)
    problems = [
        Problem(name, None, "is no input of this study", nearest(name, known))
        for name in {**tables, **dict.fromkeys(chosen)}
        if name not in known
    ]
    made = {}
    for name in known:
        if name in chosen and name in tables:
            try:
                made[name] = _distribution(name, tables[name])
            except InputError as error:
                problems += error.problems
    if problems:
        raise InputError(problems, file=None if path is None else str(path))
    return made


def _distribution(name: str, table: Mapping[str, Any]) -> Distribution:
    try:
        read = validated(_Table, table)
    except InputError as error:
        raise error.within(name) from None
    unit = EFFECTS[name].unit
    wanted = {"uniform": (), "triangular": ("mode",), "normal": ("mean", "deviation")}[read.distribution]
    values = {}
    for key in ("low", "high", "mode", "mean", "deviation"):
        given = getattr(read, key)
        if key in ("low", "high", *wanted) and given is None:
            raise InputError.single(f"{name}.{key}", None, "is missing", remedy=f"give it in {unit}")
        if key not in ("low", "high", *wanted) and given is not None:
            remedy = f"a {read.distribution} distribution takes low, high{''.join(', ' + w for w in wanted)}"
            raise InputError.single(f"{name}.{key}", given, "is not of this distribution", remedy=remedy)
        if given is not None:
            values[key] = to_si(given, unit, key=f"{name}.{key}")
    if not values["high"] > values["low"]:
        raise InputError.single(f"{name}.high", values["high"], "is not above low", remedy="give low below high")
    if "mode" in values and not values["low"] <= values["mode"] <= values["high"]:
        raise InputError.single(f"{name}.mode", values["mode"], "is not between low and high", remedy="move it there")
    if "deviation" in values and not values["deviation"] > 0.0:
        raise InputError.single(f"{name}.deviation", values["deviation"], "must be positive", remedy="give it above 0")
    for end in ("low", "high"):
        EFFECTS[name].check(f"{name}.{end}", values[end])
    numbers = tuple(values[key] for key in wanted)
    return Distribution(read.distribution, values["low"], values["high"], numbers, read.status, read.reason)


def draw(chosen: Inputs, runs: int, seed: int) -> list[dict[str, float]]:
    """Values of every run: scrambled Sobol points through the distributions; more runs begin with the same ones.

    The same inputs, seed and order of names give the same values, whatever else is drawn beside.

    >>> two, four = (draw(inputs(only=["friction", "payload"]), n, 1) for n in (2, 4))
    >>> two == four[:2]
    True
    """
    sobol = qmc.Sobol(len(chosen), scramble=True, rng=np.random.default_rng(seed))
    points = sobol.random_base2(max(1, math.ceil(math.log2(max(runs, 1)))))[:runs]
    columns = {name: each.quantile(points[:, i]) for i, (name, each) in enumerate(chosen.items())}
    return [{name: float(column[k]) for name, column in columns.items()} for k in range(runs)]


LEVELS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of the range, from low to high, at which each input is tried alone."""


def levels(chosen: Inputs) -> dict[str, list[float]]:
    """Values at which each input is tried alone: evenly from its low to its high end.

    >>> levels(inputs(only=["delay"]))["delay"]
    [0.0, 0.0075, 0.015, 0.0225, 0.03]
    """
    return {name: [each.low + u * (each.high - each.low) for u in LEVELS] for name, each in chosen.items()}
