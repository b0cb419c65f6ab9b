"""Steering by the track database alone: the moment that a curve needs is known, and nothing is measured but the place.
Solid wheelsets centre themselves around it; pairs of independently rotating wheels are coupled by their motors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS
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
    parameters.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = Feedforward().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> {channel.rsplit(".", 1)[1] for channel in spec["measurements"]} == {"s", "speed"}
    True
    """

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
        for w in WHEELSETS:
            if motors is not None:
                self._speed_loop(d, plant, motors, w, track)
            forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
            steer(d, plant, w, {forward.moment: 1.0}, self.timing)
        return d.spec()
