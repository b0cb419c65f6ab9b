"""Random response without time stepping: spectra of track irregularity to spectra and r.m.s. values of any channel.
Also the same irregularity as excitations of a simulation, to check one against the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from klingel.errors import InputError
from klingel.linear.model import LinearModel, Signal
from klingel.linear.response import all_outputs, input_weights, irregularity, points, positions, side
from klingel.track.irregularity import RAILS, Course, Kind, Quality

Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RandomResponse:
    """Power spectral densities of outputs on irregular track.

    quality: name of the track; speed: [m/s]; frequencies: (f) [Hz], rising; outputs: names and units; shares: one-sided
    density (f, outputs) that each kind of irregularity makes [unit2/Hz].
    """

    quality: str
    speed: float
    frequencies: Real
    outputs: tuple[Signal, ...]
    shares: Mapping[Kind, Real]

    @property
    def psd(self) -> Real:
        """Sum of the shares (f, outputs) [unit2/Hz]."""
        return np.asarray(sum(self.shares.values()))

    def rms(self, band: tuple[float, float] | None = None) -> dict[str, float]:
        """Root mean square of every output, in its unit; band: lowest and highest frequency [Hz], None for all.

        Errors: InputError for a band outside the frequencies.
        """
        f = self.frequencies
        low, high = (f[0], f[-1]) if band is None else band
        if not f[0] <= low < high <= f[-1]:
            remedy = f"give {f[0]:.4g} to {f[-1]:.4g} Hz, the lower one first"
            raise InputError.single("band", band, "is not within the frequencies [Hz]", remedy=remedy)
        squares = PchipInterpolator(f, self.psd, axis=0).integrate(low, high)
        values = np.sqrt(squares)
        return {signal.name: float(value) for signal, value in zip(self.outputs, values, strict=True)}


def random_response(
    model: LinearModel,
    quality: Quality,
    *,
    outputs: Sequence[str] | None = None,
    frequencies: ArrayLike | None = None,
    behind: Mapping[str, float] | None = None,
    plant: LinearModel | None = None,
) -> RandomResponse:
    """Spectra of the outputs, S_y(f) = sum over the kinds of |G(f)|^2 S(f), the kinds being independent.

    model: stable, with the irregularity inputs; quality: of the track; outputs: names, None for all; frequencies: [Hz],
    rising, None for a grid that resolves the resonances and the delays between the wheelsets; behind: of
    `irregularity`; plant: the continuous model that a sampled one was made from. Errors: InputError, also for
    frequencies outside the valid wavelengths at the model's speed, for a sampled model without plant, and for an
    unstable model, which has no stationary response.
    """
    if model.sample_time is not None and plant is None:
        remedy = "give plant=linearise(..., controllers=False) of the same scenario"
        raise InputError.single("plant", None, "is missing: the track goes on between samples", remedy=remedy)
    _check_stable(model)
    chosen = model if outputs is None else model.select(outputs=outputs)
    f = _frequencies(model, quality, behind) if frequencies is None else np.atleast_1d(np.asarray(frequencies, float))
    if not (np.diff(f) > 0.0).all():
        raise InputError.single("frequencies", None, "do not rise [Hz]", remedy="sort them, each one once")
    at = positions(model) if behind is None else behind
    densities = {kind: each.over_frequency(f, speed=model.speed) for kind, each in quality.spectra.items()}
    inputs = [input_weights(model, irregularity(model, kind, f, behind=at), len(f)) for kind in densities]
    G = all_outputs(chosen, points(model, f), np.stack(inputs, axis=-1), plant=plant)
    shares = {kind: (np.abs(G[:, :, i]) ** 2 * S).T for i, (kind, S) in enumerate(densities.items())}
    return RandomResponse(quality.name, model.speed, f, chosen.outputs, shares)


def _check_stable(model: LinearModel) -> None:
    """An eigenvalue that grows is an error; the free arc length, which does not, moves no force."""
    poles = continuous_poles(model)
    worst = poles[int(np.argmax(poles.real))] if len(poles) else 0.0
    if worst.real > 1e-4 * (1.0 + abs(worst)):
        value = f"{worst.real:.4g} +- {abs(worst.imag):.4g}j 1/s"
        message = "grows: an unstable vehicle has no stationary response"
        raise InputError.single("eigenvalue", value, message, remedy="take a lower speed or mend the controller")


def continuous_poles(model: LinearModel) -> NDArray[np.complex128]:
    """Eigenvalues as of a continuous model [1/s]: s = ln z/T of a sampled one, without its pure delays (z = 0)."""
    poles = np.linalg.eigvals(model.A).astype(np.complex128)
    if model.sample_time is None:
        return poles
    return np.asarray(np.log(poles[np.abs(poles) > 1e-12]) / model.sample_time, dtype=np.complex128)


def _frequencies(model: LinearModel, quality: Quality, behind: Mapping[str, float] | None) -> Real:
    """Grid over the band that all kinds are valid in: even steps for the delays, and dense at resonances."""
    bands = [each.band(model.speed) for each in quality.spectra.values()]
    low, high = max(band[0] for band in bands), min(band[1] for band in bands)
    if model.sample_time is not None:
        high = min(high, 0.5 / model.sample_time)
    if not low < high:
        raise InputError.single("quality", quality.name, "its kinds share no wavelength", remedy="take fewer kinds")
    length = max((positions(model) if behind is None else behind).values())
    even = np.linspace(low, high, 2 + int((high - low) * 40.0 * length / model.speed))
    return np.unique(np.concatenate((even, np.geomspace(low, high, 400)[1:-1], _resonances(model, low, high))))


def _resonances(model: LinearModel, low: float, high: float) -> Real:
    """Frequencies around every lightly damped pole, in steps of its half width and wider further out."""
    poles = continuous_poles(model)
    light = poles[(poles.imag > 0.0) & (np.abs(poles.real) < 0.3 * np.abs(poles))]
    around = np.sinh(np.linspace(-4.5, 4.5, 91))
    f = (light.imag[:, None] + np.abs(light.real)[:, None] * around).reshape(-1) / (2.0 * np.pi)
    return np.asarray(f[(f > low) & (f < high)])


def excitations(
    courses: Sequence[Course], behind: Mapping[str, float], *, speed: float, duration: float, interval: float
) -> list[dict[str, Any]]:
    """Irregularities as `run.excitations` of a spec: what every wheel's rail does.

    courses: at most one of a kind; behind: how far each wheel runs behind the first one [m], which starts at s = 0 (see
    `positions`); speed: [m/s]; duration: [s]; interval: from value to value [s], a multiple of the step; straight lines
    join them. Errors: InputError for two courses of a kind.
    """
    kinds = [course.kind for course in courses]
    if len(set(kinds)) < len(kinds):
        raise InputError.single("courses", kinds, "have a kind twice", remedy="give one of each kind")
    time = np.arange(round(duration / interval) + 1) * interval
    entries = []
    for wheel, distance in behind.items():
        moved: dict[str, Real] = {}
        for course in courses:
            value, slope = course.at(speed * time - distance)
            for name, shares in RAILS[course.kind].items():
                share = shares[side(wheel)]
                moved[name] = moved.get(name, 0.0) + share * (speed * slope if name.endswith("_rate") else value)
        entries += [
            {"input": f"{wheel}.{name}", "interval": interval, "values": values.tolist(), "joined": True}
            for name, values in moved.items()
        ]
    return entries
