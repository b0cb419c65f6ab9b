"""Controllers written as a Python class with `reset()` and `step(t, measurements) -> commands`.
The core calls a copy of it at every sample of a run; what goes wrong in it ends that run, with name and time."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from klingel.control.basics import Timing
from klingel.control.diagram import Diagram
from klingel.errors import InputError, Problem, nearest
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle

Commands = Mapping[str, float] | Sequence[float]


class Stepped(Protocol):
    """What you write."""

    def reset(self) -> object:
        """Forgets everything; called once before the first step of a run."""
        ...

    def step(self, t: float, measurements: dict[str, float], /) -> Commands:
        """Commands for the measurements at the time t since the start of the run [s], all in SI units.

        By name, or in the order in which they are declared.
        """
        ...


@dataclass(frozen=True)
class PythonController:
    """A strategy that is a Python object: `step` is called once a sample, its commands held until the next.

    controller: with `reset()` and `step(t, measurements)`; every run has a copy of its own (`copy.deepcopy`), so that
    several may run at once; sample_time [s]: a multiple of the integrator's step; measurements: channels that it reads;
    commands: inputs that it drives, such as `bogie1.wheelset1.actuator_left.force` [N] or
    `bogie1.wheelset1.left.armature_voltage` [V]; inputs that are not named keep their values of the operating point;
    probes: more numbers that `step` gives, recorded under these names with these units; name: in messages, that of the
    class if not given.
    As with every controller, commands act one sample after the measurements they were made from. There are no steady
    states and linear models of it: where you need those, write it as blocks (`Composed`) or as a `DiscreteController`.
    Errors: InputError.

    >>> class Damper:
    ...     def reset(self): ...
    ...     def step(self, t, measurements):
    ...         return {"bogie1.wheelset1.actuator_left.force": -1e5 * measurements["bogie1.yaw_rate"]}
    >>> strategy = PythonController(
    ...     Damper(), sample_time="2 ms", measurements=["bogie1.yaw_rate"],
    ...     commands=["bogie1.wheelset1.actuator_left.force"])
    >>> strategy.name, strategy.sample_time
    ('Damper', 0.002)
    """

    controller: Stepped
    sample_time: Quantity = field(kw_only=True)
    measurements: Sequence[str] = field(kw_only=True)
    commands: Sequence[str] = field(kw_only=True)
    probes: Mapping[str, str] = field(kw_only=True, default_factory=dict)
    name: str = field(kw_only=True, default="")

    def __post_init__(self) -> None:
        made: dict[str, Any] = {
            "sample_time": to_si(self.sample_time, "s", key="sample_time"),
            "measurements": names(self.measurements, "measurements"),
            "commands": names(self.commands, "commands"),
            "probes": dict(self.probes),
            "name": self.name or type(self.controller).__name__,
        }
        for key, value in made.items():
            object.__setattr__(self, key, value)
        if problems := list(self._problems()):
            raise InputError(problems)

    def _problems(self) -> Iterator[Problem]:
        if inspect.isclass(self.controller):
            yield Problem("controller", self.controller, "is a class", f"give an object: {self.controller.__name__}()")
        for method in ("reset", "step"):
            if not callable(getattr(self.controller, method, None)):
                remedy = "write a class with reset() and step(t, measurements)"
                yield Problem("controller", self.controller, f"has no method {method}", remedy)
        if not self.sample_time > 0.0:  # type: ignore[operator]
            yield Problem("sample_time", self.sample_time, "must be positive [s]", "give a value above zero")
        if not self._outputs:
            yield Problem("commands", self.commands, "are none", "name at least one command or probe")

    @property
    def _outputs(self) -> tuple[str, ...]:
        return (*self.commands, *self.probes)

    @property
    def timing(self) -> Timing:
        """Its sampling; delays are its own affair."""
        assert isinstance(self.sample_time, float)
        return Timing(self.sample_time, 0, 0)

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """Measurements, one external block, commands and probes."""
        d = Diagram(sample_time=self.timing.sample_time)
        inputs = [d.measure(channel) for channel in self.measurements]
        signals = d.external(self.name, inputs, [f"{self.name}.{output}" for output in self._outputs])
        for target, signal in zip(self.commands, signals, strict=False):
            d.command(target, signal)
        for (channel, unit), signal in zip(self.probes.items(), signals[len(self.commands) :], strict=True):
            d.probe(channel, unit, signal)
        return d.spec()

    def externals(self) -> dict[str, Called]:
        """A copy of the controller for one run, as the core calls it, by the name of its block.

        Errors: InputError for one that cannot be copied.
        """
        try:
            own = copy.deepcopy(self.controller)
        except Exception as error:  # whatever the parts of someone's object raise
            message = f"cannot be copied for a run ({type(error).__name__}: {error})"
            remedy = "make what it holds in reset(), or give it a __deepcopy__"
            raise InputError.single("controller", self.name, message, remedy=remedy) from error
        return {self.name: Called(own, tuple(self.measurements), self._outputs)}


class Called:
    """A controller as the core calls it: numbers in the declared orders in and out.

    >>> class Twice:
    ...     def reset(self): ...
    ...     def step(self, t, measurements): return {"out": 2.0 * measurements["in"]}
    >>> Called(Twice(), ("in",), ("out",)).step(0.0, [3.0])
    [6.0]
    """

    def __init__(self, controller: Stepped, measurements: tuple[str, ...], outputs: tuple[str, ...]) -> None:
        self._controller = controller
        self._measurements = measurements
        self._outputs = outputs

    def reset(self) -> None:
        """Before the first step."""
        self._controller.reset()

    def step(self, time: float, inputs: Sequence[float]) -> list[float]:
        """Errors: InputError for names missing or not declared; TypeError, ValueError for what is no number."""
        given = self._controller.step(time, dict(zip(self._measurements, inputs, strict=True)))
        if not isinstance(given, Mapping):
            return [float(value) for value in given]
        if given.keys() != set(self._outputs):
            raise InputError(self._misnamed(given))
        return [float(given[name]) for name in self._outputs]

    def _misnamed(self, given: Mapping[str, float]) -> Iterator[Problem]:
        for name in self._outputs:
            if name not in given:
                yield Problem(
                    f"command {name}", None, "is missing from what step() returned", "give every one declared"
                )
        for name in given:
            if name not in self._outputs:
                yield Problem(f"command {name}", None, "is not declared", nearest(name, self._outputs))


def names(given: Sequence[str], key: str) -> tuple[str, ...]:
    """Names of channels or inputs, each once; errors: InputError."""
    if isinstance(given, str) or not all(isinstance(name, str) for name in given):
        raise InputError.single(key, given, "is no list of names", remedy=f"give {key}=[...]")
    if twice := [name for i, name in enumerate(given) if name in given[:i]]:
        raise InputError.single(key, twice[0], "is named twice", remedy="name it once")
    return tuple(given)
