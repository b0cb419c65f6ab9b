"""The cache of contact tables: kept, read back, replaced when damaged, shared by processes, switched off."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ASK = """
from klingel.contact import Profile, WheelRailPair
pair = WheelRailPair(Profile.s1002(), Profile.rail_60e1(), rail_inclination=0.05, gauge=1.437, flange_back=1.36,
                     radius=0.45, normal="hertz")
first = pair.prepare()
force = pair.contact(2e-3, wheel_load=4e4)["pressure"].tolist()
print(first.origin, pair.prepare().origin, first.unkept is None, force)
"""


def start(cache: object) -> subprocess.Popen[str]:
    environment = os.environ | {"KLINGEL_CACHE": str(cache)}
    return subprocess.Popen([sys.executable, "-c", ASK], env=environment, stdout=subprocess.PIPE, text=True)


def ask(cache: object) -> tuple[str, str]:
    """(where the table came from and whether it was kept, what it gives)."""
    return said(start(cache))


def said(process: subprocess.Popen[str]) -> tuple[str, str]:
    out, _ = process.communicate(timeout=120)
    assert process.returncode == 0
    head, _, values = out.partition("[")
    return head.strip(), values


def test_tables_are_kept_and_replaced_when_damaged(tmp_path: Path) -> None:
    first = ask(tmp_path / "new")
    assert first[0] == "compiled compiled True"
    (table,) = (tmp_path / "new").glob("*.table")
    assert ask(tmp_path / "new") == ("disk disk True", first[1])
    whole = table.read_bytes()
    table.write_bytes(whole[:-8] + b"\0\0\0\1\0\0\0\0")
    assert ask(tmp_path / "new") == ("compiled compiled True", first[1])
    assert table.read_bytes() == whole


def test_processes_that_compile_at_once_leave_one_whole_table(tmp_path: Path) -> None:
    both = [start(tmp_path), start(tmp_path)]
    answers = [said(process) for process in both]
    assert answers[0][1] == answers[1][1]
    assert [path.suffix for path in tmp_path.iterdir()] == [".table"]
    assert ask(tmp_path)[0] == "disk disk True"


@pytest.mark.parametrize("cache", ["off", "/dev/null/folder"])
def test_without_a_cache_tables_are_compiled(cache: str) -> None:
    assert ask(cache)[0] == f"compiled compiled {cache == 'off'}"
