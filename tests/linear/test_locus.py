"""Root loci: branches that cross, split and join; sweeps of real vehicles; the command."""

from pathlib import Path

import numpy as np
import pytest

import klingel as kl
from klingel import cli
from klingel.errors import InputError
from klingel.linear.locus import follow, root_locus
from klingel.linear.model import LinearModel, Signal
from klingel.linear.modes import modes


def model(A: np.ndarray) -> LinearModel:
    n = len(A)
    empty = np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0))
    signals = tuple(Signal(f"x{i}", "") for i in range(n))
    return LinearModel("by hand", 1.0, signals, (), (), A, *empty, np.zeros(n), np.zeros(0), np.zeros(0))


def oscillator(omega: float, zeta: float) -> np.ndarray:
    return np.array([[0.0, 1.0], [-(omega**2), -2.0 * zeta * omega]])


def pair(first: np.ndarray, second: np.ndarray, coupling: float = 0.0) -> np.ndarray:
    return np.block([[first, coupling * np.eye(2)], [coupling * np.eye(2), second]])


def test_branches_cross() -> None:
    """Two oscillators whose frequencies cross keep their shapes, and so their branches."""
    values = np.linspace(0.0, 1.0, 21)
    branches = follow(model(pair(oscillator(10.0 + 5.0 * p, 0.05), oscillator(15.0 - 5.0 * p, 0.05))) for p in values)
    assert branches.shape == (2, 21)
    slopes = np.sign(np.diff(np.abs(branches)))
    assert all((slope == slope[0]).all() for slope in slopes)
    assert slopes[0, 0] != slopes[1, 0]


def test_weakly_coupled_branches_cross_too_when_the_steps_are_wide() -> None:
    values = np.linspace(0.0, 1.0, 12)
    coupling = 1e-3
    made = (model(pair(oscillator(10.0 + 5.0 * p, 0.05), oscillator(15.0 - 5.0 * p, 0.08), coupling)) for p in values)
    branches = follow(made)
    assert np.ptp(-branches.real / np.abs(branches), axis=1).max() < 1e-3


def test_a_pair_becomes_two_real_eigenvalues() -> None:
    branches = follow(model(oscillator(3.0, zeta)) for zeta in np.linspace(0.5, 1.5, 11))
    assert branches.shape == (2, 11)
    alone = np.isnan(branches).any(axis=0)
    assert alone[:5].all()  # the lower half of the pair is left out
    assert not alone[6:].any()
    assert np.all(np.abs(branches[:, 6:].imag) < 1e-9)


def scenario(name: str = "manchester_coach") -> kl.Scenario:
    control = kl.control.IRWLike() if name == "mechatronic_irw" else None
    return kl.Scenario(kl.library.vehicle(name), kl.Track.straight("1 km"), speed=40.0, control=control)


def test_over_speed() -> None:
    locus = root_locus(scenario(), "speed", ["100 km/h", 35.0, 40.0, 45.0])
    assert locus.values == pytest.approx([27.7777778, 35.0, 40.0, 45.0])
    assert (locus.unit, locus.speed) == ("m/s", None)
    rows = locus.table()
    assert list(rows.columns) == ["speed", "branch", "name", "real", "imag", "frequency", "damping"]
    assert len(rows) == 4 * len(locus.names)
    now = rows[(rows["speed"] == 40.0) & rows["real"].notna()]
    for mode in modes(scenario()):
        off = np.abs(now["real"] + 1j * now["imag"] - mode.eigenvalue).min()
        assert off < 1e-6 * (1.0 + abs(mode.eigenvalue)), mode.name
    hunting = [
        i for i, name in enumerate(locus.names) if name == "bogie hunting, in phase" and locus.damping[2, i] < 0.5
    ]
    assert len(hunting) == 1
    assert (np.diff(locus.frequency[:, hunting[0]]) > 0.0).all()


@pytest.mark.parametrize(
    ("vehicle", "parameter", "values"),
    [
        ("manchester_coach", "conicity", [0.05, 0.08, 0.11]),
        ("manchester_coach", "friction", [0.2, 0.3, 0.4]),
        ("manchester_coach", "vehicle.yaw_damper.damping", ["100 kN s/m", "200 kN s/m"]),
        ("mechatronic_irw", "control.frequency", ["1.2 Hz", "1.6 Hz", "2 Hz"]),
    ],
)
def test_over_other_parameters(vehicle: str, parameter: str, values: list[float | str]) -> None:
    steps: list[tuple[int, int]] = []
    locus = root_locus(scenario(vehicle), parameter, values, step=lambda done, count: steps.append((done, count)))
    assert locus.eigenvalues.shape == (len(values), len(locus.names))
    assert locus.speed == 40.0
    assert steps[-1] == (len(values), len(values))
    moved = np.abs(np.diff(locus.eigenvalues, axis=0))
    assert np.nanmax(moved / (1.0 + np.abs(locus.eigenvalues[1:]))) > 1e-4
    assert np.isfinite(locus.eigenvalues).any(axis=0).all()


def test_refuses() -> None:
    with pytest.raises(InputError, match=r"did you mean 'vehicle\.body\.mass'"):
        root_locus(scenario(), "vehicle.body.mas", [1.0])
    with pytest.raises(InputError, match="holds no value"):
        root_locus(scenario(), "speed", [])
    with pytest.raises(InputError, match="is a mass"):
        root_locus(scenario(), "speed", ["3 kg"])


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, rows = tmp_path / "locus.svg", tmp_path / "locus.csv"
    options = [
        "--vehicle",
        "manchester_coach",
        "--without",
        "yaw_damper",
        "--from",
        "30 m/s",
        "--to",
        "60 m/s",
        "--points",
        "4",
    ]
    assert cli.run(["rootlocus", *options, "--out", str(out), "--table", str(rows)]) == 0
    assert "bogie hunting" in capsys.readouterr().out
    assert out.read_bytes().startswith(b"<?xml")
    assert rows.read_text().startswith("speed,branch,name,real,imag,frequency,damping")


@pytest.mark.parametrize(
    ("options", "first", "last"),
    [
        (["--vehicle", "mechatronic_irw", "--control", "irw_like"], 15.0, 80.0),
        (["--vehicle", "manchester_coach"], 15.0, 80.0),
        (["--vehicle", "manchester_coach", "--speed", "40 m/s", "--parameter", "friction"], 0.175, 0.7),
        (["--vehicle", "manchester_coach", "--speed", "40 m/s", "--parameter", "friction", "--to", "0.3"], 0.175, 0.3),
    ],
)
def test_command_without_a_range(tmp_path: Path, options: list[str], first: float, last: float) -> None:
    rows = tmp_path / "locus.csv"
    written = ["--points", "2", "--out", str(tmp_path / "locus.png"), "--table", str(rows)]
    assert cli.run(["rootlocus", *options, *written]) == 0
    values = np.unique(np.loadtxt(rows, delimiter=",", skiprows=1, usecols=0))
    assert values == pytest.approx([first, last])


def test_command_refuses_a_range_of_one_value(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["rootlocus", "--vehicle", "manchester_coach", "--from", "40 m/s", "--to", "40 m/s"]) == 2
    assert "is the first value too" in capsys.readouterr().err
