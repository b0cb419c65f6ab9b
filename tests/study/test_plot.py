"""The figures: drawn from tables and runs, in both formats, with bytes that repeat.
Looks are compared by their marks, so that a grey print still tells the vehicles apart."""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
import pytest

from klingel.assess import COLUMNS, curving
from klingel.assess.header import header_of
from klingel.plot import FIGURES, LOOKS, displacement_history, per_radius, render

RADII = {300.0: 30.0, 800.0: 49.0, 1800.0: 73.6}


@pytest.fixture(scope="module")
def table(synthetic):
    scale = {"passive": 1.0, "solid_like": 0.3, "irw_like": 0.25}
    rows = [
        curving(
            synthetic.run({"bogie1.wheelset1.y": 6e-3 * k, "bogie1.wheelset1.left.tgamma": 900 * k}, radius=r, speed=v),
            vehicle=name,
        ).row()
        for name, k in scale.items()
        for r, v in RADII.items()
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


@pytest.mark.parametrize("name", list(FIGURES))
def test_figures_over_the_radius(table, name):
    axes = per_radius(table, name).axes[0]
    quantity = FIGURES[name]
    lines = {line.get_label(): line for line in axes.lines}
    for vehicle, look in LOOKS.items():
        expected = table.loc[table["vehicle"] == vehicle, quantity.column]
        np.testing.assert_allclose(lines[look.label].get_ydata(), expected)
        np.testing.assert_allclose(lines[look.label].get_xdata(), list(RADII))
    assert "[" in axes.get_ylabel()
    assert "[m]" in axes.get_xlabel()
    assert axes.get_ylim()[0] == 0.0


def test_the_least_lateral_force_is_dotted(table):
    line = next(line for line in per_radius(table, "fig18").axes[0].lines if "own mass" in str(line.get_label()))
    assert line.get_linestyle() == ":"
    np.testing.assert_allclose(line.get_ydata(), table["lateral_force_floor_kN"].iloc[: len(RADII)])


def test_vehicles_of_different_mass_have_their_own_floor(table):
    heavier = table.assign(
        lateral_force_floor_kN=table["lateral_force_floor_kN"] + 0.5 * (table["vehicle"] != "passive")
    )
    lines = {str(line.get_label()): line for line in per_radius(heavier, "fig18").axes[0].lines}
    passive, active = (lines[f"own mass / 4 × unbalanced acceleration, {name}"] for name in ("passive", "active"))
    np.testing.assert_allclose(active.get_ydata(), passive.get_ydata() + 0.5)


def test_runs_that_did_not_complete_are_crossed_out(table):
    broken = table.assign(outcome=["derailed: bogie1.wheelset1 at 7 s", *table["outcome"][1:]])
    labels = [line.get_label() for line in per_radius(broken, "fig16").axes[0].lines]
    assert "run did not complete" in labels
    assert "run did not complete" not in [line.get_label() for line in per_radius(table, "fig16").axes[0].lines]


def test_missing_vehicles_are_left_out(table):
    some = table[table["vehicle"] == "irw_like"]
    assert [line.get_label() for line in per_radius(some, "fig16").axes[0].lines] == [LOOKS["irw_like"].label]


def test_history_shows_every_wheelset_of_every_vehicle(synthetic):
    shapes = {f"{name}.y": lambda t, k=k: 1e-3 * k * np.sin(t) for k, name in enumerate(synthetic.WHEELSETS, 1)}
    runs = {vehicle: synthetic.run(shapes) for vehicle in LOOKS}
    header = header_of(runs["passive"])
    names = [wheelset.name for wheelset in header.wheelsets]
    figure = displacement_history(runs, names, header.course, caption="R = 300 m")
    assert len(figure.axes) == 3
    for axes in figure.axes:
        drawn = {line.get_label(): line for line in axes.lines}
        assert np.max(np.abs(drawn["wheelset 1 (leading)"].get_ydata())) == pytest.approx(1.0, rel=1e-3)
        assert np.max(np.abs(drawn["wheelset 4"].get_ydata())) == pytest.approx(4.0, rel=1e-3)
    solid, irw = figure.axes[1:]
    assert solid.get_ylim() == irw.get_ylim()


@pytest.mark.parametrize("form", ["svg", "png"])
def test_bytes_repeat(table, form):
    first, second = (render(per_radius(table, "fig16"), form, name="fig16") for _ in range(2))
    assert first == second
    assert first.startswith(b"<?xml" if form == "svg" else b"\x89PNG")


def test_looks_differ_without_colour():
    for one, other in itertools.combinations(LOOKS.values(), 2):
        assert one.marker != other.marker
        assert one.line != other.line
