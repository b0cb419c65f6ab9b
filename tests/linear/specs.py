"""Hand-made specs for the linear tests, each with its twin for the textbook: a guided wheelset and a guided bogie.
The guide is a body too heavy to move, which holds the speed; gravity is so weak that it weighs as much as the load."""

from __future__ import annotations

from typing import Any

from tests.linear.railed import contact_numbers
from tests.linear.textbook import Body, Damper, Joint, Spring, Triple, Vehicle, Wheelset

from klingel.contact import WheelRailPair

Spec = dict[str, Any]

MASS, INERTIA, AXLE, RADIUS = 1813.0, 1120.0, 112.0, 0.46
"""Of a wheelset of the Manchester coach: mass [kg], roll and yaw, spin [kg m2], radius [m]."""
LOAD = 55e3
"""Of each wheel [N]."""
FRAME = Body(2615.0, 1722.0, 3067.0, 0.0, 0.6)
"""Of the bogie: as the Manchester coach's."""
AXLES = {"front": 1.28, "rear": -1.28}
SIDES = {"left": -1.0, "right": 1.0}
PRIMARY: Triple = (31.391e6, 3.884e6, 1.22e6)
SECONDARY: Triple = (0.16e6, 0.16e6, 0.43e6)
LATERAL_DAMPER, VERTICAL_DAMPER, PRIMARY_DAMPER = (32e3, 6e6), (20e3, 6e6), (4e3, 1e6)
"""Damping [N s/m] and stiffness in series [N/m]."""
VERTICAL, ROLL = 1e6, 1e5
"""Of the wheelset's guide [N/m], [N m/rad]: they keep the guide level."""
GUIDE = 1e12
"""Mass and moments of inertia of the guide [kg], [kg m2]."""


def guided_wheelset(pair: WheelRailPair, speed: float, lateral: float, yaw: float, law: str = "linear") -> Spec:
    """One wheelset on a lateral and a yaw spring [N/m], [N m/rad] to the guide, at axle height."""
    spec = rails(pair, speed, ["wheelset"], law)
    spec["bodies"] = [body("guide", Body(GUIDE, GUIDE, GUIDE, 0.0, RADIUS)), axle("wheelset", 0.0)]
    spec["bushings"] = [
        {
            "name": "guide",
            "joint": {"a": "guide", "b": "wheelset", "point": [0.0, 0.0, -RADIUS]},
            "stiffness": [1e7, lateral, VERTICAL],
            "rotational_stiffness": [ROLL, ROLL, yaw],
            "preload": [0.0, 0.0, 2.0 * LOAD],
        }
    ]
    return spec


def guided_wheelset_twin(pair: WheelRailPair, lateral: float, yaw: float) -> Vehicle:
    """The same for the textbook."""
    wheelset = Wheelset(MASS, INERTIA, INERTIA, 0.0, RADIUS, AXLE, contact_numbers(pair, LOAD))
    spring = Spring(Joint(None, "wheelset", (0.0, 0.0, RADIUS)), (1e7, lateral, VERTICAL), (ROLL, yaw), 2.0 * LOAD)
    return Vehicle({"wheelset": wheelset}, [spring])


def guided_bogie(pair: WheelRailPair, speed: float, law: str = "linear") -> Spec:
    """A frame on two wheelsets, with secondary springs and dampers to the guide."""
    twin = guided_bogie_twin(pair)
    spec = rails(pair, speed, list(AXLES), law)
    spec["bodies"] = [
        body("guide", Body(GUIDE, GUIDE, GUIDE, 0.0, 1.8)),
        body("frame", FRAME),
        *(axle(name, x) for name, x in AXLES.items()),
    ]
    spec["bushings"] = [
        {
            "name": f"spring{i}",
            "joint": joint(spring.joint),
            "stiffness": list(spring.stiffness),
            "preload": [0.0, 0.0, spring.load],
        }
        for i, spring in enumerate(twin.springs)
    ]
    spec["maxwells"] = [
        {
            "name": f"damper{i}",
            "joint": joint(d.joint),
            "axis": "xyz"[d.axis],
            "stiffness": d.series,
            "damping": d.damping,
        }
        for i, d in enumerate(twin.dampers)
    ]
    return spec


def guided_bogie_twin(pair: WheelRailPair) -> Vehicle:
    """The same for the textbook."""
    contact = contact_numbers(pair, LOAD)
    bodies: dict[str, Body] = {"frame": FRAME}
    springs, dampers = [], []
    for name, x in AXLES.items():
        bodies[name] = Wheelset(MASS, INERTIA, INERTIA, x, RADIUS, AXLE, contact)
        for side in SIDES.values():
            at = Joint("frame", name, (x, side, RADIUS))
            springs.append(Spring(at, PRIMARY, load=LOAD))
            dampers.append(Damper(at, 2, *PRIMARY_DAMPER))
    for side in SIDES.values():
        springs.append(Spring(Joint(None, "frame", (0.0, side, 0.8275)), SECONDARY, load=2.0 * LOAD))
        dampers.append(Damper(Joint(None, "frame", (0.0, side, 0.7)), 1, *LATERAL_DAMPER))
        dampers.append(Damper(Joint(None, "frame", (0.0, side, 0.8275)), 2, *VERTICAL_DAMPER))
    return Vehicle(bodies, springs, dampers)


def rails(pair: WheelRailPair, speed: float, axles: list[str], law: str) -> Spec:
    """What both specs have in common: straight level track, wheels, creep law, the load on the wheels."""
    track = {"segments": [{"length": 300.0, "curvature": [0.0, 0.0], "cant": [0.0, 0.0]}], "start": 100.0}
    return {
        "name": "guided",
        "gravity": 2.0 * LOAD * len(axles) / GUIDE,
        "speed": speed,
        "track": track | {"cant_base": 1.5},
        "contact_pairs": [
            {
                "wheel": pair.wheel.spec(),
                "rail": pair.rail.spec(),
                "rail_inclination": pair.rail_inclination,
                "gauge": pair.gauge,
                "flange_back": pair.flange_back,
                "radius": pair.radius,
                "normal": pair.normal,
            }
        ],
        "wheels": [
            {"name": f"{name}.{side}", "body": name, "rotor": "spin", "side": side, "pair": 0, "friction": 0.35}
            for name in axles
            for side in SIDES
        ],
        "creep": {"law": law, "elements": [16, 16], "contact_dissipation": 3.0},
        "run": {"duration": 1.0, "step": 5e-4, "record_interval": 1e-3, "equilibrium": True},
    }


def body(name: str, b: Body) -> Spec:
    pitch = max(b.roll, b.yaw)
    return {"name": name, "mass": b.mass, "inertia": [b.roll, pitch, b.yaw], "position": [b.x, 0.0, -b.height]}


def axle(name: str, x: float) -> Spec:
    return {
        "name": name,
        "mass": MASS,
        "inertia": [INERTIA, 0.0, INERTIA],
        "position": [x, 0.0, -RADIUS],
        "pitches": False,
        "rotors": [{"name": "spin", "inertia": AXLE}],
    }


def joint(at: Joint) -> Spec:
    ahead, right, height = at.point
    return {"a": at.a or "guide", "b": at.b, "point": [ahead, right, -height]}
