"""Which strategy fits which vehicle: what it must have, and what it must not.
A scenario asks its strategy before the run; the messages name the table of the vehicle's file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal

from klingel.errors import Problem

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle

Table = Literal["wheelset", "axle_bridge", "drive", "steering", "secondary_steering", "yaw_damper"]

WORDS: dict[Table, str] = {
    "wheelset": "solid wheelsets",
    "axle_bridge": "independently rotating wheels",
    "drive": "a motor for every wheel",
    "steering": "steering actuators at the wheelsets",
    "secondary_steering": "yaw actuators between body and bogies",
    "yaw_damper": "yaw dampers",
}


def misfits(
    strategy: object, vehicle: Vehicle, *, needs: tuple[Table, ...], without: tuple[Table, ...] = (), take: str
) -> Iterator[Problem]:
    """Why a strategy does not fit a vehicle; nothing where it does. take: a vehicle of the library that it fits.

    >>> from klingel import library
    >>> from klingel.control import SolidLike
    >>> for problem in SolidLike().problems(library.vehicle("trailed_irw")):
    ...     print(problem)
    control = 'SolidLike': needs a motor for every wheel ([drive]), which trailed_irw lacks; take mechatronic_irw
    """
    lacking = [f"{WORDS[table]} ([{table}])" for table in needs if getattr(vehicle, table) is None]
    surplus = [f"{WORDS[table]} ([{table}])" for table in without if getattr(vehicle, table) is not None]
    messages = [f"needs {', '.join(lacking)}, which {vehicle.name} lacks"] if lacking else []
    messages += [f"is made for vehicles without {', '.join(surplus)}, which {vehicle.name} has"] if surplus else []
    if messages:
        yield Problem("control", type(strategy).__name__, " and ".join(messages), f"take {take}")
