"""The traction study writes its folder: a table, figures, one report, the runs."""

from pathlib import Path

import pandas as pd
import pytest

import klingel as kl
from klingel.errors import InputError
from klingel.study import traction
from klingel.study.traction_cases import traction_runs
from klingel.study.traction_drives import comparison


def test_one_part_of_the_study(tmp_path: Path) -> None:
    study = traction.run(tmp_path, parts=["stop"], strategies=["irw_like"], jobs=1)
    assert not study.failed
    table = pd.read_csv(tmp_path / "summary.csv")
    assert table["speed_end_kmh"].iloc[0] == pytest.approx(0.0, abs=0.2)
    assert table["y_max_mm"].iloc[0] < 4.0
    assert {p.name for p in tmp_path.iterdir()} >= {"report.html", "stop_irw_like.svg", "stop_irw_like.png", "runs"}
    page = (tmp_path / "report.html").read_text()
    assert "A stop from 160 km/h" in page
    assert "http" not in page.replace("http://www.w3.org", "")
    assert kl.load(tmp_path / "runs" / "stop_irw_like.nc").attrs["outcome"] == "completed"


def test_runs_have_their_own_names_and_unknown_parts_are_refused(tmp_path: Path) -> None:
    names = [run.name for run in traction_runs()]
    assert len(names) == len(set(names)) == 24
    with pytest.raises(InputError, match="not in this study"):
        traction.run(tmp_path, parts=["brake"])


def test_both_kinds_of_motor_are_compared_run_by_run() -> None:
    table = comparison({"dc_R300_irw_like": 1.0e-3, "induction_R300_irw_like": 1.02e-3, "dc_R500_irw_like": 1.0})
    assert table["run"].tolist() == ["R300 irw like"]
    assert table["difference [mm]"].iloc[0] == pytest.approx(0.02)
