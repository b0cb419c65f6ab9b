"""Comparisons: what texts stand for, that failures are rows, and a small one through the real core.
The simulator is a stand-in where only the folder matters."""

from __future__ import annotations

import itertools
import re
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

import klingel as kl
from klingel import control, result
from klingel.assess import COLUMNS
from klingel.errors import InputError, RunCancelledError
from klingel.plot.style import LOOKS, SPARE, looks_of
from klingel.study.compare import compare, history_case
from klingel.study.compare_cases import contenders, made_for
from klingel.study.compare_curves import curves
from klingel.track.cases import perez2004

QUIET = Console(quiet=True)
FIRST = perez2004()[0]
SHORT = (
    "R=800,cant=60 mm,transition=60 m,arc=80 m,straight_before=30 m,straight_after=110 m,speed=108 km/h",
    "R=600,cant=60 mm,transition=60 m,arc=80 m,straight_before=30 m,straight_after=110 m,speed=90 km/h",
)
MINE = '''
from __future__ import annotations
from dataclasses import dataclass
from klingel import control

@dataclass(frozen=True)
class Mine:
    """An example. frequency: crossover [Hz]."""

    frequency: float = 1.0

    def lower(self, vehicle, track, speed):
        return control.IRWLike(frequency=self.frequency).lower(vehicle, track, speed)

class Fails(Mine):
    def problems(self, vehicle):
        raise KeyError("mass")

ready = Mine(0.9)
other = 3
text = "irw_like"
'''


@pytest.fixture
def undrawn(monkeypatch):
    """Figures cost a second each, and are looked at elsewhere."""
    monkeypatch.setattr("klingel.study.folder.render", lambda *_, **__: b"<svg></svg>")


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    path = tmp_path / "mine_of_this_test.py"
    path.write_text(MINE)
    return path


def test_strategies_by_name_with_parameters_and_of_ones_own(mine: Path) -> None:
    texts = ["passive", "quick=irw_like:frequency=1.6 Hz,timing.sensor_samples=2", f"{mine}:Mine:frequency=0.8"]
    passive, quick, own = contenders(texts, FIRST)
    assert passive.scenario.vehicle.name == "manchester_coach"
    assert quick.name == "quick"
    assert (quick.scenario.control.frequency, quick.scenario.control.timing.sensor_samples) == (1.6, 2)
    assert own.scenario.control.frequency == 0.8
    assert own.scenario.vehicle.name == "mechatronic_irw"
    (ready,) = contenders([f"r={mine}:ready"], FIRST)
    assert ready.scenario.control.frequency == 0.9


def test_strategies_from_python_and_scenario_files(tmp_path: Path) -> None:
    file = tmp_path / "slow.toml"
    file.write_text(
        'vehicle = "mechatronic_irw"\nspeed = "50 km/h"\nfriction = 0.3\nduration = "1 s"\n'
        '[track.curve]\nradius = "900 m"\n[control]\nstrategy = "irw_like"\n'
    )
    made = contenders(
        {"none": None, "S": control.SolidLike(), "file": f"{file}:frequency=0.9,step=1 ms"},
        FIRST,
        settings={"vehicle.body.mass": "30 t"},
    )
    assert [c.scenario.vehicle.name for c in made] == ["manchester_coach", "mechatronic_irw", "mechatronic_irw"]
    assert {c.scenario.vehicle.body.mass for c in made} == {30e3}
    run = made[2].through(FIRST)
    assert (run.friction, run.control.frequency, run.step, run.duration) == (0.3, 0.9, 1e-3, None)
    assert (run.speed, run.track) == (FIRST.speed, FIRST.track)
    (case,) = curves([str(file)])
    assert (case.radius, case.track.name) == (900.0, "slow")


def test_the_vehicle_is_the_first_that_a_strategy_fits() -> None:
    class Picky(control.Passive):
        def problems(self, vehicle: kl.Vehicle):
            return [] if vehicle.name == "manchester_coach" else ["no"]

    assert made_for(control.SolidLike()).name == "mechatronic_irw"
    assert made_for(Picky()).name == "manchester_coach"
    (chosen,) = contenders(["passive"], FIRST, vehicle="mechatronic_irw")
    assert chosen.scenario.vehicle.name == "mechatronic_irw"
    (own,) = contenders(["passive:vehicle=mechatronic_irw"], FIRST, vehicle="manchester_coach")
    assert own.scenario.vehicle.name == "mechatronic_irw"


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        ([], "nothing to compare"),
        (["solid_lik"], "did you mean 'solid_like'"),
        (["irw_like", "irw_like"], "same name"),
        (["irw_like:frequenzy=2"], "did you mean 'frequency'"),
        (["irw_like:frequency"], "'frequency' sets nothing"),
        (["{}:Nine"], "did you mean 'Mine'"),
        (["{}:other"], "is no strategy"),
        (["{}:text"], "is no strategy"),
        (["{}:Zzz"], "known: Fails, Mine, ready"),
        (["{}:Fails"], "mechatronic_irw: control = 'Fails': fails when asked whether it fits: KeyError: 'mass'"),
        (["{}:Fails:vehicle=trailed_irw"], "mend its method problems(vehicle)"),
        (["irw_like:timing=5,timing.sample_time=1e-3"], "'timing.sample_time' is given twice"),
        (["irw_like:timing.sample_time=1e-3,timing=5"], "'timing' is given twice"),
        (["{}:Mine:gain=2"], "known: frequency"),
        (["{}:ready:frequency=2"], "takes no parameters"),
        (["nowhere.py:Mine"], "no such file"),
        (["irw_like:vehicle=tram"], "is not in the library"),
    ],
)
def test_bad_strategies_are_refused_before_anything_runs(mine: Path, texts: list[str], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        contenders([text.format(mine) for text in texts], FIRST)


@pytest.mark.parametrize(
    ("given", "said"),
    [(control.IRWLike, "make one of it: IRWLike()"), ("irw_like", "is a text, no strategy"), (3, "is no strategy")],
)
def test_a_scenario_takes_objects_as_control(given: object, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        kl.Scenario(kl.library.vehicle("mechatronic_irw"), FIRST.track, speed=30.0, control=given)
    if not isinstance(given, str):
        with pytest.raises(InputError, match=re.escape(said)):
            contenders({"one": given}, FIRST)


class Nothing:
    """Commands nothing."""

    def reset(self) -> None: ...

    def step(self, t: float, measurements: dict[str, float]) -> dict[str, float]:
        return {}


def test_the_vehicle_has_the_inputs_that_a_strategy_commands() -> None:
    def of(command: str, sample_time: str) -> control.PythonController:
        return control.PythonController(Nothing(), sample_time=sample_time, measurements=[], commands=[command])

    assert made_for(of("bogie1.yaw_actuator_left.force", "2 ms")).name == "actuated_coach"
    with pytest.raises(InputError, match=r"control.timing.sample_time = 0.1: is too slow for `Nothing`"):
        contenders({"slow": of("bogie1.wheelset1.actuator_left.force", "100 ms")}, FIRST)
    with pytest.raises(InputError, match=r"mechatronic_irw: it has no input `bogie1.wing`"):
        made_for(of("bogie1.wing", "2 ms"))


def test_a_file_imports_its_neighbours(mine: Path, tmp_path: Path) -> None:
    neighbour = tmp_path / "neighbour.py"
    neighbour.write_text(f"from {mine.stem} import Mine\n")
    (made,) = contenders([f"{neighbour}:Mine"], FIRST)
    assert made.scenario.control.frequency == 1.0
    assert str(tmp_path) not in sys.path


def test_a_file_that_fails_and_a_class_that_cannot_be_made_are_said(tmp_path: Path) -> None:
    path = tmp_path / "broken.py"
    path.write_text("1 / 0")
    with pytest.raises(InputError, match="fails when run: ZeroDivisionError"):
        contenders([f"{path}:A"], FIRST)
    path.write_text("class A:\n    def __init__(self, gain): ...\n    def lower(self, *_): ...\n")
    with pytest.raises(InputError, match="cannot be made: TypeError"):
        contenders([f"{path}:A"], FIRST)


def test_curves_by_radius_text_and_file() -> None:
    five = curves(None)
    assert [case.track.name for case in five] == ["R300", "R500", "R800", "R1200", "R1800"]
    own, known = curves(["1200", "R=500,speed=20 m/s,cant=50mm,hand=left"])
    assert (own.radius, own.speed, own.track.curvature(own.track.length / 2)) == (500.0, 20.0, -1 / 500)
    assert [s.length for s in own.track.segments] == [85.0, 80.0, 120.0, 80.0, 85.0]
    assert known.speed == pytest.approx(60.0)
    again = curves([300, "R=300,speed=20 m/s", "R=300,speed=20 m/s,cant=1cm"])
    assert [case.track.name for case in again] == ["R300_72kmh_1", "R300_72kmh_2", "R300_108kmh"]
    assert history_case(five).radius == 800.0
    assert history_case(again) is again[1]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("301", "none of the five curves"),
        ("R=301", "has no speed"),
        ("R=301,sped=20", "did you mean 'speed'"),
        ("R=301,speed=3 kg", "is a mass"),
        ("R=20,speed=3", "too tight"),
    ],
)
def test_bad_curves_are_refused(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        curves([text])


def test_looks_stay_apart_in_colour_and_in_grey() -> None:
    looks = looks_of({name: name for name in ("irw_like", "a", "b", "c", "d", "e", "f", "g", "h", "passive")})
    assert looks["irw_like"] == LOOKS["irw_like"]
    for one, other in itertools.combinations((*LOOKS.values(), *SPARE), 2):
        assert one.color != other.color
        assert one.marker != other.marker
        assert one.line != other.line
    with pytest.raises(InputError, match="told apart"):
        looks_of({str(i): str(i) for i in range(10)})


def test_everything_is_written_and_a_failure_is_a_row(simulated, mine, tmp_path):
    out = tmp_path / "out"
    done = compare(
        {"passive": None, "mine": f"{mine}:Mine", "S": control.SolidLike()},
        curves=[800, "R=2000,speed=30"],
        out=out,
        jobs=1,
        console=QUIET,
    )
    assert sorted(p.name for p in out.iterdir()) == sorted(
        [f"fig{i}.{form}" for i in range(15, 20) for form in ("svg", "png")]
        + ["report.html", "runs", "summary.csv", "straight.csv", "margins.csv"]
    )
    assert {p.name for p in (out / "runs").iterdir()} == {
        f"{name}_{curve}.nc" for name in ("passive", "S", "mine") for curve in ("R800", "R2000")
    }
    assert done.failed == {}
    table = pd.read_csv(out / "summary.csv", keep_default_na=False)
    assert list(table.columns) == ["strategy", "curve", *COLUMNS]
    assert list(table["strategy"]) == ["passive"] * 2 + ["mine"] * 2 + ["S"] * 2
    assert list(table["vehicle"]) == ["manchester_coach"] * 2 + ["mechatronic_irw"] * 4


def test_bad_controllers_do_not_stop_the_rest(simulated, undrawn, mine, tmp_path, monkeypatch):
    working = result.simulate

    def simulate(scenario, *, progress):
        if type(scenario.control).__name__ == "Mine":
            raise ZeroDivisionError("too long for me")
        return working(scenario, progress=progress)

    monkeypatch.setattr(result, "simulate", simulate)
    done = compare(["passive", f"mine={mine}:Mine"], curves=[800], out=tmp_path / "out", console=QUIET)
    assert done.failed == {"mine_R800": "ZeroDivisionError: too long for me"}
    row = done.table[done.table["strategy"] == "mine"].iloc[0]
    assert row["outcome"] == "no run: ZeroDivisionError: too long for me"
    assert np.isnan(row["y_max_mm"])
    assert "too long for me" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_a_run_that_ends_at_once_has_its_outcome(simulated, undrawn, tmp_path, monkeypatch):
    working = result.simulate

    def simulate(scenario, *, progress):
        series = working(scenario, progress=progress).isel(time=slice(1))
        return series.assign_attrs(outcome="controller failed: `Mine` raised ValueError, at 0.000 s")

    monkeypatch.setattr(result, "simulate", simulate)
    done = compare(["passive"], curves=[800], out=tmp_path / "out", console=QUIET)
    assert list(done.table["outcome"]) == ["controller failed: `Mine` raised ValueError, at 0.000 s"]
    assert list(done.failed) == ["passive_R800"]
    assert "controller failed" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_nothing_finished_still_writes_the_page(simulated, undrawn, tmp_path, monkeypatch):
    def simulate(scenario, *, progress):
        raise RunCancelledError("no")

    monkeypatch.setattr(result, "simulate", simulate)
    done = compare(["passive"], curves=[800], out=tmp_path, console=QUIET)
    assert list(done.table["outcome"]) == ["no run: RunCancelledError: no"]
    assert (tmp_path / "report.html").is_file()


def test_ctrl_c_writes_what_is_finished(simulated, undrawn, tmp_path, monkeypatch):
    def interrupt(futures, *_):
        while not all(future.done() for future in futures):
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr("klingel.study.runner._watch", interrupt)
    with pytest.raises(KeyboardInterrupt, match="1 of 1 runs are kept"):
        compare(["passive"], curves=[800], out=tmp_path, jobs=1, console=QUIET)
    assert len(pd.read_csv(tmp_path / "summary.csv")) == 1


def test_a_small_comparison_through_the_core(undrawn, tmp_path):
    done = compare(["passive:step=1 ms", "irw_like"], curves=SHORT, out=tmp_path, jobs=2, console=QUIET)
    assert set(done.table["outcome"]) == {"completed"}
    assert done.table["y_max_mm"].notna().all()
    assert set(done.straight["stable"]) == {"yes"}
    assert (done.straight["damping"] > 0.02).all()
    assert set(done.margins["kind"]) == {"steering", "motors"}
    assert done.margins["gain_margin"].between(1.2, 100.0).all()
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "http" not in page.replace("http://www.w3.org", "")
    assert "2 strategies in 2 curves" in page
