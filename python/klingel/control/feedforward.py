"""What the steering must hold in a curve: the moment that keeps a wheelset radial plus its attack angle.
M = kpsi [+-a rho + alpha_Y - psi_b]: + leading, - trailing in its bogie; symbols at each function."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

GRAVITY = 9.81
"""[m/s2]"""


@dataclass(frozen=True)
class ContactDesign:
    """Wheel-rail contact as the controllers assume it; the vehicle itself runs on the real contact.

    longitudinal_creep, lateral_creep: f11, f22 of one wheel at `load` [N]: Kalker's coefficients on the Hertz ellipse
    of S1002 on 60E1 at 1:40; they scale with load^(2/3). conicity: gamma, effective slope at 1 to 2 mm. friction: 0.35,
    a dry rail; on a more slippery one the feedback adds what is missing. inclination: lateral force without any attack
    angle over the difference of the two wheel loads, by the contact angle near the tape circle and by spin creepage.
    """

    longitudinal_creep: float = 10.0e6
    lateral_creep: float = 8.8e6
    load: float = 54.5e3
    conicity: float = 0.2
    friction: float = 0.35
    inclination: float = 0.075


@dataclass(frozen=True)
class Sway:
    """g times roll over lateral acceleration, of the body and of a bogie frame against the track [-]."""

    body: float
    bogie: float

    @classmethod
    def of(cls, vehicle: Vehicle, *, acceleration: float = 2.0) -> Sway:
        """Quasi-static roll on the springs at a lateral acceleration [m/s2], with the shifted weight of the body.

        The acceleration, that of a cant deficiency of 300 mm, matters because of the lateral stops.
        """
        body, bogie, p, s = vehicle.body, vehicle.bogie, vehicle.primary, vehicle.secondary
        shift = _body_shift(vehicle, body.mass * acceleration / 2.0)
        arm, weight = body.height - s.height, body.mass * GRAVITY
        stiffness = (
            4.0 * (s.stiffness.z * s.half_spacing**2 + s.bending_stiffness) + 2.0 * vehicle.anti_roll_bar.stiffness
        )
        upper = (body.mass * acceleration * arm + weight * shift) / (stiffness - weight * arm)
        moment = body.mass * acceleration * (body.height - p.height) + weight * (shift + upper * arm)
        moment += 2.0 * bogie.mass * acceleration * (bogie.height - p.height)
        lower = moment / (8.0 * p.stiffness.z * p.half_spacing**2)
        return cls(body=GRAVITY * (upper + lower) / acceleration, bogie=GRAVITY * lower / acceleration)


def _body_shift(vehicle: Vehicle, force: float) -> float:
    """Lateral deflection [m] of the secondary suspension of one bogie, springs and stop, under a force [N]."""
    stop, spring = vehicle.lateral_stop, 2.0 * vehicle.secondary.stiffness.y
    deflections = np.asarray(stop.deflection)
    return float(np.interp(force, spring * deflections + np.asarray(stop.force), deflections))


def spin_momentum(vehicle: Vehicle) -> float:
    """Angular momentum of a wheelset's turning parts about its axle over the speed V [kg m].

    The rotors turn against the wheels (one gear stage), 1/N times as fast.
    """
    if vehicle.axle_bridge is None:
        assert vehicle.wheelset is not None
        return vehicle.wheelset.inertia.spin / vehicle.geometry.wheel_radius
    rotor = vehicle.drive.rotor_inertia / vehicle.drive.gear_ratio if vehicle.drive else 0.0
    return 2.0 * (vehicle.axle_bridge.wheel.inertia.spin - rotor) / vehicle.geometry.wheel_radius


@dataclass(frozen=True)
class SteeringGeometry:
    """What the feedforward needs of a vehicle, all SI.

    yaw_stiffness: kpsi of one wheelset's primary suspension [N m/rad]; lateral_stiffness: of one wheelset [N/m];
    secondary_yaw: kpsi of one bogie's secondary suspension [N m/rad]; yaw_damping: of its yaw dampers [N m s/rad];
    mass, centre_height: of the whole vehicle; body_yaw_inertia about its centre of mass [kg m2]. sway: g times the roll
    of body and bogie against the track over its lateral acceleration; sensors fixed to them read that much more.
    spin_momentum: of a wheelset's turning parts over its speed V [kg m]; primary_height above the rails.
    """

    half_wheelbase: float
    half_bogie_spacing: float
    half_tape_distance: float
    mass: float
    centre_height: float
    yaw_stiffness: float
    lateral_stiffness: float
    secondary_yaw: float
    yaw_damping: float
    body_mass: float
    body_yaw_inertia: float
    sway: Sway
    spin_momentum: float
    primary_height: float

    @property
    def bogie_mass(self) -> float:
        """Of one bogie with its wheelsets [kg]."""
        return 0.5 * (self.mass - self.body_mass)

    @classmethod
    def of(cls, vehicle: Vehicle) -> SteeringGeometry:
        """The numbers of a vehicle."""
        g, p, s = vehicle.geometry, vehicle.primary, vehicle.secondary
        moment = vehicle.body.mass * vehicle.body.height + 2.0 * vehicle.bogie.mass * vehicle.bogie.height
        moment += 4.0 * vehicle.wheelset_mass * g.wheel_radius
        return cls(
            half_wheelbase=g.half_wheelbase,
            half_bogie_spacing=g.half_bogie_spacing,
            half_tape_distance=vehicle.wheel_profile.half_tape_distance,
            mass=vehicle.total_mass,
            centre_height=moment / vehicle.total_mass,
            yaw_stiffness=2.0 * p.stiffness.x * p.half_spacing**2,
            lateral_stiffness=2.0 * p.stiffness.y,
            secondary_yaw=2.0 * s.stiffness.x * s.half_spacing**2,
            yaw_damping=2.0 * d.damping * d.half_spacing**2 if (d := vehicle.yaw_damper) else 0.0,
            body_mass=vehicle.body.mass,
            body_yaw_inertia=vehicle.body.inertia.yaw,
            sway=Sway.of(vehicle),
            spin_momentum=spin_momentum(vehicle),
            primary_height=p.height,
        )

    def pair_share(self, wheelset: int) -> float:
        """Lateral force of a wheelset over the yaw moment that its bogie needs [1/m]: +-1/(2 a).

        Two wheelsets that are free of yaw moment turn their bogie by a pair of lateral forces.
        """
        lead = 1.0 if wheelset == 1 else -1.0
        return lead / (2.0 * self.half_wheelbase)

    def lateral_share(self, bogie: int, wheelset: int) -> float:
        """d(Y)/d(rho) [N m] of a wheelset by the yaw of its bogie against the body: +-kpsi_secondary L / (2 a).

        The secondary suspension turns the bogie back towards the body: + for wheelset 1 of bogie 1 and wheelset 2 of
        bogie 2, - for the two inner ones.
        """
        front = 1.0 if bogie == 1 else -1.0
        return self.pair_share(wheelset) * front * self.secondary_yaw * self.half_bogie_spacing

    def bogie_yaw(self, bogie: int) -> float:
        """d(psi_b)/d(rho) [m]: the bogie frame's yaw that the same pair of forces makes on the primary springs."""
        pair = self.lateral_share(bogie, 1) - self.lateral_share(bogie, 2)
        return -pair / self.lateral_stiffness / (2.0 * self.half_wheelbase)


def creep_force(creepage: float, stiffness: float, limit: float) -> float:
    """Creep force [N] of one wheel: linear at first, saturated at `limit`; Johnson and Vermeulen's cubic."""
    share = min(abs(stiffness * creepage) / (3.0 * limit), 1.0)
    return float(np.copysign(limit * (1.0 - (1.0 - share) ** 3), creepage))


def attack_angle(force: float, geometry: SteeringGeometry, contact: ContactDesign) -> float:
    """alpha_Y [rad]: the yaw against the track at which both wheels together give the lateral force Y [N].

    The wheel loads are those of the cant deficiency that Y stands for: m/4 a_nc = Y, with the moment of a_nc about the
    rails at the height of the vehicle's centre of mass. Linear for small forces: Y/(2 f22).

    >>> from klingel import library
    >>> geometry = SteeringGeometry.of(library.vehicle("mechatronic_irw"))
    >>> round(1e3 * attack_angle(1e3, geometry, ContactDesign()), 3)
    0.048
    """
    if force == 0.0:
        return 0.0
    static = geometry.mass * GRAVITY / 8.0
    transfer = abs(force) * geometry.centre_height / (2.0 * geometry.half_tape_distance)
    loads = (static + transfer, max(static - transfer, 0.05 * static))
    wheels = [(contact.lateral_creep * (n / contact.load) ** (2.0 / 3.0), contact.friction * n) for n in loads]

    carried = contact.inclination * (loads[0] - loads[1])

    def missing(angle: float) -> float:
        return carried + sum(creep_force(angle, f22, limit) for f22, limit in wheels) - abs(force)

    saturated = max(3.0 * limit / f22 for f22, limit in wheels)
    if missing(saturated) <= 0.0:
        return float(np.copysign(saturated, force))
    return float(np.copysign(brentq(missing, 0.0, saturated, xtol=1e-9), force))


@cache
def attack_angle_table(
    geometry: SteeringGeometry, contact: ContactDesign
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Lateral force [N] and attack angle [rad] for a lookup; its ends are 0.9 of what the friction can hold."""
    limit = 0.9 * contact.friction * geometry.mass * GRAVITY / 4.0
    forces = np.linspace(-limit, limit, 41)
    return tuple(map(float, forces)), tuple(attack_angle(float(f), geometry, contact) for f in forces)
