"""From railway words to the core's spec: a Scenario becomes bodies, joints, force elements, wheels and drives.
The design position is the loaded vehicle on straight level track; x from its centre, z down from the top of rail."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from klingel.contact import profile_of
from klingel.drives import induction_point, operating_point, running_resistance, starting_point
from klingel.errors import InputError
from klingel.scenario import Scenario
from klingel.track import CANT_BASE, Adhesion, Track
from klingel.vehicle import Actuator, Drive, InductionDrive, Transmission, Vehicle

GRAVITY = 9.81
"""[m/s2], as the study's cant deficiencies assume."""

CONTACT_DISSIPATION = 3.0
"""Contact damping over elastic force and approach speed (Hunt and Crossley) [s/m]: about 8 % of critical for a
wheelset that bounces on its contact springs near 180 Hz; this project's choice."""

HOLD_FREQUENCY = 0.1
"""Of the ideal force that holds the speed [Hz]: slow against everything that the study looks at; critically damped."""

IMPLICIT_RATE, IMPLICIT_RATE_FREE = 25e3, 35e3
"""Speed below which steps are implicit, over the step [m/s2]: with solid wheelsets and with independently rotating
wheels. The spin of a free wheel of 45 kg m2 has the rate 87e3/V 1/s in an arc at 300 mm of cant deficiency and a
friction of 0.5, and explicit steps h are stable below 2.78/h; on straight track both kinds are from 21e3 h on."""

Spec = dict[str, Any]
Point = list[float]


class Axle(NamedTuple):
    """Where one wheelset sits: dotted name, its bogie, x of both [m]; `inward` points to the bogie's centre."""

    name: str
    bogie: str
    x: float
    bogie_x: float

    @property
    def inward(self) -> float:
        return 1.0 if self.bogie_x > self.x else -1.0


CIRCUIT = (
    "stator_resistance",
    "rotor_resistance",
    "stator_leakage",
    "rotor_leakage",
    "magnetizing_inductance",
    "pole_pairs",
)
"""Equivalent circuit of an induction motor."""

CONTROL_KEYS = ("sample_time", "measurements", "blocks", "commands")
"""What every control spec has."""

SIDES = (("left", -1.0), ("right", 1.0))


def axles(vehicle: Vehicle) -> tuple[Axle, ...]:
    """The four wheelsets from the front.

    >>> from klingel import library
    >>> [axle.name for axle in axles(library.vehicle("manchester_coach"))][:2]
    ['bogie1.wheelset1', 'bogie1.wheelset2']
    """
    plan = vehicle.geometry
    return tuple(
        Axle(f"bogie{i}.wheelset{j}", f"bogie{i}", xb + dx, xb)
        for i, xb in ((1, plan.half_bogie_spacing), (2, -plan.half_bogie_spacing))
        for j, dx in ((1, plan.half_wheelbase), (2, -plan.half_wheelbase))
    )


def lower(scenario: Scenario) -> Spec:
    """The core's spec of a scenario, SI throughout, ready for JSON.

    Springs carry their share of the weight in the design position, so that this is nearly the static equilibrium.
    """
    vehicle = scenario.vehicle
    wheels = axles(vehicle)
    control = _control(scenario)
    return {
        "name": vehicle.name,
        "gravity": GRAVITY,
        "speed": scenario.speed,
        "track": _track(scenario.track, scenario.start),
        "adhesion": _adhesion(scenario.adhesion),
        "bodies": [*_bodies(vehicle), *(_wheelset(vehicle, axle) for axle in wheels)],
        "contact_pairs": [_pair(scenario)],
        "wheels": list(_wheels(scenario, wheels)),
        "creep": {
            "law": scenario.creep_law,
            "elements": list(scenario.creep_elements),
            "contact_dissipation": CONTACT_DISSIPATION,
            "stick": scenario.stick,
            **scenario.creep_options.spec(scenario.creep_law),
        },
        "bushings": [*_primary(vehicle, wheels), *_secondary(vehicle)],
        "maxwells": [*_primary_dampers(vehicle, wheels), *_secondary_dampers(vehicle)],
        "stops": [_lateral_stop(vehicle, bogie, x) for bogie, x in _bogies(vehicle)],
        "actuators": [*_actuators(vehicle, wheels), *_secondary_actuators(vehicle)],
        "drives": list(_drives(scenario, wheels, control)),
        "induction_drives": list(_induction_drives(vehicle, wheels, scenario.speed)),
        "drag": _drag(vehicle, scenario.headwind),
        "hold": _hold(vehicle) if scenario.traction is None else None,
        "control": control,
        "run": {
            "duration": scenario.end_time,
            "step": scenario.step,
            "implicit_below": implicit_below(vehicle, scenario.step),
            "record_interval": scenario.record_interval,
            "equilibrium": True,
            "kicks": [],
            "energy": scenario.energy,
        },
    }


def _control(scenario: Scenario) -> Spec | None:
    """The strategy for the track that it believes in, measuring with the sensors of the scenario."""
    if scenario.control is None:
        return None
    known = scenario.track if scenario.database is None else scenario.database
    spec = scenario.control.lower(scenario.vehicle, known, scenario.speed)
    if spec is None:
        return None
    _check_control(spec, type(scenario.control).__name__)
    return scenario.sensors.applied(spec)


def _check_control(spec: object, name: str) -> None:
    """Errors: InputError naming a strategy whose `lower` gives no control spec."""
    place, remedy = f"what {name}.lower() returns", "return spec() of a klingel.control.Diagram, or None for no control"
    if not isinstance(spec, dict):
        raise InputError.single(place, spec, "is no control spec", remedy=remedy)
    if missing := [key for key in CONTROL_KEYS if key not in spec]:
        raise InputError.single(place, None, f"has no {', '.join(missing)}", remedy=remedy)
    time = spec["sample_time"]
    if isinstance(time, bool) or not isinstance(time, (int, float)) or not time > 0.0:
        raise InputError.single(f"sample_time in {place}", time, "is no time above zero [s]", remedy="give e.g. 1e-3")


def implicit_below(vehicle: Vehicle, step: float) -> float:
    """Speed [m/s] below which steps [s] of a vehicle are implicit."""
    return (IMPLICIT_RATE_FREE if vehicle.independent_wheels else IMPLICIT_RATE) * step


def explicit_step(vehicle: Vehicle, speed: float, step: float) -> float:
    """The step [s], halved until it is explicit at a speed [m/s] above nil: two explicit steps cost less than an
    implicit one.

    >>> from klingel import library
    >>> explicit_step(library.vehicle("mechatronic_irw"), 30.0, 1e-3)
    0.0005
    """
    return step if implicit_below(vehicle, step) < speed or speed < 1.0 else explicit_step(vehicle, speed, step / 2.0)


def _track(track: Track, start: float) -> Spec:
    segments = [
        {"length": s.length, "curvature": list(s.curvature), "cant": list(s.cant), "grade": list(s.grade)}
        for s in track.segments
    ]
    return {"segments": segments, "start": start, "cant_base": CANT_BASE}


def _adhesion(adhesion: Adhesion | None) -> Spec | None:
    if adhesion is None:
        return None
    places, left, right = adhesion.points()
    return {"s": places.tolist(), "left": left.tolist(), "right": right.tolist()}


def _bogies(vehicle: Vehicle) -> tuple[tuple[str, float], ...]:
    half = vehicle.geometry.half_bogie_spacing
    return (("bogie1", half), ("bogie2", -half))


def _bodies(vehicle: Vehicle) -> Iterator[Spec]:
    for name, part, x in (("body", vehicle.body, 0.0), *((n, vehicle.bogie, x) for n, x in _bogies(vehicle))):
        inertia = [part.inertia.roll, part.inertia.pitch, part.inertia.yaw]
        yield {"name": name, "mass": part.mass, "inertia": inertia, "position": [x, 0.0, -part.height]}


def _wheelset(vehicle: Vehicle, axle: Axle) -> Spec:
    position = [axle.x, 0.0, -vehicle.geometry.wheel_radius]
    if vehicle.axle_bridge is not None:
        bridge = vehicle.axle_bridge
        rotors = [{"name": side, "inertia": bridge.wheel.inertia.spin} for side, _ in SIDES]
        inertia, mass, pitches = list(bridge.total_inertia), bridge.total_mass, True
    else:
        solid = vehicle.solid_wheelset
        rotors = [{"name": "spin", "inertia": solid.inertia.spin}]
        # Its frame does not pitch: the moment of inertia about y belongs to the spin alone.
        inertia, mass, pitches = [solid.inertia.roll, 0.0, solid.inertia.yaw], solid.mass, False
    return {
        "name": axle.name,
        "mass": mass,
        "inertia": inertia,
        "position": position,
        "pitches": pitches,
        "rotors": rotors,
    }


def _pair(scenario: Scenario) -> Spec:
    vehicle = scenario.vehicle
    wheel = scenario.wheel or profile_of(vehicle.wheel_profile.name, "wheel")
    rail = profile_of(scenario.rail, "rail") if isinstance(scenario.rail, str) else scenario.rail
    return {
        "wheel": wheel.spec(),
        "rail": rail.spec(),
        "rail_inclination": scenario.rail_inclination,
        "gauge": scenario.gauge,
        "flange_back": vehicle.wheel_profile.flange_back_distance,
        "radius": vehicle.geometry.wheel_radius,
        "normal": scenario.contact,
    }


def _wheels(scenario: Scenario, wheels: tuple[Axle, ...]) -> Iterator[Spec]:
    """Each wheel has half of what the right one is larger by than the left one."""
    for axle, mismatch in zip(wheels, scenario.radius_mismatch, strict=True):
        for side, sign in SIDES:
            yield {
                "name": f"{axle.name}.{side}",
                "body": axle.name,
                "rotor": side if scenario.vehicle.independent_wheels else "spin",
                "side": side,
                "pair": 0,
                "friction": scenario.friction,
                "radius_offset": 0.5 * sign * mismatch,
            }


def _joint(a: str, b: str, x: float, y: float, height: float) -> Spec:
    return {"a": a, "b": b, "point": [x, y, -height]}


def _primary(vehicle: Vehicle, wheels: tuple[Axle, ...]) -> Iterator[Spec]:
    primary = vehicle.primary
    load = (0.5 * vehicle.body.mass + vehicle.bogie.mass) * GRAVITY / 4.0
    k = primary.stiffness
    for axle in wheels:
        for side, sign in SIDES:
            yield {
                "name": f"{axle.name}.primary_{side}",
                "joint": _joint(axle.bogie, axle.name, axle.x, sign * primary.half_spacing, primary.height),
                "stiffness": [k.x, k.y, k.z],
                "preload": [0.0, 0.0, load],
            }
        if vehicle.torque_link is not None:
            link = vehicle.torque_link
            x = axle.x + axle.inward * link.offset
            yield {
                "name": f"{axle.name}.torque_link",
                "joint": _joint(axle.bogie, axle.name, x, 0.0, vehicle.geometry.wheel_radius),
                "stiffness": [0.0, 0.0, link.stiffness],
                "damping": [0.0, 0.0, link.damping],
            }


def _primary_dampers(vehicle: Vehicle, wheels: tuple[Axle, ...]) -> Iterator[Spec]:
    primary = vehicle.primary
    for axle in wheels:
        for side, sign in SIDES:
            joint = _joint(axle.bogie, axle.name, axle.x, sign * primary.half_spacing, primary.height)
            for axis in ("x", "y", "z"):
                damping = getattr(primary.damping, axis)
                if damping > 0.0:
                    name = f"{axle.name}.primary_damper_{axis}_{side}"
                    yield _maxwell(name, joint, axis, getattr(primary.series_stiffness, axis), damping)


def _maxwell(name: str, joint: Spec, axis: str, stiffness: float, damping: float) -> Spec:
    return {"name": name, "joint": joint, "axis": axis, "stiffness": stiffness, "damping": damping}


def _secondary(vehicle: Vehicle) -> Iterator[Spec]:
    secondary = vehicle.secondary
    k, bending = secondary.stiffness, secondary.bending_stiffness
    load = vehicle.body.mass * GRAVITY / 4.0
    for bogie, x in _bogies(vehicle):
        for side, sign in SIDES:
            yield {
                "name": f"{bogie}.secondary_{side}",
                "joint": _joint(bogie, "body", x, sign * secondary.half_spacing, secondary.height),
                "stiffness": [k.x, k.y, k.z],
                "rotational_stiffness": [bending, bending, 0.0],
                "preload": [0.0, 0.0, -load],
            }
        yield {
            "name": f"{bogie}.anti_roll_bar",
            "joint": _joint(bogie, "body", x, 0.0, secondary.height),
            "rotational_stiffness": [vehicle.anti_roll_bar.stiffness, 0.0, 0.0],
        }
        yield {
            "name": f"{bogie}.traction_rod",
            "joint": _joint(bogie, "body", x, 0.0, vehicle.traction_rod.height),
            "stiffness": [vehicle.traction_rod.stiffness, 0.0, 0.0],
        }


def _secondary_dampers(vehicle: Vehicle) -> Iterator[Spec]:
    secondary, rod, yaw = vehicle.secondary, vehicle.traction_rod, vehicle.yaw_damper
    for bogie, x in _bogies(vehicle):
        rod_joint = _joint(bogie, "body", x, 0.0, rod.height)
        yield _maxwell(f"{bogie}.traction_rod_damper", rod_joint, "x", rod.series_stiffness, rod.damping)
        for side, sign in SIDES:
            for axis, damper in (("y", secondary.lateral_damper), ("z", secondary.vertical_damper)):
                joint = _joint(bogie, "body", x, sign * secondary.half_spacing, damper.height)
                word = "lateral" if axis == "y" else "vertical"
                name = f"{bogie}.{word}_damper_{side}"
                yield _maxwell(name, joint, axis, damper.series_stiffness, damper.damping)
            if yaw is not None:
                joint = _joint(bogie, "body", x, sign * yaw.half_spacing, yaw.height)
                damper_spec = _maxwell(f"{bogie}.yaw_damper_{side}", joint, "x", yaw.series_stiffness, yaw.damping)
                yield damper_spec | {"blow_off": {"force": yaw.blow_off_force, "damping": yaw.blow_off_damping}}


def _lateral_stop(vehicle: Vehicle, bogie: str, x: float) -> Spec:
    stop = vehicle.lateral_stop
    return {
        "name": f"{bogie}.lateral_stop",
        "joint": _joint(bogie, "body", x, 0.0, stop.height),
        "axis": "y",
        "deflection": list(stop.deflection),
        "force": list(stop.force),
    }


def _actuators(vehicle: Vehicle, wheels: tuple[Axle, ...]) -> Iterator[Spec]:
    steering = vehicle.steering
    if steering is None:
        return
    for axle in wheels:
        for side, sign in SIDES:
            y = sign * steering.half_spacing
            joint = _joint(axle.bogie, axle.name, axle.x, y, vehicle.geometry.wheel_radius)
            yield _actuator(f"{axle.name}.actuator_{side}", joint, steering)


def _secondary_actuators(vehicle: Vehicle) -> Iterator[Spec]:
    steering = vehicle.secondary_steering
    if steering is None:
        return
    for bogie, x in _bogies(vehicle):
        for side, sign in SIDES:
            joint = _joint(bogie, "body", x, sign * steering.half_spacing, steering.height)
            yield _actuator(f"{bogie}.yaw_actuator_{side}", joint, steering)


def _actuator(name: str, joint: Spec, actuator: Actuator) -> Spec:
    return {
        "name": name,
        "joint": joint,
        "natural_frequency": 2.0 * math.pi * actuator.bandwidth,
        "damping_ratio": actuator.damping_ratio,
        "force_max": actuator.force_max,
        "rate_max": actuator.force_rate_max,
        "stroke": actuator.stroke,
        "stop_stiffness": actuator.stop_stiffness,
    }


def _drives(scenario: Scenario, wheels: tuple[Axle, ...], control: Spec | None) -> Iterator[Spec]:
    """DC drives; their fields move where the controller commands a field voltage, else they are held."""
    vehicle = scenario.vehicle
    drive = vehicle.drive
    if not isinstance(drive, Drive):
        return
    traction = scenario.traction
    if traction is None:
        point = operating_point(vehicle, scenario.speed)
        field_current, armature_voltage = point.field_current, point.armature_voltage
    else:
        field_current, armature_voltage = starting_point(vehicle, scenario.speed, margin=traction.field_margin)
    commanded = {command["target"] for command in control["commands"]} if control else set()
    field = {
        "resistance": drive.field_resistance,
        "inductance": drive.field_inductance,
        "voltage_max": drive.field_voltage_max,
    }
    for axle in wheels:
        for side, _ in SIDES:
            name = f"{axle.name}.{side}"
            yield {
                "name": name,
                "body": axle.name,
                "rotor": side,
                "armature_resistance": drive.armature_resistance,
                "armature_inductance": drive.armature_inductance,
                "emf_constant": drive.emf_constant,
                "field_current": field_current,
                "field": field if f"{name}.field_voltage" in commanded else None,
                "armature_voltage": armature_voltage,
                "armature_voltage_max": drive.armature_voltage_max,
                **_transmission(drive),
            }


def _induction_drives(vehicle: Vehicle, wheels: tuple[Axle, ...], speed: float) -> Iterator[Spec]:
    drive = vehicle.drive
    if not isinstance(drive, InductionDrive):
        return
    point = induction_point(vehicle, speed)
    motor = {key: getattr(drive, key) for key in CIRCUIT}
    assumed = drive.rotor_resistance_assumed
    for axle in wheels:
        for side, _ in SIDES:
            yield {
                "name": f"{axle.name}.{side}",
                "body": axle.name,
                "rotor": side,
                "motor": motor,
                "control": {
                    "model": None if assumed is None else motor | {"rotor_resistance": assumed},
                    "torque_bandwidth": drive.torque_bandwidth,
                    "flux_bandwidth": drive.flux_bandwidth,
                    "flux_rated": drive.rotor_flux_rated,
                    "current_max": drive.current_max,
                    "voltage_max": drive.voltage_max,
                    "flux_share": drive.flux_share,
                },
                "torque_command": point.torque_command,
                "transmission": _transmission(drive),
            }


def _transmission(drive: Transmission) -> Spec:
    return {
        "gear_ratio": drive.gear_ratio,
        "gear_sense": -1.0,  # one stage of spur gears turns the motor against the wheel
        "rotor_inertia": drive.rotor_inertia,
        "rotor_damping": drive.rotor_damping,
        "transmission_stiffness": drive.transmission_stiffness,
        "transmission_damping": drive.transmission_damping,
    }


def _drag(vehicle: Vehicle, headwind: float) -> Spec | None:
    if vehicle.running_resistance is None:
        return None
    davis = running_resistance(vehicle)
    return {"body": "body", "coefficients": [davis.constant, davis.linear, davis.quadratic], "headwind": headwind}


def _hold(vehicle: Vehicle) -> Spec:
    omega = 2.0 * math.pi * HOLD_FREQUENCY
    mass = vehicle.total_mass
    return {"body": "body", "proportional": 2.0 * mass * omega, "integral": mass * omega**2}
