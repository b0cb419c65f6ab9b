"""A discrete state space of python-control as a strategy, compiled into the core.
Its integrators are split off exactly into PI blocks, so that steady states and linear models know them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from klingel.control.basics import Timing
from klingel.control.diagram import Diagram
from klingel.control.own import names
from klingel.errors import InputError, Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle

Matrix = NDArray[np.float64]

AT_ONE = 1e-9
"""Singular values of A - 1, over the largest, that are nil: a pole of 1 kHz that decays in days is no integrator."""

SKEW = 1e8
"""Condition number of the modes beyond which integrators hang together: a chain, not side by side."""


class Split(NamedTuple):
    """A system with its integrators apart: w+ = w + b1 u, x+ = a x + b u, y = c x + c1 w + d u."""

    a: Matrix
    b: Matrix
    c: Matrix
    d: Matrix
    b1: Matrix
    c1: Matrix


def split(A: Matrix, B: Matrix, C: Matrix, D: Matrix) -> Split:
    """Splits off the poles at z = 1.

    The states, scaled until A is balanced, are (V, U) times new ones: V the null space of A - 1, where nothing changes
    by itself, and U its range.
    Errors: InputError for integrators of integrals, where V and U have a direction in common.

    >>> A, B, C, D = (np.array(m, dtype=float) for m in ([[1, 0.5], [0, 0.5]], [[0], [1]], [[1, 0]], [[0]]))
    >>> parts = split(A, B, C, D)
    >>> parts.a.round(9), (parts.c1 @ parts.b1).round(9)
    (array([[0.5]]), array([[1.]]))
    """
    from scipy.linalg import matrix_balance

    n = len(A)
    if n == 0:
        return Split(A, B, C, D, np.zeros((0, B.shape[1])), np.zeros((len(C), 0)))
    _, scale = matrix_balance(A, permute=False)
    balanced, inputs, outputs = np.linalg.solve(scale, A @ scale), np.linalg.solve(scale, B), C @ scale
    u, s, vt = np.linalg.svd(balanced - np.eye(n))
    rest = int((s > AT_ONE * max(float(s[0]), 1.0)).sum())
    basis = np.hstack([vt[rest:].T, u[:, :rest]])
    if np.linalg.cond(basis) > SKEW:
        remedy = "such a controller has no steady state to start from; give at most one integral of every signal"
        raise InputError.single("system", None, "has repeated poles at z = 1 in a chain", remedy=remedy)
    k = n - rest
    a, b = np.linalg.solve(basis, balanced @ basis), np.linalg.solve(basis, inputs)
    c = outputs @ basis
    return Split(a[k:, k:], b[k:], c[:, k:], D, b[:k], c[:, :k])


@dataclass(frozen=True)
class DiscreteController:
    """A strategy that is a discrete linear system: commands = u0 + K(z) (measurements - y0).

    system: python-control's StateSpace with its sample time as `dt`, one input a measurement, one output a command, in
    their orders; measurements: channels; commands: inputs of the plant; measured_at: y0, zero if not given;
    commanded_at: u0, zero if not given; name: in messages and of its states.
    Poles at z = 1 become `pi` blocks; half a sample's growth of the first measurement apart, they start from zero as
    everything else starts from where the first measurements would lead it. Inputs that are not named keep their values
    of the operating point. Errors: InputError.

    >>> import control
    >>> gain = control.ss([], [], [], [[-2e4]], 1e-3)
    >>> strategy = DiscreteController(
    ...     gain, measurements=["bogie1.yaw_rate"], commands=["bogie1.wheelset1.actuator_left.force"])
    >>> strategy.timing.sample_time
    0.001
    """

    system: Any
    measurements: Sequence[str] = field(kw_only=True)
    commands: Sequence[str] = field(kw_only=True)
    measured_at: Sequence[float] | None = field(kw_only=True, default=None)
    commanded_at: Sequence[float] | None = field(kw_only=True, default=None)
    name: str = field(kw_only=True, default="controller")

    def __post_init__(self) -> None:
        object.__setattr__(self, "measurements", names(self.measurements, "measurements"))
        object.__setattr__(self, "commands", names(self.commands, "commands"))
        if problems := list(self._problems()):
            raise InputError(problems)
        self._split()

    def _problems(self) -> Iterator[Problem]:
        if not all(hasattr(self.system, key) for key in ("A", "B", "C", "D", "dt")):
            yield Problem("system", self.system, "is no state space", "give control.ss(...) or control.tf2ss(...)")
            return
        dt = self.system.dt
        if dt is None or isinstance(dt, bool) or not dt > 0.0:
            remedy = 'give control.c2d(system, 1e-3, method="bilinear")' if dt == 0 else "give control.ss(..., dt=1e-3)"
            yield Problem("system.dt", dt, "is no sample time [s]", remedy)
        for key, asked, count, what in (
            ("measurements", self.measurements, self.system.ninputs, "inputs"),
            ("commands", self.commands, self.system.noutputs, "outputs"),
        ):
            if len(asked) != count:
                yield Problem(key, len(asked), f"are not as many as the system has {what}", f"name {count}")
        for key, values, of in (
            ("measured_at", self.measured_at, self.measurements),
            ("commanded_at", self.commanded_at, self.commands),
        ):
            if values is not None and np.shape(values) != (len(of),):
                yield Problem(key, values, "is not one number each", f"give {len(of)} numbers, or nothing for zero")
        for key in "ABCD":
            if not np.isfinite(getattr(self.system, key)).all():
                yield Problem(f"system.{key}", None, "is not finite", "check how it was made")

    @property
    def timing(self) -> Timing:
        """Its sampling; delays are among its states."""
        return Timing(float(self.system.dt), 0, 0)

    def _split(self) -> Split:
        return split(*(np.asarray(getattr(self.system, key), dtype=float) for key in "ABCD"))

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """A state space, and a `pi` block for every integrator."""
        d = Diagram(sample_time=self.timing.sample_time)
        inputs = [d.measure(channel) for channel in self.measurements]
        if self.measured_at is not None:
            inputs = [
                d.sum(f"{self.name}.from.{signal}", {signal: 1.0}, bias=-float(at))
                for signal, at in zip(inputs, self.measured_at, strict=True)
            ]
        parts = self._split()
        direct = [f"{self.name}.direct.{command}" for command in self.commands]
        d.state_space(self.name, inputs, direct, parts.a, parts.b, parts.c, parts.d)
        integrals = [self._integrator(d, i, inputs, row) for i, row in enumerate(parts.b1)]
        offsets = np.zeros(len(direct)) if self.commanded_at is None else np.asarray(self.commanded_at, dtype=float)
        for command, own, shares, offset in zip(self.commands, direct, parts.c1, offsets, strict=True):
            terms = {own: 1.0, **{name: float(share) for name, share in zip(integrals, shares, strict=True)}}
            d.command(command, d.sum(f"{self.name}.to.{command}", terms, bias=float(offset)))
        return d.spec()

    def _integrator(self, d: Diagram, i: int, inputs: Sequence[str], row: Matrix) -> str:
        """w+ = w + v by the trapezoidal rule, which adds half of v to what this one has before the sample."""
        terms = {signal: float(gain) for signal, gain in zip(inputs, row, strict=True)}
        rate = d.sum(f"{self.name}.growth{i}", terms)
        return d.pi(f"{self.name}.integral{i}", rate, proportional=-0.5, integral=1.0 / d.sample_time)
