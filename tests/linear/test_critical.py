"""Critical speeds: the search on known curves, the coach without yaw dampers, its limit cycle in the simulator."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import cli
from klingel.errors import InputError
from klingel.linear.critical import CriticalSpeed, critical_speed, least_stable
from klingel.linear.limit_cycle import RECORD, _lowest_cycle, bifurcation, envelope, run_at, sustained
from klingel.linear.model import LinearModel, Signal
from klingel.linear.sweep import Sweep

Values = np.ndarray[tuple[int], np.dtype[np.float64]]


def scenario(speed: float = 40.0) -> kl.Scenario:
    """The coach without its yaw dampers, with a quick creep law."""
    tables = kl.library.vehicle("manchester_coach").model_dump(exclude_none=True)
    vehicle = kl.Vehicle.from_tables({key: value for key, value in tables.items() if key != "yaw_damper"})
    return kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=speed, creep_law="polach")


def diagonal(*values: complex) -> LinearModel:
    blocks = [np.array([[v.real, v.imag], [-v.imag, v.real]]) if v.imag else np.array([[v.real]]) for v in values]
    n = sum(len(b) for b in blocks)
    A, at = np.zeros((n, n)), 0
    for block in blocks:
        A[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    empty = np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0))
    signals = tuple(Signal(f"x{i}", "") for i in range(n))
    return LinearModel("by hand", 1.0, signals, (), (), A, *empty, np.zeros(n), np.zeros(0), np.zeros(0))


def test_what_decides_on_stability() -> None:
    assert least_stable(diagonal(-1 + 5j, -0.2 + 8j, -0.01 + 0j)) == pytest.approx(-0.2 + 8j)
    assert least_stable(diagonal(-1 + 5j, 0.3 + 0j)) == pytest.approx(0.3 + 0j)


@pytest.fixture(scope="module")
def linear() -> CriticalSpeed:
    return critical_speed(scenario(), lowest="60 m/s", highest="90 m/s", points=7)


def test_linear_critical_speed_of_the_coach_without_yaw_dampers(linear: CriticalSpeed) -> None:
    assert linear.outcome == "found"
    assert linear.speed is not None
    assert 70.0 < linear.speed < 82.0
    assert linear.mode.name.startswith("bogie hunting")
    assert 5.0 < linear.frequency < 8.0
    sweep = Sweep()
    below, above = (least_stable(sweep(scenario(linear.speed + dv)).model).real for dv in (-0.01, 0.01))
    assert below < 0.0 < above
    assert (np.diff(linear.growth[-3:]) > 0.5).all()
    assert list(linear.table().columns) == ["speed", "growth", "damping", "frequency"]


def test_with_yaw_dampers_the_coach_is_stable_throughout() -> None:
    coach = kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("1 km"), speed=40.0)
    found = critical_speed(coach, lowest=40.0, highest=90.0, points=3)
    assert (found.outcome, found.speed) == ("stable throughout", None)


def test_the_simulator_agrees_on_both_sides(linear: CriticalSpeed) -> None:
    """Small motion dies a little below the linear critical speed and grows a little above it, at the rates foretold."""
    assert linear.speed is not None
    for off in (-4.0, 4.0):
        speed = linear.speed + off
        run = run_at(scenario(), speed, duration=6.0, kick=1e-3)
        expected = least_stable(Sweep()(scenario(speed)).model)
        y = run["bogie1.wheelset1.y"].to_numpy()[round(2.0 / RECORD) :]
        # the envelope of an oscillation: its largest values within half seconds
        each = round(0.5 / RECORD)
        tops = np.abs(y[: len(y) // each * each].reshape(-1, each)).max(axis=1)
        growth = np.polyfit(0.5 * np.arange(len(tops)), np.log(tops), 1)[0]
        assert growth == pytest.approx(expected.real, abs=0.25), speed


def dataset(y: Values, speed: Values) -> xr.Dataset:
    time = RECORD * np.arange(len(y))
    wheel = {"a.wheelset.left.Q": ("time", np.ones_like(y)), "a.wheelset.y": ("time", y)}
    return xr.Dataset(wheel | {"body.speed": ("time", speed)}, coords={"time": time})


def test_envelope_and_rest() -> None:
    t = RECORD * np.arange(round(12.0 / RECORD))
    wave = np.sin(2.0 * np.pi * 5.0 * t)
    steady = dataset(4e-3 * wave + 1e-3, 70.0 - t)
    speeds, amplitudes = envelope(steady)
    assert amplitudes == pytest.approx(np.full(12, 4e-3), rel=0.01)
    assert speeds == pytest.approx(70.0 - (np.arange(12) + 0.5), abs=0.01)
    assert sustained(steady) == pytest.approx(4e-3, rel=0.01)
    assert sustained(dataset(4e-3 * np.exp(-0.3 * t) * wave, 70.0 + 0.0 * t)) == 0.0
    assert sustained(dataset(1e-5 * wave, 70.0 + 0.0 * t)) == 0.0


@pytest.mark.parametrize("dies", [30.0, 58.0, 61.0, 75.0])
def test_the_lowest_cycle_is_found_from_wherever_the_run_died(dies: float) -> None:
    edge = _lowest_cycle(lambda speed: speed >= 60.3, dies, 80.0, 20.0, 0.5)
    assert edge is not None
    assert 60.3 <= edge <= 60.8


def test_a_vehicle_that_never_hunts_has_no_edge() -> None:
    assert _lowest_cycle(lambda speed: False, 40.0, 80.0, 20.0, 0.5) is None


def test_bifurcation_of_the_coach(linear: CriticalSpeed) -> None:
    said: list[str] = []
    found = bifurcation(
        scenario(), linear=linear, lowest="65 m/s", deceleration="2 m/s^2", resolution="4 m/s", step=said.append
    )
    assert found.speed is not None
    assert linear.speed is not None
    assert found.speed <= linear.speed + 4.0
    assert found.amplitudes[0] > 3e-3
    assert found.amplitudes[-1] < found.amplitudes.max()
    hunts = found.table().set_index("speed")["hunts"]
    assert hunts[found.speed]
    assert any("slows down" in line for line in said)


def test_a_driven_vehicle_is_swept_from_below_its_base_speed() -> None:
    track = kl.Track.straight("1 km")
    driven = kl.Scenario(kl.library.vehicle("mechatronic_irw"), track, speed=40.0, control=kl.control.IRWLike())
    found = critical_speed(driven, highest="60 m/s", points=2)
    assert found.speeds == pytest.approx([10.0, 60.0])
    assert found.outcome == "stable throughout"


def test_refuses() -> None:
    with pytest.raises(InputError, match="must exceed the lowest speed"):
        critical_speed(scenario(), lowest="50 m/s", highest="40 m/s")
    with pytest.raises(InputError, match="make no sweep"):
        critical_speed(scenario(), points=1)


def test_bifurcation_refuses(linear: CriticalSpeed) -> None:
    stable = dataclasses.replace(linear, outcome="stable throughout", speed=None)
    with pytest.raises(InputError, match="begin: has no default: the vehicle is stable throughout"):
        bifurcation(scenario(), linear=stable)
    with pytest.raises(InputError, match=r"begin = 9\.0: must exceed the lowest speed 10 m/s"):
        bifurcation(scenario(), linear=stable, begin="9 m/s")


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, rows = tmp_path / "critical.png", tmp_path / "critical.csv"
    options = ["--vehicle", "manchester_coach", "--without", "yaw_damper", "--lowest", "60 m/s", "--highest", "90 m/s"]
    assert cli.run(["critical-speed", *options, "--out", str(out), "--table", str(rows)]) == 0
    said = capsys.readouterr().out
    assert "bogie hunting" in said
    assert "km/h" in said
    assert out.stat().st_size > 20_000
    assert rows.read_text().startswith("speed,growth,damping,frequency")


def test_command_without_a_range(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--vehicle", "mechatronic_irw", "--control", "irw_like", "--highest", "60 m/s"]
    assert cli.run(["critical-speed", *options, "--out", str(tmp_path / "c.png")]) == 0
    assert "stable throughout" in capsys.readouterr().out
    assert cli.run(["critical-speed", *options, "--nonlinear", "--out", str(tmp_path / "c.png")]) == 2
    assert "begin: has no default" in capsys.readouterr().err
