"""Nonlinear critical speed: the lowest speed at which a hunting vehicle does not come to rest by itself.
A run that slows down from full hunting shows the limit cycle over speed; runs that keep a speed confirm its end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from klingel.errors import InputError, SimulationError
from klingel.linear.critical import LOWEST, CriticalSpeed, critical_speed
from klingel.lower import Spec, lower
from klingel.result import COMPLETED, simulate_spec
from klingel.scenario import Scenario
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

Values = NDArray[np.float64]

RECORD = 5e-3
"""Interval of the recorded samples [s]: hunting stays below 20 Hz."""

WINDOW = 1.0
"""Amplitudes are half the travel within this time [s]."""

AT_REST = 0.1e-3
"""Amplitude below which a wheelset no longer hunts [m]."""

KICK = 0.2
"""Every run starts with the whole vehicle moving to the right [m/s], into the flanges."""

ENTERS = 4.0
"""Time that hunting has to build up before a run slows down to its speed [s]."""

SLOWS = 1.0
"""Deceleration to that speed [m/s2]."""

SETTLES = 15.0
"""Time at that speed [s]."""

FIRMER = 5.0
"""How many times faster the speed is held than in other runs: 0.5 Hz, so that the speeds are those asked for."""


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """How far a vehicle hunts over its speed.

    linear: the linear critical speed; speeds (n) [m/s], amplitudes (n) [m]: largest lateral amplitude of a wheelset in
    the course of the run that slows down; held: speeds of the runs that then keep their speed [m/s] and the amplitudes
    that they end with [m], zero for those that come to rest; speed: nonlinear critical speed [m/s], the lowest at which
    hunting goes on for ever, None if it does at none; resolution: of that speed [m/s].
    """

    linear: CriticalSpeed
    speeds: Values
    amplitudes: Values
    held: tuple[tuple[float, float], ...]
    speed: float | None
    resolution: float

    def table(self) -> pd.DataFrame:
        """The runs at constant speed as rows: speed [m/s], amplitude at the end [m], whether it hunts for ever."""
        import pandas as pd

        rows = [{"speed": speed, "amplitude": a, "hunts": a > 0.0} for speed, a in sorted(self.held)]
        return pd.DataFrame(rows, columns=["speed", "amplitude", "hunts"])


def bifurcation(
    scenario: Scenario,
    *,
    begin: Quantity | None = None,
    lowest: Quantity = LOWEST,
    deceleration: Quantity = "0.5 m/s^2",
    resolution: Quantity = "0.5 m/s",
    linear: CriticalSpeed | None = None,
    step: Callable[[str], None] | None = None,
) -> Bifurcation:
    """Limit cycles over speed on straight track.

    begin: where the run that slows down begins, a tenth above the linear critical speed by default; lowest: where it
    may end, as for `critical_speed`; deceleration: of that run; resolution: of the nonlinear critical speed; linear:
    the linear one if it is known; step: told what is done next. Errors: InputError for a range that is none, and for a
    vehicle without a linear critical speed when `begin` is not given; SimulationError for a run that ends early, such
    as by derailing.
    """
    said = step if step is not None else _silent
    end = to_si(lowest, "m/s", key="lowest")
    rate = to_si(deceleration, "m/s^2", key="deceleration")
    fine = to_si(resolution, "m/s", key="resolution")
    if linear is None:
        said("linear critical speed")
        linear = critical_speed(scenario, lowest=end, highest=120.0)
    first = _begin(linear, begin, end)
    if not (rate > 0.0 and fine > 0.0):
        raise InputError.single("deceleration", deceleration, "must be positive, as the resolution", remedy="give 0.5")
    said(f"a run that slows down from {first:.1f} m/s")
    speeds, amplitudes = envelope(run_at(scenario, first, duration=(first - end) / rate, acceleration=-rate))
    held: list[tuple[float, float]] = []

    def hunts(speed: float) -> bool:
        said(f"a run at {speed:.1f} m/s")
        held.append((speed, sustained(run_down(scenario, first, speed))))
        return held[-1][1] > 0.0

    edge = _lowest_cycle(hunts, _dies(speeds, amplitudes), first, end, fine)
    return Bifurcation(linear, speeds, amplitudes, tuple(sorted(held)), edge, fine)


def run_at(
    scenario: Scenario, speed: float, *, duration: float, acceleration: float = 0.0, kick: float = KICK
) -> xr.Dataset:
    """A run on endless straight track from a kick to the right [m/s]; errors: SimulationError if it ends early."""
    spec = _spec(scenario, speed, duration, kick)
    spec["hold"]["acceleration"] = acceleration
    return _completed(spec)


def run_down(scenario: Scenario, begin: float, speed: float) -> xr.Dataset:
    """The last seconds of a run that starts hunting at `begin` and is slowed down to a speed, which it then keeps.

    So it starts in the limit cycle, if there is one: a kick at that speed may be too small for it, or too large.
    """
    slowing = ENTERS + (begin - speed) / SLOWS
    spec = _spec(scenario, begin, slowing + SETTLES, KICK)
    interval = round(0.1 / scenario.step) * scenario.step
    t = interval * np.arange(math.ceil(spec["run"]["duration"] / interval) + 1)
    values = np.clip(SLOWS * (ENTERS - t), speed - begin, 0.0)
    spec["run"]["excitations"] = [{"input": "hold.speed", "interval": interval, "values": values.tolist()}]
    run = _completed(spec)
    return run.isel(time=slice(round(slowing / RECORD), None))


def _spec(scenario: Scenario, speed: float, duration: float, kick: float) -> Spec:
    """On endless straight track, the speed held firmly, all bodies kicked to the right."""
    spec = straight(lower(scenario.replace(speed=speed)))
    hold = spec["hold"]
    hold |= {"proportional": FIRMER * hold["proportional"], "integral": FIRMER**2 * hold["integral"]}
    spec["run"] |= {
        "duration": math.ceil(duration / RECORD) * RECORD,
        "record_interval": RECORD,
        "kicks": [{"body": body["name"], "velocity": [0.0, kick, 0.0]} for body in spec["bodies"]],
    }
    return spec


def _completed(spec: Spec) -> xr.Dataset:
    result = simulate_spec(spec)
    if result.attrs["outcome"] != COMPLETED:
        raise SimulationError(f"{spec['name']} from {spec['speed']:.1f} m/s: {result.attrs['outcome']}; begin slower")
    return result


def straight(spec: Spec) -> Spec:
    """The same spec on endless straight level track."""
    track = {"segments": [], "uniform": {"curvature": 0.0, "cant": 0.0}}
    return spec | {"track": spec["track"] | track, "run": dict(spec["run"])}


def envelope(run: xr.Dataset) -> tuple[Values, Values]:
    """Mean speed [m/s] of every window of a run and the largest lateral amplitude of a wheelset in it [m]."""
    y = _wheelsets(run)
    each = round(WINDOW / RECORD)
    count = y.shape[1] // each
    pieces = y[:, : count * each].reshape(len(y), count, each)
    amplitude = 0.5 * (pieces.max(axis=2) - pieces.min(axis=2)).max(axis=0)
    speed = run["body.speed"].to_numpy()[: count * each].reshape(count, each).mean(axis=1)
    return speed, amplitude


def sustained(run: xr.Dataset) -> float:
    """Amplitude of the limit cycle that a run at constant speed ends in [m]; zero if it comes to rest.

    It does so if the amplitude is below 0.1 mm at the end, or falls by more than a tenth over the last third.
    """
    amplitudes = envelope(run)[1]
    third = max(len(amplitudes) // 3, 2)
    now = float(np.mean(amplitudes[-2:]))
    before = float(np.mean(amplitudes[-third:][:2]))
    return now if now > AT_REST and now > 0.9 * before else 0.0


def _wheelsets(run: xr.Dataset) -> Values:
    """Lateral displacement of every body that has wheels [m] (bodies, samples)."""
    wheels = {str(name).removesuffix(".Q").rpartition(".")[0] for name in run.data_vars if str(name).endswith(".Q")}
    return np.array([run[f"{body}.y"].to_numpy() for body in sorted(wheels)])


def _begin(linear: CriticalSpeed, begin: Quantity | None, end: float) -> float:
    if begin is not None:
        first = to_si(begin, "m/s", key="begin")
    elif linear.speed is not None:
        first = 1.1 * linear.speed
    else:
        remedy = "give the speed that the slowing run begins at"
        raise InputError.single("begin", None, f"has no default: the vehicle is {linear.outcome}", remedy=remedy)
    if not first > end > 0.0:
        raise InputError.single(
            "begin", first, f"must exceed the lowest speed {end:g} m/s", remedy="begin faster, or lower the lowest"
        )
    return first


def _dies(speeds: Values, amplitudes: Values) -> float:
    """Speed at which the run that slows down has lost half of its amplitude; its last one if it never does."""
    alive = np.flatnonzero(amplitudes > 0.5 * amplitudes.max())
    return float(speeds[alive[-1]])


def _lowest_cycle(
    hunts: Callable[[float], bool], dies: float, begin: float, end: float, resolution: float
) -> float | None:
    """The lowest speed with a limit cycle, by bisection around where the slowing run died."""
    low, high = dies, None
    if hunts(low):
        low, high = end, low
        if hunts(low):
            return low
    else:
        reach = resolution
        while high is None:
            trial = min(low + reach, begin)
            if hunts(trial):
                high = trial
            elif trial == begin:
                return None
            else:
                low, reach = trial, 2.0 * reach
    while high - low > resolution:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if hunts(middle) else (middle, high)
    return high


def _silent(_: Any) -> None:
    pass
