"""A name for a mode from what moves in it: body bounce, lower sway, bogie hunting, axle wind-up, motor and shaft ...
A guess from energies and phases, for people to read; nothing is computed from it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from klingel.linear.shapes import Body, Shape, Structure

DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")

ROLLS = 0.35
"""Hunting: the lateral velocity of a wheelset is its speed times its yaw, to this share of their squares."""

SIDEWAYS = ("y", "yaw", "roll")

WITHIN = {"controller": 0.6}
"""Share of a kind of inner states from which a mode is called after it; half for the other kinds."""

HOLDS = 0.2
"""Share of the speed hold's integral from which a motion along the track is that of the hold."""

PHASE = 0.7
"""Cosine of the angle up to which two bodies swing in phase or in antiphase; nothing is said between."""

SAME = 0.02
"""Relative distance of eigenvalues up to which modes of one name are a group, as those of the two bogies are."""

ALONE = 0.85
"""One of two bogies or wheelsets leads a mode with this share of their energy."""


@dataclass(frozen=True)
class Guess:
    """What a name is guessed from: eigenvalue s, shape, shares of kinds of states and of states, kinetic energies."""

    structure: Structure
    s: complex
    shape: Shape
    parts: Mapping[str, float]
    participation: NDArray[np.float64]
    kinetic: Mapping[str, float]

    @property
    def oscillates(self) -> bool:
        """Whether it swings visibly: below a damping ratio of 0.995."""
        return abs(self.s.imag) > 0.1 * abs(self.s)

    @cached_property
    def kinds(self) -> Mapping[str, list[Body]]:
        """Car body, bogies, wheelsets of a vehicle; for another spec, its bodies by their names."""
        kinds: dict[str, list[Body]] = {}
        wheels = {wheel["body"] for wheel in self.structure.spec.get("wheels", ())}
        for body in self.structure.bodies:
            word = body.name.rpartition(".")[2].rstrip("0123456789") or body.name
            kind = "wheelset" if body.name in wheels else word
            kinds.setdefault(kind, []).append(body)
        return kinds

    @cached_property
    def energies(self) -> Mapping[str, Mapping[str, float]]:
        """Kinetic energy by kind of body and direction; spin: of wheels, motor: of motors."""
        found: dict[str, dict[str, float]] = {}
        for kind, bodies in self.kinds.items():
            total = sum((body.energies(self.shape) for body in bodies), start=np.zeros(6))
            found[kind] = {d: float(e) for d, e in zip(DIRECTIONS, total, strict=True)}
        own = {body.name for body in self.structure.bodies}
        others = {name: energy for name, energy in self.kinetic.items() if name not in own}
        found["wheels"] = {"spin": sum(e for n, e in others.items() if not n.endswith(".motor"))}
        found["motors"] = {"spin": sum(e for n, e in others.items() if n.endswith(".motor"))}
        return found

    def lead(self) -> tuple[str, str]:
        """The kind of body and the direction that carry most energy."""
        kind = max(self.energies, key=lambda k: sum(self.energies[k].values()))
        return kind, max(self.energies[kind], key=lambda d: self.energies[kind][d])

    def rolls(self) -> bool:
        """Whether the wheelsets run where they point, y' = V yaw, as in hunting."""
        sliding, size = 0.0, 0.0
        for body in self.kinds.get("wheelset", []):
            move = body.moves(self.shape)
            y_rate, ahead = self.s * move[1], self.structure.model.speed * move[5]
            sliding += abs(y_rate - ahead) ** 2
            size += abs(y_rate) ** 2 + abs(ahead) ** 2
        return size > 0.0 and sliding < ROLLS * size

    def swings_beside(self) -> bool:
        """Whether the wheelsets move further sideways than the car body above the bogies."""
        if "body" not in self.kinds:
            return True
        body = self.kinds["body"][0]
        y, yaw = body.moves(self.shape)[[1, 5]]
        middle = self.structure.model.x[body.at[0]]
        sets = self.kinds.get("wheelset", [])
        below = sum(abs(each.moves(self.shape)[1]) ** 2 for each in sets)
        above = sum(abs(y + yaw * (self.structure.model.x[each.at[0]] - middle)) ** 2 for each in sets)
        return bool(below > above)

    def follows(self) -> bool:
        """Whether the wheelsets yaw with their bogies rather than against them."""
        of = {body.name: body for body in self.structure.bodies}
        relative, size = 0.0, 0.0
        for body in self.kinds.get("wheelset", []):
            frame = of.get(body.name.rpartition(".")[0])
            if frame is None:
                return False
            yaw, yaw_frame = body.moves(self.shape)[5], frame.moves(self.shape)[5]
            relative += abs(yaw - yaw_frame) ** 2
            size += abs(yaw) ** 2
        return relative < 0.5 * size

    def solid(self) -> bool:
        """Whether both wheels of an axle turn together."""
        rotors = {(wheel["body"], wheel["rotor"]) for wheel in self.structure.spec.get("wheels", ())}
        return len(rotors) == len({body for body, _ in rotors})


def guess(mode: Guess) -> str:
    """The name of a mode."""
    inner = {name: share for name, share in mode.parts.items() if name not in ("bodies", "rotors")}
    part = max(inner, key=lambda name: inner[name], default="")
    least = WITHIN.get(part, 0.5)
    if part and inner[part] > least and not (part == "drives" and mode.oscillates):
        return _inner(mode, part)
    kind, direction = mode.lead()
    if direction == "x" and mode.parts.get("hold", 0.0) > HOLDS:
        return "speed hold"
    if not mode.oscillates:
        return f"{_mechanical(mode, kind, direction)}, overdamped"
    return _mechanical(mode, kind, direction)


def _inner(mode: Guess, part: str) -> str:
    """Of a mode that lives in states which are no motion."""
    places = mode.structure.groups[part]
    most = mode.structure.model.states[int(places[np.argmax(mode.participation[places])])].name
    match part:
        case "controller":
            return f"controller, {block(most)}"
        case "dampers":
            return f"relaxation of {plain(most.removesuffix('.force'))}"
        case _:
            return {"hold": "speed hold", "actuators": "steering actuator", "drives": "motor"}[part]


def block(state: str) -> str:
    """The block of a controller's state, wherever in the vehicle it is.

    >>> block("control.bogie1.wheelset2.gyro.slow.0"), block("bogie1.wheelset1.actuator_left.force.put_out")
    ('gyro slow', 'force put out')
    """
    words = state.removeprefix("control.").split(".")
    of_vehicle = re.compile(r"(bogie|wheelset)\d|body|left|right|(yaw_)?actuator_.*|now|\d+")
    return " ".join(word.replace("_", " ") for word in words if not of_vehicle.fullmatch(word)) or state


def _mechanical(mode: Guess, kind: str, direction: str) -> str:
    if direction in SIDEWAYS and mode.oscillates and mode.rolls() and mode.swings_beside():
        return _running(mode)
    match kind, direction:
        case "body", _:
            return _car_body(mode, direction)
        case "wheels" | "motors", _:
            return _spinning(mode, kind)
        case (("bogie" | "wheelset"), ("y" | "yaw")) if mode.rolls():
            word = "hunting" if mode.solid() else "steering"
            whole = kind == "bogie" or mode.follows()
            return f"{'bogie' if whole else 'wheelset'} {word}{_which(mode, 'bogie' if whole else 'wheelset')}"
        case "wheelset", "pitch":
            return f"axle wind-up{_which(mode, 'wheelset')}"
        case _:
            words = {"x": "surge", "y": "lateral", "z": "bounce"}
            return f"{kind} {words.get(direction, direction)}{_which(mode, kind)}"


def _running(mode: Guess) -> str:
    """Of wheelsets that run sideways where they point: hunting; steering where the wheels turn independently."""
    word = "hunting" if mode.solid() else "steering"
    kind = "bogie" if mode.follows() else "wheelset"
    return f"{kind} {word}{_which(mode, kind)}"


def _car_body(mode: Guess, direction: str) -> str:
    words = {"x": "body surge", "z": "body bounce", "pitch": "body pitch", "yaw": "body yaw"}
    if direction in words:
        return words[direction]
    move = mode.kinds["body"][0].moves(mode.shape)
    # rolling about an axis below the centre of mass carries that to the side which sinks: y and roll have one sign
    return "lower sway" if (move[1] * np.conj(move[3])).real >= 0.0 else "upper sway"


def _spinning(mode: Guess, kind: str) -> str:
    """Wheels and motors: torsion of the shafts when they turn against each other."""
    twists = [i for name, i in mode.structure.places.items() if name.endswith(".shaft_twist")]
    if kind == "motors" or (twists and mode.oscillates and abs(mode.s) > 30.0):
        return f"motor and shaft torsion{_which(mode, 'wheelset')}" if mode.oscillates else "motor"
    return f"wheel spin{_which(mode, 'wheelset')}"


def _which(mode: Guess, kind: str) -> str:
    """Which of several bodies leads, or how two of them move against each other."""
    bodies = mode.kinds.get(kind, [])
    energies = {body.name: _with_spin(mode, body) for body in bodies}
    total = sum(energies.values())
    if len(bodies) < 2 or not total > 0.0:
        return ""
    if kind == "wheelset":
        bogies = _summed(energies, lambda name: name.rpartition(".")[0])
        name = _alone(energies, total) or _alone(bogies, total)
        return f", {_spoken(name)}" if name else ""
    name = _alone(energies, total)
    if name:
        return f", {_spoken(name)}"
    if len(bodies) == 2:
        first, second = (body.moves(mode.shape) for body in bodies)
        place = int(np.argmax(bodies[0].energies(mode.shape) + bodies[1].energies(mode.shape)))
        product = complex(first[place] * np.conj(second[place]))
        if abs(product.real) > PHASE * abs(product):
            return ", in phase" if product.real > 0.0 else ", in antiphase"
    return ""


def _with_spin(mode: Guess, body: Body) -> float:
    return sum(e for name, e in mode.kinetic.items() if name == body.name or name.startswith(f"{body.name}."))


def _summed(energies: Mapping[str, float], key: object) -> dict[str, float]:
    assert callable(key)
    found: dict[str, float] = {}
    for name, energy in energies.items():
        found[key(name)] = found.get(key(name), 0.0) + energy
    return found


def _alone(energies: Mapping[str, float], total: float) -> str:
    name = max(energies, key=lambda n: energies[n])
    return name if energies[name] > ALONE * total and len(energies) > 1 else ""


def _spoken(name: str) -> str:
    """`bogie1.wheelset2` as people say it."""
    words = {"bogie1": "front bogie", "bogie2": "rear bogie"}
    numbers = {"wheelset1": "its first wheelset", "wheelset2": "its second wheelset"}
    return ", ".join(words.get(part, numbers.get(part, part)) for part in name.split("."))


def numbered(names: Sequence[str], eigenvalues: ArrayLike) -> tuple[str, ...]:
    """Names with a number, by frequency, where different modes would share one; numbers that they had are forgotten.

    Modes of one name and nearly one eigenvalue [1/s] are a group, and keep one name; eigenvalues (n), or (n, k) of
    branches over a parameter, NaN where they are not, which are then to be near everywhere.

    >>> numbered(["sway", "surge", "surge", "surge"], [-1 + 5j, -2 + 59j, -1 + 47j, -1 + 47.1j])
    ('sway', 'surge #2', 'surge #1', 'surge #1')
    """
    bare = [name.partition(" #")[0] for name in names]
    s = np.asarray(eigenvalues, dtype=np.complex128).reshape(len(bare), -1)
    mean = np.nanmean(s, axis=1)
    groups: dict[str, list[int]] = {}
    places = dict.fromkeys(range(len(bare)), 0)
    for k in sorted(places, key=lambda i: (abs(mean[i].imag), -mean[i].real)):
        seen = groups.setdefault(bare[k], [])
        same = (place for place, other in enumerate(seen) if not (abs(s[k] - s[other]) >= SAME * abs(s[k])).any())
        places[k] = next(same, len(seen))
        if places[k] == len(seen):
            seen.append(k)
    return tuple(f"{name} #{places[k] + 1}" if len(groups[name]) > 1 else name for k, name in enumerate(bare))


def plain(element: str) -> str:
    """Kind of an element: `bogie1.yaw_damper_left` is a yaw damper.

    >>> plain("bogie1.wheelset2.primary_damper_x_left")
    'primary damper x'
    """
    return element.rpartition(".")[2].removesuffix("_left").removesuffix("_right").replace("_", " ")


def by_kind(shares: Mapping[str, float]) -> dict[str, float]:
    """Shares of elements summed over those of one kind, the largest first."""
    summed = _summed(shares, plain)
    return dict(sorted(summed.items(), key=lambda item: -abs(item[1])))
