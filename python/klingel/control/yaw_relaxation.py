"""Actuated solid wheelsets whose yaw springs go soft at low frequency and stay stiff where wheelsets hunt.
Active yaw relaxation after Shen and Goodall (1997), as recalled; it needs nothing but the strokes of the actuators."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import WHEELSETS, Timing, check_positive
from klingel.control.common import Plant
from klingel.control.diagram import Diagram
from klingel.control.discrete import low_pass
from klingel.control.fit import misfits
from klingel.control.steering import relative_yaw, steer
from klingel.errors import InputError, Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True)
class YawRelaxation:
    """M = k kpsi LP(psi), psi the yaw of the wheelset against its bogie: the springs are 1 - k as stiff in a curve.

    relaxation: k, below 1, as the actuators would else steer away from the track by themselves.
    frequency: corner of the low-pass [Hz], a fifth of the slowest hunting: what it lags there would take damping away.
    timing: sampling and delays.

    >>> from klingel import library
    >>> from klingel.track import Track
    >>> spec = YawRelaxation().lower(library.vehicle("mechatronic_solid"), Track.straight("500 m"), 30.0)
    >>> spec["measurements"][:2]
    ['bogie1.wheelset1.actuator_left.stroke', 'bogie1.wheelset1.actuator_right.stroke']
    """

    relaxation: float = 0.95
    frequency: float = 0.5
    timing: Timing = field(default_factory=Timing)

    def __post_init__(self) -> None:
        check_positive(self, ("relaxation", "frequency"))
        if self.relaxation > 1.0:
            remedy = "give a share of the yaw stiffness, 0 to 1"
            raise InputError.single("control.relaxation", self.relaxation, "is more than the springs", remedy=remedy)

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=("wheelset", "steering"), take="mechatronic_solid")

    def lower(self, vehicle: Vehicle, track: Track | None, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle.

        Errors: InputError for a vehicle without steering actuators.
        """
        plant = Plant.of(vehicle)
        d = Diagram(sample_time=self.timing.sample_time)
        section = low_pass(self.frequency, sample_time=self.timing.sample_time)
        for w in WHEELSETS:
            yaw = relative_yaw(d, f"{w.name}.actuator", plant.actuators, self.timing)
            slow = d.filter(f"{w.name}.actuator.yaw.slow", yaw, [section])
            steer(d, plant, w, {slow: self.relaxation * plant.geometry.yaw_stiffness}, self.timing)
        return d.spec()
