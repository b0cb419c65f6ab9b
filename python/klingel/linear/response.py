"""Frequency responses of a LinearModel between any input and output, combinations of them and track irregularities.
One complex Schur form, then a triangular solve for all frequencies at once: x(s) = Z (s I - T)^-1 Z* B."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import matrix_balance, schur

from klingel.errors import InputError, nearest
from klingel.linear.model import LinearModel, Signal
from klingel.linear.standing import NIL, refuse, standing
from klingel.track.irregularity import KINDS, RAILS, Kind

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

Combination = Mapping[str, ArrayLike]
"""Weights of signals, numbers or arrays over the frequencies: as an input what each of them gets, as an output the
weighted sum."""

BLOCK = 32
"""Columns of the triangular solve that are done one by one before the rest is updated by one matrix product."""

COLUMNS = 8192
"""Right-hand sides that are solved at a time: bounds the memory."""


@dataclass(frozen=True, eq=False)
class Resolvent:
    """(s I - A)^-1 for many s: A = W T W^-1 with W = (balancing) x (unitary).

    triangular: T; into: W^-1; out: W, both (n x n).
    """

    triangular: Complex
    into: Complex
    out: Complex

    @classmethod
    def of(cls, A: Real) -> Resolvent:
        """From a square matrix, real."""
        if A.size == 0:
            empty = np.zeros((0, 0), dtype=np.complex128)
            return cls(empty, empty, empty)
        balanced, (scale, _) = matrix_balance(A, permute=False, separate=True)
        T, Z = schur(balanced, output="complex")
        return cls(T, Z.conj().T / scale, scale[:, None] * Z)

    def solve(self, s: Complex, right: Complex) -> Complex:
        """X (n, f, k) with (s_f I - A) X_f = right_f, no s an eigenvalue; s: (f); right: (n, f, k), or (n, k) for the
        same at every s."""
        n, f, k = len(self.triangular), len(s), right.shape[-1]
        X = np.empty((n, f, k), dtype=np.complex128)
        step = max(1, COLUMNS // max(k, 1))
        for first in range(0, f, step):
            part = slice(first, min(first + step, f))
            shape = (n, part.stop - first, k)
            sides = right[:, part] if right.ndim == 3 else np.broadcast_to(right[:, None], shape)
            X[:, part] = self._part(np.repeat(s[part], k), sides.reshape(n, shape[1] * k)).reshape(shape)
        return X

    def _part(self, s: Complex, right: Complex) -> Complex:
        """Columns x_c of (s_c I - A) x_c = right_c."""
        T, Y = self.triangular, self.into @ right
        for end in range(len(T), 0, -BLOCK):
            begin = max(0, end - BLOCK)
            for j in range(end - 1, begin - 1, -1):
                Y[j] /= s - T[j, j]
                Y[begin:j] += T[begin:j, j, None] * Y[j]
            Y[:begin] += T[:begin, begin:end] @ Y[begin:end]
        return np.asarray(self.out @ Y)

    def meets(self, s: Complex) -> NDArray[np.bool_]:
        """Which of s are eigenvalues to rounding."""
        poles = np.diag(self.triangular)
        floor = NIL * float(np.abs(self.triangular).max(initial=0.0))
        return np.asarray(np.abs(s[:, None] - poles).min(axis=1, initial=np.inf) <= floor)


def points(model: LinearModel, frequencies: ArrayLike) -> Complex:
    """s = j w of a continuous model, z = exp(j w T) of a sampled one; frequencies: [Hz].

    Errors: InputError for frequencies that are negative, not finite, or above half the sample rate.
    """
    f = np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    wrong = ~(np.isfinite(f) & (f >= 0.0))
    if wrong.any():
        raise InputError.single("frequencies", float(f[wrong][0]), "is no frequency [Hz]", remedy="give 0 or more")
    jw = 2j * np.pi * f
    if model.sample_time is None:
        return cast(Complex, jw)
    limit = 0.5 / model.sample_time
    if (f > limit * (1.0 + 1e-12)).any():
        remedy = f"give at most {limit:g} Hz, or the continuous model"
        raise InputError.single("frequencies", float(f.max()), "is above half the sample rate [Hz]", remedy=remedy)
    return cast(Complex, np.exp(jw * model.sample_time))


def frequency_response(
    model: LinearModel,
    input: str | Combination,
    output: str | Combination | Sequence[str | Combination],
    frequencies: ArrayLike,
    *,
    plant: LinearModel | None = None,
) -> Complex:
    """Response of an output to an input at frequencies [Hz], in units of the output per unit of the input.

    input: a name, or weights by name (such as +1 and -1 of two motors; arrays are over the frequencies, see
    `irregularity`); output: the same, or a sequence of them. Returns an array (frequencies), for a sequence
    (frequencies, outputs). A sampled model answers at its samples to an input held between them; with plant, the
    continuous model that it was made from, to one that goes on between them, as the track does.
    At 0 Hz it is the steady gain; what grows for ever, such as the place along the track, has none. Errors: InputError
    for unknown names, frequencies that a sampled model does not have, and outputs that are infinite at one of them.

    >>> one = lambda v: np.array([[v]])
    >>> lag = LinearModel("lag", 0.0, (Signal("x", "m"),), (Signal("u", "m"),), (Signal("y", "m"),), one(-1.0),
    ...     one(1.0), one(1.0), one(0.0), np.zeros(1), np.zeros(1), np.zeros(1))
    >>> complex(frequency_response(lag, "u", "y", [1.0 / (2.0 * np.pi)])[0].round(12))
    (0.5-0.5j)
    """
    s = points(model, frequencies)
    several = not isinstance(output, (str, Mapping))
    wanted = cast("list[str | Combination]", list(output) if several else [output])
    weights = [output_weights(model, each, len(s)) for each in wanted]
    used = np.flatnonzero(np.any(weights, axis=(0, 2)))
    seen = model.select(outputs=[model.outputs[i].name for i in used])
    direct = all_outputs(seen, s, input_weights(model, input, len(s))[:, :, None], plant=plant)[:, :, 0]
    rows = [np.sum(weight[used] * direct, axis=0) for weight in weights]
    return np.stack(rows, axis=-1) if several else rows[0]


def all_outputs(model: LinearModel, s: Complex, u: Complex, *, plant: LinearModel | None = None) -> Complex:
    """All outputs (p, f, k) at points s (f) to inputs u (m, f, k); plant: of `frequency_response`.

    Errors: InputError where s is an eigenvalue, for the outputs that are infinite there.
    """
    b = _product(model.B, u)
    if plant is not None:
        b[: len(plant.A)] = _between_samples(model, plant, s, u)
    resolvent = Resolvent.of(model.A)
    alone = resolvent.meets(s)
    x = np.empty_like(b)
    x[:, ~alone] = resolvent.solve(s[~alone], b[:, ~alone])
    for i in np.flatnonzero(alone):
        found = standing(model.A, model.C, s[i], b[:, i])
        T = model.sample_time
        refuse(model, found.growing, u[:, i], abs(s[i] if T is None else np.angle(s[i]) / T) / (2.0 * np.pi))
        x[:, i] = found.rest
    return _product(model.C, x) + _product(model.D, u)


def _product(matrix: Real, u: Complex) -> Complex:
    """matrix @ u[:, f, k] for all f, k."""
    return np.asarray((matrix @ u.reshape(len(u), u.shape[1] * u.shape[2])).reshape(-1, *u.shape[1:]))


def _between_samples(model: LinearModel, plant: LinearModel, z: Complex, u: Complex) -> Complex:
    """What the plant's states get over a sample from inputs u exp(j w t) that are not held: (z I - Phi) X(j w)."""
    n = len(plant.A)
    if model.sample_time is None or plant.sample_time is not None or model.states[:n] != plant.states:
        remedy = "give the sampled model's own plant: the same scenario linearised with controllers=False"
        raise InputError.single("plant", plant.name, "is not the continuous part of the model", remedy=remedy)
    jw = np.asarray(1j * np.angle(z) / model.sample_time)
    b, resolvent = _product(plant.B, u), Resolvent.of(plant.A)
    alone = resolvent.meets(jw)
    X, got = np.empty_like(b), np.zeros_like(b)
    X[:, ~alone] = resolvent.solve(jw[~alone], b[:, ~alone])
    for i in np.flatnonzero(alone):
        X[:, i], drift, _ = standing(plant.A, plant.C, jw[i], b[:, i])
        got[:, i] = model.sample_time * z[i] * drift  # of drift/s: (z - z0)/(s - s0) is T z0
    return np.asarray(got + z[:, None] * X - _product(model.A[:n, :n], X))


def input_weights(model: LinearModel, combination: str | Combination, count: int) -> Complex:
    """Weights (inputs, frequencies) of a name or a combination; errors: InputError for an unknown name."""
    return _weights(model.inputs, combination, "inputs", count)


def output_weights(model: LinearModel, combination: str | Combination, count: int) -> Complex:
    """Weights (outputs, frequencies) of a name or a combination; errors: InputError for an unknown name."""
    return _weights(model.outputs, combination, "outputs", count)


def _weights(signals: Sequence[Signal], combination: str | Combination, kind: str, count: int) -> Complex:
    terms = {combination: 1.0} if isinstance(combination, str) else combination
    places = {signal.name: i for i, signal in enumerate(signals)}
    weights = np.zeros((len(signals), count), dtype=np.complex128)
    for name, weight in terms.items():
        if name not in places:
            raise InputError.single(kind, name, "is not of this model", remedy=nearest(name, list(places)))
        weights[places[name]] += np.asarray(weight)
    return weights


def positions(model: LinearModel) -> dict[str, float]:
    """How far behind the first one each wheel runs [m], from the arc lengths `<body>.s` of the operating point.

    The wheel `bogie1.wheelset1.left` is on the body `bogie1.wheelset1`. Errors: InputError if the model has no
    irregularity inputs, or neither states nor outputs with the arc lengths.
    """
    wheels = [i.name.removesuffix(".rail_z") for i in model.inputs if i.name.endswith(".rail_z")]
    if not wheels:
        remedy = "keep the inputs <wheel>.rail_y, .rail_z and their rates"
        raise InputError.single("inputs", None, "there is no irregularity among them", remedy=remedy)
    places = {signal.name: float(value) for signal, value in zip(model.states, model.x, strict=True)}
    places |= {signal.name: float(value) for signal, value in zip(model.outputs, model.y, strict=True)}
    at = {}
    for wheel in wheels:
        body = f"{wheel.rpartition('.')[0]}.s"
        if body not in places:
            remedy = "keep it among the outputs, or give `behind`"
            raise InputError.single("outputs", body, "is not of this model", remedy=remedy)
        at[wheel] = places[body]
    first = max(at.values())
    return {wheel: first - place for wheel, place in at.items()}


def side(wheel: str) -> int:
    """0 for a left wheel, 1 for a right one, by the end of its name; errors: InputError for neither."""
    for i, end in enumerate(("left", "right")):
        if wheel.endswith(end):
            return i
    raise InputError.single("wheel", wheel, "is neither left nor right", remedy="end its name with .left or .right")


def irregularity(
    model: LinearModel, kind: Kind, frequencies: ArrayLike, *, behind: Mapping[str, float] | None = None
) -> Combination:
    """The input "one metre of irregularity under the first wheelset", which all wheels meet one after the other.

    kind: vertical, alignment, crosslevel or gauge (see `klingel.track.irregularity`); behind: how far each wheel runs
    behind the first one [m], by default from the operating point. A wheel at l meets it as exp(-j w l/V), and its rate
    j w times that. For a sampled model give its `plant` to the response: rails held between samples would hit the
    wheels in steps. Errors: InputError for an unknown kind or missing inputs or positions.
    """
    if kind not in KINDS:
        raise InputError.single("kind", kind, "is no irregularity", remedy=nearest(kind, KINDS))
    points(model, frequencies)
    jw: Complex = np.asarray(2j * np.pi * np.atleast_1d(np.asarray(frequencies)), dtype=np.complex128)
    weights: dict[str, ArrayLike] = {}
    for wheel, distance in (positions(model) if behind is None else behind).items():
        met = np.exp(-jw * distance / model.speed)
        for name, shares in RAILS[kind].items():
            share = shares[side(wheel)]
            weights[f"{wheel}.{name}"] = share * (jw * met if name.endswith("_rate") else met)
    return weights
