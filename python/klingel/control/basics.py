"""What every part of a controller shares: the measured speed and gains scheduled over it, sampling, the wheelsets.
Wheelsets are named as in the results: bogie1.wheelset1 leads, bogie2.wheelset2 trails."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from klingel.control.diagram import Diagram, check_samples
from klingel.errors import InputError

SPEED = "body.speed"
SPEED_GRID = tuple(float(v) for v in np.geomspace(5.0, 100.0, 25))
"""Speeds [m/s] of the gain schedules; below and above, the gain of the last one."""


@dataclass(frozen=True)
class Timing:
    """sample_time [s]; delays in samples: sensors of the signals fed back, computation of the commands.

    Errors: InputError for what is no time above zero, or no whole number of samples.
    """

    sample_time: float = 1e-3
    sensor_samples: int = 1
    computation_samples: int = 1

    def __post_init__(self) -> None:
        check_positive(self, ("sample_time",), key="control.timing")
        for name in ("sensor_samples", "computation_samples"):
            check_samples(getattr(self, name), f"control.timing.{name}")


@dataclass(frozen=True)
class Wheelset:
    """Place of a wheelset; `lead` is +1 for the leading one of its bogie, -1 for the trailing one."""

    bogie: int
    number: int

    @property
    def lead(self) -> float:
        return 1.0 if self.number == 1 else -1.0

    @property
    def bogie_name(self) -> str:
        return f"bogie{self.bogie}"

    @property
    def name(self) -> str:
        return f"bogie{self.bogie}.wheelset{self.number}"


WHEELSETS = tuple(Wheelset(bogie, number) for bogie in (1, 2) for number in (1, 2))


def scheduled(d: Diagram, name: str, gain: Callable[[float], float]) -> str:
    """The signal of a gain scheduled over the measured speed; made once."""
    return name if d.has(name) else d.lookup(name, d.measure(SPEED), SPEED_GRID, [gain(v) for v in SPEED_GRID])


def check_unused(owner: Any, names: Sequence[str]) -> None:
    """Errors: InputError naming an inherited parameter that was given although this strategy has no use for it."""
    for parameter in dataclasses.fields(owner):
        default = parameter.default
        if parameter.name in names and (value := getattr(owner, parameter.name)) != default:
            message = f"does nothing in {type(owner).__name__}"
            raise InputError.single(f"control.{parameter.name}", value, message, remedy="leave it out")


def check_positive(owner: object, names: Sequence[str], *, key: str = "control") -> None:
    """Errors: InputError naming the parameter of a strategy that is no number or not above zero."""
    for name in names:
        value = getattr(owner, name)
        if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
            remedy = "give a plain number in SI; only scenario files take strings with units here"
            raise InputError.single(f"{key}.{name}", value, "is no number", remedy=remedy)
        if not value > 0.0:
            raise InputError.single(f"{key}.{name}", value, "must be positive", remedy="give a value above zero")
