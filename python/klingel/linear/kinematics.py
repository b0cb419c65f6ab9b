"""Joints of a spec on a uniform track: deflections and their exact Jacobian by complex steps.
Frames as in docs/conventions.md: x forward, y right, z down; each body in the track frame of its own arc length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[Any]
"""(n, 3), or rotations (n, 3, 3): real or complex."""

STEP = 1e-30
"""Of the complex step: far below rounding, as nothing is subtracted."""


@dataclass(frozen=True)
class UniformTrack:
    """Endless track: curvature [1/m], positive to the right; cant_angle [rad], positive with the left rail higher."""

    curvature: float = 0.0
    cant_angle: float = 0.0

    def origin(self, s: Vectors) -> Vectors:
        """Of the track frame at arc lengths (n) [m]: (n, 3)."""
        if self.curvature == 0.0:
            x, y = s, 0.0 * s
        else:
            turn = self.curvature * s
            x, y = np.sin(turn) / self.curvature, 2.0 * np.sin(0.5 * turn) ** 2 / self.curvature
        return np.stack([x, y, 0.0 * s], axis=1)

    def rotation(self, s: Vectors) -> Vectors:
        """From the track frame at arc lengths (n) to the world: (n, 3, 3)."""
        return about_z(self.curvature * s) @ about_x(self.cant_angle + 0.0 * s)


@dataclass(frozen=True)
class Placement:
    """A body's coordinates (s, y, z, roll, pitch, yaw) and a point of it from its centre of mass [m]."""

    coordinates: NDArray[np.float64]
    point: NDArray[np.float64]


def joint_jacobian(track: UniformTrack, a: Placement, b: Placement) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Deflection of b's point from a's and small rotation of b, in a's frame (6), and its Jacobian (6, 12).

    Columns: s, y, z, roll, pitch, yaw of a, then of b.
    """
    q = np.concatenate([a.coordinates, b.coordinates])
    steps = q + 1j * STEP * np.eye(12)
    d = _deflection(track, steps[:, :6], a.point, steps[:, 6:], b.point)
    return d[0].real.copy(), np.ascontiguousarray(d.imag.T) / STEP


def _deflection(track: UniformTrack, qa: Vectors, point_a: Vectors, qb: Vectors, point_b: Vectors) -> Vectors:
    (pa, Ra), (pb, Rb) = _pose(track, qa), _pose(track, qb)
    back = np.swapaxes(Ra, 1, 2)
    moved = np.einsum("nij,nj->ni", back, pb + Rb @ point_b - pa) - point_a
    R = back @ Rb
    turned = 0.5 * np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    return np.concatenate([moved, turned], axis=1)


def _pose(track: UniformTrack, q: Vectors) -> tuple[Vectors, Vectors]:
    """Centre of mass in the world (n, 3), and rotation from the body to the world (n, 3, 3)."""
    s, y, z, roll, pitch, yaw = q.T
    RT = track.rotation(s)
    offset = np.stack([0.0 * s, y, z], axis=1)
    return track.origin(s) + np.einsum("nij,nj->ni", RT, offset), RT @ about_z(yaw) @ about_x(roll) @ about_y(pitch)


def about_x(angle: Vectors) -> Vectors:
    """Rotations about x by angles (n): (n, 3, 3)."""
    c, s, one, nil = np.cos(angle), np.sin(angle), 1.0 + 0.0 * angle, 0.0 * angle
    return np.moveaxis(np.array([[one, nil, nil], [nil, c, -s], [nil, s, c]]), 2, 0)


def about_y(angle: Vectors) -> Vectors:
    """Rotations about y by angles (n): (n, 3, 3)."""
    c, s, one, nil = np.cos(angle), np.sin(angle), 1.0 + 0.0 * angle, 0.0 * angle
    return np.moveaxis(np.array([[c, nil, s], [nil, one, nil], [-s, nil, c]]), 2, 0)


def about_z(angle: Vectors) -> Vectors:
    """Rotations about z by angles (n): (n, 3, 3)."""
    c, s, one, nil = np.cos(angle), np.sin(angle), 1.0 + 0.0 * angle, 0.0 * angle
    return np.moveaxis(np.array([[c, -s, nil], [s, c, nil], [nil, nil, one]]), 2, 0)
