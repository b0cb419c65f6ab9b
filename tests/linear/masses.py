"""Small linear models with known answers: masses on springs, a pair of wheels under a mass."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from klingel.linear.model import LinearModel, Signal

Matrix = NDArray[np.float64]


def model(
    A: Matrix,
    B: Matrix,
    C: Matrix,
    D: Matrix,
    *,
    states: Sequence[str] = (),
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    speed: float = 20.0,
    sample_time: float | None = None,
    x: Matrix | None = None,
) -> LinearModel:
    """A LinearModel of bare matrices, its signals numbered where they have no names."""
    n, m, p = len(A), B.shape[1], len(C)

    def signals(kind: str, names: Sequence[str], count: int) -> tuple[Signal, ...]:
        return tuple(Signal(name, "1") for name in (names or [f"{kind}{i}" for i in range(count)]))

    return LinearModel(
        "synthetic",
        speed,
        signals("x", states, n),
        signals("u", inputs, m),
        signals("y", outputs, p),
        A,
        B,
        C,
        D,
        np.zeros(n) if x is None else x,
        np.zeros(m),
        np.zeros(p),
        sample_time,
    )


def chain(masses: Sequence[float], stiffness: Sequence[float], damping: Sequence[float]) -> LinearModel:
    """Masses in a row, each on a spring and damper to the one before, the first to the ground.

    Inputs: force on each mass; outputs: displacement of each.
    """
    n = len(masses)
    K, c = (_links(np.asarray(values, dtype=np.float64)) for values in (stiffness, damping))
    M = np.asarray(masses, dtype=np.float64)[:, None]
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / M, -c / M]])
    B = np.vstack((np.zeros((n, n)), np.eye(n) / M))
    return model(A, B, np.eye(n, 2 * n), np.zeros((n, n)))


def _links(k: Matrix) -> Matrix:
    over = np.append(k[1:], 0.0)
    return np.diag(k + over) - np.diag(k[1:], 1) - np.diag(k[1:], -1)


def on_two_axles(
    *, mass: float, inertia: float, stiffness: float, damping: float, half_base: float, speed: float
) -> LinearModel:
    """A beam on two spring-damper legs over a track, massless wheels `a.left` (front), `b.left` (rear).

    States z, pitch, their rates; inputs rail_z and rail_z_rate under each; outputs z and pitch of the beam and `a.s`.
    """
    k, c, h = stiffness, damping, half_base
    legs = np.array([[1.0, -h], [1.0, h]])  # deflection upwards of the front and rear leg per z, pitch
    M = np.array([[mass], [inertia]])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-k * legs.T @ legs / M, -c * legs.T @ legs / M]])
    A = np.block([[A, np.zeros((4, 2))], [np.zeros((2, 6))]])  # and the free arc lengths of both axles
    B = np.zeros((6, 4))
    B[2:4, :2], B[2:4, 2:] = k * legs.T / M, c * legs.T / M
    names = ["a.left.rail_z", "b.left.rail_z", "a.left.rail_z_rate", "b.left.rail_z_rate"]
    states = ["z", "pitch", "vz", "wy", "a.s", "b.s"]
    x = np.array([0.0, 0.0, 0.0, 0.0, h, -h])
    return model(
        A, B, np.eye(2, 6), np.zeros((2, 4)), states=states, inputs=names, outputs=["z", "pitch"], speed=speed, x=x
    )
