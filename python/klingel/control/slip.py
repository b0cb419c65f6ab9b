"""Creep control of the wheels under traction and braking: torque is given back where a wheel slips too much.
One limiter a pair of wheels, so that both keep equal shares and what steers them stays in hand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.basics import SPEED, Timing, check_positive
from klingel.control.diagram import BEYOND, Diagram, Gain

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

GRIP_LOST = (0.2, 0.35)
"""Slip speed over what is allowed at which the coupling of a pair begins to fall, and has."""

FREE_FREQUENCY = 5.0
"""Crossover of the coupling on free wheels [Hz], with the delays of sampling far from its stability limit."""


@dataclass(frozen=True)
class SlipControl:
    """Limits the longitudinal creepage of the wheel of a pair that slips most.

    creepage: wanted limit [-], near the maximum of adhesion of a wet rail; slip_speed: the limit at low speed [m/s];
    frequency: crossover of the loop on wheel and rotor spinning freely [Hz]; integral_time: [s], by which torque comes
    back after a slide.

    T = PI(s_max - s) within 0 and the torque asked, s the slip speed r0 w - V: where the wheel sticks the upper limit
    holds and nothing winds up. Braking is the same with opposite signs. Speeds are measured: the wheels' by encoders,
    the vehicle's over ground.

    >>> SlipControl().creepage
    0.015
    """

    creepage: float = 0.015
    slip_speed: float = 0.15
    frequency: float = 3.0
    integral_time: float = 0.2

    def __post_init__(self) -> None:
        check_positive(self, ("creepage", "slip_speed", "frequency", "integral_time"), key="control.traction.slip")

    def limited(self, d: Diagram, vehicle: Vehicle, w: str, asked: str, timing: Timing) -> str:
        """The torque of each wheel of a pair [N m], out of the torque asked."""
        allowed, spinning, sliding = self._slips(d, vehicle, w, timing)
        gain = 2.0 * math.pi * self.frequency * turning_inertia(vehicle) / vehicle.geometry.wheel_radius
        driving = d.saturation(f"{w}.T.driving", asked, 0.0, BEYOND)
        braking = d.saturation(f"{w}.T.braking", asked, -BEYOND, 0.0)
        ranges: dict[str, tuple[str, float, tuple[Gain, Gain]]] = {
            "spinning": (spinning, 1.0, (0.0, driving)),
            "sliding": (sliding, -1.0, (braking, 0.0)),
        }
        parts: dict[str, Gain] = {}
        for name, (slip, sign, within) in ranges.items():
            error = d.sum(f"{w}.slip.{name}.error", {allowed: sign, slip: -1.0})
            integral = gain / self.integral_time
            parts[d.pi(f"{w}.T.{name}", error, proportional=gain, integral=integral, within=within)] = 1.0
        return d.sum(f"{w}.T", parts)

    def gripped(self, d: Diagram, vehicle: Vehicle, w: str, damping: str, timing: Timing) -> str:
        """A damping between the wheels of a pair that falls to what free wheels bear while one of them slips.

        Creep holds a wheel that rolls; one that slides is held by nothing, and a stiff loop with its delays would make
        the rotors swing.
        """
        allowed, spinning, sliding = self._slips(d, vehicle, w, timing)
        backwards = d.sum(f"{w}.slip.backwards", {sliding: -1.0})
        share = d.quotient(f"{w}.slip.share", d.larger(f"{w}.slip.worse", spinning, backwards), allowed, floor=1e-3)
        grip = d.lookup(f"{w}.grip", share, GRIP_LOST, (1.0, 0.0))
        free = 2.0 * math.pi * FREE_FREQUENCY * turning_inertia(vehicle)
        bound = d.sum(f"{w}.speed_loop.bound", {damping: grip}, bias=free)
        return d.smaller(f"{w}.speed_loop.gripped", damping, bound)

    def _slips(self, d: Diagram, vehicle: Vehicle, w: str, timing: Timing) -> tuple[str, str, str]:
        """What is allowed, the most forward and the most backward slip speed r0 w - V of a pair [m/s]; made once."""
        names = tuple(f"{w}.slip.{part}" for part in ("allowed", "spinning", "sliding"))
        if not d.has(names[0]):
            radius, speed = vehicle.geometry.wheel_radius, d.measure(SPEED)
            # at walking pace a creepage says nothing: a slip speed takes its place
            places = (0.0, self.slip_speed / self.creepage, 100.0)
            d.lookup(names[0], speed, places, (self.slip_speed, self.slip_speed, 100.0 * self.creepage))
            slips = []
            for side in ("left", "right"):
                wheel = d.measure(f"{w}.{side}.spin_speed")
                now = d.sum(f"{w}.slip.{side}.now", {wheel: radius, speed: -1.0})
                slips.append(d.delay(f"{w}.slip.{side}", now, timing.sensor_samples))
            d.larger(names[1], *slips)
            d.smaller(names[2], *slips)
        return names[0], names[1], names[2]


def turning_inertia(vehicle: Vehicle) -> float:
    """Of a wheel with its rotor behind the gear, Iwy + JM/N^2 [kg m2]."""
    drive, bridge = vehicle.drive, vehicle.axle_bridge
    assert drive is not None
    assert bridge is not None
    return bridge.wheel.inertia.spin + drive.rotor_inertia / drive.gear_ratio**2
