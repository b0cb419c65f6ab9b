"""Steering by the track database alone: the moment that a curve needs is known, and nothing is measured but the place.
Solid wheelsets centre themselves around it; pairs of independently rotating wheels are coupled by their motors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing
from klingel.control.common import Plant
from klingel.control.coupling import WheelCoupling
from klingel.control.diagram import Diagram
from klingel.control.driven import motors_of
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.steering import database_feedforward, expect_inertia, steer
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Feedforward:
    """M = kpsi [+-a rho + alpha_Y - psi_b - h p/V] - H p, all of it from curvature and cant of the database.

    pair: the damper that the motors make between independently rotating wheels, which have no guidance of their own.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.
    traction: loop that drives and brakes the vehicle through the same motors.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = Feedforward().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> {channel.rsplit(".", 1)[1] for channel in spec["measurements"]} == {"s", "speed"}
    True
    """

    pair: WheelCoupling = field(default_factory=WheelCoupling)
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)
    traction: Traction | None = None

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
            forward = database_feedforward(d, plant, self.contact, w, track, self.timing)
            if motors is not None:
                self.pair.drive(d, plant, self.contact, motors, w, track, self.timing, beside={})
            steer(d, plant, w, {forward.moment: 1.0}, self.timing)
        return d.spec()
