"""Klingel: simulator and design bench for mechatronic railway vehicles.
Names are resolved on first use, so that `import klingel` stays quick."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from klingel.doctor import warn_if_stale

if TYPE_CHECKING:
    from klingel import assess, contact, control, design, drives, library, linear, plot, report, study, track
    from klingel.linear import linearise
    from klingel.result import load, progress, save, simulate, simulate_spec
    from klingel.scenario import Scenario
    from klingel.track import Track
    from klingel.vehicle import Vehicle

__version__ = "0.1.0"

_MODULES = ("assess", "contact", "control", "design", "drives", "library", "linear", "plot", "report", "study", "track")

_HOMES = {
    "Scenario": "klingel.scenario",
    "Track": "klingel.track",
    "Vehicle": "klingel.vehicle",
    "linearise": "klingel.linear",
    "load": "klingel.result",
    "progress": "klingel.result",
    "save": "klingel.result",
    "simulate": "klingel.result",
    "simulate_spec": "klingel.result",
}

__all__ = [
    "Scenario",
    "Track",
    "Vehicle",
    "__version__",
    "assess",
    "contact",
    "control",
    "design",
    "drives",
    "library",
    "linear",
    "linearise",
    "load",
    "plot",
    "progress",
    "report",
    "save",
    "simulate",
    "simulate_spec",
    "study",
    "track",
]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(f"klingel.{name}")
    if name in _HOMES:
        return getattr(importlib.import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'klingel' has no attribute {name!r}; it has {', '.join(__all__)}")


def __dir__() -> list[str]:
    return sorted(__all__)


warn_if_stale()
