"""No control of independently rotating wheels: nothing steers, and the two wheels of a pair are not coupled.
What a pair does without any guidance: it runs to the flange."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, check_positive
from klingel.control.diagram import Diagram
from klingel.control.driven import motors_of
from klingel.control.fit import misfits
from klingel.control.motors import command_motors
from klingel.control.traction import Traction
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class PassiveIRW:
    """Actuators without force, equal torques for both wheels of a pair.

    Motors at a held voltage would be a damper between the wheels and so guide them a little. So the difference of the
    torques is held at nil, as in `IRWLike`; a vehicle without motors has nothing to control.

    current_frequency: crossover of the differential current loop of DC motors [Hz], as `IRWLike` has it.
    timing: sampling and delays. traction: loop that drives and brakes through the same motors.

    >>> from klingel import library
    >>> PassiveIRW().lower(library.vehicle("trailed_irw"), None, 30.0) is None
    True
    >>> len(PassiveIRW().lower(library.vehicle("mechatronic_irw"), None, 30.0)["commands"])
    8
    """

    current_frequency: float = 5.0
    timing: Timing = field(default_factory=Timing)
    traction: Traction | None = None

    def __post_init__(self) -> None:
        check_positive(self, ("current_frequency",))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("axle_bridge",), take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track | None, speed: float) -> dict[str, Any] | None:
        """The block diagram for a vehicle at a speed [m/s]; None for one without motors."""
        if vehicle.drive is None:
            return None
        motors = motors_of(vehicle, self.traction, self.timing, speed)
        d = Diagram(sample_time=self.timing.sample_time)
        for w in WHEELSETS:
            command_motors(d, motors, w.name, motors.equal_torques(d, w.name, frequency=self.current_frequency))
        return d.spec()
