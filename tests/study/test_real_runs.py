"""The study's own runs through the real core: balances in the arc, the mirrored curve, the halved step.
One run of each kind, made once for all tests of this file."""

from __future__ import annotations

import json
import math
import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import klingel as kl
from klingel.assess import curving
from klingel.assess.header import header_of
from klingel.study.cases import Run
from klingel.track.cases import perez2004

GRAVITY = 9.81
CURVES = {case.radius: case for case in perez2004()}

ODD = frozenset(
    {
        "y", "roll", "yaw", "Y", "roll_rate", "yaw_rate", "lateral_acceleration", "curvature", "cant", "yaw_moment",
        "steering_voltage", "steering_moment_command",
    }
)  # fmt: skip
"""Quantities that change sign in the mirror; those of left and right change places."""


@pytest.fixture(scope="module")
def runs():
    passive = Run("passive", CURVES[300.0]).scenario()
    solid = Run("solid_like", CURVES[800.0]).scenario()
    scenarios = {
        "passive": passive,
        "passive halved": passive.replace(step=passive.step / 2),
        "solid_like": solid,
        "solid_like halved": solid.replace(step=solid.step / 2),
    }
    for hand in ("right", "left"):
        track = kl.Track.curve(
            radius=400.0, cant=0.06, transition=50.0, arc=30.0, straight_before=30.0, straight_after=30.0, hand=hand
        )
        for name, scenario in (("passive", passive), ("solid_like", solid)):
            scenarios[f"{name} {hand}"] = scenario.replace(track=track, speed=30.0)
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(scenarios, pool.map(kl.simulate, scenarios.values()), strict=True))


def in_arc(run, channel):
    """Mean of a channel over the last 1.5 s of the arc, all of the vehicle inside."""
    course, s = header_of(run).course, run["body.s"].to_numpy()
    speed = header_of(run).speed
    inside = (s > course.arc_end - 13.0 - 1.5 * speed) & (s < course.arc_end - 13.0)
    return float(run[channel].to_numpy()[inside].mean())


def wheels(run):
    return [wheel for wheelset in header_of(run).wheelsets for wheel in (wheelset.left, wheelset.right)]


@pytest.mark.parametrize("vehicle", ["passive", "solid_like"])
def test_run_completes_with_every_figure(runs, vehicle):
    row = curving(runs[vehicle])
    assert row.outcome == "completed"
    assert row.after_curve_s == 3.0
    numbers = [x for x in row.row().values() if not isinstance(x, str)]
    assert sum(map(math.isnan, numbers)) == (3 if vehicle == "passive" else 0)


@pytest.mark.parametrize("vehicle", ["passive", "solid_like"])
def test_static_wheel_loads_carry_the_weight(runs, vehicle):
    header = header_of(runs[vehicle])
    assert sum(header.static_wheel_loads.values()) == pytest.approx(header.mass * GRAVITY, rel=1e-6)
    sides = [
        header.static_wheel_loads[wheelset.left] / header.static_wheel_loads[wheelset.right]
        for wheelset in header.wheelsets
    ]
    assert sides == pytest.approx([1.0] * 4, rel=1e-6)


@pytest.mark.parametrize("vehicle", ["passive", "solid_like"])
def test_contact_forces_balance_weight_and_centrifugal_force_in_the_arc(runs, vehicle):
    """Across the track plane the wheels carry the mass times the unbalanced acceleration, along its normal the rest.

    Tolerance: 0.5 %, for the frames of bogies and body, which stand a little askew to the track at each wheelset.
    """
    run, header = runs[vehicle], header_of(runs[vehicle])
    course, speed = header.course, in_arc(runs[vehicle], "body.speed")
    sine = course.cant / course.cant_base
    cosine = math.sqrt(1.0 - sine**2)
    lateral = sum(in_arc(run, f"{wheel}.Y") for wheel in wheels(run))
    normal = sum(in_arc(run, f"{wheel}.Q") for wheel in wheels(run))
    unbalanced = course.unbalanced_acceleration(speed, GRAVITY)
    assert lateral == pytest.approx(-header.mass * unbalanced, rel=5e-3)
    assert normal == pytest.approx(header.mass * (GRAVITY * cosine + speed**2 * course.curvature * sine), rel=1e-3)


def test_inner_wheels_unload_by_the_overturning_moment_of_the_swayed_body(runs):
    """Moments of all bodies about the line between the wheels, at the rail.

    2 lambda dQ / 2 = sum m (a h + g' e): a body of mass m stands h above the rail and e outwards of the wheels' line;
    g' is gravity along the normal of the track plane with its share of the centrifugal force. In a curve a body's own
    arc lies x^2/(2 R) inwards of the tangent, so e takes the versines of body and wheels. Tolerance: 3 % of the static
    load, for the contact points, which leave the tape circles (the outer wheel's by up to 30 mm in the root).
    """
    run, header = runs["passive"], header_of(runs["passive"])
    spec = json.loads(run.attrs["spec"])
    course, speed = header.course, in_arc(run, "body.speed")
    sine = course.cant / course.cant_base
    across = course.unbalanced_acceleration(speed, GRAVITY)
    along = GRAVITY * math.sqrt(1.0 - sine**2) + speed**2 * course.curvature * sine
    place = {body["name"]: body["position"] for body in spec["bodies"]}
    versine = {name: 0.5 * course.curvature * x**2 for name, (x, _, _) in place.items()}
    wheel_line = np.mean([versine[wheelset.name] for wheelset in header.wheelsets])
    moment = 0.0
    for body in spec["bodies"]:
        name = body["name"]
        height = -(place[name][2] + in_arc(run, f"{name}.z"))
        outwards = wheel_line - versine[name] - in_arc(run, f"{name}.y")
        moment += body["mass"] * (across * height + along * outwards)
    loads = {side: sum(in_arc(run, f"{w}.Q") for w in wheels(run) if w.endswith(side)) for side in ("left", "right")}
    inner = 0.5 * (sum(loads.values()) - moment / 0.75)
    assert loads["right"] == pytest.approx(inner, abs=0.03 * 0.5 * header.mass * GRAVITY)


@pytest.mark.parametrize("vehicle", ["passive", "solid_like"])
def test_a_left_curve_is_the_mirrored_right_curve(runs, vehicle):
    """In a short, sharply entered curve; within 1e-7 of each channel's range, rounding of sums in another order."""
    right, left = runs[f"{vehicle} right"], runs[f"{vehicle} left"]
    for channel in right.data_vars:
        swapped = re.sub("left|right", lambda side: {"left": "right", "right": "left"}[side[0]], channel)
        sign = -1.0 if channel.rsplit(".", 1)[1] in ODD else 1.0
        here, there = right[channel].to_numpy(), sign * left[swapped].to_numpy()
        assert np.max(np.abs(here - there)) <= 1e-7 * np.ptp(here) + 1e-12, channel


@pytest.mark.parametrize("vehicle", ["passive", "solid_like"])
def test_halving_the_step_changes_no_figure(runs, vehicle):
    """Within 1 % or 0.01 mm, 0.01 mrad, 0.05 kN, 0.1 V, whichever is larger."""
    floors = {"mm": 0.01, "mrad": 0.01, "kN": 0.05, "V": 0.1}
    whole, halved = (curving(runs[name]).row() for name in (vehicle, f"{vehicle} halved"))
    for name, value in whole.items():
        if isinstance(value, float) and not math.isnan(value) and name != "realtime_factor":
            assert halved[name] == pytest.approx(value, rel=0.01, abs=floors.get(name.rsplit("_", 1)[1], 0.0)), name
        elif isinstance(value, str):
            assert halved[name] == value
