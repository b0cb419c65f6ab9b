"""Creep control of the wheels under traction and braking: torque is given back where a wheel slips too much.
One limiter a pair of wheels, so that both keep equal shares and what steers them stays in hand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.basics import SPEED, Timing, check_positive
from klingel.control.diagram import BEYOND, Diagram

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


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
        drive, bridge = vehicle.drive, vehicle.axle_bridge
        assert drive is not None
        assert bridge is not None
        radius = vehicle.geometry.wheel_radius
        inertia = bridge.wheel.inertia.spin + drive.rotor_inertia / drive.gear_ratio**2
        gain = 2.0 * math.pi * self.frequency * inertia / radius
        speed = d.measure(SPEED)
        # at walking pace a creepage says nothing: a slip speed takes its place
        allowed = d.lookup(
            f"{w}.slip.most", speed, (0.0, self.slip_speed / self.creepage, 100.0),
            (self.slip_speed, self.slip_speed, 100.0 * self.creepage),
        )  # fmt: skip
        slips = []
        for side in ("left", "right"):
            wheel = d.measure(f"{w}.{side}.spin_speed")
            now = d.sum(f"{w}.slip.{side}.now", {wheel: radius, speed: -1.0})
            slips.append(d.delay(f"{w}.slip.{side}", now, timing.sensor_samples))
        spinning = d.larger(f"{w}.slip.spinning", *slips)
        sliding = d.smaller(f"{w}.slip.sliding", *slips)
        parts = []
        for name, slip, sign in (("spinning", spinning, 1.0), ("sliding", sliding, -1.0)):
            error = d.sum(f"{w}.slip.{name}.error", {allowed: sign, slip: -1.0})
            range_: tuple[float | str, float | str]
            if sign > 0.0:
                range_ = (0.0, d.saturation(f"{w}.T.{name}.asked", asked, 0.0, BEYOND))
            else:
                range_ = (d.saturation(f"{w}.T.{name}.asked", asked, -BEYOND, 0.0), 0.0)
            parts.append(
                d.pi(f"{w}.T.{name}", error, proportional=gain, integral=gain / self.integral_time, within=range_)
            )
        torque = d.sum(f"{w}.T", {parts[0]: 1.0, parts[1]: 1.0})
        d.probe(f"{w}.slip_speed_limit", "m/s", allowed)
        return torque
