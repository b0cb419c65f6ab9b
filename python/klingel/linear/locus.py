"""Root loci: the eigenvalues of a vehicle over its speed, conicity, friction or any number of vehicle and controllers.
Every eigenvalue is followed from one value to the next by its size and its shape."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from klingel.errors import InputError
from klingel.linear import parameters
from klingel.linear.blocks import Complex, live
from klingel.linear.model import LinearModel
from klingel.linear.modes import STILL, Mode, modes
from klingel.linear.names import numbered
from klingel.linear.sweep import Linearised, Sweep
from klingel.scenario import Scenario
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd

LIKENESS = 1.0
"""Weight of two shapes being unlike against the relative distance of their eigenvalues."""


@dataclass(frozen=True, eq=False)
class RootLocus:
    """Eigenvalues over one parameter, every branch one mode that was followed.

    parameter, unit: what varies; values (k): ascending or as given; eigenvalues (k, n) [1/s], one of each conjugate
    pair; names (n): guessed at the middle value; speed: of the vehicle [m/s], None where that is what varies.
    """

    parameter: str
    unit: str
    values: NDArray[np.float64]
    eigenvalues: Complex
    names: tuple[str, ...]
    speed: float | None = None

    @property
    def frequency(self) -> NDArray[np.float64]:
        """Of the damped oscillations [Hz] (k, n)."""
        return np.asarray(np.abs(self.eigenvalues.imag) / (2.0 * np.pi))

    @property
    def damping(self) -> NDArray[np.float64]:
        """Damping ratios (k, n): negative where a mode is unstable, zero for a free position."""
        size = np.abs(self.eigenvalues)
        return np.asarray(np.where(size > STILL, -self.eigenvalues.real / np.maximum(size, STILL), 0.0))

    def table(self) -> pd.DataFrame:
        """Tidy rows: the parameter's value, branch, name, real and imaginary part [1/s], frequency [Hz], damping."""
        import pandas as pd

        k, n = self.eigenvalues.shape
        return pd.DataFrame(
            {
                self.parameter: np.repeat(self.values, n),
                "branch": np.tile(np.arange(n), k),
                "name": np.tile(np.array(self.names, dtype=object), k),
                "real": self.eigenvalues.real.ravel(),
                "imag": self.eigenvalues.imag.ravel(),
                "frequency": self.frequency.ravel(),
                "damping": self.damping.ravel(),
            }
        )


def root_locus(
    scenario: Scenario,
    parameter: str,
    values: Iterable[Quantity],
    *,
    at: Quantity | None = None,
    controllers: bool = True,
    step: Callable[[int, int], None] | None = None,
) -> RootLocus:
    """The eigenvalues of a scenario over a parameter.

    parameter: "speed", "friction", "conicity" or any path of `klingel.linear.parameters`; values: in SI or strings with
    units, neighbours next to each other; at, controllers: as for `klingel.linearise`; step: called with how many values
    are done and how many there are. Errors: InputError for an unknown parameter, and as `klingel.linearise`.
    """
    unit = parameters.unit(scenario, parameter)
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError.single("values", values, "is no series of values", remedy=f"give some of {parameter} [{unit}]")
    numbers = np.array([to_si(value, unit, key=parameter) for value in values])
    if numbers.size == 0:
        raise InputError.single("values", [], "holds no value", remedy=f"give values of {parameter} [{unit}]")
    changed = [parameters.replace(scenario, parameter, float(number)) for number in numbers]
    sweep = Sweep(at=at, controllers=controllers)
    middle = len(changed) // 2
    kept: list[Linearised] = []

    def models() -> Iterator[LinearModel]:
        for k, each in enumerate(changed):
            made = sweep(each)
            if k == middle:
                kept.append(made)
            yield made.model
            if step is not None:
                step(k + 1, len(changed))

    followed = follow(models())
    names = _names(followed, middle, modes(kept[0].model, kept[0].spec, plant=kept[0].plant))
    speed = None if parameter == "speed" else scenario.speed
    return RootLocus(parameter, unit, numbers, followed.T, names, speed)


def _names(branches: Complex, middle: int, found: Sequence[Mode]) -> tuple[str, ...]:
    """Of every branch the name of the mode with its eigenvalue at the middle, or where it is next to it."""
    known = np.array([mode.eigenvalue for mode in found])
    there = np.isfinite(branches)
    nearest = np.abs(np.where(there, np.arange(branches.shape[1]) - middle, np.inf)).argmin(axis=1)
    values = branches[np.arange(len(branches)), nearest]
    names = [found[i].name for i in np.abs(values[:, None] - known[None, :]).argmin(axis=1)]
    return numbered(names, branches)


def follow(models: Iterable[LinearModel]) -> Complex:
    """Eigenvalues of neighbouring models as branches (n, k): each is followed by its size and by its shape.

    Of conjugate pairs the upper one is followed. Where a pair turns into two real eigenvalues a branch begins, where
    two become a pair one ends; it is NaN elsewhere. The bare memory of controllers is left out.
    """
    steps: list[tuple[NDArray[np.intp], Complex]] = []
    now: _Seen | None = None
    weights = np.ones(1)
    count = 0
    for model in models:
        found = _seen(model)
        if now is None:
            weights = 1.0 / np.maximum(np.sqrt(np.mean(np.abs(found.shapes) ** 2, axis=1)), 1e-300)
        found = found._replace(shapes=_scaled(found.shapes, weights))
        branch = np.full(len(found.roots), -1)
        if now is not None:
            old, new = _matched(now, found)
            branch[new] = now.branch[old]
            found.ahead[new] = 2.0 * found.roots[new] - now.roots[old]
        fresh = np.flatnonzero(branch < 0)
        branch[fresh] = count + np.arange(len(fresh))
        count += len(fresh)
        now = found._replace(branch=branch)
        steps.append((branch, found.roots))
    branches = np.full((count, len(steps)), np.nan, dtype=np.complex128)
    for k, (branch, roots) in enumerate(steps):
        branches[branch, k] = roots
    return branches


class _Seen(NamedTuple):
    """Eigenvalues, shapes as columns, where a straight line leads next, and the branches that they are on."""

    roots: Complex
    shapes: Complex
    ahead: Complex
    branch: NDArray[np.intp]


def _seen(model: LinearModel) -> _Seen:
    roots, shapes = live(model)
    return _Seen(roots, shapes, roots.copy(), np.zeros(0, dtype=np.intp))


def _scaled(shapes: Complex, weights: NDArray[np.float64]) -> Complex:
    weighted = shapes * weights[:, None]
    return np.asarray(weighted / np.linalg.norm(weighted, axis=0))


def _matched(now: _Seen, found: _Seen) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Which old eigenvalue each new one continues: places in `now` and in `found`."""
    size = np.abs(now.roots)[:, None] + np.abs(found.roots)[None, :] + 1.0
    distance = np.abs(now.roots[:, None] - found.roots[None, :])
    off_line = np.abs(now.ahead[:, None] - found.roots[None, :])
    unlike = 1.0 - np.abs(np.conj(now.shapes.T) @ found.shapes) ** 2
    old, new = linear_sum_assignment(np.minimum(distance, off_line) / size + LIKENESS * unlike)
    return np.asarray(old), np.asarray(new)
