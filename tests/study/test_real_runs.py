"""The study's scenarios through the real core and the assessment: every figure is there.
Balances, mirror and step are tried in `tests/physics`; here a short curve is enough."""

from __future__ import annotations

import math

import pytest

import klingel as kl
from klingel.assess import curving
from klingel.study.cases import VEHICLES, Run
from klingel.track.cases import perez2004

SHORT = kl.Track.curve(
    radius="800 m", cant="60 mm", transition="60 m", arc="80 m", straight_before="30 m", straight_after="110 m"
)


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_a_run_has_every_figure(vehicle):
    scenario = Run(vehicle, perez2004()[2]).scenario().replace(track=SHORT, speed="108 km/h", step="1 ms")
    row = curving(kl.simulate(scenario), vehicle=vehicle)
    assert row.outcome == "completed"
    assert row.after_curve_s == pytest.approx(3.0, abs=0.5)
    missing = [name for name, value in row.row().items() if not isinstance(value, str) and math.isnan(value)]
    motors = ["actuator_force_max_kN", "steering_voltage_max_V", "armature_current_max_A"]
    assert missing == (motors if vehicle == "passive" else [])
    assert 0.5 * row.lateral_force_floor_kN < row.lateral_force_max_kN < 3.0 * row.lateral_force_floor_kN
    assert len(row.static_wheel_loads) == 8
