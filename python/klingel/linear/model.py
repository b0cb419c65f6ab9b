"""Linear models with names: A, B, C, D about an operating point, for python-control, MATLAB files and JSON.
Continuous with the commands as inputs, or sampled with the controllers closed around the plant."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from klingel.errors import InputError, nearest

if TYPE_CHECKING:
    import control

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Signal:
    """Dotted name of a state, input or output, and its unit."""

    name: str
    unit: str


@dataclass(frozen=True, eq=False)
class LinearModel:
    """x' = A x + B u, y = C x + D u of small departures from an operating point; sampled if `sample_time` is not None.

    states (n), inputs (m), outputs (p): names and units; A (n x n), B (n x m), C (p x n), D (p x m), SI.
    x (n), u (m), y (p): the values at the operating point that departures are counted from.
    sample_time: [s], None for a continuous model. speed: [m/s]. name: of the vehicle.
    warnings: elements near a kink of their law, where the linear model holds on one side only.
    """

    name: str
    speed: float
    states: tuple[Signal, ...]
    inputs: tuple[Signal, ...]
    outputs: tuple[Signal, ...]
    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    x: Matrix
    u: Matrix
    y: Matrix
    sample_time: float | None = None
    warnings: tuple[str, ...] = ()

    def select(self, *, inputs: Sequence[str] | None = None, outputs: Sequence[str] | None = None) -> LinearModel:
        """The same model with some inputs and outputs only, in the order given.

        Errors: InputError for a name that it does not have.
        """
        i = _places(self.inputs, inputs, "inputs")
        o = _places(self.outputs, outputs, "outputs")
        return dataclasses.replace(
            self,
            inputs=tuple(self.inputs[k] for k in i),
            outputs=tuple(self.outputs[k] for k in o),
            B=self.B[:, i],
            C=self.C[o],
            D=self.D[np.ix_(o, i)],
            u=self.u[i],
            y=self.y[o],
        )

    def state(self, name: str) -> int:
        """Place of a state; errors: InputError."""
        return _places(self.states, [name], "states")[0]

    def reduced(self, order: int, *, scales: Mapping[str, float] | None = None) -> tuple[LinearModel, float]:
        """With `order` states by balanced truncation, and a bound of the error (`klingel.linear.reduce.reduced`).

        scales: sizes of inputs and outputs by name, 1 for those not named. Errors: InputError for an order out of range.
        """
        from klingel.linear.reduce import reduced

        return reduced(self, order, scales=scales)

    def to_control(self) -> control.StateSpace:
        """As python-control's StateSpace with the names of states, inputs and outputs."""
        import control

        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            self.sample_time if self.sample_time is not None else 0,
            states=[_plain(s.name) for s in self.states],
            inputs=[_plain(s.name) for s in self.inputs],
            outputs=[_plain(s.name) for s in self.outputs],
            name=_plain(self.name),
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and strings, ready for JSON."""
        signals = {kind: [[s.name, s.unit] for s in getattr(self, kind)] for kind in ("states", "inputs", "outputs")}
        matrices = {key: getattr(self, key).tolist() for key in ("A", "B", "C", "D", "x", "u", "y")}
        head = {"name": self.name, "speed": self.speed, "sample_time": self.sample_time}
        return head | signals | matrices | {"warnings": list(self.warnings)}

    def to_json(self, path: str | Path) -> Path:
        """Write as JSON, whole or not at all; numbers keep every digit."""
        return _whole(Path(path), lambda part: part.write_text(json.dumps(self.to_dict(), allow_nan=False)))

    def to_mat(self, path: str | Path) -> Path:
        """Write as a MATLAB file (version 5): matrices A to D, values x, u, y, and cells of names and units."""
        from scipy.io import savemat

        cells = {
            f"{kind[:-1]}_{part}": np.array([getattr(s, field) for s in getattr(self, kind)], dtype=object)
            for kind in ("states", "inputs", "outputs")
            for part, field in (("names", "name"), ("units", "unit"))
        }
        matrices = {key: getattr(self, key) for key in ("A", "B", "C", "D", "x", "u", "y")}
        Ts = 0.0 if self.sample_time is None else self.sample_time
        content = matrices | cells | {"Ts": Ts, "speed": self.speed, "name": self.name}

        def write(part: Path) -> None:
            savemat(str(part), content, appendmat=False, oned_as="column", do_compression=True)

        return _whole(Path(path), write)


def _plain(name: str) -> str:
    """A name without dots, which python-control reserves."""
    return name.replace(".", "_")


def _places(signals: Sequence[Signal], wanted: Sequence[str] | None, kind: str) -> list[int]:
    if wanted is None:
        return list(range(len(signals)))
    places = {signal.name: i for i, signal in enumerate(signals)}
    for name in wanted:
        if name not in places:
            raise InputError.single(kind, name, "is not of this model", remedy=nearest(name, list(places)))
    return [places[name] for name in wanted]


def _whole(path: Path, write: Any) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.tmp")
    try:
        write(part)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path
