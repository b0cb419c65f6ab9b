"""Scenarios: a vehicle on a track at a speed, with its controllers and the contact and run settings.
Made in Python or read from a TOML file; plain immutable data that `lower` turns into the spec of the core."""

from klingel.scenario.scenario import CreepLaw, Scenario, Strategy

__all__ = ["CreepLaw", "Scenario", "Strategy"]
