"""How far loops are from instability: gain, phase, delay and disk margins, exact between the frequencies looked at.
Definitions and their derivation: docs/theory/design.md."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.design.grid import crossings, peak, whole
from klingel.design.loops import Loop, loops
from klingel.linear.steady import UNSTABLE
from klingel.linear.sweep import Sweep
from klingel.scenario import Scenario
from klingel.units import Quantity, to_si

if TYPE_CHECKING:
    import pandas as pd

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

NONE = 1e-3
"""Gains below this are none: a loop that may lose a thousandth may lose everything."""

FLAT = 1e-3
"""Part of L across the real axis up to which it lies on it, at the lowest frequency."""


@dataclass(frozen=True, kw_only=True)
class Margins:
    """How far a closed loop is from instability, each with the frequency [Hz] at which it would begin to swing.

    crossover: highest frequency where |L| = 1 [Hz]; gain: least factor above one at which the loop is at its edge;
    gain_down: largest factor below one (0: the loop may be cut); phase: least lag or lead to the edge [rad]; delay:
    least delay to it [s]; disk: symmetric disk margin alpha = 2/max |S - T|, gain and phase off together;
    sensitivity: largest |S| = 1/|1 + L|. What there is none of is infinite (gain_down: 0), its frequency NaN.
    stable: whether the closed loop is; else all figures are NaN, as it has no margins. growth: largest real part of
    the closed loop's eigenvalues [1/s].
    """

    stable: bool
    growth: float = math.nan
    crossover: float = math.nan
    gain: float = math.nan
    gain_frequency: float = math.nan
    gain_down: float = math.nan
    gain_down_frequency: float = math.nan
    phase: float = math.nan
    phase_frequency: float = math.nan
    delay: float = math.nan
    delay_frequency: float = math.nan
    disk: float = math.nan
    disk_frequency: float = math.nan
    sensitivity: float = math.nan
    sensitivity_frequency: float = math.nan

    @property
    def disk_gain(self) -> tuple[float, float]:
        """Gains that the disk margin bears, with no phase: from (2 - alpha)/(2 + alpha) to its inverse."""
        low = (2.0 - self.disk) / (2.0 + self.disk)
        return max(low, 0.0), math.inf if low <= 0.0 else 1.0 / low

    @property
    def disk_phase(self) -> float:
        """Phase that the disk margin bears, with no gain [rad]: 2 arctan(alpha/2)."""
        return 2.0 * math.atan(0.5 * self.disk)


@dataclass(frozen=True, eq=False)
class Shown:
    """A loop as figures draw it: name, speed [m/s], frequencies (f) [Hz], response L (f), margins."""

    name: str
    speed: float
    frequencies: Real
    response: Complex
    margins: Margins


def margins_of(loop: Loop) -> Margins:
    """Margins of one loop, all others closed.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed="176 km/h", control=kl.control.SolidLike())
    >>> found = margins_of(loops(scenario)[0])
    >>> found.stable, found.gain > 2.0
    (True, True)
    """
    return margins_of_all([loop])[0]


def margins_of_all(found: Iterable[Loop]) -> list[Margins]:
    """Margins of loops, those of one model together in one set of frequencies."""
    known: dict[int, tuple[Real, Complex]] = {}
    result = []
    for loop in found:
        closed = loop.closed
        if not closed.growth < UNSTABLE:
            result.append(Margins(stable=False, growth=closed.growth))
            continue
        if id(closed) not in known:
            known[id(closed)] = whole(closed)
        f, S = known[id(closed)]
        L = 1.0 / S[:, loop.index, loop.index] - 1.0
        result.append(of_response(loop.response, f, L, growth=closed.growth))
    return result


def of_response(response: Callable[[Real], Complex], f: Real, L: Complex, *, growth: float = math.nan) -> Margins:
    """Margins of a loop whose closed loop is stable; response: L at frequencies [Hz]; L: at f (f), which show it whole.

    >>> s = lambda f: 2j * np.pi * np.asarray(f)
    >>> third = lambda f: 4.0 / (s(f) + 1.0) ** 3
    >>> f = np.geomspace(1e-3, 10.0, 60)
    >>> found = of_response(third, f, third(f))
    >>> round(found.gain, 4), round(found.phase, 4), round(found.delay, 4)
    (2.0, 0.4737, 0.3843)
    """
    ones = crossings(lambda x: np.log(np.abs(response(x))), f, np.log(np.abs(L)))
    angles = np.angle(response(ones)) if len(ones) else np.zeros(0)
    phases, lags = np.abs(_wrapped(angles + np.pi)), np.mod(angles + np.pi, 2.0 * np.pi)
    opposite, factors = _opposite(response, f, L)
    up, down = factors > 1.0, (factors < 1.0) & (factors > NONE)
    disk, disk_frequency = peak(lambda x: _disk(response(x)), f, _disk(L))
    sensitivity, sensitivity_frequency = peak(lambda x: 1.0 / np.abs(1.0 + response(x)), f, 1.0 / np.abs(1.0 + L))
    gain, gain_frequency = _least(factors[up], opposite[up])
    inverse, gain_down_frequency = _least(1.0 / factors[down], opposite[down])
    phase, phase_frequency = _least(phases, ones)
    delay, delay_frequency = _least(lags / (2.0 * np.pi * ones), ones)
    return Margins(
        stable=True,
        growth=growth,
        crossover=float(ones.max(initial=-np.inf)) if len(ones) else math.nan,
        gain=gain,
        gain_frequency=gain_frequency,
        gain_down=1.0 / inverse,
        gain_down_frequency=gain_down_frequency,
        phase=phase,
        phase_frequency=phase_frequency,
        delay=delay,
        delay_frequency=delay_frequency,
        disk=2.0 / disk,
        disk_frequency=disk_frequency,
        sensitivity=sensitivity,
        sensitivity_frequency=sensitivity_frequency,
    )


def _opposite(response: Callable[[Real], Complex], f: Real, L: Complex) -> tuple[Real, Real]:
    """Frequencies [Hz] at which L is real and negative, both ends included, and the factors that make it -1 there."""
    found = crossings(lambda x: response(x).imag, f, L.imag)
    values = response(found) if len(found) else np.zeros(0, dtype=np.complex128)
    ends = [i for i in (0, -1) if abs(L[i].imag) < FLAT * abs(L[i])]
    places = np.concatenate((found, f[ends]))
    real = np.concatenate((values.real, L[ends].real))
    negative = real < 0.0
    return places[negative], -1.0 / real[negative]


def _disk(L: Complex) -> Real:
    """|S - T| of a loop."""
    return np.asarray(np.abs((1.0 - L) / (1.0 + L)))


def _wrapped(angle: Real) -> Real:
    """Between -pi and pi."""
    return np.asarray(np.mod(angle + np.pi, 2.0 * np.pi) - np.pi)


def _least(values: Real, places: Real) -> tuple[float, float]:
    if not len(values):
        return math.inf, math.nan
    i = int(np.argmin(values))
    return float(values[i]), float(places[i])


COLUMNS: Mapping[str, str] = {
    "crossover": "Hz",
    "gain": "1",
    "gain_down": "1",
    "phase": "rad",
    "delay": "s",
    "disk": "1",
    "sensitivity": "1",
    "stable": "",
    "growth": "1/s",
}
"""Figures of `margins`, and their units."""


def margins(
    scenario: Scenario, speeds: Iterable[Quantity] | None = None, *, at: Quantity | None = None
) -> pd.DataFrame:
    """Margins of every loop of a scenario's strategy on the full linear model, one row a loop and a speed.

    speeds: None for that of the scenario; at: place on its track [m] whose curve it runs through, None for straight
    level track. Columns: loop, kind, speed [m/s], then those of `COLUMNS` (fields of `Margins`). Errors: as
    `klingel.linearise`.

    >>> import klingel as kl
    >>> vehicle = kl.library.vehicle("mechatronic_irw")
    >>> scenario = kl.Scenario(vehicle, kl.Track.straight("1 km"), speed="176 km/h", control=kl.control.SolidLike())
    >>> table = margins(scenario)
    >>> sorted(set(table["kind"])), bool(table["stable"].all())
    (['motors', 'steering'], True)
    """
    import pandas as pd

    sweep = Sweep(at=at)
    rows = []
    for speed in [scenario.speed] if speeds is None else [to_si(v, "m/s", key="speeds") for v in speeds]:
        found = loops(sweep(scenario.replace(speed=speed)).model)
        rows += [row(loop, each) for loop, each in zip(found, margins_of_all(found), strict=True)]
    return pd.DataFrame(rows, columns=["loop", "kind", "speed", *COLUMNS])


def row(loop: Loop, found: Margins) -> dict[str, object]:
    """A line of the table."""
    head = {"loop": loop.name, "kind": loop.kind, "speed": loop.speed}
    return head | {name: getattr(found, name) for name in COLUMNS}
