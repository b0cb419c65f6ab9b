"""Induction drive: library numbers, steady running against the core, strategies on it, the paper's assumption.
The laws are tested in the core; whole curves are the study's."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import library
from klingel.control import IRWLike, SolidLike
from klingel.control.common import WHEELSETS
from klingel.control.response import controller_response
from klingel.core import core
from klingel.drives import InductionTransfer, WheelPair, induction_point, induction_torque_max, operating_point
from klingel.errors import InputError
from klingel.linear import steady_spec
from klingel.linear.modes import modes
from klingel.linear.rig import STEP, longitudinal_creep, torque_response
from klingel.lower import lower
from klingel.track import Track

DC = library.vehicle("mechatronic_irw")
VEHICLE = DC.replace(drive=library.drive("induction_160kw"))
DRIVE = VEHICLE.induction_drive
CURVE = Track.curve(radius=800.0, cant=0.16, transition=195.0, arc=150.0, straight_before=80.0, straight_after=80.0)
SPEED = 176.0 / 3.6
SPEEDS = [v / 3.6 for v in (108, 140, 176, 216, 265)]


def test_library_drive_states_sources_and_takes_the_place_of_the_other() -> None:
    assert DRIVE.sources.keys() == set(DRIVE.source)
    status = {p.key: p.status for p in VEHICLE.parameters() if p.key.startswith("drive.")}
    assert status["drive.rotor_resistance"] == "derived"
    assert status["drive.voltage_max"] == "design"
    for key in ("gear_ratio", "rotor_inertia", "rotor_damping", "transmission_stiffness", "transmission_damping"):
        assert getattr(DRIVE, key) == getattr(DC.drive, key)
    assert VEHICLE.replace(drive=DC.drive) == DC
    with pytest.raises(InputError, match=r"drive = 'induction'.*library"):
        library.drive("induction")


def test_bad_drives_are_named_by_their_key() -> None:
    tables = DRIVE.model_dump()
    with pytest.raises(InputError, match=r"drive.rotor_resistance = '3 H'"):
        DC.replace(drive=tables | {"rotor_resistance": "3 H"})
    with pytest.raises(InputError, match=r"drive.stator_leak .*stator_leakage"):
        DC.replace(drive=tables | {"stator_leak": 1.0})
    with pytest.raises(InputError, match=r"drive.kind = 'steam'.*dc.*induction"):
        DC.replace(drive=tables | {"kind": "steam"})
    with pytest.raises(InputError, match="is no DC drive"):
        operating_point(VEHICLE, 30.0)
    with pytest.raises(InputError, match="is no induction drive"):
        induction_point(DC, 30.0)


@pytest.mark.parametrize("speed", SPEEDS)
def test_steady_running_is_that_of_the_core(speed: float) -> None:
    """Currents, flux and voltage by hand and from the core's steady state; the resistance is held."""
    point = induction_point(VEHICLE, speed)
    scenario = kl.Scenario(VEHICLE, Track.straight(500.0), speed=speed)
    model = kl.linearise(scenario)
    found = dict(zip([o.name for o in model.outputs], model.y, strict=True))
    wheel = "bogie1.wheelset1.left"
    for key in ("torque_command", "current_d", "current_q", "rotor_flux", "stator_voltage", "motor_speed"):
        assert found[f"{wheel}.{key}"] == pytest.approx(getattr(point, key), rel=3e-3), key
    assert found[f"{wheel}.air_gap_torque"] == pytest.approx(point.torque_command, rel=1e-9)
    assert found[f"{wheel}.shaft_torque"] == pytest.approx(point.wheel_torque, rel=3e-3)


def test_largest_torques() -> None:
    """By current at low speed, by voltage at high speed; below the circuit's breakdown torque at the base speed."""
    slow, base, fast = (induction_torque_max(DRIVE, w) for w in (0.0, 190.0, 480.0))
    assert slow == pytest.approx(1373.0, rel=1e-3)
    assert base <= slow < 1858.0
    assert fast == pytest.approx(317.6, rel=1e-3)
    with pytest.raises(InputError, match=r"needs .* N m of a motor that gives"):
        induction_point(VEHICLE, 265 / 3.6, resistance=lambda v: 1e5)


def test_modes_of_the_vehicle_count_its_states_as_drives() -> None:
    spec = steady_spec(kl.Scenario(VEHICLE, Track.straight(500.0), speed=SPEED))
    core().check(json.dumps(spec, allow_nan=False))
    assert len(spec["induction_drives"]) == 8
    assert spec["drives"] == []
    found = modes(kl.Scenario(VEHICLE, Track.straight(500.0), speed=SPEED))
    assert any(mode.name.startswith("motor") for mode in found)
    assert not any("controller" in mode.name for mode in found)


@pytest.mark.parametrize("speed", [SPEEDS[0], SPEEDS[4]])
def test_torque_answers_as_that_of_the_dc_motor_below_15_hz(speed: float) -> None:
    """The paper replaces the induction motor by a DC motor: within 1 dB and 10 degrees on the rig."""
    f, dc = torque_response(DC, speed)
    same, induction = torque_response(VEHICLE, speed)
    np.testing.assert_array_equal(f, same)
    ratio = induction / dc
    assert np.abs(20.0 * np.log10(np.abs(ratio))).max() < 1.0
    assert np.abs(np.degrees(np.angle(ratio))).max() < 10.0
    assert np.abs(induction[0]) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("speed", [SPEEDS[0], SPEEDS[4]])
def test_the_transfer_functions_are_what_the_rig_answers(speed: float) -> None:
    """Eq. (27) with A = a/(s + a): within 0.01 dB once sample, output and hold of the command are counted."""
    f, found = torque_response(VEHICLE, speed, band=(1.0, 100.0))
    omega = 2.0 * np.pi * f
    pair = WheelPair(45.0, 0.46, speed, longitudinal_creep(VEHICLE))
    s = 1j * omega * STEP
    stated = InductionTransfer.of(DRIVE).torque_plant(pair).response(omega) * np.exp(-s) * (1.0 - np.exp(-s)) / s
    np.testing.assert_allclose(found / stated, 1.0, atol=2e-3)


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_speed_loop_of_s_has_a_gain_margin_of_2_and_a_phase_margin_of_45_degrees(speed: float) -> None:
    """On the plant (29) of the induction drive, with creep coefficients 30 % off either way."""
    omega = 2.0 * np.pi * np.geomspace(0.1, 400.0, 3000)
    spec = SolidLike().lower(VEHICLE, CURVE, speed)
    response = controller_response(spec, {"body.speed": speed}, omega)
    command = [c["target"] for c in spec["commands"]].index("bogie1.wheelset1.left.torque_command")
    left, right = (spec["measurements"].index(f"bogie1.wheelset1.{side}.spin_speed") for side in ("left", "right"))
    controller = response[:, command, left] - response[:, command, right]
    late = np.exp(-1.5j * omega * spec["sample_time"])
    for creep in (7.0e6, 10.0e6, 13.0e6):
        plant = InductionTransfer.of(DRIVE).speed_plant(WheelPair(45.0, 0.46, speed, creep)).response(omega)
        loop = -controller * plant * late
        crosses = (loop.imag[1:] * loop.imag[:-1] < 0.0) & (loop.real[1:] < 0.0)
        assert np.max(np.abs(loop[1:][crosses]), initial=0.0) < 0.5
        unity = (np.abs(loop[1:]) - 1.0) * (np.abs(loop[:-1]) - 1.0) < 0.0
        phases = 180.0 - np.abs(np.degrees(np.angle(loop[1:][unity])))
        assert np.min(phases, initial=180.0) > 45.0


def test_a_warm_rotor_turns_the_flux_off_its_axis() -> None:
    """The control takes the rotor for cold: less torque than commanded, which a linear model still runs about."""
    warm = VEHICLE.replace(
        drive=DRIVE.model_copy(update={"rotor_resistance": 0.1077, "rotor_resistance_assumed": DRIVE.rotor_resistance})
    )
    model = kl.linearise(kl.Scenario(warm, Track.straight(500.0), speed=SPEED))
    state = dict(zip([s.name for s in model.states], model.x, strict=True))
    found = dict(zip([o.name for o in model.outputs], model.y, strict=True))
    wheel = "bogie1.wheelset1.left"
    assert state[f"{wheel}.rotor_flux_q"] > 0.01
    assert 0.7 < found[f"{wheel}.air_gap_torque"] / found[f"{wheel}.torque_command"] < 0.99


def y_max(run: xr.Dataset) -> float:
    assert run.attrs["outcome"] == "completed"
    return max(float(np.abs(run[f"{w.name}.y"]).max()) for w in WHEELSETS)


@pytest.mark.parametrize("strategy", [SolidLike(), IRWLike()])
def test_a_curve_is_run_as_with_dc_motors(strategy: SolidLike | IRWLike) -> None:
    """R = 800 m at 176 km/h: the largest displacement within 0.1 mm, drives within their limits."""
    runs = [
        kl.simulate(kl.Scenario(vehicle, CURVE, speed=SPEED, control=strategy, step="1 ms"))
        for vehicle in (DC, VEHICLE)
    ]
    dc, induction = (y_max(run) for run in runs)
    assert induction == pytest.approx(dc, abs=0.1e-3)
    run = runs[1]
    for w in WHEELSETS:
        u = run[f"{w.name}.steering_torque"].values
        left, right = (run[f"{w.name}.{side}.torque_command"].values for side in ("left", "right"))
        np.testing.assert_allclose(0.5 * (left - right)[1:], u[:-1], atol=1e-9)
        current = np.hypot(run[f"{w.name}.left.current_d"], run[f"{w.name}.left.current_q"])
        assert float(current.max()) < DRIVE.current_max
        assert float(run[f"{w.name}.left.stator_voltage"].max()) < DRIVE.voltage_max
    if isinstance(strategy, IRWLike):
        assert not np.any(run[f"{WHEELSETS[0].name}.steering_torque"])


def test_a_field_is_moved_where_a_controller_commands_it() -> None:
    """The lowering gives a field circuit to the drives whose field voltage is commanded, and to no other."""

    class Forcing:
        def lower(self, vehicle: object, track: object, speed: float) -> dict[str, object]:
            signal = {"kind": "sum", "name": "Vf", "terms": [], "bias": 130.0}
            target = {"target": "bogie1.wheelset1.left.field_voltage", "signal": "Vf"}
            return {"sample_time": 1e-3, "measurements": [], "blocks": [signal], "commands": [target]}

    scenario = kl.Scenario(DC, Track.straight(400.0), speed=SPEED, control=Forcing(), duration=0.5)
    fields = [d["field"] for d in lower(scenario)["drives"]]
    assert fields[0] == {"resistance": 20.0, "inductance": 12.0, "voltage_max": 300.0}
    assert fields[1:] == [None] * 7
    run = kl.simulate(scenario)
    start = operating_point(DC, SPEED).field_current
    wanted = 6.5 + (start - 6.5) * math.exp(-0.499 / 0.6)
    assert float(run["bogie1.wheelset1.left.field_current"][-1]) == pytest.approx(wanted, abs=2e-4)
