"""No control: actuators without force, motors at their operating point; also the fall-back after a failure.
A vehicle with solid wheelsets has nothing to control."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class Passive:
    """Leaves the vehicle to itself.

    >>> from klingel import library
    >>> Passive().lower(library.vehicle("manchester_coach"), None, 30.0) is None
    True
    """

    def lower(self, vehicle: Vehicle, track: Track | None, speed: float) -> dict[str, Any] | None:
        """No controller."""
        return None
