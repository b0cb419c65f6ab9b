"""Fixtures of the study's tests: the synthetic runs, importable by their short name, and a stand-in for the simulator.
The tests share no state; every fixture is a function that makes a fresh run."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from klingel import result


@pytest.fixture(scope="session")
def synthetic() -> ModuleType:
    """The maker of synthetic runs beside this file."""
    location = Path(__file__).with_name("synthetic.py")
    spec = importlib.util.spec_from_file_location("klingel_tests_synthetic", location)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


class Watch:
    """A stand-in for the core's progress object."""

    def __init__(self):
        self.fraction = 0.0
        self.cancelled = False

    def cancel(self):
        self.cancelled = True


@pytest.fixture
def simulated(synthetic, monkeypatch):
    """Replaces the simulator; returns the scenarios that were asked for."""
    asked = []

    def simulate(scenario, *, progress):
        asked.append(scenario)
        progress.fraction = 1.0
        active = scenario.control is not None
        radius = 1.0 / max(abs(c) for segment in scenario.track.segments for c in segment.curvature)
        k = 1.0 if active else 4.0
        shapes = {
            "bogie1.wheelset1.y": lambda t: 1.5e-3 * k * np.exp(-((t - 5.0) ** 2)),
            "bogie1.wheelset1.yaw": 1e-3 * k,
            "bogie1.wheelset1.left.Y": -22e3,
            "bogie1.wheelset1.left.tgamma": 250.0 * k,
        }
        settings = {"speed": scenario.speed, "friction": scenario.friction, "active": active}
        return synthetic.run(shapes, radius=radius, **settings)

    monkeypatch.setattr(result, "simulate", simulate)
    monkeypatch.setattr(result, "progress", Watch)
    return asked
