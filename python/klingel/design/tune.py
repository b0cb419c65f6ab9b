"""Designs of single loops: the largest value of a strategy's parameter at which its loops keep wanted margins.
On the plants of the formulas or on the full vehicle; either way the result is looked at on the full vehicle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from klingel.control import IRWLike, SolidLike
from klingel.design.check import check
from klingel.design.designed import Basis, Design, robustness
from klingel.design.grid import LOWEST, whole
from klingel.design.limits import MOTORS, STEERING, Limits, missed
from klingel.design.loops import loops
from klingel.design.margins import Margins, Shown, margins, margins_of_all, of_response
from klingel.design.plants import plant_loop
from klingel.errors import InputError, SimulationError
from klingel.linear.parameters import get, replace
from klingel.linear.sweep import Sweep
from klingel.scenario import Scenario, Strategy
from klingel.track import Track
from klingel.units import Quantity, to_si
from klingel.vehicle import Vehicle

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

Kind = Literal["steering", "motors"]

SPAN = 8.0
"""Values looked at: from what the strategy has over this to what it has times this."""

SCAN = 13
"""Values of the first look, evenly over the logarithm."""

HALVINGS = 5
"""Of the last step, to a hundredth of the value."""

POINTS = 600
"""Frequencies of a plant's loop, evenly over the logarithm."""

HIGHEST = 0.4995
"""Highest of them, in sample rates."""

CONICITIES = (None, 0.05, 0.4)
FRICTIONS = (0.3,)
"""Of the check that every design makes by itself."""


def tune(
    scenario: Scenario,
    parameter: str,
    kind: Kind,
    wanted: Limits,
    *,
    speeds: Sequence[Quantity] | None = None,
    basis: Basis = "plant",
) -> Design:
    """The largest value of a parameter of a strategy at which one kind of its loops keeps wanted margins.

    scenario: with the strategy to begin from; parameter: its field, such as "coupling"; kind: of loop, steering or
    motors; wanted: least margins; speeds: at all of which they are kept, None for that of the scenario; basis: "plant"
    (formulas, one wheelset, the rest at rest) or "vehicle" (all loops of that kind on the full linear model).
    Values between an eighth and eight times the one that the strategy has are looked at. The result has been looked at
    on the full vehicle over speed, conicity, friction and the five curves; its `words()` say where it fails.
    Errors: InputError for an unknown parameter or loop.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed="140 km/h", control=kl.control.IRWLike())
    >>> found = tune(scenario, "current_frequency", "motors", Limits(gain=4.0))
    >>> found.met, 10.0 < found.value < 20.0
    (True, True)
    """
    fast = [scenario.speed] if speeds is None else [to_si(v, "m/s", key="speeds") for v in speeds]
    path = f"control.{parameter}"
    now = get(scenario, path)
    known: dict[float, tuple[Shown, ...]] = {}

    def keeps(value: float) -> bool:
        if value not in known:
            known[value] = _look(replace(scenario, path, value), fast, kind, basis)
        return not any(short for each in known[value] for short in missed(vars(each.margins), wanted))

    scan = [float(v) for v in now * np.geomspace(1.0 / SPAN, SPAN, SCAN)]
    kept = [value for value in scan if keeps(value)]
    if kept:
        value = _last(keeps, kept[-1], scan)
    else:
        value = max(scan, key=lambda v: min(robustness(each.margins) for each in known[v]))
    best = replace(scenario, path, value)
    assert best.control is not None
    table = margins(best, fast)
    return Design(
        parameter=parameter,
        value=value,
        strategy=best.control,
        basis=basis,
        met=bool(kept),
        wanted=wanted,
        shown=known[value],
        full=table[table["kind"] == kind].reset_index(drop=True),
        check=check(best, conicities=CONICITIES, frictions=FRICTIONS),
    )


def _last(keeps: Any, kept: float, scan: Sequence[float]) -> float:
    """Largest value that keeps them: between the last of the scan and the next one."""
    place = scan.index(kept)
    if place + 1 == len(scan):
        return kept
    beyond = scan[place + 1]
    for _ in range(HALVINGS):
        between = math.sqrt(kept * beyond)
        kept, beyond = (between, beyond) if keeps(between) else (kept, between)
    return kept


def _look(scenario: Scenario, speeds: Sequence[float], kind: Kind, basis: Basis) -> tuple[Shown, ...]:
    """The loop of a kind at each speed; on the vehicle the one with the least disk margin."""
    if basis == "plant":
        return tuple(_on_plant(scenario.replace(speed=speed), kind) for speed in speeds)
    sweep = Sweep()
    return tuple(_on_vehicle(sweep, scenario.replace(speed=speed), kind) for speed in speeds)


def _on_plant(scenario: Scenario, kind: Kind) -> Shown:
    response = plant_loop(scenario, kind)
    timing = getattr(scenario.control, "timing", None)
    rate = 1e3 if timing is None else 1.0 / timing.sample_time
    f = np.geomspace(LOWEST, HIGHEST * rate, POINTS)
    L = response(f)
    stable = encirclements(f, L) == 0
    found = of_response(response, f, L) if stable else Margins(stable=False)
    return Shown(f"{kind} on the plant", scenario.speed, f, L, found)


def encirclements(f: Real, L: Complex) -> int:
    """Poles of the closed loop that grow, by Nyquist's count, of a loop that alone has none that grow.

    f: frequencies [Hz] that show the loop whole; L: there. Integrators, told by the slope of |L| at the first two
    frequencies, turn 1 + L by a right angle each before those.

    >>> f = np.geomspace(1e-3, 1e3, 2000)
    >>> s = 2j * np.pi * f
    >>> [encirclements(f, L) for L in (4.0 / (s + 1.0) ** 3, 9.0 / (s + 1.0) ** 3, 1.0 / s, (s + 1.0) / s**2)]
    [0, 2, 0, 0]
    """
    turned = np.unwrap(np.angle(1.0 + L))
    slope = float(np.log(abs(L[0] / L[1])) / np.log(f[1] / f[0]))
    before = 0.5 * np.pi * (round(slope) if abs(L[0]) > 1.0 else 0)
    return round(-float(turned[-1] - turned[0] - before) / np.pi)


def _on_vehicle(sweep: Sweep, scenario: Scenario, kind: Kind) -> Shown:
    try:
        found = [loop for loop in loops(sweep(scenario).model) if loop.kind == kind]
    except SimulationError:
        nothing = np.zeros(0)
        return Shown("no steady state", scenario.speed, nothing, nothing.astype(complex), Margins(stable=False))
    if not found:
        remedy = f"{type(scenario.control).__name__} has other loops"
        raise InputError.single("kind", kind, "is no loop of this strategy", remedy=remedy)
    edges = margins_of_all(found)
    worst = min(range(len(found)), key=lambda i: robustness(edges[i]))
    f, S = whole(found[worst].closed)
    index = found[worst].index
    return Shown(found[worst].name, scenario.speed, f, 1.0 / S[:, index, index] - 1.0, edges[worst])


def _begin(vehicle: Vehicle, speeds: Sequence[Quantity], strategy: Strategy) -> Scenario:
    if not speeds:
        raise InputError.single("speeds", list(speeds), "are none", remedy="give at least one")
    return Scenario(vehicle, Track.straight("1 km"), speed=speeds[0], control=strategy)


def torque_loop(
    vehicle: Vehicle,
    speeds: Sequence[Quantity],
    *,
    strategy: IRWLike | None = None,
    wanted: Limits = MOTORS,
    basis: Basis = "plant",
) -> Design:
    """Differential torque loop of I: `current_frequency`, on plant (27) seen through the armature currents.

    vehicle: with DC motors; speeds: at all of which the margins are kept; strategy: to begin from; wanted, basis,
    result, errors: as `tune`.
    """
    return tune(
        _begin(vehicle, speeds, strategy or IRWLike()),
        "current_frequency",
        "motors",
        wanted,
        speeds=speeds,
        basis=basis,
    )


def speed_loop(
    vehicle: Vehicle,
    speeds: Sequence[Quantity],
    *,
    strategy: SolidLike | None = None,
    wanted: Limits = MOTORS,
    basis: Basis = "plant",
) -> Design:
    """Differential speed loop of S: `coupling`, on plant (29); arguments as `torque_loop`."""
    return tune(
        _begin(vehicle, speeds, strategy or SolidLike()), "coupling", "motors", wanted, speeds=speeds, basis=basis
    )


def yaw_moment_loop(
    vehicle: Vehicle,
    speeds: Sequence[Quantity],
    *,
    strategy: SolidLike | None = None,
    wanted: Limits = STEERING,
    basis: Basis = "plant",
) -> Design:
    """Yaw moment loop of S: `yaw_frequency`, on the actuators of an axle that the contact holds; as `torque_loop`."""
    return tune(
        _begin(vehicle, speeds, strategy or SolidLike()),
        "yaw_frequency",
        "steering",
        wanted,
        speeds=speeds,
        basis=basis,
    )


def steering_loop(
    vehicle: Vehicle,
    speeds: Sequence[Quantity],
    *,
    strategy: IRWLike | None = None,
    wanted: Limits = STEERING,
    basis: Basis = "plant",
) -> Design:
    """Steering loop of I: `frequency`, on a freely rolling axle on its primary springs; as `torque_loop`."""
    return tune(
        _begin(vehicle, speeds, strategy or IRWLike()), "frequency", "steering", wanted, speeds=speeds, basis=basis
    )
