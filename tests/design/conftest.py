"""Loops that the tests of the design bench share: linear models of the full vehicle, made once."""

import pytest

import klingel as kl
from klingel.design import Loop, loops

STRATEGIES = {
    "S": kl.control.SolidLike(),
    "I gyro": kl.control.IRWLike(),
}
SPEED = 140.0 / 3.6


def scenario(name: str = "S", speed: float = SPEED) -> kl.Scenario:
    """The mechatronic vehicle on straight track."""
    vehicle = kl.library.vehicle("mechatronic_irw")
    return kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=speed, control=STRATEGIES[name])


@pytest.fixture(scope="session")
def opened() -> dict[str, dict[str, Loop]]:
    """Loops by strategy and name."""
    return {name: {loop.name: loop for loop in loops(scenario(name))} for name in STRATEGIES}
