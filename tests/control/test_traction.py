"""Traction loops: what is asked follows the command, voltages keep their shares, slip control keeps wheels rolling."""

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel.assess.traction import patch
from klingel.control import IRWLike, SlipControl, SolidLike, Traction
from klingel.drives import starting_point, torque_limit, traction_torque_max
from klingel.errors import InputError
from klingel.linear.blocks import eigenvalues
from klingel.track import Adhesion

VEHICLE = kl.library.vehicle("mechatronic_irw")
DRIVE = VEHICLE.dc_drive
WHEELSETS = [f"bogie{i}.wheelset{j}" for i in (1, 2) for j in (1, 2)]


def run(traction: Traction, speed: float, *, strategy: type = SolidLike, **more: object) -> xr.Dataset:
    track = kl.Track.straight("1 km")
    scenario = kl.Scenario(VEHICLE, track, speed=speed, control=strategy(traction=traction), **more)
    return kl.simulate(scenario, strict=True)


@pytest.fixture(scope="module")
def launch() -> xr.Dataset:
    return run(Traction.follow([0.0, 1.0, 8.0], ["0 km/h", "0 km/h", "20 km/h"]), 0.0)


def test_a_launch_follows_the_speed_asked(launch: xr.Dataset) -> None:
    wanted = np.interp(launch.time, [0.0, 1.0, 8.0], [0.0, 0.0, 20.0 / 3.6])
    assert float(np.abs(launch["body.speed"] - wanted).max()) < 0.3  # the slip limit lets torque rise in 0.2 s
    assert float(launch["body.speed"][-1]) == pytest.approx(20.0 / 3.6, abs=0.15)  # the last corner is rounded


def test_the_energy_of_a_launch_balances(launch: xr.Dataset) -> None:
    account = kl.assess.energy(launch)
    assert abs(account.loc["residual", "share"]) < 5e-3
    assert account.loc["kinetic", "energy_kJ"] == pytest.approx(0.5 * 47.0 * (20.0 / 3.6) ** 2, rel=0.03)


def test_traction_and_steering_keep_their_shares_of_the_voltage() -> None:
    result = run(Traction.notched([0.0, 0.1, 4.0], [0.0, 1.0, 1.0]), 45.0)
    share = DRIVE.traction_share * DRIVE.armature_voltage_max
    for name in WHEELSETS:
        left, right = (result[f"{name}.{side}.armature_voltage"] for side in ("left", "right"))
        assert float(np.abs(0.5 * (left + right)).max()) <= share * (1.0 + 1e-9)
        assert float(np.abs(0.5 * (left - right)).max()) <= DRIVE.armature_voltage_max - share + 1e-9
        assert float(np.abs(result[f"{name}.left.armature_current"]).max()) < 1.1 * DRIVE.armature_current_rated
    given = float(result["bogie1.wheelset1.left.shaft_torque"][-1])
    most = traction_torque_max(VEHICLE, float(result["body.speed"][-1]))
    assert 0.95 * most < given < most  # the field leaves a margin of 3 % of the voltage


def test_the_field_is_full_at_rest_and_weak_at_speed() -> None:
    assert starting_point(VEHICLE, 0.0, margin=0.97) == (10.0, 0.0)
    field, voltage = starting_point(VEHICLE, 70.0, margin=0.97)
    assert field == pytest.approx(0.97 * 900.0 / (DRIVE.emf_constant * 70.0 / 0.46 * 3.0))
    assert 0.97 * 900.0 < voltage < 900.0
    speed = 300.0
    friction = DRIVE.rotor_damping * speed / DRIVE.gear_ratio
    there = speed * DRIVE.gear_ratio * 0.46
    assert traction_torque_max(VEHICLE, there) == pytest.approx(torque_limit(DRIVE, speed) - friction)


@pytest.mark.parametrize("strategy", [SolidLike, IRWLike])
@pytest.mark.parametrize("notch", [1.0, -1.0])
def test_slip_control_on_a_patch(strategy: type, notch: float) -> None:
    leaves = Adhesion(patches=[(90.0, 130.0, 0.08)], transition=5.0)
    speed = 15.0
    result = run(Traction.notched([0.0, 0.5, 8.0], [0.0, notch, notch]), speed, strategy=strategy, adhesion=leaves)
    found = patch(result, 90.0, 130.0)
    assert 0.005 < found.creepage_max < 0.03
    assert found.recovery_s < 1.0
    assert found.growth < 1.0


def test_a_braking_notch_stops_and_does_not_drive_backwards() -> None:
    result = run(Traction.notched([0.0, 0.5, 12.0], [0.0, -1.0, -1.0]), 3.0)
    assert abs(float(result["body.speed"][-1])) < 0.1
    assert float(result["body.speed"].min()) > -0.1


def test_slip_control_can_be_left_out() -> None:
    assert Traction.notched([0.0], [1.0], slip=None).slip is None
    assert Traction.follow(["0 s", "1 min"], [1.0, 2.0]).time == (0.0, 60.0)


@pytest.mark.parametrize("slip", [None, SlipControl()])
@pytest.mark.parametrize("drive", ["dc", "induction"])
def test_vehicles_with_traction_loops_linearise_and_are_stable(slip: SlipControl | None, drive: str) -> None:
    vehicle = VEHICLE if drive == "dc" else VEHICLE.replace(drive=kl.library.drive("induction_160kw"))
    control = IRWLike(traction=Traction.follow([0.0, 9.0], [40.0, 40.0], slip=slip))
    model = kl.linearise(kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=40.0, control=control))
    found = eigenvalues(model)
    assert found[np.isfinite(found)].real.max() < 1e-3


def test_without_slip_control_wheels_spin() -> None:
    leaves = Adhesion(patches=[(50.0, 130.0, 0.05)], transition=5.0)
    wild = Traction((0.0, 0.5, 5.0), notch=(0.0, 1.0, 1.0), slip=None)
    result = run(wild, 15.0, strategy=IRWLike, adhesion=leaves)
    assert patch(result, 50.0, 130.0).creepage_max > 0.1


@pytest.mark.parametrize("strategy", [SolidLike, IRWLike])
@pytest.mark.parametrize("speed", [8.0, 14.0, 22.0])
def test_both_strategies_are_stable_below_the_speeds_of_the_study(strategy: type, speed: float) -> None:
    model = kl.linearise(kl.Scenario(VEHICLE, kl.Track.straight("1 km"), speed=speed, control=strategy()))
    found = eigenvalues(model)
    assert found[np.isfinite(found)].real.max() < 1e-3


def test_commands_that_are_none_are_refused() -> None:
    for make, said in (
        (lambda: Traction((0.0, 1.0)), "needs a speed or a notch"),
        (lambda: Traction.follow([0.0], ["10 km/h", "20 km/h"]), "does not go with its times"),
        (lambda: Traction.follow([0.0, 0.0], [1.0, 2.0]), "does not grow"),
        (lambda: Traction.notched([0.0], [1.5]), "out of range"),
        (lambda: Traction.follow([0.0], ["10 kg"]), "is a mass"),
        (lambda: SlipControl(creepage=0.0), "control.traction.slip.creepage = 0.0: must be positive"),
    ):
        with pytest.raises(InputError, match=said):
            make()
    with pytest.raises(InputError, match="begins elsewhere"):
        kl.Scenario(
            VEHICLE,
            kl.Track.straight("1 km"),
            speed=30.0,
            control=IRWLike(traction=Traction.follow([0.0, 5.0], [10.0, 20.0])),
        )
    with pytest.raises(InputError, match=r"ends before 2000 m are run"):
        kl.Scenario(
            VEHICLE,
            kl.Track.straight("1 km"),
            speed=50.0,
            control=IRWLike(traction=Traction.follow([0.0, 40.0], [50.0, 50.0])),
        )


def test_a_run_ends_where_the_track_ends() -> None:
    control = SolidLike(traction=Traction.notched([0.0, 10.0], [1.0, 1.0]))
    result = kl.simulate(kl.Scenario(VEHICLE, kl.Track.straight("80 m"), speed=30.0, control=control))
    assert result.attrs["outcome"].startswith("end of track: bogie1.wheelset1 has reached 80.0 m")
