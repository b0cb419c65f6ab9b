"""A roller rig: one wheelset whose bridge is guided, both drives on it, to measure what Eqs (12) to (29) state.
Only its wheels spin and its weight rests on the rails; creep is linear, the track straight and level."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from klingel.contact import WheelRailPair, profile_of
from klingel.contact.creep import creep_force
from klingel.control.diagram import Diagram
from klingel.control.discrete import lead
from klingel.control.response import controller_response
from klingel.drives import DriveTransfer, WheelPair, operating_point
from klingel.errors import InputError
from klingel.linear.measured import Measured, measured_response
from klingel.linear.model import LinearModel
from klingel.linear.operating import steady_spec
from klingel.linear.response import frequency_response
from klingel.linear.statespace import linearise
from klingel.lower import GRAVITY, Spec, axles
from klingel.scenario import CreepLaw, Scenario
from klingel.track import Track
from klingel.units import Quantity, to_si
from klingel.vehicle import Drive, Vehicle

Response = NDArray[np.complex128]

GUIDED = ("x", "y", "roll", "pitch", "yaw")
"""Motions of the bridge that the rig keeps: all but up and down."""

HEAVY = 1e9
"""Moment of inertia of wheels that are held [kg m2]."""

SHEAR_MODULUS, POISSON = 210e9 / 2.56, 0.28
"""Of the steel of wheels and rails [Pa], [-]."""

STEP = 5e-4
"""Of the integrator and of the inputs [s]."""

EQUATIONS = ("(13)", "(14)", "(25)", "(27)", "(29)")

CROSSOVER = 2.0
"""Of the torque controller that Eq. (25) is measured with [Hz]; at 5 Hz the torsion is nearly unstable at 265 km/h."""

CANCELS = 0.06
"""Distance of a zero from a pole, over its size, up to which the two count as cancelled."""

AMPLITUDE = 0.02
"""R.m.s. of an excitation over what the motors are given in steady running."""


def rig_spec(vehicle: Vehicle, speed: Quantity, *, held: bool = False) -> Spec:
    """The core's spec of one wheelset of a driven vehicle on the rig, at a speed, loaded as in the vehicle.

    held: wheels too heavy to change their speed. Bodies and inputs are named `wheelset`, `wheelset.left`, ...
    Error: InputError for a vehicle without drives.

    >>> from klingel import library
    >>> spec = rig_spec(library.vehicle("mechatronic_irw"), "176 km/h")
    >>> len(spec["bodies"]), len(spec["drives"]), spec["bodies"][0]["guided"]
    (1, 2, ['x', 'y', 'roll', 'pitch', 'yaw'])
    """
    if vehicle.drive is None:
        raise InputError.single("drive", None, "is missing", remedy=f"{vehicle.name} is hauled; take a driven vehicle")
    scenario = Scenario(vehicle, Track.straight(1000.0), speed=speed, creep_law="linear", step=STEP)
    whole = steady_spec(scenario)
    first = next(b for b in whole["bodies"] if b["name"].endswith("wheelset1"))
    old = first["name"]

    def own(part: Spec) -> Spec:
        renamed = {key: value.replace(old, "wheelset") for key, value in part.items() if isinstance(value, str)}
        return copy.deepcopy(part) | renamed

    bridge = own(first) | {
        "mass": vehicle.total_mass / 4.0,
        "position": [0.0, 0.0, first["position"][2]],
        "guided": list(GUIDED),
    }
    if held:
        bridge["rotors"] = [rotor | {"inertia": HEAVY} for rotor in bridge["rotors"]]
    return {
        "name": f"{vehicle.name} on the rig",
        "gravity": GRAVITY,
        "speed": whole["speed"],
        "track": whole["track"] | {"start": 0.0},
        "bodies": [bridge],
        "contact_pairs": whole["contact_pairs"],
        "wheels": [own(w) for w in whole["wheels"] if w["body"] == old],
        "creep": whole["creep"],
        **{kind: [own(d) for d in whole[kind] if d["body"] == old] for kind in ("drives", "induction_drives")},
        "run": whole["run"],
    }


def longitudinal_creep(vehicle: Vehicle) -> float:
    """f11 of one wheel [N] under its share of the vehicle's weight, centred: Kalker's linear theory."""
    wheel, rail = profile_of(vehicle.wheel_profile.name, "wheel"), profile_of("60E1", "rail")
    pair = WheelRailPair(
        wheel,
        rail,
        rail_inclination=0.025,
        gauge="1435 mm",
        flange_back=vehicle.wheel_profile.flange_back_distance,
        radius=vehicle.geometry.wheel_radius,
        normal="hertz",
    )
    load = vehicle.total_mass * GRAVITY / 8.0
    contacts = pair.contact(0.0, wheel_load=load)
    right = contacts[contacts["side"] == "right"]
    a, b, load_on = (right[key].to_numpy(dtype=np.float64) for key in ("a", "b", "normal_force"))
    nil, slip = np.zeros(len(right)), 1e-6
    force, _, _ = creep_force(
        "linear",
        a=a,
        b=b,
        xi=nil + slip,
        eta=nil,
        phi=nil,
        normal_force=load_on,
        friction=0.35,
        shear_modulus=SHEAR_MODULUS,
        poisson=POISSON,
    )
    return float(-force.sum() / slip)


@dataclass(frozen=True, eq=False)
class RigResponses:
    """Responses measured on the rig beside those of the equations, by equation number.

    frequencies: [Hz]; measured, stated: complex amplitude ratios, in N m, V and rad/s.
    """

    speed: float
    frequencies: NDArray[np.float64]
    measured: Mapping[str, Response]
    stated: Mapping[str, Response]

    def worst(self) -> dict[str, tuple[float, float]]:
        """Of each equation the largest departure in dB and in degrees."""
        found = {}
        for name, stated in self.stated.items():
            ratio = self.measured[name] / stated
            level, angle = np.abs(20.0 * np.log10(np.abs(ratio))), np.abs(np.degrees(np.angle(ratio)))
            found[name] = (float(level.max()), float(angle.max()))
        return found


def rig_responses(vehicle: Vehicle, speed: Quantity, *, band: tuple[float, float] = (1.0, 100.0)) -> RigResponses:
    """Measure Eqs (13), (14), (25), (27) and (29) on the rig, from runs of the simulator, up to 100 Hz.

    (13) and the first term of (25) with the wheels held, (27) and (29) free, (14) from all three:
    TOUT = Gu Va + Gv wOUT. Inputs are held over a step; what that does is divided out, as the equations do not know it.
    (25) is measured with an integral controller in the core's own sampled diagram, which K(s) of the equation includes.
    Errors: InputError for a vehicle without DC motors; SimulationError.
    """
    point = operating_point(vehicle, to_si(speed, "m/s", key="speed"))
    transfer = DriveTransfer.of(vehicle.dc_drive, field_current=point.field_current)
    bridge = vehicle.axle_bridge
    assert bridge is not None
    pair = WheelPair(bridge.wheel.inertia.spin, vehicle.geometry.wheel_radius, point.speed, longitudinal_creep(vehicle))
    amplitude = AMPLITUDE * point.armature_voltage
    held_rig, free_rig = rig_spec(vehicle, point.speed, held=True), rig_spec(vehicle, point.speed)
    va, torque, spin = (f"wheelset.left.{part}" for part in ("armature_voltage", "shaft_torque", "spin_speed"))
    f, (gu,) = _measure(held_rig, va, [torque], amplitude, band)
    _, (plant, speed_plant) = _measure(free_rig, va, [torque, spin], amplitude, band)

    diagram = torque_diagram(transfer, point.armature_voltage)
    _, (closed,) = _measure(held_rig | {"control": diagram}, _SIGNAL, [torque], amplitude, band, hold=False)
    omega = 2.0 * math.pi * f
    response = controller_response(diagram, {}, omega)[:, 0]
    late = np.exp(-1j * omega * STEP) * _hold(f)
    to, of = (diagram["measurements"].index(name) for name in (_SIGNAL, torque))
    command, back = response[:, to] * late, -response[:, of] * late
    gu_stated, gv_stated = transfer.Gu.response(omega), transfer.Gv.response(omega)
    return RigResponses(
        point.speed,
        f,
        {
            "(13)": gu,
            "(14)": (plant - gu) / speed_plant,
            "(25)": closed,
            "(27)": plant,
            "(29)": speed_plant,
        },
        {
            "(13)": gu_stated,
            "(14)": gv_stated,
            "(25)": gu_stated * command / (1.0 + gu_stated * back),
            "(27)": transfer.torque_plant(pair).response(omega),
            "(29)": transfer.speed_plant(pair).response(omega),
        },
    )


_SIGNAL = "wheelset.right.armature_voltage"
"""The right motor's voltage, excited, is the signal that the left one's controller is commanded by: on the rig neither
wheel feels the other."""


def torque_diagram(transfer: DriveTransfer, mean: float) -> Spec:
    """u = K (Td_command - Td) on the left motor, K(s) = 2 pi fc (1/s + La/Ra)/Gu(0), Td_command = Gu(0) x signal."""
    d = Diagram(sample_time=STEP)
    gain = abs(transfer.Gu(0j))
    signal = d.sum("command", {d.measure(_SIGNAL): gain}, bias=-gain * mean)
    error = d.sum("error", {signal: 1.0, d.measure("wheelset.left.shaft_torque"): -1.0})
    crossover = 2.0 * math.pi * CROSSOVER / gain
    lag = transfer.armature_inductance / transfer.armature_resistance
    u = d.pi("u", error, proportional=crossover * lag, integral=crossover, limit=0.1 * mean)
    d.command("wheelset.left.armature_voltage", d.sum("Va", {u: 1.0}, bias=mean))
    return d.spec()


def torque_response(
    vehicle: Vehicle, speed: Quantity, *, band: tuple[float, float] = (0.5, 15.0)
) -> tuple[NDArray[np.float64], Response]:
    """Shaft torque over commanded torque of one wheel on the rig, frequencies [Hz] and complex ratio, from a run.

    The command passes a sampled diagram as the strategies' do: for DC motors u = N Ra/KT x lead(La/Ra, 2 ms), for
    induction motors the command itself. Errors: InputError for a vehicle without drives; SimulationError.
    """
    spec = rig_spec(vehicle, speed)
    drive = vehicle.drive
    d = Diagram(sample_time=STEP)
    if isinstance(drive, Drive):
        point = operating_point(vehicle, spec["speed"])
        name, mean = "armature_voltage", point.armature_voltage
        gain = point.torque_constant / (drive.gear_ratio * drive.armature_resistance)
        shape = [lead(drive.armature_inductance / drive.armature_resistance, 0.002, sample_time=STEP)]
    else:
        name, mean = "torque_command", float(spec["induction_drives"][0]["torque_command"])
        gain, shape = 1.0, []
    signal = d.sum("signal", {d.measure(f"wheelset.right.{name}"): 1.0}, bias=-mean)
    shaped = d.filter("shaped", signal, shape) if shape else signal
    d.command(f"wheelset.left.{name}", d.sum("command", {shaped: 1.0}, bias=mean))
    amplitude = AMPLITUDE * mean
    rig = spec | {"control": d.spec()}
    f, (found,) = _measure(rig, f"wheelset.right.{name}", ["wheelset.left.shaft_torque"], amplitude, band, hold=False)
    return f, found / gain


def _hold(f: NDArray[np.float64]) -> Response:
    """What holding an input over a step does at frequencies [Hz]."""
    s = 2j * math.pi * f * STEP
    return np.asarray((1.0 - np.exp(-s)) / s)


def _measure(
    spec: Spec, input: str, outputs: Sequence[str], amplitude: float, band: tuple[float, float], *, hold: bool = True
) -> tuple[NDArray[np.float64], list[Response]]:
    """Frequencies and responses of some channels to an input, the hold divided out if asked."""
    period = max(2.0, 2.0 / band[0])
    found: Measured = measured_response(
        spec, input, outputs, amplitude=amplitude, band=band, period=period, interval=STEP, courses=2
    )
    by = _hold(found.frequencies) if hold else 1.0
    return found.frequencies, [np.asarray(column / by) for column in found.response.T]


@dataclass(frozen=True, eq=False)
class PlantDeparture:
    """Design plants of a wheel pair beside what the whole vehicle answers, wheelset by wheelset.

    frequencies [Hz]; stated: Eqs (27) and (29); exact: by wheelset, the same two of the vehicle's linear model; zeros:
    by wheelset, the lightly damped ones of wd/u [Hz, damping ratio].
    """

    speed: float
    frequencies: NDArray[np.float64]
    stated: Mapping[str, Response]
    exact: Mapping[str, Mapping[str, Response]]
    zeros: Mapping[str, tuple[tuple[float, float], ...]]


def plant_departure(
    vehicle: Vehicle, speed: Quantity, frequencies: NDArray[np.float64], *, creep_law: CreepLaw = "table"
) -> PlantDeparture:
    """Eqs (27) and (29) against the exact linear model of the vehicle on straight track, no controller acting.

    Eq. (26) drops yaw and lateral motion, which carry the wheels along. Where wd is kept at nil the two wheels are a
    solid wheelset, so the zeros of wd/u are the motions of the vehicle with that pair locked: the kinematic oscillation
    of Klingel, V/(2 pi) sqrt(gamma/(lambda r0)), hardly damped (docs/theory/drives.md).
    Errors: InputError for a vehicle without DC motors; SimulationError where it has no steady state.
    """
    scenario = Scenario(vehicle, Track.straight(1000.0), speed=speed, creep_law=creep_law)
    point = operating_point(vehicle, scenario.speed)
    model = linearise(scenario, controllers=False)
    transfer = DriveTransfer.of(vehicle.dc_drive, field_current=point.field_current)
    bridge = vehicle.axle_bridge
    assert bridge is not None
    f11 = longitudinal_creep(vehicle)
    pair = WheelPair(bridge.wheel.inertia.spin, vehicle.geometry.wheel_radius, scenario.speed, f11)
    omega = 2.0 * math.pi * frequencies
    stated = {
        "(27)": transfer.torque_plant(pair).response(omega),
        "(29)": transfer.speed_plant(pair).response(omega),
    }
    exact, zeros = {}, {}
    for axle in axles(vehicle):
        left, right = f"{axle.name}.left", f"{axle.name}.right"
        u = {f"{left}.armature_voltage": 1.0, f"{right}.armature_voltage": -1.0}
        parts = ("shaft_torque", "spin_speed")
        found = frequency_response(model, u, [f"{side}.{p}" for p in parts for side in (left, right)], frequencies)
        exact[axle.name] = {
            "(27)": 0.5 * (found[:, 0] - found[:, 1]),
            "(29)": 0.5 * (found[:, 2] - found[:, 3]),
        }
        zeros[axle.name] = _zeros(model, u, {f"{left}.spin_speed": 0.5, f"{right}.spin_speed": -0.5})
    return PlantDeparture(scenario.speed, frequencies, stated, exact, zeros)


def _zeros(model: LinearModel, u: Mapping[str, float], y: Mapping[str, float]) -> tuple[tuple[float, float], ...]:
    """Lightly damped zeros from a sum of inputs to a sum of outputs up to 20 Hz, without those that cancel a pole."""
    from scipy.linalg import eig

    inputs, outputs = [i.name for i in model.inputs], [o.name for o in model.outputs]
    b = sum(gain * model.B[:, [inputs.index(name)]] for name, gain in u.items())
    c = sum(gain * model.C[[outputs.index(name)]] for name, gain in y.items())
    n = len(model.A)
    mass = np.zeros((n + 1, n + 1))
    mass[:n, :n] = np.eye(n)
    s = eig(np.block([[model.A, b], [c, np.zeros((1, 1))]]), mass, right=False)
    poles = np.linalg.eigvals(model.A)
    light = [z for z in s[np.isfinite(s)] if z.imag > 0.0 and 2.0 < abs(z) < 126.0 and abs(z.real) < 0.5 * abs(z)]
    alone = [z for z in light if np.abs(poles - z).min() > CANCELS * abs(z)]
    return tuple(sorted((float(abs(z)) / (2.0 * math.pi), float(-z.real / abs(z))) for z in alone))
