"""Driven independently rotating wheels guided by the difference of their torques alone; nothing else steers.
The yaw moment is made by creep forces along the rails, within what adhesion and motors give."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, Wheelset, check_positive
from klingel.control.common import Plant, sense_inertia
from klingel.control.coupling import WheelCoupling
from klingel.control.diagram import Diagram
from klingel.control.driven import motors_of
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.motors import Motors
from klingel.control.steering import database_feedforward
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class TorqueVectoring:
    """Td = c (lambda V rho/r0 - wd) + (1 + c V/(f11 r0^2)) r0/(2 lambda) M, M the moment that steering would need.

    The first part is a damper between the wheels; the second makes the moment of the feedforward by creep forces in
    place of actuators. Those the vehicle has are left without force.

    torque_max: largest torque of a wheel that the feedforward asks for [N m]; 1.6 times the rated one of the library's
        DC motors, for the seconds of a curve.
    sensor_frequency: low-pass of the inertial sensors [Hz], above the body's own modes near 1 Hz.
    pair: the damper between the wheels.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.
    traction: loop that drives and brakes the vehicle through the same motors.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = TorqueVectoring().lower(library.vehicle("mechatronic_irw"), Track.straight("500 m"), 30.0)
    >>> {command["target"].rsplit(".", 1)[1] for command in spec["commands"]}
    {'armature_voltage'}
    """

    torque_max: float = 4000.0
    sensor_frequency: float = 2.0
    pair: WheelCoupling = field(default_factory=WheelCoupling)
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        check_positive(self, ("torque_max", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge", "drive"), take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s] on a track whose curvature the database knows.

        Errors: InputError for a vehicle without drives.
        """
        plant = Plant.unsteered(vehicle)
        motors = motors_of(vehicle, self.traction, self.timing, speed)
        d = Diagram(sample_time=self.timing.sample_time)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for w in WHEELSETS:
            self._drive(d, plant, motors, w, track)
        return d.spec()

    def _drive(self, d: Diagram, plant: Plant, motors: Motors, w: Wheelset, track: Track) -> None:
        """The torque for the moment of the feedforward, asked for as a speed difference."""
        forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
        arm = plant.radius / (2.0 * plant.geometry.half_tape_distance)
        wanted = d.sum(f"{w.name}.Td.wanted", {forward.moment: arm})
        torque = d.saturation(f"{w.name}.Td", wanted, -self.torque_max, self.torque_max)
        d.probe(f"{w.name}.torque_forward", "N m", torque)
        beside = {torque: self.pair.per_torque(d, plant, self.contact)}
        self.pair.drive(d, plant, self.contact, motors, w, track, self.timing, beside=beside)
