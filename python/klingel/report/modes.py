"""One page about the modes of a vehicle: the picture, a moving vehicle in plan, side and end view, and the table.
The page draws itself from the shapes; nothing is loaded from outside."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from klingel.linear.modes import Mode
from klingel.linear.names import by_kind
from klingel.linear.shapes import Shape, Structure
from klingel.plot.linear import modes_figure
from klingel.plot.style import render
from klingel.report.page import Report, inline_svg, template

SHOWN = 4
"""Bodies and kinds of elements of a mode in the table."""

LEAST = 0.02
"""Smallest share that is shown."""

HALF_TAPES = 0.75
"""Half distance of the wheels that are drawn [m]."""

DIGITS = 4
"""Of the numbers that the picture moves by."""


def modes_report(found: Sequence[Mode], structure: Structure, *, title: str, subtitle: str = "") -> Report:
    """The page of modes.

    Args:
        found: as `klingel.linear.modes.modes` gives them.
        structure: the spec on the states of their model.
        title: of the page.
        subtitle: the operating point in words.

    Returns:
        The page; the same input gives the same page.
    """
    swinging = [mode for mode in found if mode.swings]
    others = [mode for mode in found if not mode.swings]
    picture = modes_figure(found, title="Oscillations up to 30 Hz")
    scene = {"parts": list(_parts(structure)), "modes": [_moves(structure, mode) for mode in swinging]}
    return Report(
        template("modes.html").render(
            title=title,
            subtitle=subtitle,
            figure=inline_svg(render(picture, "svg", name="modes"), "modes"),
            scene=json.dumps(scene, separators=(",", ":"), allow_nan=False),
            first=_first(swinging),
            swinging=[_row(mode, structure.model.speed) for mode in swinging],
            others=[_row(mode, structure.model.speed) for mode in others],
            warnings=structure.model.warnings,
        )
    )


def _row(mode: Mode, speed: float) -> dict[str, str]:
    return {
        "name": mode.name,
        "frequency": f"{mode.frequency:.2f}",
        "damping": f"{100.0 * mode.damping:.1f}",
        "real": f"{mode.eigenvalue.real:.2f}",
        "wavelength": f"{speed / mode.frequency:.1f}" if mode.frequency > 0.1 else "",
        "bodies": _listed(_gathered(mode.bodies)),
        "elements": _listed(by_kind(mode.elements)),
    }


def _listed(shares: Mapping[str, float]) -> str:
    shown = [(name, share) for name, share in list(shares.items())[:SHOWN] if abs(share) >= LEAST]
    return ", ".join(f"{name.replace('_', ' ')} {100.0 * share:.0f} %" for name, share in shown)


def _gathered(bodies: Mapping[str, float]) -> dict[str, float]:
    """Shares of the car body, of both bogies, of all wheelsets, wheels and motors together."""
    words = {"wheelset": "wheelsets", "left": "wheels", "right": "wheels", "spin": "wheel spin", "motor": "motors"}
    sums: dict[str, float] = {}
    for name, share in bodies.items():
        last = name.rpartition(".")[2].rstrip("0123456789")
        word = words.get(last, "bogies" if last == "bogie" else last)
        sums[word] = sums.get(word, 0.0) + share
    return dict(sorted(sums.items(), key=lambda item: -item[1]))


def _first(swinging: Sequence[Mode]) -> int:
    """The mode that moves first: the least damped one below 10 Hz."""
    slow = [i for i, mode in enumerate(swinging) if mode.frequency < 10.0] or list(range(len(swinging)))
    return min(slow, key=lambda i: swinging[i].damping, default=0)


def _parts(structure: Structure) -> Iterator[dict[str, Any]]:
    """What is drawn: boxes of bodies, and wheelsets, about their centres of mass in the design frame [m]."""
    spec = structure.spec
    wheels = {wheel["body"] for wheel in spec.get("wheels", ())}
    radius = float(spec["contact_pairs"][0]["radius"]) if wheels else 0.0
    for body in spec["bodies"]:
        centre = np.array(body["position"], dtype=float)
        part: dict[str, Any] = {"name": body["name"], "at": _rounded(centre)}
        if body["name"] in wheels:
            yield part | {"wheel": radius, "half": [0.09, HALF_TAPES, 0.09]}
        else:
            yield part | {"half": _rounded(_half_size(spec, body["name"], centre))}


def _half_size(spec: Mapping[str, Any], name: str, centre: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Half the size of a box that reaches to all joints of a body, and a little further."""
    kinds = ("bushings", "maxwells", "stops", "actuators")
    joints = [element["joint"] for kind in kinds for element in spec.get(kind) or ()]
    points = [joint["point"] for joint in joints if name in (joint["a"], joint["b"])]
    if not points:
        return np.array([0.5, 0.5, 0.3])
    reach = np.abs(np.array(points, dtype=float) - centre).max(axis=0)
    return np.asarray(np.maximum(reach * np.array([1.2, 1.0, 1.0]), [0.3, 0.3, 0.12]))


def _moves(structure: Structure, mode: Mode) -> list[list[float]]:
    """Of every part x, y, z [m], roll, pitch, yaw [rad] and the turn of both wheels [rad], real then imaginary parts.

    Scaled to a largest displacement of 1 m at the corners of the parts.
    """
    moves = [np.append(body.moves(mode.shape), _turns(structure, body.name, mode)) for body in structure.bodies]
    sizes = {part["name"]: np.linalg.norm(part["half"]) for part in _parts(structure)}
    most = max(
        float(np.linalg.norm(move[:3]) + sizes[body.name] * np.linalg.norm(move[3:6]))
        for body, move in zip(structure.bodies, moves, strict=True)
    )
    scale = 1.0 / most if most > 0.0 else 0.0
    return [_rounded(np.concatenate([scale * move.real, scale * move.imag])) for move in moves]


def _turns(structure: Structure, body: str, mode: Mode) -> Shape:
    """Angles by which the left and right wheel of a body swing, pitching nose up counted like its pitch [rad]."""
    found = {"left": 0.0 + 0.0j, "right": 0.0 + 0.0j}
    for wheel in structure.spec.get("wheels", ()):
        if wheel["body"] == body and mode.eigenvalue != 0.0:
            place, _ = structure.rotors[f"{body}.{wheel['rotor']}"]
            found[wheel["side"]] = complex(-mode.shape[place] / mode.eigenvalue)
    return np.array([found["left"], found["right"]])


def _rounded(values: np.ndarray[Any, Any]) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") if abs(value) > 1e-6 else 0.0 for value in values]
