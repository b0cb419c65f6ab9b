"""Textbook matrices of vehicles' lateral motion (Wickens; Garg & Dukkipati), for tests and validation only.
Derived in docs/theory/linear_vehicle.md; nothing here uses the package: M q'' + D q' + K q + series dampers = 0."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Triple = tuple[float, float, float]

GRAVITY = 9.81
DOFS = 3
"""Of a body: y to the right [m], roll (right side down) and yaw (to the right) [rad]."""


@dataclass(frozen=True)
class Contact:
    """Right-hand contact of a centred wheelset, and how it moves with the wheelset's shift y to the right.

    load: vertical force of the wheel [N]; half_distance: of the contacts [m]; radius: rolling radius [m]; angle: of the
    contact plane, positive rising to the field side [rad]; conicity: growth of the rolling radius per shift; roll: of
    the wheelset per shift, its right side rising [rad/m]; tilt: growth of the angle per shift, in the track [rad/m];
    f11, f22 [N], f23 [N m], f33 [N m2]: Kalker's coefficients of one wheel, G a b C11 and so on; f23_growth: of f23 per
    shift at a constant load [N], which arcs do not have.
    """

    load: float
    half_distance: float
    radius: float
    angle: float
    conicity: float
    roll: float
    tilt: float
    f11: float
    f22: float
    f23: float = 0.0
    f33: float = 0.0
    f23_growth: float = 0.0

    @property
    def slip(self) -> float:
        """Lateral slip of the contact per lateral velocity: the wheelset rolls as it shifts."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return c + self.roll * (self.radius * c + self.half_distance * s)

    @property
    def transfer(self) -> float:
        """Relative growth of the right wheel's normal force per shift [1/m]."""
        c, s, b, r = math.cos(self.angle), math.sin(self.angle), self.half_distance, self.radius
        sharpness = self.conicity / s if s else 1.0
        return (sharpness + (self.tilt - self.roll) * (r * c + b * s)) / (b * c - r * s)


def plain(load: float, half_distance: float, radius: float, conicity: float, f11: float, f22: float) -> Contact:
    """The simplest contact: a conicity, no contact angle, so no gravity, roll or spin."""
    return Contact(load, half_distance, radius, 0.0, conicity, 0.0, 0.0, f11, f22)


def arcs(
    load: float, half_distance: float, radius: float, angle: float, wheel: float, rail: float, f: Sequence[float]
) -> Contact:
    """A wheel's hollow arc (radius `wheel` [m], infinite for a cone) on a rail's arc (`rail` [m]); f: f11 to f33."""
    c, s = math.cos(angle), math.sin(angle)
    roll = s / (half_distance * c - radius * s)
    rest = c + roll * (rail + radius * c + half_distance * s)
    share = 1.0 / (1.0 - rail / wheel)
    tilt = roll + rest * share / wheel
    return Contact(load, half_distance, radius, angle, rest * share * s, roll, tilt, *f)


@dataclass(frozen=True)
class Terms:
    """What is counted: stiffness of the weights, forces and moments of spin, momentum of the spinning axles, and (no
    textbook does) the change of the lateral spin force as lateral creep, springs and inertia shift load across."""

    gravity: bool = True
    spin: bool = True
    gyroscope: bool = True
    load_shift: bool = False


TEXTBOOK = Terms()


def shift_of_load(contact: Contact, terms: Terms) -> tuple[float, float]:
    """Share of the lateral creep force that is left by the load that it shifts across itself, and the part of a roll
    moment on the wheelset that becomes lateral force [1/m]: the spin force at rest grows with the load."""
    if not (terms.load_shift and terms.spin):
        return 1.0, 0.0
    c, s, b, r = math.cos(contact.angle), math.sin(contact.angle), contact.half_distance, contact.radius
    gain = contact.f23 * s / r / (contact.load / c) / (b * c - r * s)
    share = 1.0 / (1.0 + gain * (r * c + b * s))
    return share, contact.slip * share * gain


def wheelset_contact(contact: Contact, speed: float, axle: float, terms: Terms = TEXTBOOK) -> tuple[Matrix, Matrix]:
    """D and K that both contacts and the spinning axle add in (y, yaw); axle: moment of inertia of the spin [kg m2]."""
    c, s, b, r, V = math.cos(contact.angle), math.sin(contact.angle), contact.half_distance, contact.radius, speed
    f11, f22 = contact.f11, contact.f22
    f23, f33 = (contact.f23, contact.f33) if terms.spin else (0.0, 0.0)
    weight = 2.0 * contact.load if terms.gravity else 0.0
    h = axle * V / r if terms.gyroscope else 0.0
    share, turned = shift_of_load(contact, terms)
    kappa, turn = contact.slip, contact.tilt - contact.roll
    T, arm = f23 * s / r, b - r * s / c
    creep = kappa * share  # of a lateral force along both contact planes
    D = np.array(
        [
            [2.0 * creep * f22 * kappa / V, 2.0 * creep * f23 * c / V - h * (contact.roll - turned)],
            [-2.0 * f23 * kappa * c / V + h * contact.roll, 2.0 * (f11 * b**2 + f33 * c**2) / V],
        ]
    )
    lateral = weight * (contact.tilt + s / c * contact.transfer) - 2.0 * creep * (
        f23 * turn * c / r + T * contact.transfer + contact.f23_growth * s / r * terms.spin
    )
    across = 2.0 * f11 * b * contact.conicity / r - 2.0 * f33 * turn * c**2 / r
    K = np.array([[lateral, -2.0 * creep * f22 / c], [across, 2.0 * f23 + (2.0 * T * c - weight * s / c) * arm]])
    return D, K


@dataclass(frozen=True)
class Body:
    """A rigid body: mass [kg], moments of inertia of roll and yaw [kg m2], place ahead [m] and height over rail [m]."""

    mass: float
    roll: float
    yaw: float
    x: float
    height: float


@dataclass(frozen=True)
class Wheelset(Body):
    """A body on two rails: `axle` is the moment of inertia of the spin [kg m2]. Its roll follows its shift."""

    axle: float
    contact: Contact


@dataclass(frozen=True)
class Joint:
    """Point (ahead, right, height) [m] of two bodies, b against a; a is None for the ground."""

    a: str | None
    b: str
    point: Triple


@dataclass(frozen=True)
class Spring:
    """Stiffness along x, y, z [N/m], about x and z [N m/rad]; load: the force down that it bears on b [N]."""

    joint: Joint
    stiffness: Triple = (0.0, 0.0, 0.0)
    turning: tuple[float, float] = (0.0, 0.0)
    load: float = 0.0


@dataclass(frozen=True)
class Damper:
    """Damper [N s/m] along an axis (0 x, 1 y, 2 z) with a spring in series [N/m]: F' = k (u' - F/c)."""

    joint: Joint
    axis: int
    damping: float
    series: float


@dataclass(frozen=True)
class Vehicle:
    """Bodies by name, springs and dampers between them."""

    bodies: Mapping[str, Body]
    springs: Sequence[Spring]
    dampers: Sequence[Damper] = field(default=())

    def names(self) -> list[str]:
        return list(self.bodies)

    def place(self, name: str) -> int:
        return DOFS * self.names().index(name)


def displacement(vehicle: Vehicle, name: str | None, point: Triple) -> Matrix:
    """Rows of the small displacement (x, y, z) of a point that is fixed in a body."""
    rows = np.zeros((3, DOFS * len(vehicle.bodies)))
    if name is not None:
        body, at = vehicle.bodies[name], vehicle.place(name)
        px, py, pz = point[0] - body.x, point[1], body.height - point[2]
        rows[:, at : at + DOFS] = [[0.0, 0.0, -py], [1.0, -pz, px], [0.0, py, 0.0]]
    return rows


def deflection(vehicle: Vehicle, joint: Joint) -> Matrix:
    """Rows of the joint's deflection: b's point less a's, seen from a."""
    return displacement(vehicle, joint.b, joint.point) - displacement(vehicle, joint.a, joint.point)


def rotation(vehicle: Vehicle, name: str | None, axis: int) -> Matrix:
    """Row of a body's roll (1) or yaw (2)."""
    row = np.zeros(DOFS * len(vehicle.bodies))
    if name is not None:
        row[vehicle.place(name) + axis] = 1.0
    return row


def elastic(vehicle: Vehicle) -> Matrix:
    """Stiffness of the springs: the sum of k row' row."""
    K = np.zeros((DOFS * len(vehicle.bodies),) * 2)
    for spring in vehicle.springs:
        rows = deflection(vehicle, spring.joint)
        K += rows.T @ np.diag(spring.stiffness) @ rows
        for axis, k in zip((1, 2), spring.turning, strict=True):
            row = rotation(vehicle, spring.joint.b, axis) - rotation(vehicle, spring.joint.a, axis)
            K += k * np.outer(row, row)
    return K


def pendulum(vehicle: Vehicle) -> Matrix:
    """Stiffness of the loads that the springs carry: they turn with a, and bodies roll about their centres."""
    K = np.zeros((DOFS * len(vehicle.bodies),) * 2)
    for spring in vehicle.springs:
        a, b, point = spring.joint.a, spring.joint.b, spring.joint.point
        roll_a, roll_b = rotation(vehicle, a, 1), rotation(vehicle, b, 1)
        across = deflection(vehicle, spring.joint)[1]
        second = -np.outer(roll_a, across) - np.outer(across, roll_a)
        second -= (vehicle.bodies[b].height - point[2]) * np.outer(roll_b, roll_b)
        if a is not None:
            second += (vehicle.bodies[a].height - point[2]) * np.outer(roll_a, roll_a)
        K -= spring.load * second
    return K


def slaved(vehicle: Vehicle, terms: Terms = TEXTBOOK) -> tuple[Matrix, Matrix]:
    """From the free coordinates to (y, roll, yaw) of every body, and from forces on these to forces on the free ones.

    A wheelset rolls by -Gamma y; forces follow by virtual work, and by the shift of load if that is counted.
    """
    columns, forces = [], []
    for name, body in vehicle.bodies.items():
        at = vehicle.place(name)
        block = np.zeros((DOFS * len(vehicle.bodies), DOFS))
        block[at : at + DOFS] = np.eye(DOFS)
        force = block.copy()
        if isinstance(body, Wheelset):
            block[at + 1, 0] = -body.contact.roll
            force[at + 1, 0] = -body.contact.roll + shift_of_load(body.contact, terms)[1]
            block, force = block[:, [0, 2]], force[:, [0, 2]]
        columns.append(block)
        forces.append(force)
    return np.hstack(columns), np.hstack(forces).T


def matrices(vehicle: Vehicle, speed: float, terms: Terms = TEXTBOOK) -> tuple[Matrix, Matrix, Matrix]:
    """M, D and K in the free coordinates, without the series dampers."""
    T, L = slaved(vehicle, terms)
    inertia = [v for body in vehicle.bodies.values() for v in (body.mass, body.roll, body.yaw)]
    K = elastic(vehicle) + (pendulum(vehicle) if terms.gravity else 0.0)
    M, K = L @ np.diag(inertia) @ T, L @ K @ T
    D = np.zeros_like(M)
    at = 0
    for body in vehicle.bodies.values():
        if isinstance(body, Wheelset):
            both = slice(at, at + 2)
            damping, stiffness = wheelset_contact(body.contact, speed, body.axle, terms)
            D[both, both] += damping
            K[both, both] += stiffness
        at += 2 if isinstance(body, Wheelset) else DOFS
    return M, D, K


def state_matrix(vehicle: Vehicle, speed: float, terms: Terms = TEXTBOOK) -> Matrix:
    """A of x' = A x with x = (q, q', damper forces)."""
    M, D, K = matrices(vehicle, speed, terms)
    T, L = slaved(vehicle, terms)
    rows = [deflection(vehicle, d.joint)[d.axis] for d in vehicle.dampers]
    R = np.array(rows).reshape(len(rows), len(T))
    k = np.array([d.series for d in vehicle.dampers])
    c = np.array([d.damping for d in vehicle.dampers])
    n, m = len(M), len(rows)
    A = np.zeros((2 * n + m, 2 * n + m))
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n] = np.linalg.solve(M, np.hstack([-K, -D, -L @ R.T]))
    A[2 * n :, n : 2 * n] = k[:, None] * (R @ T)
    A[2 * n :, 2 * n :] = -np.diag(k / c) if m else 0.0
    return A
