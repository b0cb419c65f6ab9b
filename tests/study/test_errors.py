"""The study of single errors: what an error touches, who withstands it, what is written.
Two strategies through one short curve."""

from pathlib import Path

import pytest
from rich.console import Console

from klingel import Track, control, library
from klingel.errors import InputError
from klingel.scenario import Scenario
from klingel.study import errors
from klingel.study.errors import ERRORS, Fault

CURVE = "R=300,cant=160 mm,speed=108 km/h,straight_before=40,transition=90,arc=50,straight_after=40"


def quiet() -> Console:
    return Console(quiet=True)


def test_an_error_touches_who_measures_it() -> None:
    vehicle, track = library.vehicle("mechatronic_irw"), Track.straight("500 m")
    gyros = Scenario(vehicle, track, speed=30.0, control=control.IRWLike())
    known = gyros.replace(control=control.IRWLike(curvature="database"))
    wrong = next(fault for fault in ERRORS if "curvature_error" in fault.inputs)
    assert not wrong.meets(gyros)
    assert wrong.meets(known)
    assert all(fault.meets(known) for fault in ERRORS)


def test_a_study_writes_who_withstands_what(tmp_path: Path) -> None:
    tried = [Fault("none", {}), Fault("curvature 10 % too large", {"curvature_error": 0.1})]
    made = errors.run(
        tmp_path, strategies=["I gyros=irw_like", "S=solid_like"], curves=[CURVE], faults=tried, console=quiet()
    )
    table = made.table.set_index(["strategy", "error"])
    assert made.robust() == {fault.words: ["I gyros", "S"] for fault in tried}
    assert table.loc[("I gyros", tried[1].words), "y_max_mm"] == table.loc[("I gyros", "none"), "y_max_mm"]
    assert not table.loc[("I gyros", tried[1].words), "touched"]
    assert table.loc[("S", tried[1].words), "y_max_mm"] != table.loc[("S", "none"), "y_max_mm"]
    page = (tmp_path / "report.html").read_text()
    assert "I gyros; S" in page
    assert {p.name for p in tmp_path.iterdir()} >= {"summary.csv", "errors.svg", "errors.png", "report.html"}


def test_nothing_to_try_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no error to try"):
        errors.run(tmp_path, faults=[], console=quiet())
