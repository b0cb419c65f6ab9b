"""Tables of the commands: whole in a pipe, folded into a terminal, brackets as they are."""

import re

import pandas as pd
import pytest

from klingel import cli
from klingel.cli.output import print_rows

LONG = "motor and shaft torsion, front bogie, its second wheelset"
ROWS = pd.DataFrame({"name": [LONG] * 2, "place": ["bogie1.wheelset2.primary_damper_left"] * 2, "value": [1.5, 2.5]})
HEADS = {"name": "mode", "place": "strains most", "value": "at speed [m/s]"}


def test_a_pipe_gets_every_column_whole(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    print_rows(ROWS, HEADS, title="A title")
    lines = capsys.readouterr().out.splitlines()
    assert sum(LONG in line and ROWS["place"][0] in line for line in lines) == 2
    assert any("at speed [m/s]" in line for line in lines)
    assert "A title" in lines[0]


@pytest.mark.parametrize("columns", [60, 200])
def test_a_terminal_gets_no_longer_lines(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setenv("TERM", "xterm")
    print_rows(ROWS, HEADS, title="A title")
    out = re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out)
    assert max(len(line) for line in out.splitlines()) <= columns
    assert "…" not in out
    letters = "".join(c for c in out if c.isalnum())
    assert letters.count("torsion") == 2


def test_units_in_heads_are_no_markup(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["vehicles"]) == 0
    assert "mass [t]" in capsys.readouterr().out
