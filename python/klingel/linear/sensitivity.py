"""Sensitivities of eigenvalues and steady values to any parameter: differences of exact Jacobians, extrapolated.
The operating point is solved again for every value, so what a parameter does through it counts too."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from klingel.errors import InputError
from klingel.linear.model import LinearModel
from klingel.linear.operating import solve, steady_spec
from klingel.linear.parameters import get, names, replace, unit
from klingel.linear.statespace import of_raw
from klingel.linear.steady import values_of

if TYPE_CHECKING:
    import pandas as pd

    from klingel.scenario import Scenario

Real = NDArray[np.float64]
Function = Callable[[float], NDArray[Any]]
"""Of a parameter's value: an array, real or complex."""

STEP = 1e-3
"""First step over the parameter."""

ACCURACY = 1e-5
"""Relative error of a derivative that is asked for; the step is halved until it is reached."""

FLOOR = 1e-7
"""Relative effects p dv/dp below this share of v are nothing: there the error is not pursued."""

GONE = 1e-3
"""Sampled eigenvalues below this size are memory of delays, gone within a few samples."""

FELT = 20.0
"""Oscillations below this frequency [Hz] are what people mean: above, wheels, shafts and motors ring."""

HALVINGS = 6
"""At most so many; a derivative that still moves sits at a kink of a law or a table, and its error shows it."""


@dataclass(frozen=True, eq=False)
class Derivative:
    """Of an array by a parameter.

    value: real or complex; error: how far the last halving of the step moved each element.
    """

    value: NDArray[Any]
    error: Real


def derivative(function: Function, value: float) -> Derivative:
    """d function/d value by central differences, extrapolated over the halving of their step (Richardson).

    The first step is 0.1 % of the value. Steps are halved until two extrapolations agree to 1e-5 in every element that
    matters, or none comes closer any more; each element keeps its best. Errors: InputError for a value of zero, which
    has no relative step.

    >>> cube = derivative(lambda p: np.array([p**3]), 2.0)
    >>> bool(abs(cube.value[0] - 12.0) < 1e-8), bool(cube.error[0] < 1e-5 * 12.0)
    (True, True)
    """
    if value == 0.0 or not np.isfinite(value):
        raise InputError.single("value", value, "has no relative effect", remedy="give the parameter a value first")
    floor = FLOOR * np.abs(function(value)) / abs(value)
    steps = [STEP * abs(value) / 2.0**halving for halving in range(HALVINGS + 1)]
    plain = _central(function, value, steps[0])
    halved = _central(function, value, steps[1])
    before = (4.0 * halved - plain) / 3.0
    found = Derivative(before, np.full(before.shape, np.inf))
    for step in steps[2:]:
        plain, halved = halved, _central(function, value, step)
        after = (4.0 * halved - plain) / 3.0
        error = np.abs(after - before)
        closer = error < found.error
        stuck = not (error < 0.5 * found.error).any()
        found = Derivative(np.where(closer, after, found.value), np.where(closer, error, found.error))
        if stuck or (found.error <= np.maximum(ACCURACY * np.abs(found.value), floor)).all():
            break
        before = after
    return found


def _central(function: Function, value: float, step: float) -> NDArray[Any]:
    return np.asarray((function(value + step) - function(value - step)) / (2.0 * step))


def eigenvalue_derivatives(
    family: Callable[[float], LinearModel], value: float, eigenvalues: Sequence[complex] | None = None
) -> tuple[NDArray[np.complex128], Derivative]:
    """Eigenvalues [1/s] and their derivatives by a parameter, d lambda = w* dA v / w* v with left and right vectors.

    family: the model over the parameter's value, always with the same states; eigenvalues: those nearest to these, of
    the model at `value` [1/s]; None for the least damped oscillation below 20 Hz. Those of a sampled model are ln z/T.
    Errors: InputError for a repeated eigenvalue, which has no derivative, or a model whose states change.
    """
    model = family(value)
    chosen, w, v = _vectors(model, eigenvalues)
    T = model.sample_time

    def quotients(p: float) -> NDArray[np.complex128]:
        other = family(p)
        if other.A.shape != model.A.shape:
            remedy = "vary something that keeps the structure"
            raise InputError.single("states", len(other.A), "is another number of states", remedy=remedy)
        z = np.einsum("ij,ik,kj->j", w.conj(), other.A, v)
        return np.asarray(z if T is None else _continuous(z, other.sample_time or T))

    return chosen, derivative(quotients, value)


def _continuous(z: NDArray[np.complex128], T: float) -> NDArray[np.complex128]:
    return np.asarray(np.log(z) / T)


def _vectors(
    model: LinearModel, eigenvalues: Sequence[complex] | None
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """Chosen eigenvalues [1/s] with left and right vectors, w* v = 1."""
    z, W, V = cast("tuple[NDArray[np.complex128], ...]", scipy.linalg.eig(model.A, left=True, right=True))
    if model.sample_time is not None:
        lasting = np.abs(z) > GONE
        z, W, V = z[lasting], W[:, lasting], V[:, lasting]
    s = z if model.sample_time is None else _continuous(z, model.sample_time)
    wanted = [_least_damped(s)] if eigenvalues is None else eigenvalues
    places = np.array([int(np.argmin(np.abs(s - each))) for each in wanted], dtype=np.int64)
    W, V = W[:, places], V[:, places]
    overlap = np.sum(W.conj() * V, axis=0)
    if (np.abs(overlap) < 1e-10).any():
        value = complex(s[places][np.argmin(np.abs(overlap))])
        raise InputError.single("eigenvalue", value, "is repeated and has no derivative", remedy="choose another one")
    return s[places], W / overlap.conj(), V


def eigenvalue_sensitivities(
    scenario: Scenario,
    parameters: Sequence[str] | None = None,
    *,
    eigenvalues: Sequence[complex] | None = None,
    at: float | None = None,
    controllers: bool = True,
) -> pd.DataFrame:
    """How much each parameter moves eigenvalues, the strongest first for every eigenvalue.

    parameters: dotted paths (`klingel.linear.parameters.names`), None for all numbers that are not zero or whole;
    eigenvalues: those nearest to these [1/s], None for the least damped oscillation below 20 Hz (faster ones are of
    wheels on rails, shafts and motors); at, controllers: of `linearise`.
    Returns rows (eigenvalue, parameter): `eigenvalue` [1/s], `frequency` [Hz], `damping` ratio, `parameter`, its
    `value` and `unit`, `effect` = p d eigenvalue/dp [1/s] (complex), `frequency_effect` = p df/dp [Hz],
    `damping_effect` = p d zeta/dp, and `error` of the effect, relative to it. Errors: InputError; SimulationError where
    there is no operating point.
    """
    near = solve(steady_spec(scenario, at=at))
    rows = []
    for path in _paths(scenario, parameters):
        value = get(scenario, path)

        def family(p: float, path: str = path) -> LinearModel:
            spec = steady_spec(replace(scenario, path, p), at=at)
            return of_raw(solve(spec, near).linearise(), spec["name"], spec["speed"], controllers=controllers)

        found, slope = eigenvalue_derivatives(family, value, eigenvalues)
        for s, change, error in zip(found, slope.value, slope.error, strict=True):
            effect = complex(value * change)
            rows.append(
                {
                    "eigenvalue": complex(s),
                    "frequency": abs(s.imag) / (2.0 * np.pi),
                    "damping": -s.real / abs(s),
                    "parameter": path,
                    "value": value,
                    "unit": unit(scenario, path),
                    "effect": effect,
                    "frequency_effect": float(np.sign(s.imag) * effect.imag / (2.0 * np.pi)),
                    "damping_effect": _damping_effect(complex(s), effect),
                    "error": _share(abs(value) * float(error), abs(effect)),
                }
            )
    return _ranked(rows, "eigenvalue")


def _damping_effect(s: complex, ds: complex) -> float:
    """d(-Re s/|s|) for a change ds."""
    size = abs(s)
    return -ds.real / size + s.real * (s.real * ds.real + s.imag * ds.imag) / size**3


def _least_damped(s: NDArray[np.complex128]) -> complex:
    """The oscillation of least damping ratio below 20 Hz."""
    oscillations = s[(s.imag > 1e-6 * np.abs(s)) & (s.imag < 2.0 * np.pi * FELT)]
    if len(oscillations) == 0:
        message = f"none of them oscillates below {FELT:g} Hz"
        raise InputError.single("eigenvalues", None, message, remedy="give the ones you mean")
    return complex(oscillations[np.argmax(oscillations.real / np.abs(oscillations))])


def steady_sensitivities(
    scenario: Scenario, channels: Sequence[str], parameters: Sequence[str] | None = None, *, at: float | None = None
) -> pd.DataFrame:
    """How much each parameter moves steady values, the strongest first for every channel.

    channels: dotted names as of a result; parameters: as of `eigenvalue_sensitivities`; at: of `steady_state`.
    Returns rows (channel, parameter): `channel`, `steady` value, `parameter`, its `value` and `unit`, `effect` =
    p d steady/dp in the channel's unit, and `error` of the effect, relative to it. Errors: InputError, also for an
    unknown channel; SimulationError where there is no steady state.
    """
    near = solve(steady_spec(scenario, at=at))
    base = values_of(near.linearise())
    unknown = [channel for channel in channels if channel not in base.index]
    if unknown:
        raise InputError.single("channels", unknown[0], "is no channel", remedy="see the steady state's values")
    rows = []
    for path in _paths(scenario, parameters):
        value = get(scenario, path)

        def steady(p: float, path: str = path) -> Real:
            state = values_of(solve(steady_spec(replace(scenario, path, p), at=at), near).linearise())
            return np.asarray(state.loc[list(channels)], dtype=np.float64)

        slope = derivative(steady, value)
        for channel, change, error in zip(channels, slope.value, slope.error, strict=True):
            effect = value * float(change)
            rows.append(
                {
                    "channel": channel,
                    "steady": float(base[channel]),
                    "parameter": path,
                    "value": value,
                    "unit": unit(scenario, path),
                    "effect": effect,
                    "error": _share(abs(value) * float(error), abs(effect)),
                }
            )
    return _ranked(rows, "channel")


def _share(error: float, effect: float) -> float:
    return error / effect if effect > 0.0 else 0.0


def _paths(scenario: Scenario, parameters: Sequence[str] | None) -> Iterator[str]:
    """Paths as given, or every one that can vary: no zeros, no whole numbers."""
    if parameters is not None:
        yield from parameters
        return
    for path in names(scenario):
        value = get(scenario, path)
        if value == 0.0:
            continue
        try:
            replace(scenario, path, value * (1.0 + STEP))
            replace(scenario, path, value * (1.0 - STEP))
        except InputError:
            continue
        yield path


def _ranked(rows: list[dict[str, Any]], group: str) -> pd.DataFrame:
    import pandas as pd

    table = pd.DataFrame(rows)
    order = {key: i for i, key in enumerate(dict.fromkeys(table[group]))}
    size = table["effect"].abs()
    places = np.lexsort((-size.to_numpy(), table[group].map(order).to_numpy()))
    return table.iloc[places].reset_index(drop=True)
