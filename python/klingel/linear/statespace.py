"""From a scenario to its linear model: the plant, or the plant with its sampled controllers around it.
Commands are put out one sample after the measurement they were made from, as in a run."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.linalg import expm

from klingel.linear.halves import Halves, parts
from klingel.linear.model import LinearModel, Matrix, Signal
from klingel.linear.operating import solve, steady_spec
from klingel.scenario import Scenario
from klingel.units import Quantity


def linearise(scenario: Scenario, *, at: Quantity | None = None, controllers: bool = True) -> LinearModel:
    """The linear model of a scenario about steady running, exact to rounding.

    at: arc length on the scenario's track [m] whose curvature and cant are held; None for straight level track.
    controllers: with a strategy, close its loops: the model is then sampled at their sample time, inputs held between
        samples, and its states are those of the plant, of the controllers, and the commands put out. Without, the
        commands are inputs of a continuous model about the same operating point.
    Inputs: voltages [V] and actuator commands [N] (added to those of the controllers); of every wheel, how its rail
    lies off its place, `rail_y` and `rail_z` [m], with their rates, and `rail_roll` [rad]; `track.curvature` [1/m] and
    `track.cant` [m], uniform along the vehicle; `wind.y`, `wind.z` [N] and `wind.roll` [N m] on the car body;
    `hold.speed` [m/s].
    Outputs: every channel of a run. Errors: SimulationError where there is no steady state; InputError.

    >>> import klingel as kl
    >>> scenario = kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("1 km"), speed="160 km/h")
    >>> model = kl.linearise(scenario)
    >>> int((model.to_control().poles().real > 1e-6).sum())
    0
    """
    spec = steady_spec(scenario, at=at)
    return of_raw(solve(spec).linearise(), spec["name"], spec["speed"], controllers=controllers)


def of_raw(raw: dict[str, Any], name: str, speed: float, *, controllers: bool = True) -> LinearModel:
    """The model from what the core gives."""
    plant = LinearModel(
        name=name,
        speed=speed,
        states=_signals(tuple(raw["states"])),
        inputs=_signals(tuple(raw["inputs"])),
        outputs=_signals(tuple(raw["outputs"])),
        A=raw["a"],
        B=raw["b"],
        C=raw["c"],
        D=raw["d"],
        x=raw["x"],
        u=raw["u"],
        y=raw["y"],
        warnings=tuple(raw["kinks"]),
    )
    return close(plant, raw["control"]) if controllers and raw["control"] is not None else plant


@lru_cache(maxsize=12)
def _signals(named: tuple[tuple[str, str], ...]) -> tuple[Signal, ...]:
    """Names and units, which do not change along a sweep."""
    return tuple(Signal(*each) for each in named)


def held(plant: LinearModel, sample_time: float) -> tuple[Matrix, Matrix]:
    """Transition over a sample with held inputs: exp([[A, B], [0, 0]] T) = [[Phi, Gamma], [0, 1]], halves apart.

    Inputs count in units of their largest effect, or they would decide into how many parts the sample is divided.
    """
    halves = Halves.of([state.name for state in plant.states])
    A, B = halves.folded(plant.A), plant.B.copy()
    halves.fold(B)
    phi, gamma = np.zeros_like(A), np.zeros_like(B)
    for at, balanced, scale in parts(A):
        b = B[at] / scale[:, None]
        effect = np.abs(b).max(axis=0)
        acting = np.flatnonzero(effect)
        n = len(at)
        block = np.zeros((n + len(acting), n + len(acting)))
        block[:n, :n], block[:n, n:] = balanced, b[:, acting] / effect[acting]
        whole = expm(block * sample_time)[:n] * scale[:, None]
        phi[np.ix_(at, at)] = whole[:, :n] / scale
        gamma[np.ix_(at, acting)] = whole[:, n:] * effect[acting]
    halves.fold(gamma)
    return halves.folded(phi), gamma


def close(plant: LinearModel, control: dict[str, Any]) -> LinearModel:
    """The plant sampled with its controllers around it; states (x, z, v), v the commands that are put out:

    x+ = Phi x + Gamma (u + E v), y = C x + D (u + E v), z+ = a z + b S y, v+ = c z + d S y,
    with S the measured outputs and E the commanded inputs.
    """
    phi, gamma = held(plant, control["sample_time"])
    measured, driven = list(control["measured"]), list(control["driven"])
    a, b, c, d = (control[key] for key in "abcd")
    n, k, p = len(phi), len(a), len(driven)
    C, D = plant.C[measured], plant.D[measured]
    Dv = D[:, driven]
    A = np.block(
        [
            [phi, np.zeros((n, k)), gamma[:, driven]],
            [b @ C, a, b @ Dv],
            [d @ C, c, d @ Dv],
        ]
    )
    B = np.vstack([gamma, b @ D, d @ D])
    outputs = len(plant.outputs)
    z = _signals(tuple((f"control.{name}", "1") for name in control["states"]))
    v = _signals(tuple((f"{plant.inputs[i].name}.put_out", plant.inputs[i].unit) for i in driven))
    assert A.shape == (n + k + p, n + k + p)
    return dataclasses.replace(
        plant,
        states=plant.states + z + v,
        A=A,
        B=B,
        C=np.hstack([plant.C, np.zeros((outputs, k)), plant.D[:, driven]]),
        x=np.concatenate([plant.x, control["z"], plant.u[driven]]),
        sample_time=control["sample_time"],
    )
