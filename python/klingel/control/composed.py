"""The base of a strategy of your own that is made of standard blocks and compiled into the core.
What it needs is beside it: `Diagram`, the filters, the wheelsets, what they measure and how they are commanded."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from klingel.control.basics import Timing
from klingel.control.common import Plant
from klingel.control.diagram import Diagram

if TYPE_CHECKING:
    from klingel.track import Track
    from klingel.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True)
class Composed(ABC):
    """A strategy as its blocks: write `build`, give your parameters as fields.

    timing: sampling and delays. Inputs that no command drives keep their values of the operating point: motors their
    voltages, actuators no force.

    >>> import klingel as kl
    >>> from klingel.control import WHEELSETS, command_steering, speed_difference
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Proportional(Composed):
    ...     gain: float = 2e4   # [N m s/rad]
    ...     def build(self, d, plant, track, speed):
    ...         for w in WHEELSETS:
    ...             wd = speed_difference(d, w, self.timing)
    ...             command_steering(d, plant, w, d.sum(f"{w.name}.M", {wd: -self.gain}), self.timing)
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> len(Proportional(gain=1e4).lower(vehicle, kl.Track.straight("500 m"), 30.0)["commands"])
    8
    """

    timing: Timing = field(default_factory=Timing)

    @abstractmethod
    def build(self, d: Diagram, plant: Plant, track: Track, speed: float) -> None:
        """Adds measurements, blocks, commands and probes to an empty diagram.

        plant: numbers of the vehicle; track: what is known of it; speed: at the start [m/s].
        """

    def lower(self, vehicle: Vehicle, track: Track, speed: float) -> dict[str, Any]:
        """The block diagram for a vehicle; errors: InputError for one without drives or steering actuators."""
        d = Diagram(sample_time=self.timing.sample_time)
        self.build(d, Plant.of(vehicle), track, speed)
        return d.spec()
