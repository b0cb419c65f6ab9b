"""Frequency response of a sampled block diagram about an operating point: what loop margins are computed from.
It reads the same spec as the core, so what is analysed is what runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Row = NDArray[np.complex128]


class _Point:
    """Values of all signals at the operating point, and their responses to every measurement (frequency, input)."""

    def __init__(self, measurements: Sequence[str], operating: Mapping[str, float], count: int) -> None:
        self.value = {name: float(operating.get(name, 0.0)) for name in measurements}
        self.row: dict[str, Row] = {}
        for i, name in enumerate(measurements):
            unit = np.zeros((count, len(measurements)), dtype=np.complex128)
            unit[:, i] = 1.0
            self.row[name] = unit

    def parameter(self, parameter: float | str | None) -> tuple[float, Row | float]:
        if isinstance(parameter, str):
            return self.value[parameter], self.row[parameter]
        return (0.0, 0.0) if parameter is None else (float(parameter), 0.0)


def controller_response(
    spec: Mapping[str, Any], operating: Mapping[str, float], omega: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Commands over measurements at each angular frequency: array (omega, commands, measurements).

    spec: block diagram as `Diagram.spec` gives it; operating: measurements at the operating point, 0 where not given
    (SI); omega: [rad/s], below the Nyquist frequency. Limits are taken as inactive at the operating point; blocks that
    round, hold or make noise as linear models take them.

    >>> from klingel.control.diagram import Diagram
    >>> d = Diagram(sample_time=1e-3)
    >>> d.command("motor", d.delay("later", d.sum("gain", {d.measure("x"): 2.0}), 2))
    >>> response = controller_response(d.spec(), {}, np.array([100.0]))
    >>> float(round(abs(response[0, 0, 0]), 6)), float(round(np.angle(response[0, 0, 0]), 6))
    (2.0, -0.2)
    """
    point = _Point(spec["measurements"], operating, len(omega))
    back = np.exp(-1j * np.asarray(omega) * spec["sample_time"])
    for block in spec["blocks"]:
        if block["kind"] == "state_space":
            _state_space(block, point, back)
            continue
        value, row = _LAWS[block["kind"]](block, point, back, spec["sample_time"])
        point.value[block["name"]], point.row[block["name"]] = value, row
    return np.stack([point.row[command["signal"]] for command in spec["commands"]], axis=1)


def _sum(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    value, row = block["bias"], np.zeros_like(next(iter(p.row.values())))
    for term in block["terms"]:
        gain, slope = p.parameter(term["gain"])
        value += gain * p.value[term["signal"]]
        row = row + gain * p.row[term["signal"]] + slope * p.value[term["signal"]]
    return value, row


def _product(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    value, row = 1.0, np.zeros_like(next(iter(p.row.values())))
    for factor in block["factors"]:
        row = row * p.value[factor] + value * p.row[factor]
        value *= p.value[factor]
    return value, row


def _quotient(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    numerator, denominator = block["numerator"], block["denominator"]
    d = p.value[denominator]
    held = float(np.copysign(max(abs(d), block["floor"]), d))
    value = p.value[numerator] / held
    slope = p.row[denominator] * (value / held) if abs(d) > block["floor"] else 0.0
    return value, p.row[numerator] / held - slope


def _filter(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    dc, response = 1.0, np.ones_like(back)
    for section in block["sections"]:
        b, a = section["b"], section["a"]
        response = response * (b[0] + b[1] * back + b[2] * back**2) / (1.0 + a[0] * back + a[1] * back**2)
        dc *= sum(b) / (1.0 + sum(a))
    return dc * p.value[block["input"]], p.row[block["input"]] * response[:, None]


def _pi(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    """About a settled integral: the output's value is its proportional part, as after a reset."""
    gain, slope = p.parameter(block["proportional"])
    integral, _ = p.parameter(block["integral"])
    error = p.value[block["input"]]
    response = gain + integral * 0.5 * ts * (1.0 + back) / (1.0 - back)
    return gain * error, p.row[block["input"]] * response[:, None] + slope * error


def _through(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    return p.value[block["input"]], p.row[block["input"]]


def _delay(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    return p.value[block["input"]], p.row[block["input"]] * (back ** block["samples"])[:, None]


def _noise(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    return 0.0, np.zeros_like(next(iter(p.row.values())))


def _hold(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    """The mean of the phases in which a hold may take its samples."""
    mean = np.mean([back**i for i in range(block["samples"])], axis=0)
    return p.value[block["input"]], p.row[block["input"]] * mean[:, None]


def _state_space(block: Mapping[str, Any], p: _Point, back: Row) -> None:
    """Its outputs: c (z - a)^-1 b + d at every frequency, and at z = 1 for their values."""
    n, m, outputs = len(block["a"]), len(block["inputs"]), len(block["outputs"])
    a, b = np.reshape(block["a"], (n, n)), np.reshape(block["b"], (n, m))
    c, d = np.reshape(block["c"], (outputs, n)), np.reshape(block["d"], (outputs, m))
    z = np.concatenate([[1.0], 1.0 / back])
    transfer = c @ np.linalg.solve(z[:, None, None] * np.eye(n) - a, np.broadcast_to(b + 0j, (len(z), n, m))) + d
    values = transfer[0].real @ [p.value[name] for name in block["inputs"]]
    rows = np.einsum("wij,jwk->iwk", transfer[1:], np.stack([p.row[name] for name in block["inputs"]]))
    for name, value, row in zip(block["outputs"], values, rows, strict=True):
        p.value[name], p.row[name] = float(value), row


def _lookup(block: Mapping[str, Any], p: _Point, back: Row, ts: float) -> tuple[float, Row]:
    x, y, at = np.asarray(block["x"]), np.asarray(block["y"]), p.value[block["input"]]
    i = int(np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2))
    slope = (y[i + 1] - y[i]) / (x[i + 1] - x[i]) if x[0] <= at <= x[-1] else 0.0
    return float(np.interp(at, x, y)), p.row[block["input"]] * slope


_LAWS = {
    "sum": _sum,
    "product": _product,
    "quotient": _quotient,
    "filter": _filter,
    "pi": _pi,
    "saturation": _through,
    "delay": _delay,
    "lookup": _lookup,
    "quantise": _through,
    "noise": _noise,
    "hold": _hold,
}
