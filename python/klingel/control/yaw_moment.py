"""Actuated solid wheelsets free of yaw moment at low frequency: the springs stabilise, the actuators let them turn.
After Shen and Goodall (1997), as recalled; the loop of `SolidLike` with solid axles in place of motors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, check_positive
from klingel.control.common import (
    Plant,
    sense_inertia,
)
from klingel.control.diagram import Diagram
from klingel.control.feedforward import ContactDesign
from klingel.control.fit import misfits
from klingel.control.steering import steer_to_no_moment
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class YawMoment:
    """Integral control of the total yaw moment between wheelset and bogie to -H p, around the feedforward.

    yaw_frequency: crossover of the loop [Hz], below the hunting of 2 to 8 Hz, where the springs must stay stiff.
    yaw_speed: running speed below which the crossover falls with it [m/s].
    yaw_share: of the largest moment of the actuators that the feedback may use.
    sensor_frequency: low-pass of the inertial sensors [Hz]: what they tell of the hunting of the bogies, 2 Hz, comes
        back as a moment of the stiff springs; with 1.4 Hz it grows in an arc of 800 m.
    timing: sampling and delays. contact: what the design assumes of wheel and rail.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = YawMoment().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> len(spec["commands"])
    8
    """

    yaw_frequency: float = 0.7
    yaw_speed: float = 28.0
    yaw_share: float = 0.3
    sensor_frequency: float = 0.5
    timing: Timing = field(default_factory=Timing)
    contact: ContactDesign = field(default_factory=ContactDesign)

    def __post_init__(self) -> None:
        check_positive(self, ("yaw_frequency", "yaw_speed", "yaw_share", "sensor_frequency"))

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("wheelset", "steering"), take="mechatronic_solid")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle on a track whose curvature the database knows.

        Errors: InputError for a vehicle without steering actuators.
        """
        plant = Plant.of(vehicle)
        d = Diagram(sample_time=self.timing.sample_time)
        sense_inertia(d, plant, self.timing, frequency=self.sensor_frequency)
        for w in WHEELSETS:
            steer_to_no_moment(
                d,
                plant,
                self.contact,
                w,
                track,
                self.timing,
                frequency=self.yaw_frequency,
                slow_speed=self.yaw_speed,
                share=self.yaw_share,
            )
        return d.spec()
