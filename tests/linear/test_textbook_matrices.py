"""The textbook matrices against exact solutions, before anything is compared with them.
Klingel's wave, the critical speed of a guided wheelset, the height of a wheelset on arcs, pendulum, rigid motions."""

import math

import numpy as np
import pytest
from tests.linear import textbook
from tests.linear.modes import critical_speed, oscillations
from tests.linear.textbook import Body, Contact, Joint, Matrix, Spring, Terms, Vehicle, Wheelset
from tests.linear.textbook_vehicles import coach

from klingel import library

LOAD, B, R0, RAIL = 56e3, 0.74, 0.46, 0.3
F = (10e6, 9e6, 20e3, 30.0)
BARE = Terms(gravity=False, spin=False, gyroscope=False)


def guided(contact: Contact, lateral: float, yaw: float) -> Vehicle:
    axle = Wheelset(1813.0, 1120.0, 1120.0, 0.0, R0, 112.0, contact)
    spring = Spring(Joint(None, "wheelset", (0.0, 0.0, R0)), (0.0, lateral, 0.0), (0.0, yaw))
    return Vehicle({"wheelset": axle}, [spring])


def test_slow_wheelset_runs_in_klingels_wave() -> None:
    """1e-6: inertia changes the wave with the square of the speed."""
    for contact in (textbook.plain(LOAD, B, R0, 0.05, *F[:2]), textbook.arcs(LOAD, B, R0, 0.025, math.inf, RAIL, F)):
        A = textbook.state_matrix(guided(contact, 0.0, 0.0), 0.1, BARE)
        (wave,) = oscillations(A, 1e-3)
        length = 2.0 * math.pi * math.sqrt(B * R0 * contact.slip * math.cos(contact.angle) / contact.conicity)
        assert 2.0 * math.pi * 0.1 / wave.imag == pytest.approx(length, rel=1e-6)


def test_guided_wheelset_has_its_closed_critical_speed() -> None:
    """1e-5: the bisection ends at 0.1 mm/s."""
    contact = textbook.plain(LOAD, B, R0, 0.1, *F[:2])
    lateral, yaw, mass, inertia = 2e6, 3e6, 1813.0, 1120.0
    c1, c2 = 2.0 * contact.f22, 2.0 * contact.f11 * B**2
    a1, a3 = c1 * yaw + c2 * lateral, mass * c2 + inertia * c1
    steer = 4.0 * contact.f11 * contact.f22 * B * contact.conicity / R0
    rest = a1 * mass * inertia / a3 + (lateral * yaw + steer) * a3 / a1 - mass * yaw - inertia * lateral
    vehicle = guided(contact, lateral, yaw)
    found = critical_speed(lambda V: textbook.state_matrix(vehicle, V, BARE), 20.0, 300.0)
    assert found == pytest.approx(math.sqrt(c1 * c2 / rest), rel=1e-5)


@pytest.mark.parametrize("wheel", [math.inf, 0.35, 0.5])
def test_weight_and_roll_follow_from_two_pairs_of_arcs(wheel: float) -> None:
    """1e-4: differences over 20 um of the exact position, without spin."""
    angle = 0.05
    contact = textbook.arcs(LOAD, B, R0, angle, wheel, RAIL, F)
    roll, height = zip(*(standing(angle, wheel, y) for y in (-2e-5, 0.0, 2e-5)), strict=True)
    assert (roll[2] - roll[0]) / 4e-5 == pytest.approx(-contact.roll, rel=1e-4)
    lift = -(height[2] - 2.0 * height[1] + height[0]) / 4e-10
    _, K = textbook.wheelset_contact(contact, 10.0, 0.0, Terms(spin=False))
    assert K[0, 0] == pytest.approx(2.0 * LOAD * lift, rel=1e-4)


def standing(angle: float, wheel: float, y: float) -> tuple[float, float]:
    """Roll and depth of a wheelset that is shifted by y, from the exact condition that both wheels touch."""
    s, c = math.sin(angle), math.cos(angle)

    def gaps(at: Matrix) -> Matrix:
        roll, depth = at
        found = []
        for side in (-1.0, 1.0):
            rail = np.array([side * (B + RAIL * s), R0 + RAIL * c])
            turn = np.array([[math.cos(roll), math.sin(roll)], [-math.sin(roll), math.cos(roll)]])
            seen = turn @ (rail - [y, depth])  # the rail's centre in the frame of the wheelset
            if math.isinf(wheel):
                normal = np.array([side * s, c])
                found.append(float(normal @ (seen - [side * B, R0])) - RAIL)
            else:
                centre = np.array([side * (B + wheel * s), R0 + wheel * c])
                found.append(float(np.linalg.norm(seen - centre)) - (wheel - RAIL))
        return np.array(found)

    at = np.zeros(2)
    for _ in range(6):
        slopes = [(gaps(at + step) - gaps(at - step)) / 2e-6 for step in 1e-6 * np.eye(2)]
        at = at - np.linalg.solve(np.transpose(slopes), gaps(at))
    return float(at[0]), float(at[1])


def test_body_on_a_rope_is_a_pendulum() -> None:
    mass, inertia, arm = 1000.0, 500.0, 2.0
    hinge = Joint(None, "body", (0.0, 0.0, 3.0))
    spring = Spring(hinge, (0.0, 1e12, 0.0), (0.0, 1e6), load=-mass * textbook.GRAVITY)
    A = textbook.state_matrix(Vehicle({"body": Body(mass, inertia, 1.0, 0.0, 3.0 - arm)}, [spring]), 1.0)
    swing = oscillations(A)[0]
    assert swing.imag == pytest.approx(math.sqrt(mass * textbook.GRAVITY * arm / (inertia + mass * arm**2)), rel=1e-6)


def test_springs_know_no_motion_of_everything_together() -> None:
    vehicle = coach(library.vehicle("manchester_coach"), textbook.plain(LOAD, B, R0, 0.1, *F[:2]), yaw_dampers=True)
    K, G = textbook.elastic(vehicle), textbook.pendulum(vehicle)
    bodies = list(vehicle.bodies.values())
    shift, yaw = ((1.0, 0.0, 0.0) * len(bodies), [v for b in bodies for v in (b.x, 0.0, 1.0)])
    roll = [v for b in bodies for v in (b.height, 1.0, 0.0)]
    for motion in (shift, yaw, roll):
        assert np.abs(K @ np.array(motion)).max() < 1e-6 * K.max()
    for motion in (shift, yaw):
        assert np.abs(G @ np.array(motion)).max() < 1e-9 * G.max()
    np.testing.assert_allclose(K, K.T, rtol=1e-14)
    np.testing.assert_allclose(G, G.T, rtol=1e-14)
    assert np.linalg.eigvalsh(K).min() > -1e-9 * K.max()
    M, D, _ = textbook.matrices(vehicle, 30.0, BARE)
    assert len(M) == 17
    assert np.linalg.eigvalsh(M).min() > 0.0
    assert np.linalg.eigvalsh(D + D.T).min() > -1e-9 * D.max()
