"""Scenarios: keywords and files give the same, bad ones are refused with file, key, value and remedy."""

from pathlib import Path
from typing import Any

import pytest

from klingel import control, library
from klingel.errors import InputError
from klingel.lower import lower
from klingel.scenario import Scenario
from klingel.track import Adhesion, Track

COACH = library.vehicle("manchester_coach")

FILE = """
vehicle = "mechatronic_irw"
speed = "176 km/h"
friction = 0.3
creep_elements = [10, 12]

[track.curve]
radius = "800 m"
cant = "160 mm"
transition = "195 m"
hand = "left"

[control]
strategy = "irw_like"
curvature = "database"
"""


def scenario(**changes: Any) -> Scenario:
    return Scenario(**{"vehicle": COACH, "track": Track.straight("500 m"), "speed": "108 km/h", **changes})


def read(tmp_path: Path, text: str) -> Scenario:
    path = tmp_path / "my.toml"
    path.write_text(text)
    return Scenario.read(path)


def test_file_and_keywords_agree(tmp_path: Path) -> None:
    track = Track.curve(radius="800 m", cant="160 mm", transition="195 m", hand="left")
    assert read(tmp_path, FILE) == Scenario(
        library.vehicle("mechatronic_irw"),
        track,
        speed="176 km/h",
        control=control.IRWLike(curvature="database"),
        friction=0.3,
        creep_elements=(10, 12),
    )


def test_strategy_parameters_carry_units(tmp_path: Path) -> None:
    parameters = """
frequency = "1600 mHz"
integral_time = "900 ms"
extrapolation = 1
timing = { sample_time = "0.5 ms", sensor_samples = 2 }
contact = { load = "60 kN", friction = 0.3 }
"""
    assert read(tmp_path, FILE + parameters).control == control.IRWLike(
        curvature="database",
        frequency=1.6,
        integral_time=0.9,
        extrapolation=1.0,
        timing=control.Timing(sample_time=0.5e-3, sensor_samples=2),
        contact=control.ContactDesign(load=60e3, friction=0.3),
    )
    solid = FILE.replace('"irw_like"', '"solid_like"').replace('curvature = "database"', 'coupling_speed = "144 km/h"')
    assert read(tmp_path, solid + 'lead_pole = "3 ms"\n').control == control.SolidLike(
        coupling_speed=40.0, lead_pole=3e-3
    )


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('frequency = "1.6 kg"', "control.frequency = '1.6 kg': is a mass [kg], wanted Hz; give for example '1 Hz'"),
        ('frequency = "1.6"', "control.frequency = '1.6': has no unit, wanted Hz"),
        ("frequency = true", "control.frequency = True: is no quantity [Hz]"),
        ("frequency = -1", "my.toml: control.frequency = -1.0: must be positive; give a value above zero"),
        ('extrapolation = "2 s"', "control.extrapolation = '2 s': is a time [s], wanted a pure number"),
        ("timing = 3", "control.timing = 3: is no table; give [control.timing]"),
        ("timing.sensor_samples = 1.5", "control.timing.sensor_samples = 1.5: is no whole number"),
        ("timing.computation_samples = -1", "control.timing.computation_samples = -1: is no whole number"),
        ("contact.load = 0", "control.contact.load = 0: must be positive [N]; give a value above zero"),
        ("timing.sampletime = 1", "did you mean 'sample_time'?"),
        ('frequency = []\nyaw_frequency = "2 m"', "2 problems"),
    ],
)
def test_bad_strategy_parameters(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, f"{FILE}{line}\n")
    assert said in str(refused.value)
    assert "my.toml: " in str(refused.value)


def test_strategies_made_in_python_refuse_text() -> None:
    with pytest.raises(InputError, match=r"control\.frequency = '1\.6 Hz': is no number; give a plain number in SI"):
        control.IRWLike(frequency="1.6 Hz")  # type: ignore[arg-type]


def test_other_tracks_and_a_vehicle_file(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(library.text("manchester_coach"))
    text = 'vehicle = "mine.toml"\nspeed = 30\ntrack.straight = "1 km"\n'
    assert read(tmp_path, text).track == Track.straight(1000)
    segments = 'track.segment = [{ length = "1 km" }, { length = "50 m", curvature = [0, "1/1000 1/m"] }]\n'
    track = read(tmp_path, text.replace('track.straight = "1 km"\n', segments)).track
    assert track.segments[1].curvature == (0.0, 1e-3)


def test_runs_from_end_to_end_of_the_track() -> None:
    made = scenario()
    assert made.start == pytest.approx(12.78)
    assert made.start + made.end_time * made.speed == pytest.approx(500 - 12.78)
    assert made.replace(duration="2 s").end_time == 2.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"speed": 0}, "duration: is missing"),
        ({"speed": "-3 m/s"}, "speed = -3.0: must not be negative"),
        ({"speed": "30 m"}, "speed = '30 m': is a length"),
        ({"friction": -0.1}, "friction = -0.1: must be positive"),
        ({"friction": 35}, "no coefficient of friction"),
        ({"creep_law": "fastsin"}, "did you mean 'fastsim'"),
        ({"creep_elements": (16, 1)}, "is no grid"),
        ({"creep_elements": (16, 16, 16)}, "is no grid"),
        ({"creep_elements": 5}, "creep_elements = 5: is no grid (along, across); give two whole numbers from 2 to 40"),
        ({"creep_elements": [10.0, 10]}, "creep_elements = (10.0, 10): is no grid"),
        ({"creep_elements": [True, 10]}, "is no grid"),
        ({"creep_law": 3}, "creep_law = 3: is not known; known: fastsim, linear, polach"),
        ({"rail": 3}, "rail = 3: is no profile; give a klingel.contact.Profile"),
        ({"rail": "60E2"}, "did you mean '60E1'"),
        ({"rail_inclination": 20}, "too steep"),
        ({"gauge": "1435 kg"}, "is a mass"),
        ({"step": 0}, "step = 0.0: must be positive"),
        ({"record_interval": "0.7 ms"}, "no multiple of the step"),
        ({"duration": "60 s"}, "runs over the end"),
    ],
)
def test_bad_keywords(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as refused:
        scenario(**changes)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("step", "sample_time", "said"),
    [
        ("5 ms", 1e-3, "step = 0.005: does not divide the controller's sample time 0.001 s; give 0.001 s"),
        ("0.3 ms", 1e-3, "give 0.00025 s"),
        ("0.5 ms", 0.7e-3, "step = 0.0005: does not divide the controller's sample time 0.0007 s; give 0.0001 s"),
    ],
)
def test_step_divides_the_sample_time(step: str, sample_time: float, said: str) -> None:
    strategy = control.IRWLike(timing=control.Timing(sample_time=sample_time))
    with pytest.raises(InputError) as refused:
        Scenario(library.vehicle("mechatronic_irw"), Track.straight("500 m"), speed=30, step=step, control=strategy)
    assert str(refused.value).startswith(said) or str(refused.value).endswith(said)


def test_track_shorter_than_the_vehicle() -> None:
    with pytest.raises(InputError, match="too short for the vehicle"):
        Scenario(COACH, Track.straight("20 m"), speed=30)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("speed =", "sped =", "sped = '176 km/h': is not a known key; did you mean 'speed'?"),
        ('"mechatronic_irw"', '"mechatronic_iwr"', "did you mean 'mechatronic_irw'?"),
        ('"mechatronic_irw"', '"none.toml"', "none.toml: no such file"),
        ('"mechatronic_irw"', "3", "vehicle = 3: is no name or path"),
        ('radius = "800 m"', 'radius = "800 kg"', "track.curve.radius = '800 kg': is a mass"),
        ('radius = "800 m"', 'radius = "100 m"', "curve is too tight"),
        ('radius = "800 m"', "", "track.curve.radius: is missing"),
        ("[track.curve]", "[track.curv]", "did you mean 'curve'?"),
        ('"irw_like"', '"irw_lik"', "did you mean 'irw_like'?"),
        ("curvature =", "curvatur =", "control.curvatur = 'database': is not a known key; did you mean 'curvature'?"),
        ('strategy = "irw_like"', "", "needs a strategy"),
        ('curvature = "database"', "curvature = 3", "control.curvature = 3: is not known; known: database, gyro"),
        ("friction = 0.3", "friction = [", "is not TOML"),
        ("friction = 0.3", 'step = "5 ms"', "step = 0.005: does not divide the controller's sample time"),
        ("friction = 0.3", "rail = 3", "rail = 3: is not known"),
        ("friction = 0.3", "creep_law = 3", "creep_law = 3: is not known"),
        ("creep_elements = [10, 12]", "creep_elements = 5", "creep_elements = 5: is no grid"),
        ("creep_elements = [10, 12]", "creep_elements = [10.0, 10]", "give two whole numbers"),
    ],
)
def test_bad_files(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in FILE
    with pytest.raises(InputError) as refused:
        read(tmp_path, FILE.replace(old, new))
    text = str(refused.value)
    assert said in text
    assert "my.toml" in text or "none.toml" in text


def test_adhesion_grade_and_wind_of_a_file(tmp_path: Path) -> None:
    text = """
vehicle = "manchester_coach"
speed = "108 km/h"
headwind = "36 km/h"

[track.curve]
radius = "800 m"
cant = "160 mm"
transition = "195 m"
grade = 0.01

[adhesion]
base = 0.3
transition = "10 m"

[[adhesion.patch]]
start = "200 m"
end = "400 m"
friction = 0.08
rail = "left"
"""
    made = read(tmp_path, text)
    assert made == scenario(
        track=Track.curve(radius="800 m", cant="160 mm", transition="195 m", grade=0.01),
        headwind=10.0,
        adhesion=Adhesion(base=0.3, patches=[(200.0, 400.0, 0.08, "left")], transition=10.0),
    )
    spec = lower(made)
    assert spec["adhesion"]["left"] == [0.3, 0.08, 0.08, 0.3]
    assert spec["drag"]["headwind"] == 10.0
    assert all(segment["grade"] == [0.01, 0.01] for segment in spec["track"]["segments"])
    with pytest.raises(InputError, match=r"adhesion\.patch\.0\.frction"):
        read(tmp_path, text.replace("friction = 0.08", "frction = 0.08"))


def test_friction_and_adhesion_must_not_contradict_each_other() -> None:
    with pytest.raises(InputError, match="contradict"):
        scenario(friction=0.2, adhesion=Adhesion(base=0.3))
    assert scenario(friction=0.3, adhesion=Adhesion(base=0.3)).friction == 0.3


@pytest.mark.parametrize(
    ("given", "text"),
    [("0.5 mm", '"0.5 mm"'), (["0.5 mm", 0.0, "-0.1 mm", 0.0], '["0.5 mm", 0.0, "-0.1 mm", 0.0]')],
)
def test_radius_mismatch_is_one_or_four(tmp_path: Path, given: Any, text: str) -> None:
    made = scenario(radius_mismatch=given)
    file = f'vehicle = "manchester_coach"\nspeed = "108 km/h"\nradius_mismatch = {text}\ntrack.straight = "500 m"'
    assert read(tmp_path, file) == made
    wheels = {wheel["name"]: wheel["radius_offset"] for wheel in lower(made)["wheels"]}
    for name, mismatch in zip(("1.wheelset1", "1.wheelset2", "2.wheelset1"), made.radius_mismatch, strict=False):
        assert wheels[f"bogie{name}.right"] == 0.5 * mismatch == -wheels[f"bogie{name}.left"]


@pytest.mark.parametrize("given", ["0.5 m", [1e-4, 1e-4], "0.5 s", None])
def test_a_bad_radius_mismatch_is_named(given: Any) -> None:
    with pytest.raises(InputError, match=r"radius_mismatch.*give"):
        scenario(radius_mismatch=given)


DATABASE = """
vehicle = "mechatronic_irw"
speed = "108 km/h"
track.curve = { radius = "800 m", cant = "100 mm" }
control = { strategy = "irw_like", curvature = "database" }
"""


def test_a_database_is_the_track_with_mistakes_or_another_one(tmp_path: Path) -> None:
    track = Track.curve(radius="800 m", cant="100 mm")
    given = read(tmp_path, DATABASE + 'database = { curvature_scale = 1.1, only = 1, shift = "-30 m" }')
    assert given.database == track.mistaken(curvature_scale=1.1, only=1, shift="-30 m")
    assert given.track == track
    assert read(tmp_path, DATABASE + "database.straight = 700").database == Track.straight(700)
    assert lower(given)["control"] != lower(given.replace(database=None))["control"]
    assert lower(given)["track"] == lower(given.replace(database=None))["track"]
    with pytest.raises(InputError, match=r"database.shift"):
        read(tmp_path, DATABASE + 'database = { shift = "10 km" }')
    with pytest.raises(InputError, match=r"database.only"):
        read(tmp_path, DATABASE + "database = { only = 2 }")
