"""Yaw control between bogies and body: actuators in place of yaw dampers.
They damp the hunting of the bogies and take the yaw moment of the secondary springs away in curves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import Timing, check_positive, scheduled
from klingel.control.diagram import Diagram
from klingel.control.discrete import high_pass, low_pass
from klingel.control.feedforward import SteeringGeometry
from klingel.control.fit import misfits
from klingel.control.steering import relative_yaw
from klingel.errors import InputError, Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class SecondaryYaw:
    """M = -c(V) HP(r_bogie - r_body) + k kpsi LP(psi), the yaw moment on each bogie; psi is its yaw against the body.

    damping: c of a bogie at `damping_speed` and above [N m s/rad]; as two yaw dampers of 200 kN s/m at 1.3 m.
    damping_speed: running speed up to which c grows with it [m/s]: bogies hunt at speed; at 10 m/s all of c would make
        them swing on their primary springs at 35 Hz.
    damping_frequency: corner of the high-pass [Hz]: transitions are slower than hunting; its lead costs
        damping near 2 Hz.
    relief: k, of the yaw moment of the secondary springs kpsi that is taken away; above 1 it turns the
        bogie further in.
    relief_frequency: corner of the low-pass of the strokes [Hz]: above it the springs stay as they are.
    timing: sampling and delays.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = SecondaryYaw().lower(library.vehicle("actuated_coach"), Track.straight("500 m"), 30.0)
    >>> [command["target"] for command in spec["commands"]][:2]
    ['bogie1.yaw_actuator_left.force', 'bogie1.yaw_actuator_right.force']
    """

    damping: float = 676e3
    damping_speed: float = 50.0
    damping_frequency: float = 0.1
    relief: float = 1.0
    relief_frequency: float = 0.3
    timing: Timing = field(default_factory=Timing)

    def __post_init__(self) -> None:
        check_positive(self, ("damping", "damping_speed", "damping_frequency", "relief", "relief_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("secondary_steering",), take="actuated_coach")

    def lower(self, vehicle: Vehicle, track: Track | None, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle.

        Errors: InputError for a vehicle without yaw actuators.
        """
        actuator = vehicle.secondary_steering
        if actuator is None:
            remedy = "take a vehicle with [secondary_steering]"
            raise InputError.single("secondary_steering", None, "is missing", remedy=remedy)
        stiffness = SteeringGeometry.of(vehicle).secondary_yaw
        ts = self.timing.sample_time
        d = Diagram(sample_time=ts)
        damping = scheduled(d, "yaw.damping", lambda v: -self.damping * min(1.0, v / self.damping_speed))
        for bogie in ("bogie1", "bogie2"):
            rates = {d.measure(f"{bogie}.yaw_rate"): 1.0, d.measure("body.yaw_rate"): -1.0}
            rate = d.delay(f"{bogie}.turning", d.sum(f"{bogie}.turning.now", rates), self.timing.sensor_samples)
            quick = d.filter(f"{bogie}.turning.quick", rate, [high_pass(self.damping_frequency, sample_time=ts)])
            # the actuators push the body against the bogie: their yaw is that of the body
            yaw = relative_yaw(d, f"{bogie}.yaw_actuator", actuator, self.timing)
            slow = d.filter(f"{bogie}.yaw.slow", yaw, [low_pass(self.relief_frequency, sample_time=ts)])
            moment = d.sum(f"{bogie}.M", {quick: damping, slow: -self.relief * stiffness})
            limited = d.saturation(f"{bogie}.M.limited", moment, -actuator.moment_max, actuator.moment_max)
            sent = d.delay(f"{bogie}.M.sent", limited, self.timing.computation_samples)
            for side, sign in (("left", -1.0), ("right", 1.0)):
                force = d.sum(f"{bogie}.F.{side}", {sent: sign / (2.0 * actuator.half_spacing)})
                d.command(f"{bogie}.yaw_actuator_{side}.force", force)
            d.probe(f"{bogie}.yaw_moment_command", "N m", sent)
        return d.spec()
