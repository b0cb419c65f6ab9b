"""Pairs in use: the command and its page, measured profiles and options in scenarios, what they lower to."""

from pathlib import Path

import numpy as np
import pytest

import klingel as kl
from klingel import cli
from klingel.cli.profile import slope
from klingel.contact import CreepOptions, Profile
from klingel.errors import InputError
from klingel.lower import lower
from klingel.scenario import Scenario


def written(folder: Path, profile: Profile, name: str) -> Path:
    """A profile as a file of measured points in millimetres."""
    path = folder / name
    rows = "\n".join(f"{y * 1e3:.6f},{z * 1e3:.6f}" for y, z in zip(profile.y[::4], profile.z[::4], strict=True))
    path.write_text(f"# measured\ny_mm,z_mm\n{rows}\n")
    return path


def test_page_and_pictures_of_a_pair(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    measured = written(tmp_path, Profile.rail_54e1(), "rail.csv")
    page = tmp_path / "pair.html"
    assert cli.run(["profile", "--rail", str(measured), "--normal", "hertz", "--out", str(page)]) == 0
    assert "S1002 on" in (said := capsys.readouterr().out)
    assert "contact table" in said
    html = page.read_text()
    assert html.count("<svg") == 6
    assert "Equivalent conicity (EN 15302)" in html
    assert "http" not in html.replace("http://www.w3.org", "").replace("https://www.w3.org", "")
    picture = tmp_path / "pair.png"
    assert cli.run(["profile", "--rail", str(measured), "--normal", "hertz", "--out", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--wheel", "S1003"], "did you mean 'S1002'"),
        (["--rail", "nothing.csv"], "no such file"),
        (["--inclination", "steep"], "is no slope"),
        (["--out", "pair.pdf"], "is no page or picture"),
        (["--out", "nowhere/pair.html"], "has no folder"),
        (["--gauge", "1435"], "gauge"),
        (["--normal", "round"], "is not known"),
        (["--load", "50 mm"], "load"),
    ],
)
def test_bad_options_say_what_to_do(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.run(["profile", "--normal", "hertz", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_slopes() -> None:
    assert slope("1:40") == slope("1/40") == slope("0.025") == 0.025


FILE = """
vehicle = "manchester_coach"
speed = "108 km/h"
rail = "rail.csv"
wheel = "wheel.csv"
contact = "kik_piotrowski"
creep_law = "fastsim"
track.straight = "300 m"
[creep_options]
blended = false
falling = [0.4, 0.6]
"""


def test_scenario_files_take_measured_profiles_and_options(tmp_path: Path) -> None:
    written(tmp_path, Profile.rail_60e1(), "rail.csv")
    written(tmp_path, Profile.s1002(), "wheel.csv")
    (tmp_path / "run.toml").write_text(FILE)
    scenario = Scenario.read(tmp_path / "run.toml")
    assert scenario.creep_options == CreepOptions(blended=False, falling=(0.4, 0.6))
    spec = lower(scenario)
    pair = spec["contact_pairs"][0]
    assert pair["normal"] == "kik_piotrowski"
    assert np.allclose(np.interp(0.0, pair["wheel"]["points"]["y"], pair["wheel"]["points"]["z"]), 0.0, atol=1e-7)
    assert len(pair["rail"]["points"]["y"]) > 500
    assert spec["creep"]["falling"] == [0.4, 0.6]
    assert spec["creep"]["blended"] is False
    assert lower(scenario.replace(creep_options=CreepOptions()))["creep"]["blended"] is True
    assert lower(scenario.replace(creep_law="polach", creep_options=CreepOptions()))["creep"]["blended"] is False


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('rail = "rail.csv"', 'rail = "wheel.csv"', "this is a wheel profile"),
        ('wheel = "wheel.csv"', 'wheel = "missing.csv"', "no such file"),
        ("blended = false", "blend = false", "did you mean 'blended'"),
        ("falling = [0.4, 0.6]", "falling = [0.4]", "is no set of 2 numbers"),
        ('contact = "kik_piotrowski"', 'contact = "kik"', "contact = 'kik': is not known"),
        ('rail = "rail.csv"', 'rail = ["60E1"]', "rail = ['60E1']: is not known"),
    ],
)
def test_bad_scenario_files(tmp_path: Path, old: str, new: str, said: str) -> None:
    written(tmp_path, Profile.rail_60e1(), "rail.csv")
    written(tmp_path, Profile.s1002(), "wheel.csv")
    assert old in FILE
    (tmp_path / "run.toml").write_text(FILE.replace(old, new))
    with pytest.raises(InputError) as refused:
        Scenario.read(tmp_path / "run.toml")
    assert said in str(refused.value)


def test_options_of_another_law_are_refused_by_the_core() -> None:
    track = kl.Track.straight("300 m")
    vehicle = kl.library.vehicle("manchester_coach")
    scenario = Scenario(
        vehicle, track, speed=30.0, creep_law="linear", creep_options=CreepOptions(reduction=(0.5, 0.3)), duration=0.1
    )
    with pytest.raises(kl.errors.SimulationError, match="polach"):
        kl.simulate(scenario)


@pytest.mark.parametrize("law", ["shen_hedrick_elkins", "polach", "fastsim"])
def test_falling_friction_reaches_the_wheels(law: str) -> None:
    track = kl.Track.curve(radius="300 m", cant="160 mm", transition="70 m", arc="60 m", straight_before="30 m")
    scenario = Scenario(
        kl.library.vehicle("manchester_coach"), track, speed="108 km/h", creep_law=law, step="1 ms", duration=3.0
    )
    plain, constant, falling = (
        kl.simulate(scenario.replace(creep_options=CreepOptions(falling=given)))
        for given in (None, (1.0, 0.6), (0.4, 0.6))
    )
    assert plain.attrs["outcome"] == constant.attrs["outcome"] == falling.attrs["outcome"] == "completed"
    force = "bogie1.wheelset1.left.X"
    np.testing.assert_allclose(constant[force], plain[force], rtol=1e-6, atol=1e-3)
    assert abs(float((falling[force] - plain[force])[-1])) > 10.0
