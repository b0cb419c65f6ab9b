"""The coach for the textbook matrices: 17 lateral degrees of freedom.
Its numbers come from the vehicle's description, not from its lowered spec."""

from __future__ import annotations

from tests.linear.textbook import GRAVITY, Body, Contact, Damper, Joint, Spring, Triple, Vehicle, Wheelset

from klingel.vehicle import Vehicle as Description
from klingel.vehicle.suspension import DirectionalDamping, DirectionalStiffness

SIDES = (-1.0, 1.0)


def coach(v: Description, contact: Contact, *, yaw_dampers: bool) -> Vehicle:
    """Body and two bogies with y, roll and yaw, four wheelsets with y and yaw: 17 degrees of freedom."""
    plan, bogie, axle = v.geometry, v.bogie, v.solid_wheelset
    bodies: dict[str, Body] = {
        "body": Body(v.body.mass, v.body.inertia.roll, v.body.inertia.yaw, 0.0, v.body.height),
    }
    springs: list[Spring] = []
    dampers: list[Damper] = []
    for i, x in ((1, plan.half_bogie_spacing), (2, -plan.half_bogie_spacing)):
        frame = f"bogie{i}"
        bodies[frame] = Body(bogie.mass, bogie.inertia.roll, bogie.inertia.yaw, x, bogie.height)
        above = secondary(v, frame, x, yaw_dampers=yaw_dampers)
        springs += above[0]
        dampers += above[1]
        for j, dx in ((1, plan.half_wheelbase), (2, -plan.half_wheelbase)):
            name = f"{frame}.wheelset{j}"
            bodies[name] = Wheelset(
                axle.mass, axle.inertia.roll, axle.inertia.yaw, x + dx, plan.wheel_radius, axle.inertia.spin, contact
            )
            below = primary(v, frame, name, x + dx)
            springs += below[0]
            dampers += below[1]
    return Vehicle(bodies, springs, dampers)


def primary(v: Description, frame: str, name: str, x: float) -> tuple[list[Spring], list[Damper]]:
    """Springs and dampers of both axle boxes."""
    p = v.primary
    load = (0.5 * v.body.mass + v.bogie.mass) * GRAVITY / 4.0
    joints = [Joint(frame, name, (x, side * p.half_spacing, p.height)) for side in SIDES]
    springs = [Spring(joint, triple(p.stiffness), load=load) for joint in joints]
    rates = list(zip(triple(p.damping), triple(p.series_stiffness), strict=True))
    dampers = [Damper(joint, axis, c, k) for joint in joints for axis, (c, k) in enumerate(rates)]
    return springs, dampers


def secondary(v: Description, frame: str, x: float, *, yaw_dampers: bool) -> tuple[list[Spring], list[Damper]]:
    """Springs, anti-roll bar and dampers between a bogie and the body; the traction rod is on the middle line."""
    s, springs, dampers = v.secondary, [], []
    for side in SIDES:
        joint = Joint(frame, "body", (x, side * s.half_spacing, s.height))
        load = -v.body.mass * GRAVITY / 4.0
        springs.append(Spring(joint, triple(s.stiffness), (s.bending_stiffness, 0.0), load))
        for axis, d in ((1, s.lateral_damper), (2, s.vertical_damper)):
            at = Joint(frame, "body", (x, side * s.half_spacing, d.height))
            dampers.append(Damper(at, axis, d.damping, d.series_stiffness))
        if yaw_dampers and v.yaw_damper is not None:
            y = v.yaw_damper
            at = Joint(frame, "body", (x, side * y.half_spacing, y.height))
            dampers.append(Damper(at, 0, y.damping, y.series_stiffness))
    bar = Joint(frame, "body", (x, 0.0, s.height))
    springs.append(Spring(bar, turning=(v.anti_roll_bar.stiffness, 0.0)))
    return springs, dampers


def triple(axes: DirectionalStiffness | DirectionalDamping) -> Triple:
    """x, y and z of a description's entry."""
    return (axes.x, axes.y, axes.z)
