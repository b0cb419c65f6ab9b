"""A damper between the two wheels of a pair, made by its motors: what guides driven wheels that nothing steers back.
As in `SolidLike`, but each pair for itself, and without an integral."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from klingel.control.basics import SPEED, Timing, Wheelset, check_positive, scheduled
from klingel.control.common import Plant, database_curvature, speed_difference
from klingel.control.diagram import Diagram, Gain
from klingel.control.discrete import lead, notch
from klingel.control.feedforward import ContactDesign
from klingel.control.motors import Motors, command_motors

if TYPE_CHECKING:
    from klingel.track import Track


@dataclass(frozen=True)
class WheelCoupling:
    """c between the wheels of a pair [N m s/rad], against the speed difference of the curve.

    share: c over f11 r0^2/V up to `full_speed` [m/s], falling with 1/V above: with c the pair takes c/(1 + c) of the
        longitudinal creep of a solid wheelset, and more would hunt on the soft primary suspension.
    slow_speed: running speed below which c stays [m/s]; delays and the transmission's torsion bear no more.
    lead_pole: time constant [s] that replaces the armature's La/Ra for DC motors.
    notch_frequency, notch_depth, notch_width: of the transmission's torsion mode with the wheel held by creep [Hz].

    >>> WheelCoupling(share=0.2).slow_speed
    18.0
    """

    share: float = 0.25
    full_speed: float = 36.0
    slow_speed: float = 18.0
    lead_pole: float = 0.002
    notch_frequency: float = 55.0
    notch_depth: float = 0.1
    notch_width: float = 0.5

    def __post_init__(self) -> None:
        shape = ("lead_pole", "notch_frequency", "notch_depth", "notch_width")
        check_positive(self, ("share", "full_speed", "slow_speed", *shape), key="control.pair")

    def damping(self, plant: Plant, contact: ContactDesign, speed: float) -> float:
        """c at a speed [m/s]"""
        share = self.share * min(1.0, self.full_speed / speed)
        return share * contact.longitudinal_creep * plant.radius**2 / max(speed, self.slow_speed)

    def drive(
        self,
        d: Diagram,
        plant: Plant,
        contact: ContactDesign,
        motors: Motors,
        w: Wheelset,
        track: Track,
        timing: Timing,
        *,
        beside: Mapping[str, Gain],
    ) -> None:
        """u = K(s) (lambda V rho/r0 + what is asked `beside` - wd), with the back-EMF of the curve's difference."""
        ts = timing.sample_time
        rho = database_curvature(d, f"{w.name}.rho.here", track, d.measure(f"{w.name}.s"))
        turn = d.product(f"{w.name}.turn", rho, d.measure(SPEED))
        measured = speed_difference(d, w, timing)
        error = d.sum(f"{w.name}.wd.error", {turn: plant.speed_ratio, **beside, measured: -1.0})
        shape = [notch(self.notch_frequency, depth=self.notch_depth, width=self.notch_width, sample_time=ts)]
        if motors.lag > 0.0:
            shape.insert(0, lead(motors.lag, self.lead_pole, sample_time=ts))
        shaped = d.filter(f"{w.name}.wd.shaped", error, shape)
        gain = motors.gain(d, w.name, lambda v: self.damping(plant, contact, v))
        back_emf = motors.per_speed(d, w.name, plant.speed_ratio)
        command_motors(d, motors, w.name, d.sum(f"{w.name}.u", {shaped: gain, turn: back_emf}))

    def per_torque(self, d: Diagram, plant: Plant, contact: ContactDesign) -> str:
        """The speed difference over a torque of the wheels, 1/c + V/(f11 r0^2): what makes it, and what it slips."""
        rolling = contact.longitudinal_creep * plant.radius**2
        return scheduled(d, "pair.per_torque", lambda v: 1.0 / self.damping(plant, contact, v) + v / rolling)
