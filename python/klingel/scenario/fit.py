"""Whether something is a strategy at all, and why a strategy does not fit a vehicle.
A user's own class may do anything when it is asked; what it raises is one reason more."""

from __future__ import annotations

from typing import Any

from klingel.errors import InputError, Problem
from klingel.vehicle import Vehicle


def no_strategy(given: object) -> Problem | None:
    """Why something is no strategy: a class, a text, what has no `lower`; None for one, and for no control.

    >>> no_strategy(None)
    >>> print(no_strategy("irw_like"))
    control = 'irw_like': is a text, no strategy; give an object such as klingel.control.IRWLike()
    """
    if given is None:
        return None
    if isinstance(given, type):
        return Problem("control", given.__name__, "is a class, no strategy", f"make one of it: {given.__name__}()")
    if isinstance(given, str):
        return Problem("control", given, "is a text, no strategy", "give an object such as klingel.control.IRWLike()")
    if not callable(getattr(given, "lower", None)):
        return Problem("control", given, "is no strategy", "give it a method lower(vehicle, track, speed)")
    return None


def misfits(strategy: Any, vehicle: Vehicle) -> list[Problem]:
    """What a strategy has against a vehicle, by its `problems(vehicle)`; nothing of one that has none, and of None.

    >>> class Broken:
    ...     def problems(self, vehicle): raise KeyError("mass")
    >>> print(misfits(Broken(), None)[0])
    control = 'Broken': fails when asked whether it fits: KeyError: 'mass'; mend its method problems(vehicle)
    """
    ask = getattr(strategy, "problems", None)
    if ask is None:
        return []
    name = type(strategy).__name__
    try:
        return [p if isinstance(p, Problem) else Problem("control", name, str(p)) for p in ask(vehicle)]
    except InputError as error:
        return list(error.problems)
    except Exception as error:  # whatever a user's class does
        message = f"fails when asked whether it fits: {type(error).__name__}: {error}"
        return [Problem("control", name, message, "mend its method problems(vehicle)")]
