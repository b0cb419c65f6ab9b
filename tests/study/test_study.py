"""The study with a stand-in for the simulator: what it writes, and what it keeps when runs fail.
Real runs are tried by the study's own command and by the engine's tests."""

from __future__ import annotations

import functools
import time
from types import SimpleNamespace

import pandas as pd
import pytest
from rich.console import Console

from klingel import library, result
from klingel.assess import COLUMNS
from klingel.drives import operating_point
from klingel.errors import InputError, RunCancelledError, SimulationError
from klingel.study import perez2004
from klingel.study.cases import MAIN, study_runs
from klingel.study.runner import run_all

QUIET = Console(quiet=True)


def test_the_study_is_three_vehicles_in_five_curves_and_variants():
    runs = study_runs()
    assert len({run.name for run in runs}) == len(runs)
    main = [run for run in runs if run.variant == MAIN]
    assert len(main) == 15
    assert {run.friction for run in main} == {0.35}
    assert runs[:15] == main
    assert {run.vehicle for run in runs if run.curvature == "database"} == {"irw_like"}
    with pytest.raises(InputError, match=r"301\.0.*choose from 300 m"):
        study_runs([301.0])
    with pytest.raises(InputError, match="choose from passive"):
        study_runs(vehicles=["tram"])


def test_scenarios_have_the_settings_of_the_study():
    by_name = {run.name: run.scenario() for run in study_runs([300.0])}
    irw = by_name["irw_like_R300"]
    assert (irw.friction, irw.rail, irw.rail_inclination, irw.creep_law) == (0.35, "60E1", 0.025, "table")
    assert irw.control.curvature == "gyro"
    assert irw.step == 0.5e-3  # 1 ms elsewhere
    assert by_name["solid_like_R300"].step == 0.5e-3
    assert by_name["passive_R300_mu025"].step == 1e-3
    assert by_name["irw_like_R300_database"].control.curvature == "database"
    assert by_name["passive_R300_mu025"].friction == 0.25
    assert by_name["passive_R300"].control is None
    assert by_name["passive_R300"].vehicle.name == "manchester_coach"
    assert by_name["solid_like_R300"].vehicle.name == "mechatronic_irw"


def test_the_study_writes_everything(simulated, tmp_path):
    study = perez2004.run(tmp_path, jobs=2, radii=[300.0, 800.0], console=QUIET)
    assert len(simulated) == 20
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
        [f"fig{i}.{form}" for i in range(15, 20) for form in ("svg", "png")]
        + ["report.html", "runs", "summary.csv", "summary_variants.csv", "table1.csv"]
    )
    assert len(list((tmp_path / "runs").glob("*.nc"))) == 20
    summary = pd.read_csv(tmp_path / "summary.csv", keep_default_na=False)
    assert tuple(summary.columns) == COLUMNS
    assert list(summary["vehicle"]) == ["passive"] * 2 + ["solid_like"] * 2 + ["irw_like"] * 2
    assert list(summary["radius_m"]) == [300.0, 800.0] * 3
    assert float(summary["y_max_mm"][0]) == pytest.approx(6.0, rel=1e-3)
    assert summary["actuator_force_max_kN"][0] == ""
    variants = pd.read_csv(tmp_path / "summary_variants.csv")
    assert list(variants.columns[:3]) == ["variant", "friction", "vehicle"]
    assert len(variants) == 14
    assert study.failed == {}
    series = result.load(tmp_path / "runs" / "irw_like_R800.nc")
    assert series["bogie1.wheelset1.y"].attrs["units"] == "m"


def test_the_same_results_give_the_same_files(simulated, tmp_path):
    contents = []
    for name in ("a", "b"):
        perez2004.run(tmp_path / name, radii=[800.0], friction_variants=False, console=QUIET)
        contents.append({p.name: p.read_bytes() for p in (tmp_path / name).iterdir() if p.is_file()})
    assert contents[0] == contents[1]


def test_finished_runs_are_kept_when_another_fails(simulated, tmp_path, monkeypatch):
    working = result.simulate

    def sometimes(scenario, *, progress):
        if scenario.control is None:
            raise SimulationError("no equilibrium: body")
        return working(scenario, progress=progress)

    monkeypatch.setattr(result, "simulate", sometimes)
    with pytest.raises(SimulationError, match="passive_R800: SimulationError: no equilibrium: body"):
        perez2004.run(tmp_path, radii=[800.0], friction_variants=False, console=QUIET)
    assert len(pd.read_csv(tmp_path / "summary.csv")) == 2
    assert "no equilibrium: body" in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert sorted(p.name for p in (tmp_path / "runs").iterdir()) == [
        "irw_like_R800.nc", "irw_like_R800_database.nc", "solid_like_R800.nc",
    ]  # fmt: skip


def test_ctrl_c_keeps_finished_runs_and_cancels_the_rest(simulated, tmp_path, monkeypatch):
    working, watches = result.simulate, []

    def first_only(scenario, *, progress):
        watches.append(progress)
        if len(watches) == 1:
            return working(scenario, progress=progress)
        while not progress.cancelled:
            time.sleep(0.01)
        raise RunCancelledError("cancelled")

    def interrupt(futures, *_):
        while not any(future.done() for future in futures) or len(watches) < 2:
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr(result, "simulate", first_only)
    monkeypatch.setattr("klingel.study.runner._watch", interrupt)
    with pytest.raises(KeyboardInterrupt, match="1 of 4 runs are kept in"):
        perez2004.run(tmp_path, jobs=1, radii=[800.0], friction_variants=False, console=QUIET)
    assert len(watches) == 2
    assert list(pd.read_csv(tmp_path / "summary.csv")["vehicle"]) == ["irw_like"]
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "not started" in report
    assert "cancelled" in report


def test_a_study_without_any_result_writes_no_tables(simulated, tmp_path, monkeypatch):
    def never(scenario, *, progress):
        raise SimulationError("refused")

    monkeypatch.setattr(result, "simulate", never)
    with pytest.raises(SimulationError, match="4 of 4 runs failed"):
        perez2004.run(tmp_path, radii=[300.0], friction_variants=False, console=QUIET)
    assert [p.name for p in tmp_path.iterdir()] == ["runs"]


def test_a_file_in_the_way_is_named(simulated, tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(InputError, match="out"):
        perez2004.run(tmp_path / "out", console=QUIET)
    assert simulated == []


def test_the_screen_shows_table_1_and_the_summary(simulated, tmp_path):
    console = Console(record=True, width=200, force_terminal=False)
    perez2004.run(tmp_path, radii=[800.0], friction_variants=False, console=console)
    text = console.export_text()
    assert "Table 1" in text
    point = operating_point(library.vehicle("mechatronic_irw"), 176 / 3.6)
    assert f"{point.field_current_normalised:.4f}" in text
    assert "irw_like" in text
    assert "curvature from the track database" in text


def test_runner_reports_progress_in_order():
    watched = functools.partial(SimpleNamespace, fraction=0.0)
    batch = run_all(["b", "a"], lambda name, watch: (name, watch.fraction), watched, jobs=1, console=QUIET)
    assert list(batch.done.items()) == [("b", ("b", 0.0)), ("a", ("a", 0.0))]
    assert not batch.interrupted
