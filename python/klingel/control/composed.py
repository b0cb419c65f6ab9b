"""The base of a strategy of your own that is made of standard blocks and compiled into the core.
What it needs is beside it: `Diagram`, the filters, the wheelsets, what they measure and how they are commanded."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from klingel.control.basics import Timing
from klingel.control.diagram import Diagram
from klingel.control.fit import Table, misfits
from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True)
class Composed(ABC):
    """A strategy as its blocks: write `build`, give your parameters as fields.

    timing: sampling and delays; needs: tables that a vehicle must have. Inputs that no command drives keep their values
    of the operating point: motors their voltages, actuators no force.

    >>> import klingel as kl
    >>> from klingel.control import WHEELSETS, Plant, command_steering, speed_difference
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Proportional(Composed):
    ...     gain: float = 2e4   # [N m s/rad]
    ...     def build(self, d, vehicle, track, speed):
    ...         for w in WHEELSETS:
    ...             wd = speed_difference(d, w, self.timing)
    ...             moment = d.sum(f"{w.name}.M", {wd: -self.gain})
    ...             command_steering(d, Plant.of(vehicle), w, moment, self.timing)
    >>> vehicle = kl.library.vehicle("trailed_irw")
    >>> len(Proportional(gain=1e4).lower(vehicle, kl.Track.straight("500 m"), 30.0)["commands"])
    8
    """

    needs: ClassVar[tuple[Table, ...]] = ("steering",)
    timing: Timing = field(default_factory=Timing)

    @abstractmethod
    def build(self, d: Diagram, vehicle: Vehicle, track: Track, speed: float) -> None:
        """Adds measurements, blocks, commands and probes to an empty diagram.

        track: what is known of it; speed: at the start [m/s]. `Plant.of(vehicle)` has what designs mostly want.
        """

    def problems(self, vehicle: Vehicle) -> Iterator[Problem]:
        """Why it does not fit a vehicle."""
        return misfits(self, vehicle, needs=self.needs, take="mechatronic_irw")

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle at a speed [m/s]."""
        d = Diagram(sample_time=self.timing.sample_time)
        self.build(d, vehicle, track, speed)
        return d.spec()
