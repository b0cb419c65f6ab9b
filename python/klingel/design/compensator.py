"""Compensators by synthesis on a reduced plant, LQG and H-infinity loop shaping, and what they do on the full vehicle.
Riccati equations by scipy; closed loop and norm are always computed again. Derivations: docs/theory/design.md."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_are, solve_discrete_lyapunov

from klingel.design.check import Check, check
from klingel.design.loops import of_model
from klingel.design.margins import COLUMNS, margins_of_all, row
from klingel.design.opening import STEERING, Weights, attached, base, cut
from klingel.design.synthesis import closed_of, delayed, growth_of, integrating, norm_of, robust, series, solved
from klingel.errors import InputError
from klingel.linear.model import LinearModel
from klingel.linear.reduce import hankel_values, reduced
from klingel.linear.sweep import Linearised
from klingel.scenario import Scenario
from klingel.units import Quantity

if TYPE_CHECKING:
    import pandas as pd

    import control

Real = NDArray[np.float64]

SAMPLE_TIME = 1e-3
"""[s]"""

BOUND = 0.01
"""Part of the largest Hankel value that the error bound of a reduction may have where no order is given."""

CONICITIES = (None, 0.05, 0.4)
FRICTIONS = (0.3,)
"""Of the check that every synthesis makes by itself."""


@dataclass(frozen=True, eq=False)
class Compensator:
    """A sampled compensator, from measurements to commands, one sample from one to the other.

    a, b, c, d: z+ = a z + b y, put out a sample later: c z + d y, in SI; measurements: channels y; commands: name to
    the inputs that it drives with their weights; order, left_out, bound: of the reduced plant, states of vehicle and
    other controllers left out, bound of the reduction's error (largest singular value, signals in their sizes);
    promised, norm: what the synthesis promised and what the closed loop on the reduced plant has, gamma or the cost of
    LQG; reduced_growth [1/s]: of that loop; full: rows of `klingel.design.margins` on the full vehicle where it was
    designed; check: over speed, conicity, friction and curves.
    """

    method: str
    a: Real
    b: Real
    c: Real
    d: Real
    sample_time: float
    measurements: tuple[str, ...]
    commands: Weights
    order: int
    left_out: int
    bound: float
    promised: float
    norm: float
    reduced_growth: float
    full: pd.DataFrame
    check: Check

    @property
    def driven(self) -> tuple[str, ...]:
        """Inputs of the vehicle that `system` drives, in the order of its outputs."""
        return tuple(name for weights in self.commands.values() for name in weights)

    @property
    def system(self) -> control.StateSpace:
        """As python-control's sampled StateSpace from `measurements` to `driven`, departures from the operating point.

        `klingel.control.DiscreteController(found.system, measurements=found.measurements, commands=found.driven)` runs
        it where the scenario had no other strategy.
        """
        import control

        E = _expansion(self.commands)
        return control.ss(self.a, self.b, E @ self.c, E @ self.d, self.sample_time)

    def words(self) -> tuple[str, ...]:
        """The verdict in sentences: reduction, closed loop on the reduced plant, on the full vehicle, over the grid."""
        told = [
            f"{self.method} on {self.order} states; {self.left_out} were left out, which changes the plant by at most"
            f" {self.bound:.2g} in the sizes of its signals.",
            f"Promised {self.promised:.3g}, found {self.norm:.3g} on the reduced plant.",
        ]
        if len(self.full):
            if not self.full["stable"].all():
                told.append("The full vehicle is unstable with it where it was designed.")
            else:
                least = self.full.sort_values("disk").iloc[0]
                told.append(
                    f"On the full vehicle the least disk margin is {least['disk']:.2f}, of {least['loop']}: gain"
                    f" {least['gain']:.2f}, phase {math.degrees(least['phase']):.0f}°, delay"
                    f" {1e3 * least['delay']:.1f} ms."
                )
        return (*told, *self.check.words())


def _expansion(commands: Weights) -> Real:
    """From commands to the inputs that they drive."""
    rows = [(j, weight) for j, weights in enumerate(commands.values()) for weight in weights.values()]
    E = np.zeros((len(rows), len(commands)))
    for i, (j, weight) in enumerate(rows):
        E[i, j] = weight
    return E


class Compensated:
    """Linearises scenarios with a compensator around them, one after the other, as `klingel.linear.sweep.Sweep`."""

    def __init__(self, made: Made, *, at: Quantity | None = None) -> None:
        self.made = made
        self.at = at

    def __call__(self, scenario: Scenario) -> Linearised:
        """Errors: as `klingel.linearise`."""
        made = self.made
        opened = base(scenario, made.commands, made.sample_time, at=self.at)
        return opened._replace(model=attached(opened.model, made.commands, made.measurements, made.K))


class Made(NamedTuple):
    """A compensator as a synthesis makes it: a, b, c, d; what it was promised to reach, and what was found."""

    K: tuple[Real, Real, Real, Real]
    commands: Weights
    measurements: tuple[str, ...]
    sample_time: float
    promised: float
    norm: float
    reduced_growth: float


class Reduced(NamedTuple):
    """The plant of a synthesis, signals in their sizes: A, B, C, D sampled; outputs first measured, then regulated."""

    A: Real
    B: Real
    C: Real
    D: Real
    left_out: int
    bound: float


def reduce_plant(
    model: LinearModel, commands: Weights, command_size: float, outputs: Mapping[str, float], order: int | None
) -> Reduced:
    """A closed model with its commands cut, in the sizes of its signals, with fewer states.

    outputs: channel to its size; order: None for the least whose error bound is a hundredth of the largest Hankel
    value. Errors: InputError.
    """
    for name, size in (("command_size", command_size), *outputs.items()):
        if not size > 0.0:
            raise InputError.single(name, size, "must be positive", remedy="give the size of the signal in SI units")
    plant = cut(model, commands, list(outputs))
    sizes = dict.fromkeys(commands, command_size) | dict(outputs)
    if order is None:
        kept, hankel = hankel_values(plant, scales=sizes)
        tails = 2.0 * np.append(np.cumsum(hankel[::-1])[::-1], 0.0)
        order = kept + int(np.argmax(tails <= BOUND * hankel[0]))
    small, bound = reduced(plant, order, scales=sizes)
    y = np.array([outputs[signal.name] for signal in small.outputs])
    return Reduced(
        small.A,
        small.B * command_size,
        small.C / y[:, None],
        small.D * command_size / y[:, None],
        len(model.A) - len(small.A),
        bound,
    )


def lqg(
    scenario: Scenario,
    *,
    regulated: Mapping[str, float],
    measurements: Mapping[str, float],
    command_size: float,
    commands: Weights = STEERING,
    order: int | None = None,
    sample_time: float = SAMPLE_TIME,
) -> Compensator:
    """The compensator with the least mean square of outputs and commands, for straight track at the scenario's speed.

    scenario: with the strategy whose other commands go on, or without one; regulated: channel to the size that counts
    as much as command_size of every command; measurements: channel to the r.m.s. of its white noise [per sample];
    commands: name to the inputs that it drives with their weights, steering of all wheelsets if not given; what
    disturbs comes in beside the commands, white and of their size; order: of the reduced plant, None for the least
    whose error bound is a hundredth of its largest Hankel value.
    Errors: InputError; SimulationError without a steady state.
    """
    outputs = dict(measurements) | {name: size for name, size in regulated.items() if name not in measurements}
    model = base(scenario, commands, sample_time).model
    plant = reduce_plant(model, commands, command_size, outputs, order)
    m = len(measurements)
    places = [list(outputs).index(name) for name in regulated]
    ratio = np.array([outputs[name] / regulated[name] for name in regulated])[:, None]
    A, B, C, D = plant.A, plant.B, plant.C[:m], plant.D[:m]
    Cz, Dz = plant.C[places] * ratio, plant.D[places] * ratio
    R, N = np.eye(B.shape[1]) + Dz.T @ Dz, Cz.T @ Dz
    X = solved(solve_discrete_are, A, B, Cz.T @ Cz, R, s=N)
    K = np.linalg.solve(R + B.T @ X @ B, B.T @ X @ A + N.T)
    P = solved(solve_discrete_are, A.T, C.T, B @ B.T, np.eye(m))
    L = np.linalg.solve((C @ P @ C.T + np.eye(m)).T, (A @ P @ C.T).T).T
    a = A - B @ K - L @ (C - D @ K)
    promised = float(np.trace(X @ B @ B.T) + np.trace(P @ K.T @ (R + B.T @ X @ B) @ K))
    closed = np.block([[A, -B @ K], [L @ C, a + L @ D @ (-K) + L @ D @ K]])
    noise = np.block([[B @ B.T, np.zeros_like(A)], [np.zeros_like(A), L @ L.T]])
    seen = np.hstack((Cz, -Dz @ K))
    used = np.hstack((np.zeros_like(K), -K))
    covariance = solve_discrete_lyapunov(closed, noise)
    found = float(np.trace(seen @ covariance @ seen.T) + np.trace(used @ covariance @ used.T))
    y = np.array([measurements[name] for name in measurements])
    made = Made(
        K=(a, L / y, -command_size * K @ a, -command_size * K @ L / y),
        commands=commands,
        measurements=tuple(measurements),
        sample_time=sample_time,
        promised=promised,
        norm=found,
        reduced_growth=growth_of(closed, sample_time),
    )
    return _judged("LQG", scenario, made, plant)


def loop_shaping(
    scenario: Scenario,
    *,
    measurements: Mapping[str, float],
    command_size: float,
    integral: float | None = None,
    commands: Weights = STEERING,
    order: int | None = None,
    sample_time: float = SAMPLE_TIME,
) -> Compensator:
    """The most robust compensator of a shaped plant by H-infinity, a sample of delay included (McFarlane, Glover 1992).

    measurements: channel to its size: of as much, command_size of the command is worth its while, which sets the
    bandwidth; integral: frequency below which the compensator integrates [Hz], None for none; the rest as `lqg`.
    gamma is 1.1 times its least value, which two Riccati equations give without a search; 1/gamma is the part of the
    shaped plant, numerator or denominator, that may be wrong at any frequency.
    Errors: InputError; SimulationError without a steady state.
    """
    model = base(scenario, commands, sample_time).model
    plant = reduce_plant(model, commands, command_size, measurements, order)
    k = len(commands)
    weight = integrating(k, integral, sample_time)
    shaped = series(delayed(plant.A, plant.B, plant.C, plant.D), weight)
    K, promised = robust(*shaped, sample_time)
    norm = norm_of(shaped, K)
    whole = series(weight, K)
    y = np.array([measurements[name] for name in measurements])
    made = Made(
        K=(whole[0], whole[1] / y, command_size * whole[2], command_size * whole[3] / y),
        commands=commands,
        measurements=tuple(measurements),
        sample_time=sample_time,
        promised=promised,
        norm=norm,
        reduced_growth=growth_of(closed_of(shaped, K), sample_time),
    )
    return _judged("H-infinity loop shaping", scenario, made, plant)


def _judged(method: str, scenario: Scenario, made: Made, plant: Reduced) -> Compensator:
    """With what it does on the full vehicle."""
    import pandas as pd

    found = of_model(Compensated(made)(scenario).model)
    rows = [row(loop, edge) for loop, edge in zip(found, margins_of_all(found), strict=True)]
    looked = check(scenario, conicities=CONICITIES, frictions=FRICTIONS, linearised=lambda at: Compensated(made, at=at))
    a, b, c, d = made.K
    return Compensator(
        method=method,
        a=a,
        b=b,
        c=c,
        d=d,
        sample_time=made.sample_time,
        measurements=made.measurements,
        commands=made.commands,
        order=len(plant.A),
        left_out=plant.left_out,
        bound=plant.bound,
        promised=made.promised,
        norm=made.norm,
        reduced_growth=made.reduced_growth,
        full=pd.DataFrame(rows, columns=["loop", "kind", "speed", *COLUMNS]),
        check=dataclasses.replace(looked, name=method),
    )
