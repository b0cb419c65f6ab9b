"""The linear model against small runs of the same spec, and against central differences.
Random inputs of every kind, two seconds, the passive vehicle and both strategies."""

import copy
import json
from typing import Any

import numpy as np
import pytest

import klingel as kl
from klingel.control import IRWLike, SolidLike
from klingel.core import core
from klingel.errors import InputError, SimulationError
from klingel.linear import LinearModel, linearise, steady_spec
from klingel.linear.statespace import held, of_raw
from klingel.result import simulate_spec

STRAIGHT = kl.Track.straight("1 km")
CURVE = kl.Track.curve(radius="800 m", cant="160 mm", transition="195 m", arc="300 m")
INTERVAL = 1e-3
DURATION = 2.0
SIZES = {"V": 0.1, "N": 1.0, "m": 1e-8, "m/s": 1e-6, "1/m": 1e-10, "N m": 1.0}
"""Of the random inputs: so small that what is left of the nonlinearity stays below the limit."""


def scenario(vehicle: str, control: Any, track: kl.Track, speed: str = "176 km/h") -> kl.Scenario:
    return kl.Scenario(kl.library.vehicle(vehicle), track, speed=speed, control=control)


def excited(spec: dict[str, Any], inputs: dict[str, np.ndarray]) -> dict[str, Any]:
    spec = copy.deepcopy(spec)
    spec["run"] |= {"duration": DURATION, "record_interval": INTERVAL}
    spec["run"]["excitations"] = [
        {"input": name, "interval": INTERVAL, "values": values.tolist()} for name, values in inputs.items()
    ]
    return spec


def predicted(model: LinearModel, inputs: dict[str, np.ndarray]) -> np.ndarray:
    """Outputs of the linear model, one row a sample, inputs held."""
    chosen = model.select(inputs=list(inputs))
    u = np.array(list(inputs.values())).T
    phi, gamma = (chosen.A, chosen.B) if chosen.sample_time else held(chosen, INTERVAL)
    x = np.zeros(len(phi))
    rows = []
    for now in u:
        rows.append(chosen.C @ x + chosen.D @ now)
        x = phi @ x + gamma @ now
    return np.array(rows)


CASES = [
    ("manchester_coach", None, STRAIGHT, None),
    ("manchester_coach", None, CURVE, "500 m"),
    ("mechatronic_irw", IRWLike(), STRAIGHT, None),
    ("mechatronic_irw", IRWLike(), CURVE, "500 m"),
    ("mechatronic_irw", SolidLike(), STRAIGHT, None),
    ("mechatronic_irw", SolidLike(), CURVE, "500 m"),
]


@pytest.mark.parametrize(("vehicle", "control", "track", "at"), CASES)
def test_small_runs_follow_the_linear_model(vehicle: str, control: Any, track: kl.Track, at: str | None) -> None:
    run = scenario(vehicle, control, track)
    model = linearise(run, at=at)
    random = np.random.default_rng(5)
    count = round(DURATION / INTERVAL)
    inputs = {
        s.name: SIZES[s.unit] * random.standard_normal(count)
        for s in model.inputs
        if s.unit in SIZES and s.name != "hold.speed"
    }
    spec = steady_spec(run, at=at)
    still, moved = (simulate_spec(excited(spec, i)) for i in ({}, inputs))
    expected = predicted(model, inputs)
    worst = {}
    for k, output in enumerate(model.outputs):
        # what branches: the angle of the steepest patch and sums of absolute values are no linear channels
        if output.name.endswith((".s", "contact_angle", "steep_force", "slender_force", "tgamma", "spin_work")):
            continue
        seen = (moved[output.name] - still[output.name]).to_numpy()[:count]
        size = float(np.sqrt(np.mean(seen**2)))
        if size > 0.0:
            worst[output.name] = float(np.sqrt(np.mean((seen - expected[:, k]) ** 2))) / size
    assert len(worst) > 100
    largest = max(worst, key=lambda name: worst[name])
    assert worst[largest] < 1e-3, (largest, worst[largest])
