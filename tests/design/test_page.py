"""Figures and page of the design bench, and its command."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import klingel as kl
from klingel.cli.app import app
from klingel.design.bench import Bench, examine
from klingel.errors import InputError
from klingel.plot.design import loop_bode, nyquist, stability_map
from klingel.plot.style import render
from klingel.report.design import HEADS, design_report, readable_margins

from .conftest import scenario


@pytest.fixture(scope="module")
def bench() -> Bench:
    """S at two speeds; coupled too hard, so that something falls short."""
    hard = scenario().replace(control=kl.control.SolidLike(coupling=0.6))
    said: list[str] = []
    found = examine(hard, speeds=[30.0, 265 / 3.6], conicities=[None, 0.3], frictions=[0.35], step=said.append)
    assert said[0] == "margins at 108 km/h"
    return found


def test_the_worst_loop_of_every_kind_is_shown(bench: Bench) -> None:
    assert set(bench.worst) == {"steering", "motors"}
    for kind, shown in bench.worst.items():
        least = bench.table[bench.table["kind"] == kind].sort_values("disk").iloc[0]
        assert shown[0].name == least["loop"]
        assert [round(3.6 * each.speed) for each in shown] == [108, 265]


def test_figures_repeat_and_show_every_speed(bench: Bench) -> None:
    shown = bench.worst["motors"]
    for make in (loop_bode, nyquist):
        one, other = (render(make(shown, title="motors"), "svg", name="m") for _ in range(2))
        assert one == other
    axis = nyquist(shown, title="motors").axes[0]
    labels = [line.get_label() for line in axis.lines]
    assert {"108 km/h", "265 km/h"} <= set(labels)
    disk = next(patch for patch in axis.patches if str(patch.get_label()).startswith("kept free"))
    alpha = min(each.margins.disk for each in shown)
    left = disk.get_extents().transformed(axis.transData.inverted()).x0
    assert left == pytest.approx(-(2.0 + alpha) / (2.0 - alpha), rel=1e-3)


def test_the_map_has_a_cell_for_every_place(bench: Bench) -> None:
    figure = stability_map(bench.check, title="map")
    assert sum(len(axis.texts) for axis in figure.axes) == len(bench.check.table)
    hatched = [patch for axis in figure.axes for patch in axis.patches if patch.get_hatch()]
    assert len(hatched) == len(bench.check.failures)


def test_the_page_tells_margins_and_failures(bench: Bench) -> None:
    html = design_report(bench, title="S", subtitle="hard").html
    assert "loops fall short of what they shall have" in html
    assert " of 0<" not in html  # margins that nothing is demanded of
    assert bench.check.words()[0] in html
    assert html.count("<figure") == 5
    assert "http" not in html.replace("http://www.w3.org", "")


def test_margins_are_readable() -> None:
    row = {"loop": "a.motors", "speed": 30.0, "missed": ""} | dict.fromkeys(list(HEADS)[2:-1], np.inf)
    row |= {"phase": np.pi / 4.0, "delay": 0.0123, "gain_down": np.nan}
    text = readable_margins(pd.DataFrame([row])).iloc[0]
    assert (text["km/h"], text["phase °"], text["delay ms"]) == ("108", "45", "12.3")
    assert (text["gain up"], text["gain down"], text["falls short"]) == ("any", "-", "-")


def test_the_command_writes_page_and_table(tmp_path: Path) -> None:
    page, table = tmp_path / "design.html", tmp_path / "design.csv"
    options = ["--vehicle", "mechatronic_irw", "--control", "irw_like", "--speed", "140 km/h"]
    done = CliRunner().invoke(app, ["design", *options, "--out", str(page), "--table", str(table)])
    assert done.exit_code == 0, done.output
    assert "IRWLike is stable at all" in done.output
    assert page.read_text().startswith("<!doctype html>")
    rows = pd.read_csv(table)
    assert len(rows) == 8
    assert {"loop", "gain", "delay", "disk", "missed"} <= set(rows.columns)


def test_a_vehicle_without_control_is_refused(tmp_path: Path) -> None:
    refused = CliRunner().invoke(app, ["design", "--vehicle", "manchester_coach", "--out", str(tmp_path / "a.html")])
    assert isinstance(refused.exception, InputError)
    assert "there is no loop to look at" in str(refused.exception)
