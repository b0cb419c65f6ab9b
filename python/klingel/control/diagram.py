"""Builder of the core's sampled block diagrams: each method adds one block and returns the name of its signal.
Only names and numbers here; the laws of the blocks, and every check, are the core's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from klingel.control.discrete import Section
from klingel.errors import InputError

Gain = float | str
"""A number, or the name of the signal that carries it."""

Matrix = Sequence[Sequence[float]] | NDArray[np.float64]
"""A matrix by rows."""

BEYOND = 1e12
"""Larger than any signal in SI units: a limit that is none."""


class Diagram:
    """A block diagram under construction, blocks in execution order.

    >>> d = Diagram(sample_time=1e-3)
    >>> speed = d.measure("body.speed")
    >>> error = d.sum("error", {speed: -1.0}, bias=30.0)
    >>> d.command("hold.force", d.saturation("force", error, -10.0, 10.0))
    >>> [block["kind"] for block in d.spec()["blocks"]]
    ['sum', 'saturation']
    """

    def __init__(self, *, sample_time: float) -> None:
        self.sample_time = sample_time
        self._measurements: list[str] = []
        self._blocks: list[dict[str, Any]] = []
        self._commands: list[dict[str, str]] = []
        self._probes: list[dict[str, str]] = []

    def measure(self, channel: str) -> str:
        """The signal of a channel of the plant (SI units)."""
        if channel not in self._measurements:
            self._measurements.append(channel)
        return channel

    def has(self, name: str) -> bool:
        """Whether a block of this name exists."""
        return any(block["name"] == name for block in self._blocks)

    def clock(self) -> str:
        """The time since the start of the run [s]."""
        return "clock" if self.has("clock") else self._add("clock", "clock")

    def sum(self, name: str, terms: Mapping[str, Gain], *, bias: float = 0.0) -> str:
        """bias + sum of gain times signal."""
        rows = [{"signal": signal, "gain": gain} for signal, gain in terms.items()]
        return self._add("sum", name, terms=rows, bias=bias)

    def product(self, name: str, *factors: str) -> str:
        """The product of signals."""
        return self._add("product", name, factors=list(factors))

    def quotient(self, name: str, numerator: str, denominator: str, *, floor: float) -> str:
        """numerator / denominator, the denominator's magnitude not below `floor`."""
        return self._add("quotient", name, numerator=numerator, denominator=denominator, floor=floor)

    def filter(self, name: str, signal: str, sections: Sequence[Section]) -> str:
        """A chain of discrete second-order sections."""
        rows = [{"b": list(section.b), "a": list(section.a)} for section in sections]
        return self._add("filter", name, input=signal, sections=rows)

    def pi(
        self,
        name: str,
        error: str,
        *,
        proportional: Gain,
        integral: Gain,
        limit: Gain | None = None,
        within: tuple[Gain, Gain] | None = None,
    ) -> str:
        """PI controller; its output stays within +-limit, or `within` two limits, and does not wind up there."""
        lower, upper = within or (None, limit)
        if isinstance(limit, str):
            lower = self.sum(f"{name}.lower", {limit: -1.0})
        elif limit is not None:
            lower = -limit
        return self._add(
            "pi", name, input=error, proportional=proportional, integral=integral, lower=lower, upper=upper
        )

    def saturation(self, name: str, signal: str, lower: Gain, upper: Gain) -> str:
        """The signal held between two limits."""
        return self._add("saturation", name, input=signal, lower=lower, upper=upper)

    def larger(self, name: str, one: str, other: str) -> str:
        """The larger of two signals."""
        return self._add("saturation", name, input=one, lower=other, upper=BEYOND)

    def smaller(self, name: str, one: str, other: str) -> str:
        """The smaller of two signals."""
        return self._add("saturation", name, input=one, lower=-BEYOND, upper=other)

    def rate_limit(self, name: str, signal: str, rate: float) -> str:
        """The signal, followed no faster than a rate [its unit/s] up and down."""
        return self._add("rate_limit", name, input=signal, rising=rate, falling=rate)

    def delay(self, name: str, signal: str, samples: int) -> str:
        """The signal some samples ago; the signal itself for none. Errors: InputError for what is no such number."""
        check_samples(samples, f"{name}.samples")
        return self._add("delay", name, input=signal, samples=int(samples)) if samples else signal

    def state_space(
        self,
        name: str,
        inputs: Sequence[str],
        outputs: Sequence[str],
        a: Matrix,
        b: Matrix,
        c: Matrix,
        d: Matrix,
    ) -> tuple[str, ...]:
        """x+ = a x + b u, y = c x + d u of several signals; the signals of its outputs.

        a: (n, n); b: (n, inputs); c: (outputs, n); d: (outputs, inputs); no pole at z = 1, use `pi`.

        >>> d = Diagram(sample_time=1e-3)
        >>> both = [d.measure("body.speed"), d.measure("body.yaw_rate")]
        >>> d.state_space("lag", both, ["slow"], [[0.9]], [[0.1, 0.2]], [[1.0]], [[0.0, 0.0]])
        ('slow',)
        """
        rows = {key: [[float(x) for x in row] for row in m] for key, m in zip("abcd", (a, b, c, d), strict=True)}
        self._add("state_space", name, inputs=list(inputs), outputs=list(outputs), **rows)
        return tuple(outputs)

    def quantise(self, name: str, signal: str, step: float) -> str:
        """The multiple of a step nearest to a signal; in linear models and steady states the signal itself."""
        return self._add("quantise", name, input=signal, step=step)

    def noise(self, name: str, std: float, seed: int) -> str:
        """White Gaussian noise of a standard deviation; in linear models and steady states nil.

        Every draw is made from the seed (0 or above) and the number of its sample alone: runs repeat bit by bit.
        """
        return self._add("noise", name, std=std, seed=seed)

    def hold(self, name: str, signal: str, samples: int) -> str:
        """A signal as it was at the last sample whose number is a multiple of `samples`.

        In linear models the mean over as many samples, which does not depend on when they are taken.
        """
        return self._add("hold", name, input=signal, samples=samples)

    def external(self, name: str, inputs: Sequence[str], outputs: Sequence[str], samples: int = 1) -> tuple[str, ...]:
        """A controller outside the core, called every so many samples, its outputs held in between.

        It goes with the spec into the run, `simulate_spec(spec, externals={name: controller})`; `PythonController`
        does all of it.
        """
        self._add("external", name, inputs=list(inputs), outputs=list(outputs), samples=samples)
        return tuple(outputs)

    def lookup(self, name: str, signal: str, x: Sequence[float], y: Sequence[float], *, edge: str = "hold") -> str:
        """Linear interpolation of y(x); outside, the end value (`hold`) or an outcome of the run (`error`)."""
        points = {"x": [float(v) for v in x], "y": [float(v) for v in y]}
        return self._add("lookup", name, input=signal, **points, interpolation="linear", edge=edge)

    def command(self, target: str, signal: str) -> None:
        """Drives an input of the plant with a signal."""
        self._commands.append({"target": target, "signal": signal})

    def probe(self, channel: str, unit: str, signal: str) -> None:
        """Records a signal with the results."""
        self._probes.append({"channel": channel, "unit": unit, "signal": signal})

    def spec(self) -> dict[str, Any]:
        """The core's control spec."""
        return {
            "sample_time": self.sample_time,
            "measurements": list(self._measurements),
            "blocks": list(self._blocks),
            "commands": list(self._commands),
            "probes": list(self._probes),
        }

    def _add(self, kind: str, name: str, **values: Any) -> str:
        self._blocks.append({"kind": kind, "name": name, **values})
        return name


def check_samples(samples: object, key: str) -> None:
    """Errors: InputError for what is no whole number of samples, 0 or more."""
    if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)) or samples < 0:
        raise InputError.single(key, samples, "is no number of samples", remedy="give a whole number, 0 or more")
