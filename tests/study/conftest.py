"""Fixtures of the study's tests: the synthetic runs, importable by their short name.
The tests share no state; every fixture is a function that makes a fresh run."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest


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
