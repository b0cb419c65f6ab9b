"""Driven independently rotating wheels guided by the difference of their torques alone; nothing else steers.
The yaw moment is made by creep forces along the rails, within what adhesion and motors give."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.control.basics import SPEED, WHEELSETS, Wheelset, check_positive, scheduled
from klingel.control.common import Plant, database_curvature, sense_inertia, speed_difference
from klingel.control.diagram import Diagram
from klingel.control.discrete import lead, notch
from klingel.control.driven import motors_of
from klingel.control.fit import misfits
from klingel.control.motors import Motors, command_motors
from klingel.control.solid_like import SolidLike
from klingel.control.steering import database_feedforward
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class TorqueVectoring(SolidLike):
    """Td = c (lambda V rho/r0 - wd) + (1 + c V/(f11 r0^2)) r0/(2 lambda) M, M the moment that steering would need.

    The first part is the damper between the wheels of `SolidLike`, with its parameters; the second makes the moment of
    the feedforward by creep forces in place of actuators. Those it has are left without force.

    torque_max: largest torque of a wheel that the feedforward asks for [N m]; 1.6 times the rated one of the library's
        DC motors, for the seconds of a curve.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = TorqueVectoring().lower(library.vehicle("mechatronic_irw"), Track.straight("500 m"), 30.0)
    >>> {command["target"].rsplit(".", 1)[1] for command in spec["commands"]}
    {'armature_voltage'}
    """

    torque_max: float = 4000.0

    def __post_init__(self) -> None:
        super().__post_init__()
        check_positive(self, ("torque_max",))

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
            self._loop(d, plant, motors, w, track)
        return d.spec()

    def _loop(self, d: Diagram, plant: Plant, motors: Motors, w: Wheelset, track: Track) -> None:
        """u = K(s) (lambda V rho/r0 + Td/c + Td V/(f11 r0^2) - wd), with the back-EMF of the speed difference."""
        ts = self.timing.sample_time
        forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
        wanted = d.sum(
            f"{w.name}.Td.wanted", {forward.moment: plant.radius / (2.0 * plant.geometry.half_tape_distance)}
        )
        torque = d.saturation(f"{w.name}.Td.forward", wanted, -self.torque_max, self.torque_max)
        d.probe(f"{w.name}.torque_forward", "N m", torque)
        rolling = self.contact.longitudinal_creep * plant.radius**2
        per_torque = scheduled(d, "speed_loop.per_torque", lambda v: 1.0 / self._damping(plant, v) + v / rolling)
        rho = database_curvature(d, f"{w.name}.rho.here", track, d.measure(f"{w.name}.s"))
        turn = d.product(f"{w.name}.turn", rho, d.measure(SPEED))
        measured = speed_difference(d, w, self.timing)
        error = d.sum(f"{w.name}.wd.error", {turn: plant.speed_ratio, torque: per_torque, measured: -1.0})
        shape = [notch(self.notch_frequency, depth=self.notch_depth, width=self.notch_width, sample_time=ts)]
        if motors.lag > 0.0:
            shape.insert(0, lead(motors.lag, self.lead_pole, sample_time=ts))
        shaped = d.filter(f"{w.name}.wd.shaped", error, shape)
        gain = motors.gain(d, w.name, lambda v: self._damping(plant, v))
        back_emf = motors.per_speed(d, w.name, plant.speed_ratio)
        command_motors(d, motors, w.name, d.sum(f"{w.name}.u", {shaped: gain, turn: back_emf}))
