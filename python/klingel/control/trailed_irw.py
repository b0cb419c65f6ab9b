"""Trailed independently rotating wheels: no motors, the actuators steer on the measured speed difference.
Section 2.2 of Perez et al. (2004): what `IRWLike` should come to, as its motors give equal torques."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from klingel.control.common import Plant
from klingel.control.fit import misfits
from klingel.control.irw_like import IRWLike
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class TrailedIRW(IRWLike):
    """The steering of `IRWLike` on a vehicle without motors; the same parameters, but for those of its motors.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = TrailedIRW().lower(library.vehicle("trailed_irw"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    8
    """

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge", "steering"), without=("drive",), take="trailed_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s]; the track is used by the database variant only.

        Errors: InputError for a vehicle without steering actuators.
        """
        return self.diagram(Plant.of(vehicle), None, track)
