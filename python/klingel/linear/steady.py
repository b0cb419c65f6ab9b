"""Steady states: what every channel shows in steady running, controllers settled, solved for without time stepping.
Whether a run would stay there is told by the eigenvalues."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from klingel.linear.blocks import eigenvalues
from klingel.linear.operating import solve, steady_spec
from klingel.linear.statespace import of_raw
from klingel.scenario import Scenario
from klingel.units import Quantity

if TYPE_CHECKING:
    from klingel._core import OperatingPoint

UNSTABLE = 1e-3
"""Growth above which a steady state is called unstable [1/s]."""


@dataclass(frozen=True)
class Steady:
    """Steady state: value of every channel (SI; names as in a run, arc lengths from the middle of the vehicle).

    values: by channel; units: by channel; warnings: that it is unstable, elements near a kink; iterations: Newton
    steps; growth: largest real part of the eigenvalues there [1/s], controllers closed.
    """

    values: pd.Series[float]
    units: dict[str, str]
    warnings: tuple[str, ...]
    iterations: int
    growth: float


def steady_state(scenario: Scenario, *, at: Quantity | None = None) -> Steady:
    """Steady running of a scenario, solved by Newton's method with the exact Jacobian, controllers settled.

    at: arc length on the scenario's track [m] whose curvature and cant are held; None for straight level track.
    Errors: SimulationError where there is none, or a wheel cannot stay on its rail; InputError.

    >>> import klingel as kl
    >>> curve = kl.Track.curve(radius="800 m", cant="160 mm", transition="195 m")
    >>> scenario = kl.Scenario(kl.library.vehicle("manchester_coach"), curve, speed="176 km/h")
    >>> steady = kl.linear.steady_state(scenario, at="500 m")
    >>> bool(2e-3 < steady.values["bogie1.wheelset1.y"] < 7e-3)  # towards the outer, left rail it would be negative
    False
    """
    return read(solve(steady_spec(scenario, at=at)).linearise())


def steady_states(scenarios: Sequence[Scenario], *, at: Quantity | None = None) -> Iterator[Steady]:
    """Steady states of one vehicle over speed, radius, friction ..., each found from the one before.

    Where several exist the branch depends on the way; a jump in the values is a change of branch.

    Errors: as `steady_state`, at the scenario that has none.
    """
    near: OperatingPoint | None = None
    for scenario in scenarios:
        near = solve(steady_spec(scenario, at=at), near)
        yield read(near.linearise())


def read(raw: dict[str, Any]) -> Steady:
    """The steady state that a raw linear model is about."""
    growth = growth_of(raw)
    unstable = (f"unstable: departures grow with {growth:.2g} 1/s, a run leaves it",) if growth > UNSTABLE else ()
    return Steady(values_of(raw), dict(raw["outputs"]), (*unstable, *raw["kinks"]), raw["iterations"], growth)


def values_of(raw: dict[str, Any]) -> pd.Series[float]:
    """Value of every channel."""
    return pd.Series(np.asarray(raw["y"]), index=pd.Index([name for name, _ in raw["outputs"]], name="channel"))


def growth_of(raw: dict[str, Any]) -> float:
    """Largest real part of the eigenvalues [1/s], controllers closed; the free arc length is not among them."""
    return float(eigenvalues(of_raw(raw, "", 0.0)).real.max())
