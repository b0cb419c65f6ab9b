"""Loops of a strategy on the exact sampled linear model of the whole vehicle, each opened alone, all others closed.
One Schur form of the closed model serves all loops and all frequencies: S = 1 + c (z I - A)^-1 b, L = 1/S - 1."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.errors import InputError
from klingel.linear.blocks import eigenvalues, lives
from klingel.linear.halves import Halves, Part, parts
from klingel.linear.model import LinearModel, Signal
from klingel.linear.response import Resolvent, points
from klingel.linear.sweep import Sweep
from klingel.scenario import Scenario
from klingel.units import Quantity

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

Kind = Literal["steering", "motors", "traction", "field", "secondary", "other"]

PUT_OUT = ".put_out"
"""End of the names of a closed model's states that hold the commands put out."""

SILENT = 1e-7
"""Largest |L| of a combination of commands that nothing feeds back, such as the mean of motors that are held."""

LISTENED = (0.01, 0.1, 1.0, 5.0, 30.0)
"""Frequencies at which a combination is heard for a loop, those below half the sample rate [Hz]."""

SIDE = re.compile(r"(?<![a-z])(left|right)(?![a-z])")


class Closed:
    """A closed sampled model as all its loops see it.

    model: with its controllers; weights: inputs of the loops with what each weighs, one mapping a loop.
    """

    def __init__(self, model: LinearModel, weights: Sequence[Mapping[str, float]]) -> None:
        if model.sample_time is None:
            remedy = "give a scenario with a strategy, linearised with its controllers"
            raise InputError.single("model", model.name, "has no sampled controllers", remedy=remedy)
        self.model = model
        self.weights = tuple(weights)

    @property
    def sample_time(self) -> float:
        """Of the controllers [s]."""
        assert self.model.sample_time is not None
        return self.model.sample_time

    @cached_property
    def poles(self) -> Complex:
        """Eigenvalues of the closed model [1/s] without the bare memory of its controllers."""
        values = eigenvalues(self.model)
        return values[lives(values, self.sample_time)]

    @property
    def growth(self) -> float:
        """Largest real part of the eigenvalues [1/s]."""
        return float(self.poles.real.max())

    def gates(self) -> tuple[Real, Real]:
        """b (n, k) and c (k, n) of the loops: from what is added to the commands put out, to their weighted sum."""
        return gates(self.model, self.weights)

    @cached_property
    def _parts(self) -> list[tuple[Part, Resolvent, Real, Real]]:
        """The parts of the folded model that the loops meet."""
        b, c = self.gates()
        halves = Halves.of([state.name for state in self.model.states])
        right = c.T.copy()
        halves.fold(b)
        halves.fold(right)
        found = []
        for part in parts(halves.folded(self.model.A)):
            into, out = b[part.at] / part.scale[:, None], (right[part.at] * part.scale[:, None]).T
            if into.any() and out.any():
                found.append((part, Resolvent.of(part.matrix), into, out))
        return found

    def sensitivities(self, frequencies: ArrayLike, *, only: Sequence[int] | None = None) -> Complex:
        """(1 + L)^-1 of all loops at once, a matrix (f, k, k) at frequencies [Hz] up to half the sample rate.

        only: some of the loops, in the order given, instead of all k.
        """
        z = points(self.model, frequencies)
        some = list(range(len(self.weights))) if only is None else list(only)
        S = np.broadcast_to(np.eye(len(some), dtype=np.complex128), (len(z), len(some), len(some))).copy()
        for _, resolvent, into, out in self._parts:
            x = resolvent.solve(z, into[:, some].astype(np.complex128))
            S += np.einsum("in,nfj->fij", out[some], x)
        return S


def gates(model: LinearModel, weights: Sequence[Mapping[str, float]]) -> tuple[Real, Real]:
    """Columns b (n, k) and rows c (k, n) of combinations of the commands put out of a closed model."""
    places = {state.name: i for i, state in enumerate(model.states)}
    b, c = np.zeros((len(places), len(weights))), np.zeros((len(weights), len(places)))
    for j, combination in enumerate(weights):
        size = sum(weight**2 for weight in combination.values())
        for name, weight in combination.items():
            i = places[name + PUT_OUT]
            b[:, j] += weight * model.A[:, i]
            c[j, i] = weight / size
    return b, c


@dataclass(frozen=True, eq=False)
class Loop:
    """One loop of a strategy, opened where its commands enter the vehicle.

    name: such as `bogie1.wheelset1.steering`; kind: steering (actuators of a wheelset), motors (their half difference),
    traction (their mean), field, secondary, other; weights: input to its share in what is commanded, +1 left and -1
    right of a difference; speed: [m/s]; closed: the model that it was opened in; index: its place among the loops.
    """

    name: str
    kind: Kind
    weights: Mapping[str, float]
    speed: float
    closed: Closed
    index: int

    def response(self, frequencies: ArrayLike) -> Complex:
        """L at frequencies [Hz]: 1 + L is what is added to the command over what comes out, all other loops closed."""
        S = self.closed.sensitivities(frequencies, only=[self.index])[:, 0, 0]
        return np.asarray(1.0 / S - 1.0)

    def scaled(self, gain: float = 1.0, delay: int = 0) -> LinearModel:
        """The closed model with the gain of this loop times `gain` and its command `delay` samples later."""
        model = self.closed.model
        b, c = gates(model, [self.weights])
        n = len(model.A)
        opened = model.A - b @ c
        A = np.zeros((n + delay, n + delay))
        A[:n, :n] = opened
        if delay:
            A[n, :n] = c[0]
            A[n + 1 :, n:-1] += np.eye(delay - 1)
            A[:n, -1] = gain * b[:, 0]
        else:
            A += gain * b @ c
        return _with_states(model, A, delay)


def _with_states(model: LinearModel, A: Real, count: int) -> LinearModel:
    added = tuple(Signal(f"control.later.{i}", "1") for i in range(count))
    none = model.select(inputs=(), outputs=())
    return dataclasses.replace(
        none,
        states=model.states + added,
        A=A,
        B=np.zeros((len(A), 0)),
        C=np.zeros((0, len(A))),
        x=np.concatenate([model.x, np.zeros(count)]),
    )


def loops(scenario: Scenario | LinearModel, *, at: Quantity | None = None) -> tuple[Loop, ...]:
    """Every loop of a scenario's strategy on the full linear model; none without a strategy.

    scenario: or a closed linear model of one; at: place on its track [m] whose curve it runs through, None for straight
    level track. Errors: as `klingel.linearise`.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed="176 km/h", control=kl.control.SolidLike())
    >>> [loop.name for loop in loops(scenario)][:2]
    ['bogie1.wheelset1.steering', 'bogie1.wheelset1.motors']
    """
    model = Sweep(at=at)(scenario).model if isinstance(scenario, Scenario) else scenario
    return of_model(model)


def of_model(model: LinearModel) -> tuple[Loop, ...]:
    """The loops of a closed linear model: combinations of commands that come back to themselves."""
    if model.sample_time is None:
        return ()
    found = _candidates([s.name.removesuffix(PUT_OUT) for s in model.states if s.name.endswith(PUT_OUT)])
    listened = [f for f in LISTENED if f * model.sample_time < 0.5]
    heard = Closed(model, [weights for _, _, weights in found]).sensitivities(listened)
    loud = [j for j in range(len(found)) if np.abs(heard[:, j, j] - 1.0).max() > SILENT]
    found = [found[j] for j in loud]
    closed = Closed(model, [weights for _, _, weights in found])
    return tuple(Loop(name, kind, weights, model.speed, closed, i) for i, (name, kind, weights) in enumerate(found))


def _candidates(driven: Sequence[str]) -> list[tuple[str, Kind, dict[str, float]]]:
    """Differences and means of pairs of commands, and single ones: name, kind, weights; by place in the vehicle."""
    found: list[tuple[str, Kind, dict[str, float]]] = []
    for left in driven:
        right = SIDE.sub("right", left)
        if right == left:
            if SIDE.sub("left", left) not in driven:
                found.append((left, "other", {left: 1.0}))
        elif right in driven:
            place = left.split(".left.")[0] if ".left." in left else left.rpartition(".")[0].rpartition(".")[0]
            difference, mean = _kinds(left)
            found.append((f"{place}.{difference}", difference, {left: 1.0, right: -1.0}))
            found.append((f"{place}.{mean}", mean, {left: 1.0, right: 1.0}))
        else:
            found.append((left, "other", {left: 1.0}))
    order: list[Kind] = ["steering", "motors", "secondary", "traction", "field", "other"]
    found.sort(key=lambda each: (each[0].rpartition(".")[0], order.index(each[1])))
    return found


def _kinds(left: str) -> tuple[Kind, Kind]:
    """Of the difference and of the mean of a pair of commands, by the name of the left one."""
    if "actuator" in left:
        return ("steering", "other") if "wheelset" in left else ("secondary", "other")
    return ("other", "field") if left.endswith("field_voltage") else ("motors", "traction")
