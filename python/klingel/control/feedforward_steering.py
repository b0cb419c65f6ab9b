"""Steering by the track database alone: the moment that a curve needs is known, and nothing is measured but the place.
Solid wheelsets centre themselves around it; pairs of independently rotating wheels are coupled by their motors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, check_unused
from klingel.control.common import Plant
from klingel.control.diagram import Diagram
from klingel.control.driven import motors_of
from klingel.control.fit import misfits
from klingel.control.solid_like import SolidLike
from klingel.control.steering import database_feedforward, expect_inertia, steer
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Feedforward(SolidLike):
    """M = kpsi [+-a rho + alpha_Y - psi_b - h p/V] - H p, all of it from curvature and cant of the database.

    Independently rotating wheels have no guidance of their own: their motors couple them as in `SolidLike`, with its
    parameters, but those of the yaw-moment loop and of the inertial sensors.

    common_share: all of the damping where both wheelsets of a bogie err alike, as nothing else centres the bogie;
        `coupling` and `coupling_speed` are so much lower.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = Feedforward().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> {channel.rsplit(".", 1)[1] for channel in spec["measurements"]} == {"s", "speed"}
    True
    """

    coupling: float = 0.25
    coupling_speed: float = 36.0
    common_share: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        check_unused(self, ("yaw_frequency", "yaw_speed", "yaw_share", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        if vehicle.independent_wheels:
            return misfits(self, vehicle, needs=("steering", "drive"), take="mechatronic_irw")
        return misfits(self, vehicle, needs=("steering",), take="mechatronic_solid")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s] on a track that the database knows.

        Errors: InputError for a vehicle without steering actuators, or with independent wheels and no drives.
        """
        plant = Plant.of(vehicle)
        d = Diagram(sample_time=self.timing.sample_time)
        expect_inertia(d, plant, track)
        motors = motors_of(vehicle, self.traction, self.timing, speed) if vehicle.independent_wheels else None
        if motors is not None:
            for w in WHEELSETS:
                self._speed_error(d, plant, w, track)
        for w in WHEELSETS:
            if motors is not None:
                self._speed_loop(d, plant, motors, w)
            forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
            steer(d, plant, w, {forward.moment: 1.0}, self.timing)
        return d.spec()
