"""The vehicle as a compensator meets it: some commands of a closed model cut and made inputs, or driven by it.
Nothing is approximated here; how the plant is reduced for a synthesis is told by its result."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from klingel.design.loops import PUT_OUT
from klingel.errors import InputError, nearest
from klingel.linear.halves import Halves, parts
from klingel.linear.model import LinearModel, Signal
from klingel.linear.operating import solve, steady_spec
from klingel.linear.statespace import close, of_raw
from klingel.linear.sweep import Linearised
from klingel.scenario import Scenario
from klingel.units import Quantity

Real = NDArray[np.float64]
Weights = Mapping[str, Mapping[str, float]]

WHEELSETS = tuple(f"bogie{i}.wheelset{j}" for i in (1, 2) for j in (1, 2))

STEERING: Weights = {
    f"{w}.steering": {f"{w}.actuator_left.force": 1.0, f"{w}.actuator_right.force": -1.0} for w in WHEELSETS
}
"""Half difference of the actuator forces of every wheelset [N]."""


def base(scenario: Scenario, commands: Weights, sample_time: float, *, at: Quantity | None = None) -> Linearised:
    """A scenario's closed model that puts out all of `commands`, nothing where its strategy has none.

    sample_time: of a scenario without controllers [s]; it must be that of the others; at: as for `klingel.linearise`.
    Errors: InputError.
    """
    spec = steady_spec(scenario, at=at)
    raw = solve(spec).linearise()
    plant = of_raw(raw, spec["name"], spec["speed"], controllers=False)
    control = raw["control"] or _nothing(sample_time)
    if abs(control["sample_time"] - sample_time) > 1e-12:
        remedy = f"take that of the strategy, {control['sample_time']:g} s"
        raise InputError.single("sample_time", sample_time, "is not the strategy's", remedy=remedy)
    names = [signal.name for signal in plant.inputs]
    driven, c, d = list(control["driven"]), np.asarray(control["c"]), np.asarray(control["d"])
    for name in (name for weights in commands.values() for name in weights):
        if name not in names:
            raise InputError.single("commands", name, "is no input", remedy=nearest(name, names))
        if names.index(name) not in driven:
            driven.append(names.index(name))
    more = len(driven) - len(c)
    c, d = np.vstack((c, np.zeros((more, c.shape[1])))), np.vstack((d, np.zeros((more, d.shape[1]))))
    return Linearised(close(plant, control | {"driven": driven, "c": c, "d": d}), plant, spec)


def _nothing(sample_time: float) -> dict[str, Any]:
    """A controller that measures and commands nothing."""
    empty = np.zeros((0, 0))
    return {"sample_time": sample_time, "measured": [], "driven": [], "states": [], "z": np.zeros(0)} | dict.fromkeys(
        "abcd", empty
    )


def cut(model: LinearModel, commands: Weights, measurements: Sequence[str]) -> LinearModel:
    """The plant that a compensator sees: commands cut and made inputs, blocks that led to them only left out.

    Of the vehicle, what the commands do not move or the measurements do not show is left out too, on straight track the
    symmetric half with the free arc length; states are combinations of the model's. Errors: InputError.
    """
    places = {state.name: i for i, state in enumerate(model.states)}
    gone = [places[name + PUT_OUT] for weights in commands.values() for name in weights]
    W = np.zeros((len(gone), len(commands)))
    row = 0
    for j, weights in enumerate(commands.values()):
        for weight in weights.values():
            W[row, j] = weight
            row += 1
    outputs = model.select(inputs=(), outputs=list(measurements))
    kept = _reach(model.A, gone, outputs.C)
    A, B, C, D = (
        model.A[np.ix_(kept, kept)],
        model.A[np.ix_(kept, gone)] @ W,
        outputs.C[:, kept],
        outputs.C[:, gone] @ W,
    )
    halves = Halves.of([model.states[i].name for i in kept])
    A, B, Ct = halves.folded(A), B.copy(), C.T.copy()
    halves.fold(B)
    halves.fold(Ct)
    met = [part for part in parts(A) if _large(B[part.at]) and _large(Ct[part.at])]
    whole = np.concatenate([part.at for part in met])
    scale = np.concatenate([part.scale for part in met])
    return dataclasses.replace(
        outputs,
        states=tuple(Signal(f"part{i}", "1") for i in range(len(whole))),
        inputs=tuple(Signal(name, "1") for name in commands),
        A=A[np.ix_(whole, whole)] / scale[:, None] * scale,
        B=B[whole] / scale[:, None],
        C=(Ct[whole] * scale[:, None]).T,
        D=D,
        x=np.zeros(len(whole)),
        u=np.zeros(len(commands)),
    )


def _large(rows: Real) -> bool:
    return bool(np.abs(rows).max(initial=0.0) > 0.0)


def _reach(A: Real, gone: Sequence[int], C: Real) -> list[int]:
    """States from which outputs are reached when some states are gone."""
    links = A.copy()
    links[:, gone] = 0.0
    shown = np.abs(C).sum(axis=0) > 0.0
    shown[gone] = False
    return _used(links, list(shown))


def attached(model: LinearModel, commands: Weights, measurements: Sequence[str], K: Sequence[Real]) -> LinearModel:
    """A closed model whose commands come from a sampled compensator: z+ = a z + b y, put out: c z + d y.

    K: a, b, c, d. The result is a closed model like any other: its loops have margins. Errors: InputError.
    """
    a, b, c, d = K
    places = {state.name: i for i, state in enumerate(model.states)}
    outputs = model.select(inputs=(), outputs=list(measurements)).C
    n, k = len(model.A), len(a)
    A = np.zeros((n + k, n + k))
    A[:n, :n] = model.A
    A[n:, :n], A[n:, n:] = b @ outputs, a
    for j, weights in enumerate(commands.values()):
        for name, weight in weights.items():
            i = places[name + PUT_OUT]
            A[i] = 0.0
            A[i, :n], A[i, n:] = weight * d[j] @ outputs, weight * c[j]
    states = model.states + tuple(Signal(f"control.compensator.{i}", "1") for i in range(k))
    kept = _used(A, [not state.name.startswith("control.") for state in states])
    none = model.select(inputs=())
    return dataclasses.replace(
        none,
        states=tuple(states[i] for i in kept),
        A=A[np.ix_(kept, kept)],
        B=np.zeros((len(kept), 0)),
        C=np.hstack((none.C, np.zeros((len(none.C), k))))[:, kept],
        x=np.concatenate([model.x, np.zeros(k)])[kept],
    )


def _used(A: Real, vehicle: Sequence[bool]) -> list[int]:
    """The vehicle's states and those of controllers that lead to them."""
    links = A != 0.0
    found = np.array(vehicle)
    new = found.copy()
    while new.any():
        new = links[new].any(axis=0) & ~found
        found |= new
    return [int(i) for i in np.flatnonzero(found)]
