"""What a result says about itself: the spec it was made from and how the run ended.
The only file of the assessment that knows how the header is laid out."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from klingel.assess.signals import Signal
from klingel.errors import InputError, nearest


@dataclass(frozen=True)
class Course:
    """Where the one curve of a track lies, in arc length of the track [m].

    Attributes:
        begin: first transition starts.
        arc_begin: the circular arc starts.
        arc_end: the circular arc ends.
        end: last transition ends.
        curvature: of the arc [1/m], positive in a right-hand curve.
        cant: of the arc [m], positive where the left rail is higher.
        cant_base: lateral distance over which cant is measured [m].
    """

    begin: float
    arc_begin: float
    arc_end: float
    end: float
    curvature: float
    cant: float
    cant_base: float

    def unbalanced_acceleration(self, speed: float, gravity: float) -> float:
        """Lateral acceleration in the arc that cant leaves over, along the canted track plane.

        a = V^2 rho cos(phi) - g sin(phi), sin(phi) = cant / cant_base.

        Args:
            speed: running speed [m/s].
            gravity: [m/s2].

        Returns:
            [m/s2], positive towards the right rail's side of the accelerometer (right-hand curve with deficiency).

        Example:
            >>> arc = Course(90.0, 210.0, 390.0, 510.0, 1 / 300, 0.16, 1.5)
            >>> round(arc.unbalanced_acceleration(30.0, 9.81), 3)
            1.936
        """
        sine = self.cant / self.cant_base
        return speed**2 * self.curvature * math.sqrt(1.0 - sine**2) - gravity * sine


@dataclass(frozen=True)
class Wheelset:
    """Channel names of one wheelset: its own and those of its left and right wheel."""

    name: str
    left: str
    right: str


@dataclass(frozen=True)
class Header:
    """The parts of a result's header that the assessment uses.

    Attributes:
        name: of the spec.
        outcome: "completed", or what happened, where and when.
        notes: what a reader of the numbers should know, mostly nothing.
        realtime_factor: simulated seconds over CPU seconds of the stepping thread [-].
        mass: of the whole vehicle [kg].
        speed: that the run was asked for [m/s].
        gravity: [m/s2].
        friction: coefficient of the first wheel [-].
        track: as in the spec.
        wheelsets: in the order of the vehicle.
        static_wheel_loads: vertical load per wheel at rest on straight level track [N], empty if not recorded.
    """

    name: str
    outcome: str
    notes: str
    realtime_factor: float
    mass: float
    speed: float
    gravity: float
    friction: float
    track: Mapping[str, Any]
    wheelsets: tuple[Wheelset, ...]
    static_wheel_loads: Mapping[str, float]

    @property
    def course(self) -> Course:
        """The one curve of the track; errors: InputError if it has none or several."""
        return course_of(self.track)


def course_of(track: Mapping[str, Any]) -> Course:
    """Find the one curve of a track.

    Args:
        track: the `track` part of a spec: segments with `length` [m], `curvature` [1/m] and `cant` [m] as
            (start, end) pairs, and `cant_base` [m].

    Returns:
        Its positions, curvature and cant.

    Raises:
        InputError: the track has no arc of constant curvature, or more than one.

    Example:
        >>> straight = {"length": 90.0, "curvature": [0.0, 0.0], "cant": [0.0, 0.0]}
        >>> ramp = {"length": 120.0, "curvature": [0.0, 1 / 300], "cant": [0.0, 0.16]}
        >>> arc = {"length": 180.0, "curvature": [1 / 300, 1 / 300], "cant": [0.16, 0.16]}
        >>> down = {"length": 120.0, "curvature": [1 / 300, 0.0], "cant": [0.16, 0.0]}
        >>> course = course_of({"segments": [straight, ramp, arc, down, straight], "cant_base": 1.5})
        >>> course.begin, course.arc_begin, course.arc_end, course.end
        (90.0, 210.0, 390.0, 510.0)
    """
    segments = track["segments"]
    edges = np.concatenate(([0.0], np.cumsum([segment["length"] for segment in segments])))
    curved = [i for i, segment in enumerate(segments) if any(segment["curvature"]) or any(segment["cant"])]
    arcs = [i for i in curved if segments[i]["curvature"][0] == segments[i]["curvature"][1] != 0.0]
    if len(arcs) != 1:
        raise InputError.single(
            "track.segments",
            len(segments),
            f"a curving assessment needs exactly one arc of constant curvature, this track has {len(arcs)}",
            remedy="use Track.curve, or cut the track",
        )
    arc = segments[arcs[0]]
    return Course(
        begin=float(edges[curved[0]]),
        arc_begin=float(edges[arcs[0]]),
        arc_end=float(edges[arcs[0] + 1]),
        end=float(edges[curved[-1] + 1]),
        curvature=float(arc["curvature"][0]),
        cant=float(arc["cant"][0]),
        cant_base=float(track["cant_base"]),
    )


def wheelsets_of(wheels: list[Mapping[str, Any]]) -> tuple[Wheelset, ...]:
    """Pair the wheels of a spec by the body that carries them.

    Args:
        wheels: the `wheels` part of a spec: `name`, `body` and `side` of each.

    Returns:
        One wheelset a body, in the order of the spec.

    Example:
        >>> wheels_of_one = [{"name": f"b.w.{side}", "body": "b.w", "side": side} for side in ("left", "right")]
        >>> wheelsets_of(wheels_of_one)
        (Wheelset(name='b.w', left='b.w.left', right='b.w.right'),)
    """
    sides: dict[str, dict[str, str]] = {}
    for wheel in wheels:
        sides.setdefault(wheel["body"], {})[wheel["side"]] = wheel["name"]
    return tuple(Wheelset(body, pair["left"], pair["right"]) for body, pair in sides.items())


def header_of(result: xr.Dataset) -> Header:
    """Read the header of a result.

    Args:
        result: one run: attributes `spec` (JSON), `outcome`, `realtime_factor` and, if recorded,
            `static_wheel_loads` (JSON, wheel name to N).

    Returns:
        What the assessment needs of it.

    Raises:
        InputError: an attribute is missing; the message names it.
    """
    missing = [key for key in ("spec", "outcome", "realtime_factor") if key not in result.attrs]
    if missing:
        raise InputError.single(
            "attrs", missing, "the result lacks these attributes", remedy="use a result of klingel.simulate"
        )
    spec = json.loads(result.attrs["spec"])
    return Header(
        name=spec["name"],
        outcome=str(result.attrs["outcome"]),
        notes=str(result.attrs.get("notes", "")),
        realtime_factor=float(result.attrs["realtime_factor"]),
        mass=float(sum(body["mass"] for body in spec["bodies"])),
        speed=float(spec["speed"]),
        gravity=float(spec["gravity"]),
        friction=float(spec["wheels"][0]["friction"]),
        track=spec["track"],
        wheelsets=wheelsets_of(spec["wheels"]),
        static_wheel_loads=json.loads(result.attrs.get("static_wheel_loads", "{}")),
    )


def values(result: xr.Dataset, channel: str) -> Signal:
    """Samples of one channel.

    Args:
        result: one run.
        channel: dotted name, for example `bogie1.wheelset1.y`.

    Returns:
        Its samples in SI.

    Raises:
        InputError: the result has no such channel; the message names it.
    """
    if channel not in result.data_vars:
        raise InputError.single(
            "channel",
            channel,
            "the result has no such channel",
            remedy=nearest(channel, [str(v) for v in result.data_vars]),
        )
    return np.asarray(result[channel].values, dtype=np.float64)
