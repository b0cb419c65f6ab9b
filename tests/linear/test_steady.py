"""Steady states against runs that have settled: two curves here, all fifteen by `python -m validation`."""

import numpy as np
import pytest

import klingel as kl
from klingel.control import IRWLike, SolidLike
from klingel.errors import SimulationError
from klingel.linear import steady_spec, steady_state, steady_states
from klingel.result import simulate_spec
from klingel.track.cases import perez2004

YAW_MOMENT = 1e4
"""What springs give to a body from either side [N m]; their sum is nil in a steady state, but for rounding."""

CASES = {case.radius: case for case in perez2004()}


@pytest.mark.parametrize(
    ("vehicle", "control"),
    [("manchester_coach", None), ("mechatronic_irw", IRWLike()), ("mechatronic_irw", SolidLike())],
)
def test_a_run_from_the_steady_state_stays_there(vehicle: str, control: object) -> None:
    case = CASES[300.0]
    scenario = kl.Scenario(kl.library.vehicle(vehicle), case.track, speed=case.speed, control=control)
    spec = steady_spec(scenario, at=0.5 * case.track.length)
    spec["run"] |= {"duration": 2.0}
    run = simulate_spec(spec, strict=True)
    moved: dict[str, float] = {}
    sizes: dict[str, float] = {}
    for name, channel in run.data_vars.items():
        quantity = str(name).rpartition(".")[2]
        if quantity != "s" and not str(name).startswith("energy."):  # which grow with the way
            moved[quantity] = max(moved.get(quantity, 0.0), float(np.ptp(channel.to_numpy())))
            least = YAW_MOMENT if quantity == "yaw_moment" else 1e-12
            sizes[quantity] = max(sizes.get(quantity, least), float(np.abs(channel.to_numpy()).max()))
    assert {quantity: m / sizes[quantity] for quantity, m in moved.items() if m > 1e-6 * sizes[quantity]} == {}


def test_an_arc_settles_at_the_steady_state() -> None:
    case = CASES[500.0]
    track = kl.Track.curve(radius=500.0, cant=0.16, transition=150.0, arc=20.0 * case.speed)
    scenario = kl.Scenario(
        kl.library.vehicle("manchester_coach"),
        track,
        speed=case.speed,
        duration=(250.0 + 20.0 * case.speed) / case.speed,
        record_interval="10 ms",
    )
    steady = steady_state(scenario, at="500 m")
    last = kl.simulate(scenario, strict=True).isel(time=-1)
    for wheelset in ("bogie1.wheelset1", "bogie2.wheelset2"):
        for side in ("left", "right"):
            for force in ("Q", "Y", "X"):
                name = f"{wheelset}.{side}.{force}"
                assert float(last[name]) == pytest.approx(steady.values[name], rel=1e-3, abs=5.0)
        assert float(last[f"{wheelset}.y"]) == pytest.approx(steady.values[f"{wheelset}.y"], rel=1e-3)


def test_a_left_curve_is_the_mirror_of_a_right_one() -> None:
    vehicle = kl.library.vehicle("manchester_coach")
    track = CASES[800.0].track
    right, left = (
        steady_state(kl.Scenario(vehicle, t, speed=40.0), at="500 m").values for t in (track, track.mirrored())
    )
    for wheelset in ("bogie1.wheelset1", "bogie2.wheelset2"):
        assert left[f"{wheelset}.y"] == pytest.approx(-right[f"{wheelset}.y"], rel=1e-9)
        assert left[f"{wheelset}.left.Q"] == pytest.approx(right[f"{wheelset}.right.Q"], rel=1e-9)


def test_each_state_of_a_sweep_is_found_from_the_one_before() -> None:
    vehicle = kl.library.vehicle("manchester_coach")
    track = CASES[800.0].track
    scenarios = [kl.Scenario(vehicle, track, speed=v) for v in (40.0, 42.0, 44.0)]
    swept = list(steady_states(scenarios, at="500 m"))
    assert swept[1].iterations < swept[0].iterations
    alone = steady_state(scenarios[2], at="500 m")
    assert swept[2].values["bogie1.wheelset1.y"] == pytest.approx(alone.values["bogie1.wheelset1.y"], rel=1e-8)


def test_an_unstable_state_says_so() -> None:
    case = CASES[1800.0]
    scenario = kl.Scenario(kl.library.vehicle("manchester_coach"), case.track, speed=case.speed)
    steady = steady_state(scenario, at=0.5 * case.track.length)
    assert steady.growth > 1.0
    assert "unstable" in steady.warnings[0]
    calm = steady_state(scenario.replace(speed=60.0))
    assert calm.growth < -0.1
    assert calm.warnings == ()


@pytest.mark.parametrize(
    ("vehicle", "control", "speed", "friction", "said"),
    [
        ("mechatronic_irw", IRWLike(), "300 km/h", 0.35, r"83\.33 m/s, friction 0\.35, in a right-hand .* 22\.49"),
        (
            "manchester_coach",
            None,
            "70 km/h",
            0.01,
            r"19\.44 m/s, friction 0\.01, in a right-hand curve of 300 m with 100 mm",
        ),
    ],
)
def test_what_has_no_steady_state_is_named(
    vehicle: str, control: object, speed: str, friction: float, said: str
) -> None:
    curve = kl.Track.curve(radius="300 m", cant="100 mm", transition="60 m")
    scenario = kl.Scenario(kl.library.vehicle(vehicle), curve, speed=speed, friction=friction, control=control)
    with pytest.raises(SimulationError, match=said):
        steady_state(scenario, at="400 m")
