"""Track irregularity: spectra over the wavenumber, and courses of track drawn from them.
Four kinds, taken as independent: vertical, alignment (means of both rails), crosslevel, gauge (right minus left)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.errors import InputError
from klingel.records import Status
from klingel.track import CANT_BASE
from klingel.units import Quantity, to_si

Array = NDArray[np.float64]

Kind = Literal["vertical", "alignment", "crosslevel", "gauge"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""vertical: mean of both rails, down; alignment: mean, to the right; crosslevel: how much lower the right rail is, over
the cant base; gauge: how much wider than nominal."""

RAILS: Mapping[Kind, Mapping[str, tuple[float, float]]] = MappingProxyType(
    {
        "vertical": {"rail_z": (1.0, 1.0), "rail_z_rate": (1.0, 1.0)},
        "alignment": {"rail_y": (1.0, 1.0), "rail_y_rate": (1.0, 1.0)},
        "crosslevel": {
            "rail_z": (-0.5, 0.5),
            "rail_z_rate": (-0.5, 0.5),
            "rail_roll": (1.0 / CANT_BASE, 1.0 / CANT_BASE),
        },
        "gauge": {"rail_y": (-0.5, 0.5), "rail_y_rate": (-0.5, 0.5)},
    }
)
"""What one metre of a kind does to the left and to the right rail, by the name of the core's input; of a rate, what one
metre a second does. Crosslevel rolls the rails too, with the sleepers."""

EDGE = 1e-9
"""Relative width of the ends of a valid range, for rounding."""


def _within(wavenumber: Array, wavelengths: tuple[float, float]) -> NDArray[np.bool_]:
    """Which wavenumbers [rad/m] belong to wavelengths [m], the ends included."""
    shortest, longest = (2.0 * math.pi / each for each in wavelengths)
    return np.asarray((wavenumber <= shortest * (1.0 + EDGE)) & (wavenumber >= longest * (1.0 - EDGE)))


@dataclass(frozen=True)
class Rational:
    """S(O) = gain O^power / product(O^2 + corner^2) [m2/(rad/m)]; O and corners [rad/m]."""

    gain: float
    power: float
    corners: tuple[float, ...]

    def __call__(self, wavenumber: Array) -> Array:
        below = np.prod([wavenumber**2 + corner**2 for corner in self.corners], axis=0)
        return np.asarray(self.gain * wavenumber**self.power / below)


@dataclass(frozen=True)
class Knee:
    """S(n) = gain / (1 + n/corner)^3 [m2/(1/m)], n = O/2 pi; given over O."""

    gain: float
    corner: float

    def __call__(self, wavenumber: Array) -> Array:
        turn = 2.0 * math.pi
        return np.asarray(self.gain / (1.0 + wavenumber / (turn * self.corner)) ** 3 / turn)


@dataclass(frozen=True)
class Powers:
    """S(n) = gain / n^exponent [m2/(1/m)] between limits of n = O/2 pi [1/m]; given over O."""

    limits: tuple[float, ...]
    gains: tuple[float, ...]
    exponents: tuple[float, ...]

    def __call__(self, wavenumber: Array) -> Array:
        n = wavenumber / (2.0 * math.pi)
        piece = np.searchsorted(self.limits, n)
        return np.asarray(np.take(self.gains, piece) / n ** np.take(self.exponents, piece) / (2.0 * math.pi))


@dataclass(frozen=True)
class Spectrum:
    """One-sided power spectral density of one kind of irregularity.

    name: for legends; kind: see `KINDS`; law: over the angular wavenumber; wavelengths: shortest and longest that it
    holds for [m]; status: of its weakest number; source: names and titles.
    """

    name: str
    kind: Kind
    law: Rational | Knee | Powers
    wavelengths: tuple[float, float]
    status: Status
    source: tuple[str, ...]

    def psd(self, wavenumber: ArrayLike) -> Array:
        """S(O) [m2/(rad/m)] at angular wavenumbers O = 2 pi/wavelength [rad/m].

        Errors: InputError outside the valid wavelengths.

        >>> from klingel.track.spectra import erri_b176
        >>> low = erri_b176("low").spectra["vertical"]
        >>> float(low.psd(1.0).round(10))
        1.631e-07
        """
        at = np.asarray(wavenumber, dtype=np.float64)
        wrong = ~_within(at, self.wavelengths)
        if wrong.any():
            shortest, longest = self.wavelengths
            low, high = 2.0 * math.pi / longest, 2.0 * math.pi / shortest
            value = float(np.atleast_1d(at)[np.atleast_1d(wrong)][0])
            message = f"is outside the wavenumbers [rad/m] of the spectrum {self.name}"
            remedy = f"use {low:.5g} to {high:.5g}, wavelengths from {shortest:g} m to {longest:g} m"
            raise InputError.single("wavenumber", value, message, remedy=remedy)
        return self.law(at)

    def band(self, speed: float) -> tuple[float, float]:
        """Lowest and highest frequency [Hz] that it excites at a speed [m/s]."""
        shortest, longest = self.wavelengths
        return speed / longest, speed / shortest

    def over_frequency(self, frequencies: ArrayLike, *, speed: float) -> Array:
        """S(f) = (2 pi/V) S(2 pi f/V) [m2/Hz] as a wheel meets it at a speed V [m/s]; errors: as `psd`."""
        scale = 2.0 * math.pi / speed
        return scale * self.psd(scale * np.asarray(frequencies, dtype=np.float64))

    def within(self, shortest: Quantity, longest: Quantity) -> Spectrum:
        """The same spectrum for some of its wavelengths only [m]; errors: InputError outside the valid ones."""
        ends = to_si(shortest, "m", key="shortest"), to_si(longest, "m", key="longest")
        if not self.wavelengths[0] <= ends[0] < ends[1] <= self.wavelengths[1]:
            remedy = f"use {self.wavelengths[0]:g} m to {self.wavelengths[1]:g} m, the shorter one first"
            raise InputError.single("wavelengths", ends, f"are not within those of {self.name}", remedy=remedy)
        return Spectrum(self.name, self.kind, self.law, ends, self.status, self.source)

    def rms(self) -> float:
        """Root mean square over the valid wavelengths [m].

        >>> from klingel.track.spectra import erri_b176
        >>> round(1e3 * erri_b176("low").spectra["vertical"].rms(), 2)
        2.86
        """
        shortest, longest = self.wavelengths
        Omega = np.geomspace(2.0 * math.pi / longest, 2.0 * math.pi / shortest, 20001)
        return float(np.sqrt(np.trapezoid(self.psd(Omega), Omega)))


@dataclass(frozen=True)
class Quality:
    """A track quality: its name and one spectrum for each kind that was published."""

    name: str
    spectra: Mapping[Kind, Spectrum]

    def within(self, shortest: Quantity, longest: Quantity) -> Quality:
        """The same quality for some wavelengths only [m]; errors: InputError outside the valid ones."""
        return Quality(self.name, {kind: each.within(shortest, longest) for kind, each in self.spectra.items()})


@dataclass(frozen=True, eq=False)
class Course:
    """One irregularity along a track, drawn from a spectrum: values [m] at equal intervals of arc length from s = 0.

    kind: see `KINDS`; interval: [m]; values: [m]; slopes: exact derivatives by arc length [-]; repeats: whether it goes
    on from its start behind its end (otherwise there is none before and behind it).
    """

    kind: Kind
    interval: float
    values: Array
    slopes: Array
    repeats: bool

    @property
    def length(self) -> float:
        """[m]."""
        return self.interval * len(self.values)

    def at(self, s: ArrayLike) -> tuple[Array, Array]:
        """Value [m] and slope [-] at arc lengths [m], by cubic Hermite interpolation."""
        place = np.asarray(s, dtype=np.float64) / self.interval
        first = np.floor(place)
        i, t = first.astype(np.int64), place - first
        n = len(self.values)
        inside = (i >= 0) & (i < n) | self.repeats
        a, b = i % n, (i + 1) % n
        ra, rb = self.values[a], self.values[b]
        da, db = self.slopes[a] * self.interval, self.slopes[b] * self.interval
        value = ra + t * (da + t * (3 * (rb - ra) - 2 * da - db + t * (2 * (ra - rb) + da + db)))
        slope = da + t * (2 * (3 * (rb - ra) - 2 * da - db) + 3 * t * (2 * (ra - rb) + da + db))
        return np.where(inside, value, 0.0), np.where(inside, slope / self.interval, 0.0)


def synthesise(
    spectrum: Spectrum, *, length: Quantity, interval: Quantity = 0.1, seed: int, fade: Quantity = 50.0
) -> Course:
    """A course with that spectrum: r(s) = sum of sqrt(2 S(O_j) dO) cos(O_j s + phi_j), phi_j uniform, dO = 2 pi/length.

    length: [m], of at least twice the longest wavelength; interval: of its values [m]; seed: of the phases; fade: where
    it rises from nothing and falls back [m]; with 0 it repeats without a seam instead. Errors: InputError.
    """
    lengths = {"length": length, "interval": interval, "fade": fade}
    L, h, edge = (to_si(value, "m", key=key) for key, value in lengths.items())
    shortest, longest = spectrum.wavelengths
    if not 2.0 * longest <= L:
        remedy = f"give {2.0 * longest:g} m or more"
        raise InputError.single("length", L, "is too short for the longest wavelength [m]", remedy=remedy)
    if not 0.0 < h <= shortest / 8.0:
        remedy = f"give {shortest / 8.0:g} m or less"
        raise InputError.single("interval", h, "is too coarse for the shortest wavelength [m]", remedy=remedy)
    if not 0.0 <= edge <= L / 4.0:
        raise InputError.single("fade", edge, "does not fit the length [m]", remedy=f"give 0 to {L / 4.0:g} m")
    n = math.ceil(L / h)
    Omega: Array = np.asarray(2.0 * math.pi / L * np.arange(n // 2 + 1), dtype=np.float64)
    valid = _within(Omega, spectrum.wavelengths)
    waves = np.zeros(len(Omega), dtype=np.complex128)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, int(valid.sum()))
    waves[valid] = np.sqrt(2.0 * spectrum.psd(Omega[valid]) * 2.0 * math.pi / L) * np.exp(1j * phases)
    values, slopes = (np.fft.irfft(each, n) * n / 2.0 for each in (waves, 1j * Omega * waves))
    if edge > 0.0:
        window, window_slope = _fade(np.asarray(L / n * np.arange(n)), L, edge)
        values, slopes = values * window, slopes * window + values * window_slope
    return Course(spectrum.kind, L / n, values, slopes, repeats=edge == 0.0)


def _fade(s: Array, length: float, edge: float) -> tuple[Array, Array]:
    """Window that rises over `edge` from 0 to 1 as a smooth half cosine and falls before the end; its slope [1/m]."""
    near = np.minimum(s, length - s)
    angle = math.pi * np.minimum(near / edge, 1.0)
    sign = np.where(s <= length / 2.0, 1.0, -1.0)
    return 0.5 * (1.0 - np.cos(angle)), sign * 0.5 * math.pi / edge * np.sin(angle)
