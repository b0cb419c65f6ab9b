"""Linear models made by hand of a lowered vehicle: springs and dampers, linear creep on coned wheels, hard contacts.
Enough like the real thing to try modes and loci on without the core."""

from typing import Any

import numpy as np

from klingel.linear.model import LinearModel, Signal
from klingel.linear.shapes import Structure

F11 = F22 = 1.0e7
CONTACT = 1.2e9
HALF_TAPES = 0.75
RADIUS = 0.46


def state_names(spec: dict[str, Any]) -> list[str]:
    names = []
    for b in spec["bodies"]:
        pitches = b.get("pitches", True)
        own = "s y z roll pitch yaw vx vy vz wx wy wz" if pitches else "s y z roll yaw vx vy vz wx wz"
        names += [f"{b['name']}.{c}" for c in own.split()]
    names += [f"{b['name']}.{r['name']}.spin_speed" for b in spec["bodies"] for r in b.get("rotors", ())]
    names += [f"{m['name']}.force" for m in spec.get("maxwells", ())]
    return names + (["hold.integral"] if spec.get("hold") else [])


def model_of(spec: dict[str, Any], *, conicity: float = 0.1) -> LinearModel:
    """A linear model of a spec with solid wheelsets or none, about its design position."""
    names = state_names(spec)
    place = {name: i for i, name in enumerate(names)}
    n = len(names)
    A = np.zeros((n, n))
    x = np.zeros(n)
    for b in spec["bodies"]:
        x[place[f"{b['name']}.s"]], _, x[place[f"{b['name']}.z"]] = b["position"]
    bare = LinearModel(
        spec["name"], spec["speed"], tuple(Signal(name, "") for name in names), (), (), A, np.zeros((n, 0)),
        np.zeros((0, n)), np.zeros((0, 0)), x, np.zeros(0), np.zeros(0),
    )  # fmt: skip
    structure = Structure(spec, bare)
    force = np.zeros((n, n))  # generalised forces in the rows of the velocities
    pairs = {}
    masses = np.ones(n)
    for body in structure.bodies:
        for q, v, mass in zip(body.at, body.rates, [body.mass] * 3 + list(body.inertia), strict=True):
            if q >= 0:
                A[q, v] = 1.0
                pairs[q], masses[v] = v, mass
    for b in spec.get("bushings", ()):
        at, _, J = structure._joint(b["joint"])
        rows = [pairs[i] for i in at]
        stiffness = [*b.get("stiffness", [0.0] * 3), *b.get("rotational_stiffness", [0.0] * 3)]
        damping = [*b.get("damping", [0.0] * 3), *b.get("rotational_damping", [0.0] * 3)]
        force[np.ix_(rows, at)] -= J.T @ np.diag(stiffness) @ J
        force[np.ix_(rows, rows)] -= J.T @ np.diag(damping) @ J
    for m in spec.get("maxwells", ()):
        at, _, J = structure._joint(m["joint"])
        rows = [pairs[i] for i in at]
        row, own = J["xyz".index(m["axis"])], place[f"{m['name']}.force"]
        force[rows, own] -= row
        A[own, rows] += m["stiffness"] * row
        A[own, own] -= m["stiffness"] / m["damping"]
    V = spec["speed"]
    for name in sorted({w["body"] for w in spec.get("wheels", ())}):
        y, z, roll, yaw = (place[f"{name}.{c}"] for c in ("y", "z", "roll", "yaw"))
        vx, vy, vz, wx, wz = (place[f"{name}.{c}"] for c in ("vx", "vy", "vz", "wx", "wz"))
        spin = place[f"{name}.spin.spin_speed"]
        force[vz, z] -= 2.0 * CONTACT
        force[wx, roll] -= 2.0 * CONTACT * HALF_TAPES**2
        force[vy, vy] -= 2.0 * F22 / V
        force[vy, yaw] += 2.0 * F22
        force[wz, wz] -= 2.0 * F11 * HALF_TAPES**2 / V
        force[wz, y] -= 2.0 * F11 * HALF_TAPES * conicity / RADIUS
        slip = {vx: 1.0 / V, spin: -RADIUS / V}
        masses[spin] = structure.rotors[f"{name}.spin"][1]
        for column, share in slip.items():
            force[vx, column] -= 2.0 * F11 * share
            force[spin, column] += 2.0 * F11 * RADIUS * share
    if spec.get("hold"):
        vx, own = place[f"{spec['hold']['body']}.vx"], place["hold.integral"]
        force[vx, vx] -= spec["hold"]["proportional"]
        force[vx, own] += 1.0
        A[own, vx] -= spec["hold"]["integral"]
    A += force / masses[:, None]
    return bare
