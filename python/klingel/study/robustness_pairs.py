"""Pairs of wheel and rail profiles that give conicities from 0.05 to 0.4: coned, new and worn wheels, rails, gauges.
A study of robustness draws from this list, as a vehicle meets pairs and not numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from klingel.contact import Profile, WheelRailPair, profile_of
from klingel.scenario import Scenario

AMPLITUDE = 3e-3
"""Of the lateral motion that the equivalent conicity belongs to [m] (EN 15302)."""

WORN_MIDDLE, WORN_HALF_WIDTH = 5e-3, 35e-3
"""Where the tread of a worn wheel is deepest, outside the tape circle, and how far wear reaches [m]."""


@lru_cache(maxsize=16)
def worn(depth: float) -> Profile:
    """S1002 with a hollow tread, deepest by `depth` [m] 5 mm outside the tape circle, fading out 35 mm beside it.

    A raised cosine: smooth, flange and field side as new. This project's own construction of what measured worn wheels
    look like; it is there for its conicity, which grows with the depth.

    >>> round(float(worn(1e-3).depth(5e-3) - Profile.s1002().depth(5e-3)), 6)
    -0.001
    """
    new = Profile.s1002()
    across = np.clip((new.y - WORN_MIDDLE) / WORN_HALF_WIDTH, -1.0, 1.0)
    return Profile(f"S1002 worn {1e3 * depth:g} mm", new.y, new.z - 0.5 * depth * (1.0 + np.cos(np.pi * across)))


@dataclass(frozen=True)
class ProfilePair:
    """Wheels of one profile on rails at an inclination (slope) and a gauge [m]; wear: depth of the hollow tread [m]."""

    wheel: str = "S1002"
    rail: str = "60E1"
    rail_inclination: float = 1 / 40
    gauge: float = 1.435
    wear: float = 0.0

    @property
    def name(self) -> str:
        """As tables have it.

        >>> ProfilePair(wear=0.3e-3).name
        'S1002 worn 0.3 mm on 60E1 1:40, 1435 mm'
        """
        return f"{self.profile.name} on {self.rail} 1:{1 / self.rail_inclination:g}, {1e3 * self.gauge:g} mm"

    @property
    def profile(self) -> Profile:
        """Of the wheels."""
        return worn(self.wear) if self.wear else profile_of(self.wheel, "wheel")

    def under(self, scenario: Scenario) -> Scenario:
        """The scenario with these wheels and rails."""
        return scenario.replace(
            wheel=self.profile, rail=self.rail, rail_inclination=self.rail_inclination, gauge=self.gauge
        )


PAIRS = (
    ProfilePair(wheel="cone 1:20"),
    ProfilePair(wheel="cone 1:10"),
    ProfilePair(gauge=1.437),
    ProfilePair(),
    ProfilePair(rail="54E1"),
    ProfilePair(wear=0.3e-3),
    ProfilePair(wear=0.45e-3),
    ProfilePair(wear=0.6e-3),
    ProfilePair(wear=0.8e-3),
    ProfilePair(wear=1.0e-3),
)
"""By rising conicity. Gauges stay within 2 mm of 1435 mm, so that wheelsets reach the flange root at much the same
place: S1002 also has 0.06 at 1440 mm and 0.42 at 1430 mm. At 1:20 its conicity is 0.01."""


def conicity_of(scenario: Scenario) -> float:
    """Equivalent conicity of a scenario's wheels on its rails at 3 mm, rigid (EN 15302).

    >>> from klingel import Track, library
    >>> round(conicity_of(Scenario(library.vehicle("manchester_coach"), Track.straight("500 m"), speed=30.0)), 3)
    0.175
    """
    vehicle = scenario.vehicle
    rail = profile_of(scenario.rail, "rail") if isinstance(scenario.rail, str) else scenario.rail
    pair = WheelRailPair(
        scenario.wheel or profile_of(vehicle.wheel_profile.name, "wheel"),
        rail,
        rail_inclination=scenario.rail_inclination,
        gauge=scenario.gauge,
        flange_back=vehicle.wheel_profile.flange_back_distance,
        radius=vehicle.geometry.wheel_radius,
        normal=scenario.contact,
    )
    return pair.equivalent_conicity(AMPLITUDE)


def with_conicity(scenario: Scenario, conicity: float) -> Scenario:
    """The scenario under the listed pair whose conicity is nearest to the wanted one."""
    return nearest_pair(scenario, conicity).under(scenario)


def nearest_pair(scenario: Scenario, conicity: float) -> ProfilePair:
    """The listed pair whose conicity under the scenario's vehicle is nearest to the wanted one."""
    found = conicities(scenario)
    return min(PAIRS, key=lambda pair: abs(found[pair] - conicity))


_FOUND: dict[tuple[float, float, str], dict[ProfilePair, float]] = {}


def conicities(scenario: Scenario) -> dict[ProfilePair, float]:
    """Conicity of every listed pair under the scenario's vehicle; measured once for the same wheels."""
    vehicle = scenario.vehicle
    key = (vehicle.wheel_profile.flange_back_distance, vehicle.geometry.wheel_radius, scenario.contact)
    if key not in _FOUND:
        _FOUND[key] = {pair: conicity_of(pair.under(scenario)) for pair in PAIRS}
    return _FOUND[key]
