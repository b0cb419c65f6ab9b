"""The README keeps its word: its commands exist and come in order, its Python example runs."""

import re
import textwrap
from pathlib import Path

import matplotlib as mpl
import pytest

import klingel as kl

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()


def test_the_first_two_commands_stand_alone() -> None:
    commands = [line.strip() for line in README.splitlines() if line.strip().startswith("make ")]
    assert commands[:2] == ["make study", "make test"]
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
    assert {"build", "study", "test"} <= set(targets)


def test_the_python_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mpl.use("Agg")
    monkeypatch.chdir(tmp_path)
    example = README.split("## In Python")[1].split("Plain numbers")[0]
    # Polach's law instead of FASTSIM: the same calls in a fraction of the time.
    quick = textwrap.dedent(example).replace('speed="176 km/h"', 'speed="176 km/h", creep_law="polach"')
    names: dict[str, object] = {}
    exec(compile(quick, "README.md", "exec"), names)
    assert kl.load("run.nc").attrs["outcome"] == "completed"
