"""Linear models of neighbouring scenarios for eigenvalues: an operating point is found from the one before.
Only the commands remain as inputs, as the loops close through them: a sampled plant costs less without the others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from klingel.linear.model import LinearModel
from klingel.linear.operating import solve, steady_spec
from klingel.linear.statespace import close, of_raw
from klingel.lower import Spec
from klingel.scenario import Scenario
from klingel.units import Quantity

if TYPE_CHECKING:
    from klingel._core import OperatingPoint


class Linearised(NamedTuple):
    """model: with its controllers closed where there are any; plant: continuous; spec: what both were made of."""

    model: LinearModel
    plant: LinearModel
    spec: Spec


class Sweep:
    """Linearises one scenario after the other, on the track at `at` (as for `klingel.linearise`).

    >>> import klingel as kl
    >>> coach = kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("1 km"), speed=40.0)
    >>> sweep = Sweep()
    >>> [sweep(coach.replace(speed=speed)).model.speed for speed in (40.0, 41.0)]
    [40.0, 41.0]
    """

    def __init__(self, *, at: Quantity | None = None, controllers: bool = True) -> None:
        self.at = at
        self.controllers = controllers
        self._near: OperatingPoint | None = None

    def __call__(self, scenario: Scenario) -> Linearised:
        """The models of a scenario; errors: SimulationError where there is no steady state, InputError."""
        spec = steady_spec(scenario, at=self.at)
        self._near = solve(spec, self._near)
        raw = self._near.linearise()
        plant = of_raw(raw, spec["name"], spec["speed"], controllers=False)
        control = raw["control"]
        if not self.controllers or control is None:
            return Linearised(plant.select(inputs=()), plant, spec)
        driven = [plant.inputs[i].name for i in control["driven"]]
        commanded = plant.select(inputs=driven)
        return Linearised(close(commanded, control | {"driven": list(range(len(driven)))}), plant, spec)
