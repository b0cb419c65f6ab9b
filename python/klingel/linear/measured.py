"""Frequency responses measured on the simulator, to lay beside the linear ones: a small random input, and coherence.
The input is a sum of sines with random phases that is played twice, settled the second time: no leakage, no window."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from klingel.errors import InputError, SimulationError
from klingel.linear.model import LinearModel
from klingel.linear.statespace import held
from klingel.lower import Spec
from klingel.result import COMPLETED, simulate_spec


@dataclass(frozen=True, eq=False)
class Measured:
    """A measured response.

    input, outputs: names; frequencies: (f) [Hz]; response: H1 estimate (f, outputs), in units of the output per unit of
    the input; coherence: (f, outputs), 1 where the output is linear in the input; interval: over which the input was
    held [s], which is the sample time of the linear model to compare with.
    """

    input: str
    outputs: tuple[str, ...]
    frequencies: NDArray[np.float64]
    response: NDArray[np.complex128]
    coherence: NDArray[np.float64]
    interval: float


def measured_response(
    spec: Spec,
    input: str,
    outputs: Sequence[str],
    *,
    amplitude: float,
    band: tuple[float, float],
    period: float = 10.0,
    interval: float = 1e-3,
    courses: int = 6,
    seed: int = 0,
) -> Measured:
    """Excite one input of a simulation and estimate the responses of some channels.

    spec: on endless track (`klingel.linear.steady_spec`); input: its name as of a linear model; amplitude:
    r.m.s. of what is added to it, small against every kink; band: lowest and highest frequency [Hz]; period: of the
    signal [s], which sets the spacing of the frequencies; interval: over which it is held [s], a multiple of the step;
    courses: how many independent signals are averaged; seed: of the phases.
    The run takes 2 courses x period. Errors: InputError; SimulationError, also for a run that did not complete.
    """
    if courses < 2:
        remedy = "give 2 or more"
        raise InputError.single("courses", courses, "are too few: one alone is always coherent", remedy=remedy)
    n = round(period / interval)
    if not 1.0 / period <= band[0] < band[1] <= 0.4 / interval:
        remedy = f"give frequencies from {1.0 / period:g} to {0.4 / interval:g} Hz, the lower one first"
        raise InputError.single("band", band, "does not fit period and interval [Hz]", remedy=remedy)
    signals = random_phases(n, interval, band, amplitude=amplitude, courses=courses, seed=seed)
    played = np.repeat(signals, 2, axis=0).reshape(-1)
    spec = copy.deepcopy(spec)
    spec["run"] |= {
        "duration": len(played) * interval,
        "record_interval": interval,
        "excitations": [{"input": input, "interval": interval, "values": played.tolist()}],
    }
    run = simulate_spec(spec)
    if run.attrs["outcome"] != COMPLETED:
        raise SimulationError(f"{spec['name']}: {run.attrs['outcome']}; take a smaller amplitude than {amplitude:g}")
    missing = [name for name in outputs if name not in run]
    if missing:
        raise InputError.single("outputs", missing[0], "is no channel", remedy="see the variables of a result")
    channels = np.stack([run[name].to_numpy()[: len(played)] for name in outputs])
    settled = channels.reshape(len(outputs), courses, 2, n)[:, :, 1]
    return estimate(input, outputs, signals, settled, interval=interval, band=band)


def sampled(model: LinearModel, interval: float) -> LinearModel:
    """A continuous model at samples, its inputs held over `interval` [s]: what a measured response is compared with.

    Errors: InputError for a model that is sampled already.
    """
    if model.sample_time is not None:
        remedy = "measure with an interval equal to its sample time"
        raise InputError.single("model", model.sample_time, "is sampled already [s]", remedy=remedy)
    A, B = held(model, interval)
    return dataclasses.replace(model, A=A, B=B, sample_time=interval)


def random_phases(
    count: int, interval: float, band: tuple[float, float], *, amplitude: float, courses: int, seed: int
) -> NDArray[np.float64]:
    """Periodic signals (courses, count): equal sines of random phase at every line of the band, r.m.s. amplitude."""
    f = np.asarray(np.fft.rfftfreq(count, interval), dtype=np.float64)
    lines = _lines(f, band)
    waves = np.zeros((courses, len(f)), dtype=np.complex128)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (courses, int(lines.sum())))
    waves[:, lines] = amplitude * np.sqrt(2.0 / lines.sum()) * np.exp(1j * phases)
    return np.asarray(np.fft.irfft(waves, count) * count / 2.0)


def estimate(
    input: str,
    outputs: Sequence[str],
    signals: NDArray[np.float64],
    settled: NDArray[np.float64],
    *,
    interval: float,
    band: tuple[float, float],
) -> Measured:
    """H1 = Suy/Suu and coherence |Suy|^2/(Suu Syy) of whole periods.

    signals: (courses, n); settled: (outputs, courses, n).
    """
    from scipy.signal import csd, welch

    n = signals.shape[-1]
    u, y = signals.reshape(-1), settled.reshape(len(settled), -1)
    whole = {"fs": 1.0 / interval, "window": "boxcar", "nperseg": n, "noverlap": 0, "detrend": "constant"}
    f = welch(u, **whole)[0]
    lines = _lines(f, band)
    Suu, Syy, Suy = (S[..., lines] for S in (welch(u, **whole)[1], welch(y, **whole)[1], csd(u, y, **whole)[1]))
    coherence = np.abs(Suy) ** 2 / (Suu * Syy)
    return Measured(input, tuple(outputs), f[lines], (Suy / Suu).T, coherence.T, interval)


def _lines(f: NDArray[np.float64], band: tuple[float, float]) -> NDArray[np.bool_]:
    edge = 1e-9 * band[1]
    return (f >= band[0] - edge) & (f <= band[1] + edge)
