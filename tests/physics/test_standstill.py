"""Whole vehicles at low speed and at rest: they start in one go, stand on cant, and run as with short explicit steps.
The laws behind are tested in the core; derivations in docs/theory/standstill.md."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import library
from klingel.errors import InputError
from klingel.lower import lower
from klingel.result import simulate_spec
from klingel.track import Segment, Track

VEHICLES = ("manchester_coach", "mechatronic_irw")


def at_rest(vehicle: str, *, cant: float = 0.0, duration: float = 2.0, **more: Any) -> kl.Scenario:
    track = Track((Segment(3000.0, (0.0, 0.0), (cant, cant)),))
    return kl.Scenario(library.vehicle(vehicle), track, speed=0.0, duration=duration, step="1 ms", **more)


def moved(run: xr.Dataset, channel: str) -> np.ndarray:
    values = run[channel].to_numpy()
    return values - values[0]


def test_a_start_from_rest_runs_to_265_km_h_in_one_go() -> None:
    """At 1 m/s2; 1 % of the last speed for the slow hold, straight on within a nanometre."""
    spec = lower(at_rest("manchester_coach", duration=74.0))
    spec["hold"]["acceleration"] = 1.0
    spec["run"]["record_interval"] = 0.01
    run = simulate_spec(spec, strict=True)
    assert float(run["body.speed"][-1]) == pytest.approx(74.0, rel=0.01)
    assert np.abs(moved(run, "bogie1.wheelset1.y")).max() < 1e-9


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_a_vehicle_on_cant_creeps_at_the_stated_rate(vehicle: str) -> None:
    """v0 Y/f22: with the load of a wheelset and about 10 MN a wheel, 0.05 mm/s; a third for f22."""
    run = kl.simulate(at_rest(vehicle, cant=0.16), strict=True)
    y = moved(run, "bogie1.wheelset1.y")
    rate = (y[-1] - y[1000]) / 1.0
    load = library.vehicle(vehicle).total_mass / 4.0 * 9.81 * 0.16 / 1.5
    assert rate == pytest.approx(0.1 * load / 20e6, rel=0.33)


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_a_vehicle_with_stick_stands_on_cant(vehicle: str) -> None:
    run = kl.simulate(at_rest(vehicle, cant=0.16, stick=True, duration=4.0), strict=True)
    for wheelset in ("bogie1.wheelset1", "bogie2.wheelset2"):
        y = moved(run, f"{wheelset}.y")
        assert abs(y[-1] - y[-1000]) < 1e-7, "no drift in a second"
        assert np.abs(y).max() < 2e-5


def test_implicit_steps_run_as_explicit_ones_that_are_short_enough() -> None:
    """The coach at 8 m/s, pushed: 1 % of each range."""
    track = Track.straight("500 m")
    scenario = kl.Scenario(library.vehicle("manchester_coach"), track, speed=8.0, duration=0.4, step="0.25 ms")
    spec = lower(scenario)
    spec["run"]["kicks"] = [{"body": "bogie1.wheelset1", "velocity": [0.0, 0.02, 0.0]}]
    implicit = simulate_spec(spec, strict=True)
    spec["run"] |= {"step": 5e-5, "implicit_below": 0.0}
    explicit = simulate_spec(spec, strict=True)
    for quantity in ("y", "yaw", "left.Y", "left.X"):
        a, b = (run[f"bogie1.wheelset1.{quantity}"].to_numpy() for run in (implicit, explicit))
        assert np.abs(a - b).max() < 0.01 * np.ptp(b), quantity


def test_what_a_scenario_at_rest_needs() -> None:
    with pytest.raises(InputError, match="duration"):
        at_rest("manchester_coach").replace(duration=None)
    with pytest.raises(InputError, match="negative"):
        at_rest("manchester_coach").replace(speed=-1.0)
    with pytest.raises(InputError, match="stick"):
        at_rest("manchester_coach", stick="yes")
