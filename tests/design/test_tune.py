"""Designs of single loops: formulas against the full vehicle, wanted margins kept as closely as they can be."""

import dataclasses

import numpy as np
import pytest

import klingel as kl
from klingel.control.response import controller_response
from klingel.design import Design, loops, tune
from klingel.design.limits import MOTORS, Limits, missed
from klingel.design.margins import of_response
from klingel.design.plants import leading_to, motor_plants, plant_loop, steering_plants
from klingel.design.tune import encirclements, steering_loop, torque_loop, yaw_moment_loop
from klingel.errors import InputError
from klingel.plot.design import loop_bode

from .conftest import scenario

VEHICLE = kl.library.vehicle("mechatronic_irw")
FAST = 265.0 / 3.6


@pytest.fixture(scope="module")
def torque() -> Design:
    return torque_loop(VEHICLE, ["108 km/h", "265 km/h"])


def test_the_plant_of_the_current_loop_is_that_of_the_vehicle() -> None:
    """Eqs (2), (10) and (27) against the whole vehicle, all other loops closed, from 3 Hz to 300 Hz."""
    fast = scenario("I gyro", FAST)
    f = np.geomspace(3.0, 300.0, 60)
    whole = next(loop for loop in loops(fast) if loop.name == "bogie1.wheelset1.motors").response(f)
    plant = plant_loop(fast, "motors")(f)
    error = np.abs(plant / whole - 1.0)
    assert error[f > 10.0].max() < 0.03
    assert error.max() < 0.25  # below, the axle yaws, which Eq. (26) does not know


def test_a_design_keeps_what_was_wanted_and_no_more(torque: Design) -> None:
    assert torque.met
    assert torque.margins.delay == pytest.approx(MOTORS.delay, rel=0.1)
    assert torque.margins.delay >= MOTORS.delay
    assert torque.gains == {"current_frequency": torque.value}
    assert isinstance(torque.strategy, kl.control.IRWLike)
    assert torque.strategy.current_frequency == torque.value


def test_a_design_tells_what_it_does_on_the_full_vehicle(torque: Design) -> None:
    assert set(torque.full["kind"]) == {"motors"}
    assert len(torque.full) == 8
    words = " ".join(torque.words())
    assert words.startswith(
        f"current_frequency = {torque.value:.4g}: keeps gain 2, phase 45°, delay 10 ms on the plant"
    )
    assert torque.check.name == "IRWLike"
    assert len(torque.check.table) == 20


def test_a_design_shows_its_response(torque: Design) -> None:
    table = torque.bode()
    assert sorted(set(table["speed"].round(2))) == [30.0, round(FAST, 2)]
    one = table[table["speed"] < 31.0]
    crossed = float(np.interp(0.0, -np.log(one["magnitude"]), one["frequency"]))
    assert crossed == pytest.approx(torque.shown[0].margins.crossover, rel=0.01)
    assert len(loop_bode(torque.shown, title="torque").axes) == 2


def test_a_design_on_a_plant_that_the_vehicle_does_not_bear_is_told() -> None:
    """The moment loop knows the actuators alone: several times faster than the hunting of the wheelsets allows."""
    moment = yaw_moment_loop(VEHICLE, ["108 km/h"])
    assert moment.met
    words = moment.words()
    assert all("keeps" not in sentence for sentence in words[1:])
    assert sum(sentence.startswith("On the full vehicle") for sentence in words) == 4


def test_what_cannot_be_kept_is_told() -> None:
    found = steering_loop(VEHICLE, ["140 km/h"], wanted=Limits(phase=3.2))
    assert not found.met
    assert "no value keeps" in found.words()[0]


def test_larger_gains_keep_less(torque: Design) -> None:
    """The largest value: five percent more misses something on the same plant."""
    assert torque.strategy is not None
    more = dataclasses.replace(torque.strategy, current_frequency=1.05 * torque.value)
    short = []
    for speed in (30.0, FAST):
        response = plant_loop(scenario(speed=speed).replace(control=more), "motors")
        f = torque.shown[0].frequencies
        short += list(missed(vars(of_response(response, f, response(f))), torque.wanted))
    assert short


def test_the_blocks_of_one_command_are_enough() -> None:
    """A loop read from the part of the diagram that makes its commands is that of the whole."""
    spec = kl.control.IRWLike().lower(VEHICLE, kl.Track.straight("1 km"), 30.0)
    target = "bogie1.wheelset1.actuator_left.force"
    part = leading_to(spec, [target])
    assert len(part["blocks"]) < 0.6 * len(spec["blocks"])
    omega = np.geomspace(1.0, 1e3, 20)
    whole = controller_response(spec, {"body.speed": 30.0}, omega)
    row = [command["target"] for command in spec["commands"]].index(target)
    some = controller_response(part, {"body.speed": 30.0}, omega)
    places = [spec["measurements"].index(name) for name in part["measurements"]]
    np.testing.assert_allclose(some[:, 0], whole[:, row, places], rtol=1e-12)
    others = np.delete(whole[:, row], places, axis=1)
    assert not others.any()


def test_growing_poles_are_counted() -> None:
    """Of a third-order lag and of integrators, as gains and roots say."""
    f = np.geomspace(1e-3, 1e3, 3000)
    s = 2j * np.pi * f
    for gain, poles in ((1.0, 0), (7.9, 0), (8.1, 2), (20.0, 2)):
        assert encirclements(f, gain / (s + 1.0) ** 3) == poles
        roots = np.roots([1.0, 3.0, 3.0, 1.0 + gain])
        assert int((roots.real > 0.0).sum()) == poles
    assert encirclements(f, 0.5 / (s * (s + 1.0) ** 2)) == 0
    assert encirclements(f, 3.0 / (s * (s + 1.0) ** 2)) == 2
    assert encirclements(f, 1.0 / (s**2 * (s + 1.0))) == 2


def test_plants_of_the_steering() -> None:
    """Slow forces turn the axle by M/kpsi, which rolls away with y' = V psi."""
    plants = steering_plants(VEHICLE, 30.0, kl.control.ContactDesign())
    s = 1e-3j
    stiffness = kl.control.common.Plant.of(VEHICLE).geometry.yaw_stiffness
    assert plants["yaw_rate"](s) / s == pytest.approx(2.0 / stiffness, rel=1e-4)
    assert plants["spin_speed"](s) * s == pytest.approx(30.0**2 * 0.2 / 0.46**2 * 2.0 / stiffness, rel=1e-3)


def test_bad_designs_are_refused() -> None:
    with pytest.raises(InputError, match="is not of this scenario"):
        tune(scenario(), "couplings", "motors", MOTORS)
    with pytest.raises(InputError, match="closes no loop"):
        plant_loop(scenario().replace(control=None), "motors")
    with pytest.raises(InputError, match="has no motors"):
        motor_plants(kl.library.vehicle("manchester_coach"), 30.0, kl.control.ContactDesign())
    with pytest.raises(InputError, match="are none"):
        torque_loop(VEHICLE, [])
