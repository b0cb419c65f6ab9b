"""`klingel contact-table`: parts are kept and taken up again, damage is made good, the built-in table is checked."""

import hashlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from klingel import cli, doctor
from klingel.cli import table_check
from klingel.cli.contact_table import Shape
from klingel.cli.table_parts import Parts
from klingel.contact.table import compare_with_exact, creep_table, header
from klingel.core import core
from klingel.errors import SimulationError

QUICK = Shape(0.28, "8x8", "4x4x4x2")
"""A table as coarse as can be: a second's work."""


def make(folder: Path, *more: str) -> int:
    arguments = ["--elements", QUICK.elements, "--intervals", str(QUICK.intervals)]
    places = ["--out", str(folder / "out.bin"), "--work", str(folder / "work")]
    return cli.run(["contact-table", *arguments, *places, *more])


def test_a_table_is_made_once_and_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert make(tmp_path) == 0
    said = capsys.readouterr().out
    content = (tmp_path / "out.bin").read_bytes()
    head, _, numbers = content.partition(b"\n\n")
    assert head.startswith(b"klingel creep table")
    made = header(content)
    assert (made["poisson"], made["coarse"], made["fine"]) == ("0.28", "4 4", "8 8")
    before = head[: head.index(b"checksum: ")]
    assert made["checksum"] == hashlib.sha256(before + numbers).hexdigest()
    assert made["checksum"] in said
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.bin", "work"]

    assert make(tmp_path) == 0
    found = re.search(r"(\d+) of (\d+) parts found", capsys.readouterr().out)
    assert found is not None
    assert found[1] == found[2]
    assert (tmp_path / "out.bin").read_bytes() == content


def test_damaged_and_misplaced_parts_are_solved_anew(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert make(tmp_path) == 0
    content = (tmp_path / "out.bin").read_bytes()
    files = sorted((tmp_path / "work").rglob("*.part"))
    whole = [file.read_bytes() for file in files]
    files[0].write_bytes(whole[0][:-8] + b"\0\0\0\1\0\0\0\0")
    files[1].write_bytes(whole[1][:50])
    files[2].write_bytes(whole[0])
    files[3].unlink()
    capsys.readouterr()
    assert make(tmp_path) == 0
    said = capsys.readouterr().out
    assert f"{len(files) - 4} of {len(files)} parts found" in said
    assert "3 damaged, to be solved anew: 0000.part, 0001.part, 0002.part" in said
    assert (tmp_path / "out.bin").read_bytes() == content
    assert [file.read_bytes() for file in files] == whole


def test_parts_of_another_table_are_left_alone(tmp_path: Path) -> None:
    keys = {Shape(poisson, *rest).maker().key for poisson in (0.28, 0.3) for rest in (("8x8", None), ("16x8", None))}
    assert len(keys | {QUICK.maker().key}) == 5
    parts = Parts(QUICK.maker(), tmp_path / "one")
    parts.solve(0)
    assert parts.solved[0].shape == (parts.maker.part_len(0), 3)
    np.testing.assert_array_equal(Parts(QUICK.maker(), tmp_path / "one").solved[0], parts.solved[0])
    other = Parts(Shape(0.3, "8x8", QUICK.intervals).maker(), tmp_path / "one")
    assert (other.solved, other.damaged) == ({}, [0])


def test_the_core_refuses_parts_that_do_not_belong(tmp_path: Path) -> None:
    maker = QUICK.maker()
    for wrong in (lambda: maker.solve(maker.parts), lambda: maker.finish([np.zeros((4, 3))])):
        with pytest.raises(core().CoreError):
            wrong()
    with pytest.raises(core().CoreError, match="three numbers"):
        maker.finish([np.zeros((4, 2))])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--elements", "40"], "elements = '40': is not 2 whole numbers of up to four digits; give them as 12x16"),
        (["--elements", "41x40"], "not an even number"),
        (["--intervals", "12x16x40"], "is not 4 whole numbers"),
        (["--intervals", "12x16x400000000000000000000x22"], "is not 4 whole numbers of up to four digits"),
        (["--intervals", "12x16x4000x22"], "4000 intervals are not an even number up to 100; take 100"),
        (["--poisson", "0.7"], "0.7 is outside 0 to 0.5"),
        (["--out", "{folder}"], "is a folder"),
        (["--out", "{folder}/none/table.bin"], "has no folder to be written to"),
        (["--work", "{file}/work"], "--work"),
    ],
)
def test_bad_options_are_one_message_and_exit_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    (tmp_path / "file").touch()
    places = {"folder": str(tmp_path), "file": str(tmp_path / "file")}
    assert make(tmp_path, *(text.format(**places) for text in arguments)) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_parts_go_into_the_cache_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["contact-table", "--elements", "8x8", "--intervals", "4x4x4x2", "--out", str(tmp_path / "out.bin")]
    monkeypatch.setenv("KLINGEL_CACHE", "off")
    assert cli.run(command) == 2
    assert "no cache folder" in capsys.readouterr().err
    monkeypatch.setenv("KLINGEL_CACHE", str(tmp_path / "cache"))
    assert cli.run(command) == 0
    assert [p.name for p in (tmp_path / "cache" / "creep-table").iterdir()] == [QUICK.maker().key]


def test_ctrl_c_keeps_what_is_solved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--elements", "20x20", "--out", str(tmp_path / "out.bin"), "--work", str(tmp_path / "work")]
    program = "from klingel.cli import main; main()"
    # A job of a shell's background inherits a SIGINT that is ignored; a person at a terminal does not.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        command = [sys.executable, "-W", "ignore", "-c", program, "contact-table", *options]
        environment = {**os.environ, "COLUMNS": "80"}
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment)
    finally:
        signal.signal(signal.SIGINT, before)
    until = time.monotonic() + 60.0
    while not list((tmp_path / "work").rglob("[0-9]*.part")) and time.monotonic() < until:
        time.sleep(0.1)
    assert run.poll() is None
    run.send_signal(signal.SIGINT)
    _, message = run.communicate(timeout=60.0)
    assert run.returncode == 130
    kept = len(list((tmp_path / "work").rglob("*.part")))
    assert f"cancelled: {kept} of " in message
    assert "the same command goes on with them" in message
    assert [p.name for p in tmp_path.iterdir()] == ["work"]


def test_a_patch_without_solution_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def fail(parts: Parts, part: int) -> None:
        raise core().CoreError("residual 1 after 2 steps")

    monkeypatch.setattr(Parts, "solve", fail)
    assert make(tmp_path) == 1
    assert not (tmp_path / "out.bin").exists()


def test_the_built_in_table_is_near_exact_theory(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["contact-table", "--check"]) == 0
    said = capsys.readouterr().out
    table = creep_table()
    assert table.check_sum in said
    assert f"{table.elements[0]} x {table.elements[1]} elements" in said
    assert "spin alone, a/b 25: differences RMS" in said


@pytest.mark.parametrize("compared", ["compare_with_exact", "compare_pure_spin"])
def test_a_table_too_far_from_exact_theory_fails(monkeypatch: pytest.MonkeyPatch, compared: str) -> None:
    for name in ("compare_with_exact", "compare_pure_spin"):
        rows = compare_with_exact(2)
        rows["error"] = [0.0, 0.03 if name == compared else 0.001]
        monkeypatch.setattr(table_check, name, lambda *_, rows=rows: rows)
    with pytest.raises(SimulationError, match=r"differs from exact theory by 3.0 % of mu N, allowed are 2 %"):
        table_check.check_built_in(print)


def test_the_check_refuses_options_of_making(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["contact-table", "--check", "--elements", "20x20", "--poisson", "0.3"]) == 2
    said = capsys.readouterr().err
    assert "elements = '20x20': does not go with --check; leave it out" in said
    assert "poisson" in said


def test_the_doctor_knows_the_table(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def found() -> doctor.Finding:
        return next(finding for finding in doctor.examine() if finding.what == "creep table")

    assert found().good
    assert "a/b 1/36 to 36" in found().found
    assert creep_table().check_sum[:12] in found().found
    data = tmp_path / "crates" / "physics" / "data"
    data.mkdir(parents=True)
    (data / "creep_table.bin").write_bytes(b"klingel creep table 1\nchecksum: 0\n\n")
    for name in ("Cargo.toml", "Cargo.lock"):
        (tmp_path / name).touch()
    monkeypatch.setattr(doctor, "checkout", lambda: tmp_path)
    assert not found().good
    assert "make build" in found().found
