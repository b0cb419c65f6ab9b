"""Short curves for whole vehicles: quick to run, long enough to come to rest in the arc.
Runs are made once a session."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import pytest
import xarray as xr

import klingel as kl
from klingel import control, library

STRATEGIES: Mapping[str, tuple[str, Callable[[], Any]]] = {
    "passive": ("manchester_coach", lambda: None),
    "solid_like": ("mechatronic_irw", control.SolidLike),
    "irw_like": ("mechatronic_irw", control.IRWLike),
}
SPEEDS = {300.0: 30.0, 800.0: 49.0}
"""[m/s] by radius [m]: about 300 mm of cant deficiency at 160 mm of cant."""

Simulate = Callable[..., xr.Dataset]


def scenario(
    vehicle: str, radius: float = 300.0, hand: str = "right", step: float = 1e-3, creep_law: Any = "table"
) -> kl.Scenario:
    name, strategy = STRATEGIES[vehicle]
    speed = SPEEDS[radius]
    track = kl.Track.curve(
        radius=radius,
        cant=0.16,
        transition=4.0 * speed,
        arc=7.0 * speed,
        straight_before=2.0 * speed,
        straight_after=30.0,
        hand=hand,  # type: ignore[arg-type]
    )
    return kl.Scenario(library.vehicle(name), track, speed=speed, control=strategy(), step=step, creep_law=creep_law)


@pytest.fixture(scope="session")
def simulate() -> Simulate:
    """`simulate(vehicle, radius, hand, step, creep_law)`: the run of that short curve."""

    @cache
    def run(
        vehicle: str, radius: float = 300.0, hand: str = "right", step: float = 1e-3, creep_law: str = "table"
    ) -> xr.Dataset:
        return kl.simulate(scenario(vehicle, radius, hand, step, creep_law), strict=True)

    return run
