"""Eigenvalues of the package's linear models against the textbook's: guided wheelset, bogie, 17-degree lateral coach.
Where they differ, the term that textbooks drop is switched on and the difference goes."""

import dataclasses
import math

import numpy as np
import pytest
from tests.linear import textbook
from tests.linear.compare import distance, pairs, plant
from tests.linear.modes import critical_speed
from tests.linear.railed import arc_wheel, contact_numbers, pair_of
from tests.linear.specs import LOAD, guided_bogie, guided_bogie_twin, guided_wheelset, guided_wheelset_twin
from tests.linear.textbook import GRAVITY, Terms, state_matrix
from tests.linear.textbook_vehicles import coach

import klingel as kl
from klingel.contact import Profile

FULL = Terms(load_shift=True)
"""The textbook and the shift of load that it drops."""

DROPPED = 0.6
"""Textbook alone, relative to the contact angle: the spin force at rest is 0.8 of the contact angle times the load, and
what a lateral force takes off one wheel and gives to the other is 0.6 (radius over half distance) of that force, so up
to half the contact angle times the lateral creep force is left out; its phase decides how much of that moves a mode."""
LEFT = 0.002
"""With the shift of load: contact springs of 1 GN/m give 0.1 % of what the primary springs do; the rest is the change
of contact angle, radius and ellipse with the load."""
LEFT_OFF_ARCS = 0.01
"""The same on S1002, whose contact angle and radius change with the load where its curvature jumps: 0.7 %."""

WHEELS = {
    "cone 1:40": (Profile.cone(1 / 40), 1 / 40),
    "cone 1:20": (Profile.cone(1 / 20), 1 / 20),
    "arc": (arc_wheel(1 / 20, 0.42, 0.00251), 1 / 20),
    "S1002": (Profile.s1002(), 1 / 40),
}
"""Wheel and inclination of its 60E1 rails."""


def pair(name: str) -> kl.contact.WheelRailPair:
    wheel, inclination = WHEELS[name]
    return pair_of(wheel, inclination, normal="hertz")


@pytest.mark.parametrize("speed", [20.0, 60.0, 100.0])
@pytest.mark.parametrize("wheel", ["cone 1:40", "cone 1:20"])
def test_guided_wheelset(wheel: str, speed: float) -> None:
    ours = plant(guided_wheelset(pair(wheel), speed, 1e6, 1e6))
    twin = guided_wheelset_twin(pair(wheel), 1e6, 1e6)
    assert distance(ours, state_matrix(twin, speed)).max() < DROPPED * WHEELS[wheel][1]
    assert distance(ours, state_matrix(twin, speed, FULL)).max() < LEFT


@pytest.mark.parametrize("speed", [20.0, 60.0, 100.0])
@pytest.mark.parametrize("wheel", ["cone 1:40", "cone 1:20", "arc"])
def test_bogie(wheel: str, speed: float) -> None:
    ours = plant(guided_bogie(pair(wheel), speed))
    twin = guided_bogie_twin(pair(wheel))
    assert distance(ours, state_matrix(twin, speed)).max() < DROPPED * WHEELS[wheel][1]
    assert distance(ours, state_matrix(twin, speed, FULL)).max() < LEFT


@pytest.mark.parametrize("yaw_dampers", [False, True])
@pytest.mark.parametrize("speed", [40.0, 75.0])
@pytest.mark.parametrize("wheel", WHEELS)
def test_coach(wheel: str, speed: float, yaw_dampers: bool) -> None:
    ours, twin = coaches(wheel, speed, yaw_dampers)
    assert len(pairs(ours, state_matrix(twin, speed))[0]) >= 12
    assert distance(ours, state_matrix(twin, speed)).max() < DROPPED * max(WHEELS[wheel][1], 0.05)
    left = LEFT_OFF_ARCS if wheel == "S1002" else LEFT
    assert distance(ours, state_matrix(twin, speed, FULL)).max() < left


def coaches(wheel: str, speed: float, yaw_dampers: bool) -> tuple[textbook.Matrix, textbook.Vehicle]:
    """The Manchester coach as the package lowers it, and as the textbook has it."""
    profile, inclination = WHEELS[wheel]
    vehicle = kl.library.vehicle("manchester_coach")
    if not yaw_dampers:
        vehicle = vehicle.model_copy(update={"yaw_damper": None})
    scenario = kl.Scenario(
        vehicle,
        kl.Track.straight("1 km"),
        speed=speed,
        wheel=profile,
        rail_inclination=inclination,
        creep_law="linear",
    )
    load = vehicle.total_mass * GRAVITY / 8.0
    return kl.linearise(scenario).A, coach(vehicle, contact_numbers(pair(wheel), load), yaw_dampers=yaw_dampers)


@pytest.mark.parametrize(
    ("without", "least"),
    [("gravity", 0.05), ("spin", 0.05), ("gyroscope", 0.003), ("load_shift", 0.01)],
)
def test_every_term_is_there_in_ours(without: str, least: float) -> None:
    """The hunting of the coach on hollow wheels moves away when a term is switched off in the textbook."""
    ours, twin = coaches("arc", 75.0, yaw_dampers=False)
    poorer = dataclasses.replace(FULL, **{without: False})
    assert distance(ours, state_matrix(twin, 75.0, FULL)).max() < LEFT
    assert distance(ours, state_matrix(twin, 75.0, poorer)).max() > least


def test_what_is_left_is_the_contact_spring() -> None:
    """The frame's roll: contact springs in series with the primary ones take most of the difference."""
    cone = pair("cone 1:40")
    ours, twin = plant(guided_bogie(cone, 60.0)), guided_bogie_twin(cone)
    patch = cone.contact(0.0, wheel_load=LOAD).iloc[0]
    # Hertz: N over penetration^1.5; at the boxes' distance of 1 m the springs under the wheels count by b^2
    stiff = 1.5 * LOAD / patch["penetration"] * contact_numbers(cone, LOAD).half_distance ** 2
    springs = [
        dataclasses.replace(s, stiffness=(*s.stiffness[:2], 1.0 / (1.0 / s.stiffness[2] + 1.0 / stiff)))
        if s.joint.a == "frame"
        else s
        for s in twin.springs
    ]
    softer = dataclasses.replace(twin, springs=springs)
    rolls = [abs(roll(ours, state_matrix(v, 60.0, FULL))) for v in (twin, softer)]
    assert rolls[1] < 0.3 * rolls[0] < 0.3 * LEFT


def roll(ours: textbook.Matrix, book: textbook.Matrix) -> complex:
    """Relative difference of the mode next to 57 rad/s."""
    wanted, found = pairs(ours, book)
    at = int(np.argmin(np.abs(wanted.imag - 57.5)))
    return complex((found[at] - wanted[at]) / wanted[at])


def test_critical_speed_of_the_guided_wheelset() -> None:
    """0.2 % with the shift of load, 1:40: lighter terms than that are left out."""
    cone = pair("cone 1:40")
    twin = guided_wheelset_twin(cone, 1e6, 1e6)

    def ours(speed: float) -> textbook.Matrix:
        return plant(guided_wheelset(cone, speed, 1e6, 1e6))

    found = critical_speed(ours, 80.0, 120.0, step=10.0)
    book = critical_speed(lambda V: state_matrix(twin, V), 80.0, 120.0, step=10.0)
    full = critical_speed(lambda V: state_matrix(twin, V, FULL), 80.0, 120.0, step=10.0)
    assert math.isclose(found, book, rel_tol=0.01)
    assert math.isclose(found, full, rel_tol=0.002)
