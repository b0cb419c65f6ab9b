"""Each strategy on the vehicle it is made for: what fits what, stability on straight track, and the law it states.
Steady states and linear models of the same spec that runs; runs only where a law is about motion."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import control, library
from klingel.control.basics import WHEELSETS
from klingel.control.feedforward import SteeringGeometry
from klingel.errors import InputError
from klingel.linear import critical_speed, frequency_response, steady_state
from klingel.linear.critical import least_stable
from klingel.linear.margins import loop_gain, margins
from klingel.scenario.files import STRATEGIES, strategy
from klingel.track import Track
from klingel.track.cases import perez2004

FITS: dict[type[Any], set[str]] = {
    control.Passive: {"actuated_coach", "manchester_coach", "mechatronic_irw", "mechatronic_solid", "trailed_irw"},
    control.PassiveIRW: {"mechatronic_irw", "trailed_irw"},
    control.TrailedIRW: {"trailed_irw"},
    control.SolidLike: {"mechatronic_irw"},
    control.IRWLike: {"mechatronic_irw"},
    control.YawMoment: {"mechatronic_solid"},
    control.YawRelaxation: {"mechatronic_solid"},
    control.LateralFeedback: {"mechatronic_irw", "trailed_irw"},
    control.SecondaryYaw: {"actuated_coach"},
    control.TorqueVectoring: {"mechatronic_irw"},
    control.Feedforward: {"mechatronic_irw", "mechatronic_solid"},
}
PAIRS = [(kind, name) for kind, names in FITS.items() for name in sorted(names)]
STRAIGHT = Track.straight("2 km")
CASES = {round(case.radius): case for case in perez2004()}
SHORT = Track.curve(radius=800.0, cant=0.16, transition=195.0, arc=150.0, straight_before=80.0, straight_after=80.0)
SPEED = 176.0 / 3.6


def scenario(kind: type[Any], vehicle: str, track: Track, speed: float, **parameters: Any) -> kl.Scenario:
    return kl.Scenario(library.vehicle(vehicle), track, speed=speed, control=kind(**parameters))


def in_arc(kind: type[Any], vehicle: str, radius: int = 800, **parameters: Any) -> Any:
    """Values of all channels in the arc of one of the five curves."""
    case = CASES[radius]
    made = scenario(kind, vehicle, case.track, case.speed, **parameters)
    return steady_state(made, at=0.5 * case.track.length).values


@cache
def run(kind: type[Any], vehicle: str) -> xr.Dataset:
    made = scenario(kind, vehicle, SHORT, SPEED).replace(step="1 ms", energy=False, friction=0.35)
    return kl.simulate(made, strict=True)


def test_every_strategy_has_its_name_in_files() -> None:
    assert set(STRATEGIES.values()) == set(FITS)
    pair = {"strategy": "feedforward", "pair": {"share": 0.2, "full_speed": "100 km/h"}}
    assert strategy(pair) == control.Feedforward(pair=control.WheelCoupling(share=0.2, full_speed=100.0 / 3.6))
    assert {name.replace("_", "") for name in STRATEGIES} == {kind.__name__.lower() for kind in FITS}
    assert strategy({"strategy": "yaw_relaxation", "frequency": "0.4 Hz"}) == control.YawRelaxation(frequency=0.4)
    assert strategy({"strategy": "torque_vectoring", "torque_max": "2 kN m"}) == control.TorqueVectoring(torque_max=2e3)


@pytest.mark.parametrize("kind", FITS)
def test_which_strategy_fits_which_vehicle(kind: type[Any]) -> None:
    """A scenario refuses what does not fit and says what the vehicle lacks, or has too much, and what to take."""
    for name in library.names():
        if name in FITS[kind]:
            assert list(getattr(kind(), "problems", lambda _: ())(library.vehicle(name))) == []
        else:
            with pytest.raises(InputError, match=rf"control = '{kind.__name__}'.*{name} (lacks|has); take \w+$"):
                scenario(kind, name, STRAIGHT, 30.0)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: control.YawRelaxation(relaxation=1.2), "relaxation = 1.2: is more than the springs"),
        (lambda: control.TrailedIRW(current_frequency=7.0), "current_frequency = 7.0: does nothing in TrailedIRW"),
        (lambda: control.WheelCoupling(share=0.0), "control.pair.share = 0.0: must be positive"),
        (lambda: control.TorqueVectoring(torque_max=0.0), "torque_max = 0.0: must be positive"),
        (lambda: control.SecondaryYaw(damping=-1.0), "damping = -1.0: must be positive"),
    ],
)
def test_parameters_that_make_no_sense_are_named(make: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        make()


@pytest.mark.parametrize(("kind", "vehicle"), PAIRS)
def test_names_are_unique_and_all_actuators_of_a_kind_are_driven(kind: type[Any], vehicle: str) -> None:
    spec = kind().lower(library.vehicle(vehicle), SHORT, SPEED)
    if spec is None:
        return
    names = spec["measurements"] + [block["name"] for block in spec["blocks"]]
    assert len(names) == len(set(names))
    driven: dict[str, int] = {}
    for command in spec["commands"]:
        what = command["target"].rsplit(".", 2 if "actuator" in command["target"] else 1)[-1]
        driven[what] = driven.get(what, 0) + 1
    assert set(driven.values()) <= {4, 8}


@pytest.mark.parametrize("case", perez2004(), ids=lambda case: f"R{case.radius:.0f}")
@pytest.mark.parametrize(("kind", "vehicle"), PAIRS)
def test_straight_track_is_stable_but_for_free_wheels(kind: type[Any], vehicle: str, case: Any) -> None:
    """Nothing guides a pair of freely rolling wheels of this profile: it runs aside with 1 to 2 1/s, without swinging.

    Motors at a held voltage are a damper between the wheels and do guide (Passive on the mechatronic vehicle).
    """
    growth = least_stable(kl.linearise(scenario(kind, vehicle, STRAIGHT, case.speed)))
    unguided = kind is control.PassiveIRW or (kind, vehicle) == (control.Passive, "trailed_irw")
    if unguided:
        assert 0.5 < growth.real < 2.0
        assert growth.imag == 0.0
    else:
        held = (kind, vehicle) == (control.Passive, "mechatronic_irw")  # less of a damper with the field weakened
        assert growth.real < (0.3 if held and case.speed > 70.0 else -0.5)


def test_free_wheels_run_to_the_flange() -> None:
    """Equal torques, and the same with motors as without, as far as their drag and rotors let it."""
    driven, trailed = (run(control.PassiveIRW, name) for name in ("mechatronic_irw", "trailed_irw"))
    for result in (driven, trailed):
        assert max(float(np.abs(result[f"{w.name}.y"]).max()) for w in WHEELSETS) > 5.5e-3
    left, right = (driven[f"bogie1.wheelset1.{side}.armature_current"] for side in ("left", "right"))
    assert float((left - right).std()) < 0.05 * float(left.mean())
    for force in (driven, trailed):
        assert np.abs(force["bogie1.wheelset1.actuator_left.force"]).max() == 0.0


@pytest.mark.parametrize("radius", CASES)
def test_trailed_wheels_are_steered_as_well_as_driven_ones(radius: int) -> None:
    """In the arc: largest attack angle and lateral force and mean wear within 2 %; what differs is the motors' pull."""
    driven = in_arc(control.IRWLike, "mechatronic_irw", radius)
    trailed = in_arc(control.TrailedIRW, "trailed_irw", radius)

    def figures(values: Any) -> list[float]:
        yaw = max(abs(values[f"{w.name}.yaw"]) for w in WHEELSETS)
        force = max(abs(values[f"{w.name}.left.Y"] + values[f"{w.name}.right.Y"]) for w in WHEELSETS)
        wear = sum(values[f"{w.name}.{side}.tgamma"] for w in WHEELSETS for side in ("left", "right"))
        return [yaw, force, wear]

    assert figures(driven) == pytest.approx(figures(trailed), rel=0.02)
    assert max(abs(v[f"{w.name}.y"]) for v in (driven, trailed) for w in WHEELSETS) < 0.2e-3


@pytest.mark.parametrize("radius", [300, 800, 1800])
def test_yaw_moment_control_leaves_none(radius: int) -> None:
    """The total of springs and actuators in the arc is nil; the wheelset stands where its rolling radii fit the arc.

    lambda rho = (rR - rL)/(2 r0): no creep along the rails, but for a little by the spin of the contact patches.
    """
    values = in_arc(control.YawMoment, "mechatronic_solid", radius)
    for w in WHEELSETS:
        assert abs(values[f"{w.name}.yaw_moment"]) < 1.0
        for side in ("left", "right"):
            assert abs(values[f"{w.name}.{side}.X"]) < 0.5e3
        assert abs(values[f"{w.name}.yaw"]) < 1.7e-3


@pytest.mark.parametrize("relaxation", [0.5, 0.95])
def test_yaw_relaxation_leaves_a_share_of_the_springs(relaxation: float) -> None:
    """M_total = -(1 - k) kpsi psi against the bogie, in an arc."""
    values = in_arc(control.YawRelaxation, "mechatronic_solid", 1800, relaxation=relaxation)
    stiffness = SteeringGeometry.of(library.vehicle("mechatronic_solid")).yaw_stiffness
    for w in WHEELSETS:
        left, right = (values[f"{w.name}.actuator_{side}.stroke"] for side in ("left", "right"))
        yaw = 0.5 * (left - right)  # at 1 m
        assert values[f"{w.name}.yaw_moment"] == pytest.approx(
            -(1.0 - relaxation) * stiffness * yaw, rel=2e-2, abs=50.0
        )


def test_yaw_relaxation_stays_out_of_hunting() -> None:
    """The critical speed is that of the passive vehicle, within 2 %."""
    made = scenario(control.YawRelaxation, "mechatronic_solid", STRAIGHT, 30.0)
    relaxed, passive = (critical_speed(s).speed for s in (made, made.replace(control=None)))
    assert relaxed == pytest.approx(passive, rel=0.02)


@pytest.mark.parametrize("radius", [800, 1800])
def test_lateral_feedback_centres_whatever_else_is_unknown(radius: int) -> None:
    """An integral of the position itself: nil displacement, also with a conicity and creep three times wrong."""
    contact = control.ContactDesign(lateral_creep=3e6, conicity=0.6)
    values = in_arc(control.LateralFeedback, "mechatronic_irw", radius, contact=contact)
    assert max(abs(values[f"{w.name}.y"]) for w in WHEELSETS) < 1e-7


@pytest.mark.parametrize("case", [perez2004()[0], perez2004()[4]], ids=["108", "265"])
def test_lateral_feedback_has_margins(case: Any) -> None:
    """At every wheelset of a bogie, all other loops closed: gain 2 and more, and 50 ms of delay."""
    model = kl.linearise(scenario(control.LateralFeedback, "mechatronic_irw", STRAIGHT, case.speed))
    f = np.geomspace(0.05, 100.0, 800)
    for w in WHEELSETS[:2]:
        left, right = f"{w.name}.actuator_left", f"{w.name}.actuator_right"
        u, total = {f"{left}.force": 1.0, f"{right}.force": -1.0}, {f"{left}.command": 0.5, f"{right}.command": -0.5}
        found = margins(loop_gain(model, u, total, f), f)
        assert found.gain > 2.0
        assert found.phase / (2.0 * np.pi * found.phase_frequency) > 0.05


def test_secondary_yaw_damps_as_yaw_dampers_do_and_lets_the_bogies_turn() -> None:
    """Critical speed above 100 m/s, against 76 m/s without; in an arc the secondary springs' moment is taken away."""
    made = scenario(control.SecondaryYaw, "actuated_coach", STRAIGHT, 30.0)
    passive = critical_speed(made.replace(control=None))
    damped = critical_speed(made)
    assert passive.speed == pytest.approx(76.0, abs=1.0)
    assert damped.outcome == "stable throughout" or (damped.speed is not None and damped.speed > 100.0)
    values = in_arc(control.SecondaryYaw, "actuated_coach")
    coach = library.vehicle("actuated_coach")
    assert coach.secondary_steering is not None
    arm = 2.0 * coach.secondary_steering.half_spacing
    for bogie in ("bogie1", "bogie2"):
        left, right = (values[f"{bogie}.yaw_actuator_{side}.force"] for side in ("left", "right"))
        strokes = values[f"{bogie}.yaw_actuator_left.stroke"] - values[f"{bogie}.yaw_actuator_right.stroke"]
        springs = SteeringGeometry.of(coach).secondary_yaw * strokes / arm
        assert 0.5 * arm * (left - right) == pytest.approx(springs, rel=1e-3)


def test_secondary_yaw_is_a_damper_at_hunting_frequencies() -> None:
    """From the yaw rates to the actuators' moment at 2 Hz: -c, within 20 % and 25 degrees (actuators of 20 Hz)."""
    made = scenario(control.SecondaryYaw, "actuated_coach", STRAIGHT, 50.0)
    model = kl.linearise(made)
    wind = "wind.y"
    rates = {"bogie1.yaw_rate": 1.0, "body.yaw_rate": -1.0}
    arm = 1.3
    moment = {"bogie1.yaw_actuator_left.force": -arm, "bogie1.yaw_actuator_right.force": arm}
    f = np.array([2.0])
    ratio = (frequency_response(model, wind, moment, f) / frequency_response(model, wind, rates, f)).item()
    assert abs(ratio) == pytest.approx(control.SecondaryYaw().damping, rel=0.2)
    assert abs(np.degrees(np.angle(-ratio))) < 25.0


@pytest.mark.parametrize("radius", [500, 800, 1200])
def test_torque_vectoring_steers_without_actuators(radius: int) -> None:
    """The springs' moment is held by creep forces of a pair, X_left - X_right; without it wheelsets run to the root."""
    values = in_arc(control.TorqueVectoring, "mechatronic_irw", radius)
    half_base = library.vehicle("mechatronic_irw").wheel_profile.half_tape_distance
    for w in WHEELSETS:
        assert abs(values[f"{w.name}.y"]) < 2e-3
        assert values[f"{w.name}.actuator_left.force"] == 0.0
        couple = half_base * (values[f"{w.name}.left.X"] - values[f"{w.name}.right.X"])
        assert couple == pytest.approx(-values[f"{w.name}.yaw_moment"], rel=0.05, abs=200.0)
    bare = in_arc(control.TorqueVectoring, "mechatronic_irw", radius, torque_max=1.0)
    assert max(abs(bare[f"{w.name}.y"]) for w in WHEELSETS) > 4e-3


def test_feedforward_reads_nothing_but_the_place() -> None:
    """On solid wheelsets. On driven ones the encoders are for the coupling of the pairs, and nothing feeds back to
    steering: a displaced wheelset gets the same moment."""
    solid = control.Feedforward().lower(library.vehicle("mechatronic_solid"), SHORT, SPEED)
    assert {m.rsplit(".", 1)[1] for m in solid["measurements"]} == {"s", "speed"}
    model = kl.linearise(scenario(control.Feedforward, "mechatronic_irw", STRAIGHT, SPEED))
    left, right = "bogie1.wheelset1.actuator_left", "bogie1.wheelset1.actuator_right"
    u, total = {f"{left}.force": 1.0, f"{right}.force": -1.0}, {f"{left}.command": 0.5, f"{right}.command": -0.5}
    loop = loop_gain(model, u, total, np.geomspace(0.1, 20.0, 20))
    assert np.abs(loop).max() < 1e-6


@pytest.mark.parametrize("radius", [300, 800, 1800])
def test_feedforward_gives_nearly_what_feedback_would(radius: int) -> None:
    """What it leaves of the yaw moment is below a tenth of what it makes."""
    for vehicle in ("mechatronic_irw", "mechatronic_solid"):
        values = in_arc(control.Feedforward, vehicle, radius)
        made = max(2.0 * abs(values[f"{w.name}.actuator_left.force"]) for w in WHEELSETS)
        assert max(abs(values[f"{w.name}.yaw_moment"]) for w in WHEELSETS) < 0.1 * made
