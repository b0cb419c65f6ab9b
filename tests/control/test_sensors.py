"""Sensors: each error is what it says, draws depend on seed and channel alone, strategies and own controllers measure
through them; mistakes are refused together."""

from __future__ import annotations

import copy
import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel.control import Encoder, Gyro, LoadCell, Position, Sensors, Speedometer
from klingel.control.diagram import Diagram
from klingel.control.sensor import KINDS, Sensor
from klingel.errors import InputError
from klingel.lower import lower

IRW = kl.library.vehicle("mechatronic_irw")
STRAIGHT = kl.Track.straight("200 m")
LEFT = "bogie1.wheelset1.left.spin_speed"
S = "bogie1.wheelset1.s"


class Listens:
    """Measures some channels and commands nothing that matters."""

    def __init__(self, *channels: str) -> None:
        self.channels = channels

    def lower(self, vehicle: object, track: object, speed: float) -> dict[str, Any]:
        """Half of everything measured is recorded."""
        d = Diagram(sample_time=1e-3)
        for channel in self.channels:
            d.probe(f"{channel}.half", "1", d.sum(f"{channel}/2", {d.measure(channel): 0.5}))
        return d.spec()


def listened(*channels: str, sensors: Sensors, **changes: Any) -> xr.Dataset:
    given: dict[str, Any] = {"speed": 30.0, "duration": 1.0, "energy": False, **changes}
    return kl.simulate(kl.Scenario(IRW, STRAIGHT, control=Listens(*channels), sensors=sensors, **given), strict=True)


def test_ideal_sensors_leave_a_strategy_as_it_is() -> None:
    for strategy in (kl.control.SolidLike(), kl.control.IRWLike()):
        spec = strategy.lower(IRW, STRAIGHT, 30.0)
        unused = Sensors(seed=5, record=True, encoder=Encoder())
        assert Sensors().applied(copy.deepcopy(spec)) == unused.applied(spec) == spec


def test_noise_has_its_size_and_each_channel_its_own() -> None:
    right = LEFT.replace("left", "right")
    both = listened(LEFT, right, sensors=Sensors(encoder=Encoder(noise="0.02 rad/s"), record=True))
    noises = [both[f"{channel}.measured"].values - both[channel].values for channel in (LEFT, right)]
    for noise in noises:
        # of 1001 draws, three standard errors
        assert noise.std() == pytest.approx(0.02, rel=0.07)
        assert abs(noise.mean()) < 0.002
    assert abs(np.corrcoef(noises)[0, 1]) < 0.1
    np.testing.assert_array_equal(2.0 * both[f"{LEFT}.half"], both[f"{LEFT}.measured"])


def test_draws_depend_on_seed_and_channel_alone() -> None:
    def measured(*channels: str, seed: int, **kinds: Any) -> np.ndarray[Any, Any]:
        sensors = Sensors(
            encoder=Encoder(noise=0.02, bias_spread=0.01, scale_spread=0.1), seed=seed, record=True, **kinds
        )
        return np.asarray(listened(*channels, sensors=sensors, duration=0.1)[f"{LEFT}.measured"].values)

    alone = measured(LEFT, seed=1)
    np.testing.assert_array_equal(alone, measured(LEFT, seed=1))
    np.testing.assert_array_equal(alone, measured("bogie1.yaw_rate", LEFT, seed=1, gyro=Gyro(noise=1.0)))
    assert np.all(alone != measured(LEFT, seed=2))


def test_spread_is_that_of_many_sensors() -> None:
    sensor = Gyro(bias=0.1, bias_spread=0.01, scale=0.5, scale_spread=0.02)
    gains, biases = np.array([sensor.errors_of(f"gyro{i}", seed=7) for i in range(1000)]).T
    assert (gains.mean(), gains.std()) == pytest.approx((1.5, 0.02), rel=0.07)
    assert (biases.mean(), biases.std()) == pytest.approx((0.1, 0.01), rel=0.07)
    assert abs(np.corrcoef(gains, biases)[0, 1]) < 0.1


def test_bias_scale_resolution_hold_and_delay() -> None:
    position = Position(bias="-30 m", scale=0.01, resolution=0.125, hold="10 ms", delay="20 ms")
    run = listened(S, sensors=Sensors(position=position, record=True))
    true, measured = run[S].values, run[f"{S}.measured"].values
    # until then the delay tells the steady state that the run began with, in which nothing is rounded
    assert np.all(np.round(measured[21:] / 0.125) == measured[21:] / 0.125)
    jumps = np.flatnonzero(np.diff(measured[30:])) + 1
    assert np.all(jumps % 10 == jumps[0] % 10)
    for k in range(100, 900, 10):
        sampled = 1.01 * true[k] - 30.0
        assert abs(measured[k + 20] - sampled) <= 0.0625 + 1e-9
        assert np.all(measured[k + 20 : k + 30] == measured[k + 20])


def test_all_positions_come_from_one_device() -> None:
    other = "bogie2.wheelset2.s"
    sensors = Sensors(position=Position(noise=0.5, bias_spread=3.0), record=True)
    run = listened(S, other, sensors=sensors, duration=0.1)
    errors = [run[f"{channel}.measured"].values - run[channel].values for channel in (S, other)]
    np.testing.assert_allclose(errors[0], errors[1], atol=1e-9)


def test_a_python_controller_measures_through_them_by_its_own_names() -> None:
    class Echo:
        def reset(self) -> None: ...

        def step(self, t: float, measurements: dict[str, float]) -> dict[str, float]:
            return {"told": measurements[LEFT]}

    own = kl.control.PythonController(
        Echo(), sample_time="1 ms", measurements=[LEFT], commands=[], probes={"told": "rad/s"}
    )
    sensors = Sensors(encoder=Encoder(noise=0.02), record=True)
    scenario = kl.Scenario(IRW, STRAIGHT, speed=30.0, control=own, sensors=sensors, duration=0.1, energy=False)
    run = kl.simulate(scenario, strict=True)
    np.testing.assert_array_equal(run["told"], run[f"{LEFT}.measured"])
    assert np.std(run["told"] - run[LEFT]) > 0.01


def test_a_counting_encoder_rounds_to_a_pulse_a_window() -> None:
    encoder = Encoder.counting(pulses=1000, window="20 ms")
    assert (encoder.hold, encoder.delay) == (0.02, 0.01)
    assert encoder.resolution == pytest.approx(2.0 * np.pi / 20.0)


def test_every_measurement_of_the_library_has_a_kind() -> None:
    """But the place of a wheelset between the rails, which no sensor in service tells."""
    known = {"y"} | {word for kind in KINDS.values() for word in kind.quantities}
    strategies = {
        "mechatronic_irw": (kl.control.SolidLike(), kl.control.IRWLike(curvature="database")),
        "trailed_irw": (kl.control.TrailedIRW(), kl.control.LateralFeedback()),
        "mechatronic_solid": (kl.control.YawMoment(), kl.control.YawRelaxation()),
        "actuated_coach": (kl.control.YawMoment(), kl.control.YawRelaxation(), kl.control.SecondaryYaw()),
    }
    for name, those in strategies.items():
        for strategy in those:
            vehicle = kl.library.vehicle(name)
            if not list(strategy.problems(vehicle)):
                for channel in strategy.lower(vehicle, STRAIGHT, 30.0)["measurements"]:
                    assert channel.rpartition(".")[2] in known, channel


def test_what_no_kind_covers_is_ideal_and_noted() -> None:
    y = "bogie1.wheelset1.y"
    run = listened(y, LEFT, sensors=Sensors.typical(), duration=0.1)
    np.testing.assert_array_equal(2.0 * run[f"{y}.half"], run[y])
    assert y in run.attrs["notes"]
    assert LEFT not in run.attrs["notes"]
    assert listened(y, sensors=Sensors(), duration=0.1).attrs["notes"] == ""


@pytest.mark.parametrize("strategy", [kl.control.SolidLike(), kl.control.IRWLike(curvature="database")])
def test_a_position_error_is_a_shifted_database(strategy: Any) -> None:
    """Believing to be 30 m behind is as good as a database in which everything lies 30 m farther along.

    1e-9 m: positions of some hundred metres are rounded.
    """
    track = kl.Track.curve(radius="800 m", cant="60 mm", transition="60 m", arc="60 m", straight_before="60 m")
    base = kl.Scenario(IRW, track, speed=40.0, control=strategy, energy=False, duration=4.0)
    runs = [
        kl.simulate(base.replace(sensors=Sensors(position=Position(bias="-30 m"))), strict=True),
        kl.simulate(base.replace(database=track.mistaken(shift="30 m")), strict=True),
    ]
    y = [run["bogie1.wheelset1.y"].values for run in runs]
    assert np.max(np.abs(y[0])) > 1e-3
    np.testing.assert_allclose(y[0], y[1], atol=1e-9)


def test_steady_states_have_biases_and_no_noise() -> None:
    """The same for the same seed; rounding and noise are not in them."""
    base = kl.Scenario(IRW, STRAIGHT, speed=30.0, control=kl.control.IRWLike())
    typical = kl.linear.steady_state(base.replace(sensors=Sensors.typical(seed=4)))
    again = kl.linear.steady_state(base.replace(sensors=Sensors.typical(seed=4)))
    noise = kl.linear.steady_state(base.replace(sensors=Sensors(encoder=Encoder(noise=0.02, resolution=0.01))))
    ideal = kl.linear.steady_state(base)
    place = "bogie1.wheelset1.y"
    assert typical.values[place] == again.values[place] != ideal.values[place]
    assert noise.values[place] == pytest.approx(ideal.values[place], abs=1e-12)


def test_a_steady_state_believes_what_the_database_has_where_it_believes_to_be() -> None:
    track = kl.Track.curve(radius="800 m", cant="60 mm", transition="60 m", arc="60 m", straight_before="60 m")
    base = kl.Scenario(IRW, track, speed=40.0, control=kl.control.IRWLike(curvature="database"))
    behind = base.replace(sensors=Sensors(position=Position(bias="-30 m")))
    there = kl.linear.steady_state(behind, at="120 m").values["bogie1.wheelset1.y"]
    half = kl.linear.steady_state(base.replace(database=track.mistaken(curvature_scale=0.5)), at="120 m")
    assert there == pytest.approx(half.values["bogie1.wheelset1.y"], abs=1e-9)
    assert abs(there) > 3e-4


def test_linear_models_have_delays_and_means_of_holds() -> None:
    base = kl.Scenario(IRW, STRAIGHT, speed=30.0, control=kl.control.IRWLike())
    slow = base.replace(sensors=Sensors(encoder=Encoder(hold="4 ms", resolution=0.01, noise=0.02)))
    late = base.replace(sensors=Sensors(encoder=Encoder(delay="30 ms")))
    growth = [kl.linear.steady_state(each).growth for each in (base, slow, late)]
    assert growth[1] == pytest.approx(growth[0], rel=0.01)
    assert growth[2] != pytest.approx(growth[0], rel=1e-4)
    with pytest.raises(kl.errors.SimulationError, match=r"control has 80... states.*5000 at most"):
        kl.linearise(base.replace(sensors=Sensors(encoder=Encoder(delay="10 s"))))


def test_problems_come_together() -> None:
    with pytest.raises(InputError) as caught:
        Encoder(noise=-1.0, delay="3 m", bias="0.1 m")
    assert {problem.key for problem in caught.value.problems} == {"noise", "delay", "bias"}
    with pytest.raises(InputError, match=r"gyro.*\n.*seed"):
        Sensors(gyro=Encoder(), seed=-1)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"Sensors"):
        kl.Scenario(IRW, STRAIGHT, speed=30.0, sensors=Encoder())  # type: ignore[arg-type]
    with pytest.raises(InputError) as caught:
        Gyro(scale=-1.0, delay="1e9 s", hold="11 s")
    assert {problem.key for problem in caught.value.problems} == {"scale", "delay", "hold"}
    late = Sensors(encoder=Encoder(delay="0.5 ms"), gyro=Gyro(hold="0.2 ms"), speed=Speedometer(delay="1 ms"))
    with pytest.raises(InputError) as caught:
        lower(kl.Scenario(IRW, STRAIGHT, speed=30.0, control=kl.control.IRWLike(), sensors=late))
    assert [problem.key for problem in caught.value.problems] == ["sensors.encoder.delay", "sensors.gyro.hold"]
    counting = Sensors(encoder=Encoder.counting(pulses=1000, window="1 ms"))
    with pytest.raises(InputError, match=r"encoder\.window = 0\.001: is less than two samples.*0\.002 s or more"):
        lower(kl.Scenario(IRW, STRAIGHT, speed=30.0, control=kl.control.IRWLike(), sensors=counting))


FILE = """
vehicle = "mechatronic_irw"
speed = "108 km/h"
track.straight = "200 m"
control.strategy = "irw_like"
sensors = { %s }
"""


@pytest.mark.parametrize(
    ("text", "sensors"),
    [
        ('gyro = { bias = "0.1 deg/s" }, seed = 3', Sensors(gyro=Gyro(bias="0.1 deg/s"), seed=3)),
        ("typical = true, seed = 2, current = false", dataclasses.replace(Sensors.typical(2), current=None)),
        (
            'load_cell = { noise = "20 N m" }, position = { bias = -30 }',
            Sensors(load_cell=LoadCell(noise=20.0), position=Position(bias=-30.0)),
        ),
    ],
)
def test_files_say_the_same(tmp_path: Path, text: str, sensors: Sensors) -> None:
    path = tmp_path / "case.toml"
    path.write_text(FILE % text)
    assert kl.Scenario.read(path).sensors == sensors


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("gyros = true", "sensors.gyros"),
        ("gyro = 3", "sensors.gyro"),
        ("gyro = { nois = 3 }", "sensors.gyro.nois"),
        ('gyro = { noise = "3 m" }', "sensors.gyro.noise"),
        ("seed = 1.5", "sensors.seed"),
        ("typical = 1", "sensors.typical"),
    ],
)
def test_files_are_refused_with_the_key(tmp_path: Path, text: str, named: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(FILE % text)
    with pytest.raises(InputError) as caught:
        kl.Scenario.read(path)
    assert [problem.key for problem in caught.value.problems] == [named]
    assert caught.value.file == str(path)


def test_every_kind_says_its_unit() -> None:
    for kind in KINDS.values():
        assert issubclass(kind, Sensor)
        assert kind.unit != "1"
        assert kind.quantities
