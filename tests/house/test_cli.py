"""The command line: exit codes, one clear message, nothing half-written, Ctrl-C."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import klingel as kl
from klingel import cli

SCENARIO = """
vehicle = "manchester_coach"
speed = "108 km/h"
creep_law = "polach"
duration = "0.2 s"
track.straight = "{length}"
"""


def write(folder: Path, text: str = SCENARIO, length: str = "200 m") -> Path:
    path = folder / "my.toml"
    path.write_text(text.replace("{length}", length))
    return path


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["--version"]) == 0
    assert capsys.readouterr().out == f"klingel {kl.__version__}\n"


@pytest.mark.parametrize("arguments", [["study", "nope"], ["nope"], ["study"], ["run"], ["--nope"]])
def test_unknown_words_exit_with_2(arguments: list[str]) -> None:
    assert cli.run(arguments) == 2


def test_study_has_a_command_a_study(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["study", "perez2004", "--help"]) == 0
    assert "--out" in capsys.readouterr().out


def test_vehicles(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["vehicles"]) == 0
    assert "mechatronic_irw" in capsys.readouterr().out
    assert cli.run(["vehicles", "manchester_coach"]) == 0
    assert "body.mass" in capsys.readouterr().out


def test_doctor_finds_this_checkout_in_order(capsys: pytest.CaptureFixture[str]) -> None:
    code = cli.run(["doctor"])
    out = capsys.readouterr().out
    assert code == 0, out
    assert "library/manchester_coach" in out


def test_run_saves_a_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["run", str(write(tmp_path))]) == 0
    assert "completed" in capsys.readouterr().out
    assert kl.load(tmp_path / "my.nc").attrs["outcome"] == "completed"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("speed", "sped"), "did you mean 'speed'?"),
        (("108 km/h", "108 kg"), "is a mass"),
        (("108 km/h", "-10 km/h"), "must not be negative"),
        (("manchester_coach", "manchester"), "manchester_coach"),
        (("200 m", "200 kg"), "track.straight"),
    ],
)
def test_bad_input_is_one_message_and_exit_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: tuple[str, str], said: str
) -> None:
    path = write(tmp_path, SCENARIO.replace("{length}", "200 m").replace(*change))
    assert cli.run(["run", str(path)]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert "my.toml" in message
    assert "Traceback" not in message
    assert [p.name for p in tmp_path.iterdir()] == ["my.toml"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('"108 km/h"', '"900 km/h"'), "is more than the motor gives"),
        (("mechatronic_irw", "manchester_coach"), "which manchester_coach lacks; take mechatronic_irw"),
        (('"0.2 s"', '"0.2 s"\nstep = "5 ms"'), "step = 0.005: does not divide"),
    ],
)
def test_what_the_vehicle_cannot_do_names_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: tuple[str, str], said: str
) -> None:
    text = SCENARIO.replace("manchester_coach", "mechatronic_irw") + '[control]\nstrategy = "irw_like"\n'
    path = write(tmp_path, text.replace(*change))
    assert cli.run(["run", str(path)]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert "my.toml: " in message
    assert message.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["my.toml"]


def test_missing_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["run", str(tmp_path / "none.toml")]) == 2
    assert "no such file" in capsys.readouterr().err


@pytest.mark.parametrize("module", ["klingel.cli.app", "klingel.cli.progress", "klingel.scenario"])
def test_ctrl_c_during_the_imports(tmp_path: Path, module: str) -> None:
    interrupt = f"""
import sys

class Interrupted:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupted())
from klingel.cli import main
main()
"""
    command = [sys.executable, "-W", "ignore", "-c", interrupt, "run", str(write(tmp_path))]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60.0, check=False)
    assert ended.returncode == 130
    assert ended.stderr == "cancelled\n"


@pytest.mark.parametrize("kept", [["1 of 4 runs are kept in out"], []])
def test_ctrl_c_says_what_a_study_keeps(
    kept: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt(*kept)

    monkeypatch.setattr("klingel.study.perez2004.run", interrupted)
    assert cli.run(["study", "perez2004"]) == 130
    assert capsys.readouterr().err == ": ".join(["cancelled", *kept]) + "\n"


def test_ctrl_c_ends_a_run_cleanly(tmp_path: Path) -> None:
    path = write(tmp_path, SCENARIO.replace('"0.2 s"', '"300 s"').replace("polach", "fastsim"), length="10 km")
    command = [sys.executable, "-W", "ignore", "-c", "from klingel.cli import main; main()", "run", str(path)]
    # A job of a shell's background inherits a SIGINT that is ignored; a person at a terminal does not.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env={**os.environ, "COLUMNS": "80"})
    finally:
        signal.signal(signal.SIGINT, before)
    time.sleep(4.0)
    assert run.poll() is None
    run.send_signal(signal.SIGINT)
    _, message = run.communicate(timeout=60.0)
    assert run.returncode == 130
    assert "cancelled" in message
    assert [p.name for p in tmp_path.iterdir()] == ["my.toml"]
