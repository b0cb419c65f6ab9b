"""The assessment on synthetic runs whose figures are known in closed form.
Each test shapes one channel and expects one figure."""

from __future__ import annotations

import math

import numpy as np
import pytest

from klingel.assess import COLUMNS, curving
from klingel.assess.signals import longer_than, low_pass, runs, sliding_mean
from klingel.errors import InputError

FIRST = "bogie1.wheelset1"
LAST = "bogie2.wheelset2"
IN_ARC = 10.0  # s: the body is in the arc from 7 s to 13 s, in the curve from 3 s to 17 s


def pulse(begin, end, height):
    return lambda t: np.where((t >= begin) & (t < end), height, 0.0)


def test_columns_are_the_asked_ones_in_the_asked_order(synthetic):
    asked = (
        "vehicle radius_m speed_kmh y_max_mm y_curve_mm attack_angle_max_mrad lateral_force_max_kN "
        "lateral_force_floor_kN wear_index_N actuator_force_max_kN steering_voltage_max_V armature_current_max_A "
        "contact_angle_max_deg yq_max q_min_kN body_lateral_acc_mps2 spin_work_N flange_contact outcome "
        "notes realtime_factor"
    )
    assert " ".join(COLUMNS) == asked
    assert tuple(curving(synthetic.run()).row()) == COLUMNS


def test_quiet_run(synthetic):
    row = curving(synthetic.run(), vehicle="passive")
    assert (row.vehicle, row.radius_m, row.speed_kmh) == ("passive", 300.0, 108.0)
    assert row.y_max_mm == row.attack_angle_max_mrad == row.wear_index_N == row.lateral_force_max_kN == 0.0
    assert row.q_min_kN == pytest.approx(54.5)
    assert (row.flange_contact, row.outcome, row.realtime_factor) == ("", "completed", 12.5)
    sine = 0.16 / 1.5
    floor = 44.482 / 4 * (900 / 300 * math.sqrt(1 - sine**2) - 9.81 * sine)
    assert row.lateral_force_floor_kN == pytest.approx(floor)


def test_a_vehicle_without_motors_has_no_motor_figures(synthetic):
    row = curving(synthetic.run())
    assert all(
        math.isnan(x) for x in (row.actuator_force_max_kN, row.steering_voltage_max_V, row.armature_current_max_A)
    )
    active = curving(synthetic.run({f"{LAST}.right.armature_current": -250.0}, active=True))
    assert (active.armature_current_max_A, active.actuator_force_max_kN) == (250.0, 0.0)


@pytest.mark.parametrize(("hand", "sign"), [(1.0, 1.0), (-1.0, -1.0)])
def test_mirrored_curves_have_equal_figures(synthetic, hand, sign):
    shapes = {
        f"{FIRST}.y": pulse(8.0, 9.0, -sign * 3e-3),
        f"{FIRST}.yaw": pulse(8.0, 9.0, sign * 2e-3),
        f"{FIRST}.{'left' if sign > 0 else 'right'}.Y": -sign * 20e3,
    }
    row = curving(synthetic.run(shapes, hand=hand))
    assert row.y_max_mm == pytest.approx(3.0)
    assert row.attack_angle_max_mrad == pytest.approx(2.0)
    assert row.lateral_force_max_kN == pytest.approx(20.0)
    assert row.yq_max == pytest.approx(20.0 / 54.5)
    assert row.lateral_force_floor_kN == pytest.approx(21.534, abs=1e-3)


def test_window_of_the_maxima_follows_each_wheelset(synthetic):
    """The curve runs from 90 m to 510 m; the first wheelset is there at 2.64 s and leaves at 16.64 s."""
    outside = {f"{FIRST}.y": lambda t: np.where((t < 1.63) | (t > 19.65), 9e-3, 0.0)}
    assert curving(synthetic.run(outside)).y_max_mm == 0.0
    early = {f"{FIRST}.y": pulse(1.65, 1.70, 9e-3)}
    assert curving(synthetic.run(early)).y_max_mm == pytest.approx(9.0)
    late = {f"{FIRST}.y": pulse(19.60, 19.63, 9e-3)}
    assert curving(synthetic.run(late)).y_max_mm == pytest.approx(9.0)


def test_steady_displacement_is_the_mean_over_the_last_two_seconds_of_the_arc(synthetic):
    """The last wheelset leaves the arc (390 m) at 13.359 s."""
    shape = {f"{LAST}.y": lambda t: np.where((t > 12.36) & (t < 13.36), -4e-4, 0.0)}
    row = curving(synthetic.run(shape))
    assert row.y_curve_mm == pytest.approx(0.2, rel=2e-3)
    assert row.wheelsets[LAST].y_curve == pytest.approx(2e-4, rel=2e-3)
    assert row.wheelsets[FIRST].y_curve == 0.0


def test_wear_is_the_mean_of_all_wheels_over_the_arc(synthetic):
    shape = {f"{FIRST}.left.tgamma": lambda t: np.where(t < 3.0, 1e6, 800.0), f"{FIRST}.right.spin_work": 16.0}
    row = curving(synthetic.run(shape))
    assert row.wear_index_N == pytest.approx(100.0)
    assert row.spin_work_N == pytest.approx(2.0)


def test_lateral_force_is_the_filtered_sum_of_a_wheelset(synthetic):
    shape = {
        f"{FIRST}.left.Y": lambda t: -30e3 + 5e3 * np.sin(2 * np.pi * 200.0 * t),
        f"{FIRST}.right.Y": lambda t: 6e3 + 3e3 * np.sin(2 * np.pi * 20.0 * t),
    }
    row = curving(synthetic.run(shape))
    assert row.lateral_force_max_kN == pytest.approx(24.0 + 3.0 * math.sqrt(0.5), abs=0.02)


def test_lateral_force_of_a_step_overshoots_little(synthetic):
    row = curving(synthetic.run({f"{FIRST}.left.Y": lambda t: np.where(t > 8.0, -20e3, 0.0)}))
    assert 20.0 < row.lateral_force_max_kN < 20.0 * 1.05


def test_guiding_force_is_positive_outwards(synthetic):
    """A pair that squeezes inwards guides nothing; a wheel that pushes its rail outwards does."""
    inwards = {f"{FIRST}.left.Y": 10e3, f"{FIRST}.right.Y": -10e3}
    assert curving(synthetic.run(inwards)).yq_max == pytest.approx(0.0, abs=1e-9)
    outwards = {f"{FIRST}.left.Y": -10e3, f"{FIRST}.right.Y": 10e3, f"{FIRST}.right.Q": 40e3}
    assert curving(synthetic.run(outwards)).yq_max == pytest.approx(0.25)


def test_short_guiding_peaks_are_averaged_over_two_metres(synthetic):
    """At 30 m/s a peak of 20 ms is 0.6 m: its mean over 2 m is 0.3 of it."""
    row = curving(synthetic.run({f"{FIRST}.left.Y": pulse(8.0, 8.02, -54.5e3)}))
    assert row.yq_max == pytest.approx(0.3, abs=0.02)


def test_least_wheel_load(synthetic):
    shape = {f"{LAST}.right.Q": lambda t: 54.5e3 - 20e3 * (np.abs(t - IN_ARC) < 1.0)}
    assert curving(synthetic.run(shape)).q_min_kN == pytest.approx(34.5, abs=1.0)


@pytest.mark.parametrize(
    ("force", "angle", "duration", "found"),
    [
        (5e3, 0.6, 0.2, "root"),
        (5e3, 1.2, 0.2, "flange"),
        (5e3, 1.2, 0.1, ""),
        (5e3, 0.6, 0.09, ""),
        (0.9e3, 0.6, 0.2, ""),
    ],
)
def test_flange_contact(synthetic, force, angle, duration, found):
    shape = {
        f"{FIRST}.left.steep_force": pulse(8.0, 8.0 + duration - 5e-4, force),
        f"{FIRST}.left.contact_angle": pulse(8.0, 8.0 + duration - 5e-4, angle),
    }
    row = curving(synthetic.run(shape))
    assert row.flange_contact == found
    assert row.contact_angle_max_deg == pytest.approx(math.degrees(angle))


def test_a_contact_that_breaks_does_not_add_up(synthetic):
    chatter = {f"{FIRST}.left.steep_force": lambda t: np.where(((t * 1e3) % 100) < 80, 5e3, 0.0)}
    assert curving(synthetic.run(chatter)).flange_contact == ""


def test_a_short_flank_contact_within_root_contact_stays_root(synthetic):
    shape = {
        f"{FIRST}.left.steep_force": pulse(8.0, 9.0, 5e3),
        f"{FIRST}.left.contact_angle": lambda t: np.where((t > 8.5) & (t < 8.55), 1.2, 0.6),
    }
    assert curving(synthetic.run(shape)).flange_contact == "root"


def test_a_run_that_ended_early_is_assessed_as_far_as_it_got(synthetic):
    shape = {f"{FIRST}.y": pulse(4.0, 5.0, 7e-3)}
    row = curving(synthetic.run(shape, duration=6.0, outcome="derailed: bogie1.wheelset1 at 6.0 s"))
    assert row.outcome.startswith("derailed")
    assert row.y_max_mm == pytest.approx(7.0)
    assert math.isnan(row.y_curve_mm)
    assert math.isnan(row.wear_index_N)
    assert row.after_curve_s == 0.0
    assert curving(synthetic.run()).after_curve_s == 3.0


def test_missing_parts_are_named(synthetic):
    whole = synthetic.run()
    with pytest.raises(InputError, match=r"bogie2\.wheelset1\.y"):
        curving(whole.drop_vars("bogie2.wheelset1.y"))
    del whole.attrs["outcome"]
    with pytest.raises(InputError, match="outcome"):
        curving(whole)


def test_thinned_files_are_refused(synthetic):
    assert curving(synthetic.run(interval=2e-3)).outcome == "completed"
    with pytest.raises(InputError, match=r"rate=None"):
        curving(synthetic.run(interval=5e-3))


def test_a_straight_track_is_refused(synthetic):
    with pytest.raises(InputError, match="this track has 0"):
        curving(synthetic.run(hand=0.0))


def test_low_pass_keeps_slow_signals_and_time():
    time = np.arange(0.0, 5.0, 1e-3)
    slow = np.sin(2 * np.pi * 2.0 * time)
    assert np.max(np.abs(low_pass(slow, 1e-3) - slow)[500:-500]) < 1e-3
    fast = low_pass(np.sin(2 * np.pi * 40.0 * time), 1e-3)[1000:-1000]
    assert np.max(np.abs(fast)) < 10 ** (-16 / 20)  # 24 dB per octave, 3 dB of it spent at the corner
    with pytest.raises(InputError, match="200 Hz"):
        low_pass(slow, 0.02)


def test_stretches():
    assert runs(np.zeros(5, bool)) == []
    assert longer_than(np.ones(100, bool), 1e-3, 0.1) == []
    assert longer_than(np.ones(101, bool), 1e-3, 0.1) == [(0, 101)]
    with pytest.raises(InputError, match="positive speed"):
        sliding_mean(np.zeros(10), 1e-3, 0.0)
