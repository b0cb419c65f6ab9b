"""What a mode shape moves and strains: bodies, joints and elements of a spec on the states of a linear model.
Energies are means over one cycle of the shape q e^(lambda t); docs/theory/linear.md derives them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from klingel.linear.kinematics import Placement, UniformTrack, joint_jacobian
from klingel.linear.model import LinearModel
from klingel.lower import Spec

Shape = NDArray[np.complex128]
Matrix = NDArray[np.float64]

COORDINATES = ("s", "y", "z", "roll", "pitch", "yaw")
RATES = ("vx", "vy", "vz", "wx", "wy", "wz")
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Body:
    """A body of the spec; `at` and `rates`: the places of its coordinates and velocities, -1 for one it has not."""

    name: str
    mass: float
    inertia: tuple[float, float, float]
    at: tuple[int, ...]
    rates: tuple[int, ...]

    def energies(self, shape: Shape) -> NDArray[np.float64]:
        """Mean kinetic energy along x, y, z and about x, y, z [J]."""
        weights = np.array([self.mass] * 3 + list(self.inertia))
        return np.asarray(0.25 * weights * np.abs(_taken(shape, self.rates)) ** 2)

    def moves(self, shape: Shape) -> Shape:
        """Its part of a shape: s, y, z [m], roll, pitch, yaw [rad]."""
        return _taken(shape, self.at)


@dataclass(frozen=True)
class Spring:
    """One elastic element: its energy is q^T stiffness q / 2 over the states at `at`."""

    name: str
    at: tuple[int, ...]
    stiffness: Matrix

    def energy(self, shape: Shape) -> float:
        """Mean over a cycle [J]."""
        q = shape[list(self.at)]
        return float(0.25 * np.real(np.conj(q) @ self.stiffness @ q))


ALL_DRIVES = (
    *("armature_current", "field_current"),
    *("current_d", "current_q", "rotor_flux_d", "rotor_flux_q", "flux_model", "integral_d", "integral_q"),
    *("motor_speed", "shaft_twist"),
)
"""States of a drive, as far as its kind has them."""


class Structure:
    """A spec on the states of its linear model.

    spec: of the vehicle, such as `lower(scenario)`; model: its states and operating point; plant: the continuous model
    of the same states where `model` is sampled, for the stiffness of the contacts (none without it).
    """

    def __init__(self, spec: Spec, model: LinearModel, plant: LinearModel | None = None) -> None:
        self.spec = spec
        self.model = model
        self.plant = plant if plant is not None else model if model.sample_time is None else None
        self.places: Mapping[str, int] = {state.name: i for i, state in enumerate(model.states)}

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """In the order of the spec."""
        return tuple(
            Body(
                b["name"],
                float(b["mass"]),
                (float(b["inertia"][0]), float(b["inertia"][1]), float(b["inertia"][2])),
                tuple(self.places.get(f"{b['name']}.{c}", -1) for c in COORDINATES),
                tuple(self.places.get(f"{b['name']}.{c}", -1) for c in RATES),
            )
            for b in self.spec["bodies"]
        )

    @cached_property
    def rotors(self) -> Mapping[str, tuple[int, float]]:
        """`<body>.<rotor>` to the place of its spin and its inertia [kg m2]."""
        return {
            f"{b['name']}.{r['name']}": (self.places[f"{b['name']}.{r['name']}.spin_speed"], float(r["inertia"]))
            for b in self.spec["bodies"]
            for r in b.get("rotors", ())
        }

    @cached_property
    def drives(self) -> tuple[Spec, ...]:
        """Name, body and transmission of every drive, whatever its motor."""
        dc, induction = (self.spec.get(kind, ()) for kind in ("drives", "induction_drives"))
        return (*dc, *({"name": d["name"], "body": d["body"]} | d["transmission"] for d in induction))

    @cached_property
    def groups(self) -> Mapping[str, NDArray[np.intp]]:
        """Kinds of states to places: `bodies`, `rotors`, `dampers`, `actuators`, `drives`, `hold`, `controller`."""
        known: dict[str, list[int]] = {
            "bodies": [i for b in self.bodies for i in (*b.at, *b.rates) if i >= 0],
            "rotors": [i for i, _ in self.rotors.values()],
            "dampers": [self.places[f"{m['name']}.force"] for m in self.spec.get("maxwells", ())],
            "actuators": [
                self.places[f"{a['name']}.{part}"]
                for a in self.spec.get("actuators", ())
                for part in ("force", "force_rate")
            ],
            "drives": [
                self.places[f"{d['name']}.{part}"]
                for d in self.drives
                for part in ALL_DRIVES
                if f"{d['name']}.{part}" in self.places
            ],
            "hold": [self.places["hold.integral"]] if "hold.integral" in self.places else [],
        }
        taken = {i for places in known.values() for i in places}
        known["controller"] = [i for i in range(len(self.model.states)) if i not in taken]
        return {name: np.array(places, dtype=np.intp) for name, places in known.items()}

    def kinetic(self, shape: Shape) -> dict[str, float]:
        """Mean kinetic energy of every body, rotor and motor [J]."""
        energies = {body.name: float(body.energies(shape).sum()) for body in self.bodies}
        for name, (place, inertia) in self.rotors.items():
            energies[name] = 0.25 * inertia * abs(shape[place]) ** 2
        of = {body.name: body for body in self.bodies}
        for d in self.drives:
            # the motor's speed is that relative to its stator on the body, which turns forward at -wy
            speed = d["gear_sense"] * shape[self.places[f"{d['name']}.motor_speed"]]
            speed -= _taken(shape, of[d["body"]].rates)[4]
            energies[f"{d['name']}.motor"] = 0.25 * d["rotor_inertia"] * abs(speed) ** 2
        return energies

    def potential(self, shape: Shape) -> dict[str, float]:
        """Mean elastic energy of every spring, series spring, stop, shaft and wheelset on its contacts [J]."""
        energies: dict[str, float] = {}
        for spring in self.springs:
            energies[spring.name] = energies.get(spring.name, 0.0) + spring.energy(shape)
        return energies

    @cached_property
    def springs(self) -> tuple[Spring, ...]:
        """Every elastic element."""
        inner = [
            Spring(name, (self.places[state],), np.array([[stiffness]]))
            for name, state, stiffness in (
                *((m["name"], f"{m['name']}.force", 1.0 / m["stiffness"]) for m in self.spec.get("maxwells", ())),
                *((f"{d['name']}.shaft", f"{d['name']}.shaft_twist", d["transmission_stiffness"]) for d in self.drives),
            )
        ]
        return (*self._bushings, *self._stops, *inner, *self._contacts)

    @cached_property
    def _bushings(self) -> tuple[Spring, ...]:
        return tuple(
            self._spring(
                b["name"], b["joint"], [*b.get("stiffness", [0.0] * 3), *b.get("rotational_stiffness", [0.0] * 3)]
            )
            for b in self.spec.get("bushings", ())
        )

    @cached_property
    def _stops(self) -> tuple[Spring, ...]:
        return tuple(
            self._spring(s["name"], s["joint"], _slopes(s, self._joint(s["joint"])[1]))
            for s in self.spec.get("stops", ())
        )

    @cached_property
    def _contacts(self) -> tuple[Spring, ...]:
        """Wheelsets on their contacts: what resists y, z and roll beside the elements, from the plant's Jacobian."""
        if self.plant is None:
            return ()
        on_rails = {wheel["body"] for wheel in self.spec.get("wheels", ())}
        return tuple(self._contact(body, self.plant.A) for body in self.bodies if body.name in on_rails)

    def _contact(self, body: Body, A: Matrix) -> Spring:
        at, rates = [[places[k] for k in (1, 2, 3)] for places in (body.at, body.rates)]
        resisting = -np.array([[body.mass], [body.mass], [body.inertia[0]]]) * A[np.ix_(rates, at)]
        for spring in (*self._bushings, *self._stops):
            if body.at[1] in spring.at:
                place = [spring.at.index(i) for i in at]
                resisting -= spring.stiffness[np.ix_(place, place)]
        return Spring(f"{body.name}.contact", tuple(at), 0.5 * (resisting + resisting.T))

    def _spring(self, name: str, joint: Mapping[str, Any], stiffness: Sequence[float]) -> Spring:
        at, _, J = self._joint(joint)
        return Spring(name, at, J.T @ np.diag(stiffness) @ J)

    def _joint(self, joint: Mapping[str, Any]) -> tuple[tuple[int, ...], Matrix, Matrix]:
        """Places of both bodies' coordinates, deflection (6) at the operating point, and its Jacobian over them."""
        key = (joint["a"], joint["b"], tuple(joint["point"]))
        if key not in self._joints:
            a, b = (next(body for body in self.bodies if body.name == joint[side]) for side in ("a", "b"))
            points = [np.subtract(joint["point"], self._design[body.name]) for body in (a, b)]
            placements = [
                Placement(_taken(self.model.x, body.at), point) for body, point in zip((a, b), points, strict=True)
            ]
            deflection, J = joint_jacobian(self.track, *placements)
            has = np.array([i >= 0 for i in (*a.at, *b.at)])
            self._joints[key] = (tuple(i for i in (*a.at, *b.at) if i >= 0), deflection, J[:, has])
        return self._joints[key]

    @cached_property
    def _joints(self) -> dict[Any, tuple[tuple[int, ...], Matrix, Matrix]]:
        return {}

    @cached_property
    def _design(self) -> Mapping[str, Sequence[float]]:
        return {b["name"]: b["position"] for b in self.spec["bodies"]}

    @cached_property
    def track(self) -> UniformTrack:
        """Curvature and cant under the vehicle: of the model's own outputs where it has them, else none."""
        first = self.bodies[0].name
        values = {signal.name: float(value) for signal, value in zip(self.model.outputs, self.model.y, strict=True)}
        cant = values.get(f"{first}.cant", 0.0) / float(self.spec["track"]["cant_base"])
        return UniformTrack(values.get(f"{first}.curvature", 0.0), float(np.arcsin(cant)))


def _taken(vector: NDArray[Any], places: Sequence[int]) -> NDArray[Any]:
    """Entries of a vector, zero where there is none (-1)."""
    return np.array([vector[i] if i >= 0 else 0.0 for i in places])


def _slopes(stop: Mapping[str, Any], deflection: Matrix) -> list[float]:
    """Stiffness of a bump stop at its deflection, in six directions."""
    axis = AXES.index(stop["axis"])
    points, forces = np.array(stop["deflection"]), np.array(stop["force"])
    piece = int(np.clip(np.searchsorted(points, abs(deflection[axis]), side="right") - 1, 0, len(points) - 2))
    slopes = [0.0] * 6
    slopes[axis] = float((forces[piece + 1] - forces[piece]) / (points[piece + 1] - points[piece]))
    return slopes
