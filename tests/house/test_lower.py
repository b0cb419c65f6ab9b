"""From railway words to the spec: weights and springs balance, names are dotted, the core accepts it."""

import json
from typing import Any

import pytest

from klingel import control, library
from klingel.doctor import core
from klingel.errors import InputError
from klingel.lower import GRAVITY, lower
from klingel.scenario import Scenario
from klingel.track import Track, cases

STRATEGIES = {
    "manchester_coach": (None, control.Passive()),
    "mechatronic_irw": (
        None,
        control.SolidLike(),
        control.IRWLike(),
        control.IRWLike(curvature="database"),
        control.PassiveIRW(),
        control.LateralFeedback(),
        control.TorqueVectoring(),
        control.Feedforward(),
    ),
    "trailed_irw": (control.PassiveIRW(), control.TrailedIRW(), control.LateralFeedback()),
    "mechatronic_solid": (None, control.YawMoment(), control.YawRelaxation(), control.Feedforward()),
    "actuated_coach": (None, control.SecondaryYaw()),
}
CASES = [(name, strategy) for name, strategies in STRATEGIES.items() for strategy in strategies]


def spec(name: str, strategy: Any = None) -> dict[str, Any]:
    case = cases.perez2004()[2]
    return lower(Scenario(library.vehicle(name), case.track, speed=case.speed, control=strategy))


@pytest.mark.parametrize(("name", "strategy"), CASES)
def test_the_core_accepts_it(name: str, strategy: Any) -> None:
    core().check(json.dumps(spec(name, strategy), allow_nan=False))


@pytest.mark.parametrize("name", library.names())
def test_preloads_carry_the_weight_of_what_is_above(name: str) -> None:
    made, vehicle = spec(name), library.vehicle(name)
    on: dict[str, float] = {body["name"]: body["mass"] * GRAVITY for body in made["bodies"]}
    for bushing in made["bushings"]:
        load = bushing.get("preload", [0.0, 0.0, 0.0])[2]
        on[bushing["joint"]["b"]] += load
        on[bushing["joint"]["a"]] -= load
    assert sum(on.values()) == pytest.approx(vehicle.total_mass * GRAVITY)
    for body in ("body", "bogie1", "bogie2"):
        assert on[body] == pytest.approx(0.0, abs=1e-6)
    wheelsets = [force for body, force in on.items() if "wheelset" in body]
    assert wheelsets == pytest.approx([vehicle.total_mass * GRAVITY / 4.0] * 4)


@pytest.mark.parametrize("name", library.names())
def test_left_and_right_are_mirror_images(name: str) -> None:
    made = spec(name)
    for kind in ("bushings", "maxwells", "stops", "actuators"):
        points = sorted(tuple(e["joint"]["point"]) for e in made[kind])
        mirrored = sorted((x, -y if y else 0.0, z) for x, y, z in points)
        assert points == mirrored, kind


def test_names_and_counts_of_the_mechatronic_vehicle() -> None:
    made = spec("mechatronic_irw")
    assert [w["name"] for w in made["wheels"]][:3] == [
        "bogie1.wheelset1.left",
        "bogie1.wheelset1.right",
        "bogie1.wheelset2.left",
    ]
    assert len(made["drives"]) == len(made["actuators"]) == 8
    names = [e["name"] for kind in ("bodies", "bushings", "maxwells", "stops", "actuators") for e in made[kind]]
    assert len(names) == len(set(names))


def test_motors_hold_the_drag_of_the_vehicle() -> None:
    made, vehicle = spec("mechatronic_irw"), library.vehicle("mechatronic_irw")
    a, b, c = made["drag"]["coefficients"]
    v = made["speed"]
    drive = made["drives"][0]
    motor_speed = v / vehicle.geometry.wheel_radius / drive["gear_ratio"]
    current = (drive["armature_voltage"] - drive["emf_constant"] * drive["field_current"] * motor_speed) / drive[
        "armature_resistance"
    ]
    torque = drive["emf_constant"] * drive["field_current"] * current - drive["rotor_damping"] * motor_speed
    hauling = 8.0 * torque / drive["gear_ratio"] / vehicle.geometry.wheel_radius
    assert hauling == pytest.approx(a + b * v + c * v**2, rel=1e-9)


def test_torque_links_point_to_the_bogie_centre() -> None:
    links = {b["name"]: b["joint"]["point"][0] for b in spec("mechatronic_irw")["bushings"] if "link" in b["name"]}
    assert links == {
        "bogie1.wheelset1.torque_link": pytest.approx(9.5 + 1.28 - 0.5),
        "bogie1.wheelset2.torque_link": pytest.approx(9.5 - 1.28 + 0.5),
        "bogie2.wheelset1.torque_link": pytest.approx(-9.5 + 1.28 - 0.5),
        "bogie2.wheelset2.torque_link": pytest.approx(-9.5 - 1.28 + 0.5),
    }


def test_a_strategy_without_motors_is_refused() -> None:
    with pytest.raises(InputError, match="drive"):
        lower(Scenario(library.vehicle("manchester_coach"), Track.straight(500), speed=30, control=control.SolidLike()))
