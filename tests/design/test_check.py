"""The check over speed, conicity and friction: what it finds, how it tells it, and the limits of margins."""

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest

import klingel as kl
from klingel.design import check, judged, limits, margins
from klingel.design.check import Check, middle, stability
from klingel.design.limits import MOTORS, Limits, missed
from klingel.errors import SimulationError
from klingel.linear.parameters import replace
from klingel.linear.sweep import Linearised
from klingel.track.cases import perez2004

from .conftest import scenario


@pytest.fixture(scope="module")
def found() -> Check:
    """S with a coupling that delays and torsion of the shafts do not bear."""
    hard = scenario().replace(control=kl.control.SolidLike(coupling=0.8))
    curves = perez2004()[:1]
    return check(hard, speeds=["108 km/h", "265 km/h"], conicities=[0.3], frictions=[0.35], curves=curves)


def test_it_finds_and_tells_where_a_design_fails(found: Check) -> None:
    assert len(found.table) == 3
    assert not found.stable
    failed = found.failures
    assert (failed["growth"] > 0.0).all()
    assert (failed["growth"].diff().dropna() <= 0.0).all()
    words = found.words()
    assert words[0].startswith(f"SolidLike fails at {len(failed)} of 3 places, the fastest growing mode is its ")
    assert len(words) == 1 + len(failed)
    grows = failed[failed["outcome"] == "unstable"]
    assert f"grows with {grows['growth'].iloc[0]:.2g} 1/s" in " ".join(words)


def test_its_rows_are_the_eigenvalues_of_the_model(found: Check) -> None:
    hard = replace(scenario(speed=30.0).replace(control=kl.control.SolidLike(coupling=0.8)), "conicity", 0.3)
    model = kl.linearise(hard)
    row = found.table[(found.table["speed"] < 31.0) & (found.table["conicity"] == 0.3)].iloc[0]
    assert row["growth"] == pytest.approx(stability(model)["growth"], rel=1e-6)
    assert stability(model)["frequency"] == pytest.approx(row["frequency"], rel=1e-6)


def test_curves_are_run_in_the_middle_of_their_arcs(found: Check) -> None:
    for case in perez2004():
        assert abs(float(case.track.curvature(middle(case)))) == pytest.approx(1.0 / case.radius)
    curve = found.table[np.isfinite(found.table["radius"])]
    assert curve["radius"].tolist() == [300.0]
    assert len(curve["outcome"]) == 1


def test_a_stable_design_is_told_in_one_sentence() -> None:
    good = check(scenario(), speeds=[30.0], conicities=[None], frictions=[0.35], curves=(), margins=True)
    assert good.stable
    (sentence,) = good.words()
    assert sentence.startswith("SolidLike is stable at all 1 places; least damping ")
    assert good.margins is not None
    alone = margins(scenario(speed=30.0))
    np.testing.assert_allclose(good.margins["gain"], alone["gain"], rtol=1e-6)


def test_a_place_without_a_steady_state_is_a_failure() -> None:
    def none(at: float | None) -> Callable[[kl.Scenario], Linearised]:
        def refuse(scenario: kl.Scenario) -> Linearised:
            raise SimulationError("no steady state")

        return refuse

    found = check(scenario(), speeds=[], frictions=[0.35], curves=perez2004()[:1], linearised=none)
    assert found.table["outcome"].tolist() == ["no steady state"]
    assert found.words() == (
        "SolidLike fails at 1 of 1 places.",
        "No steady state at 108 km/h in R = 300 m, friction 0.35.",
    )


def test_limits_are_those_of_the_kind_of_loop() -> None:
    database = scenario().replace(control=kl.control.IRWLike(curvature="database"))
    assert limits(database, "steering", 30.0) == Limits(gain=1.6)
    assert limits(database, "steering", 40.0) == Limits(gain=2.0)
    assert limits(scenario(), "steering", 30.0) == Limits(gain=2.0, delay=0.05)
    assert limits(scenario(), "motors", 30.0) == MOTORS
    good = {"stable": True, "gain": math.inf, "phase": math.inf, "delay": math.inf}
    assert list(missed(good, MOTORS)) == []
    assert list(missed(good | {"stable": False}, MOTORS)) == ["unstable"]
    short = good | {"phase": 0.5, "delay": 4e-3}
    assert list(missed(short, MOTORS)) == ["phase 29° of 45°", "delay 4.0 ms of 10 ms"]
    assert list(missed(good | {"gain": 1.9}, dataclasses.replace(MOTORS, gain=1.8))) == []


def test_a_table_is_judged_row_by_row() -> None:
    table = judged(scenario(), margins(scenario()))
    assert len(table) == 8
    steering = table[table["kind"] == "steering"]
    assert (steering["missed"] == "").all() == bool(((steering["gain"] >= 2.0) & (steering["delay"] >= 0.05)).all())
