"""Curving behaviour of one run: the row of figures that the study tabulates.
Every figure is a small function of the signals; its definition and source stand with its field below."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from klingel.assess.flange import CARRYING_FORCE, flange_contact
from klingel.assess.header import Course, Header, Wheelset, header_of, values
from klingel.assess.signals import Mask, Signal, low_pass, sliding_mean
from klingel.errors import InputError

INTERVAL_MAX = 2e-3
"""Longest sample interval [s]: a wheelset rings on its contact springs near 180 Hz, and samples at 200 Hz, as files
have them by default, fold that down to 20 Hz, where no filter removes it (5 % of the lateral force at R = 300 m)."""

SAMPLES_MIN = 3
"""Fewest samples of a run that can be assessed."""
BEFORE_CURVE = 1.0
"""Maxima start this long before the curve [s]."""
AFTER_CURVE = 3.0
"""Maxima end this long after the curve [s]."""
STEADY_PART = 2.0
"""The steady state is read over this last part of the arc [s]."""


@dataclass(frozen=True)
class WheelsetFigures:
    """What one wheelset contributed to an assessment: SI, magnitudes, windows of this wheelset's own position."""

    y_max: float
    y_curve: float
    attack_angle_max: float
    lateral_force_max: float


@dataclass(frozen=True)
class Assessment:
    """One row of the study's summary. Magnitudes are positive; NaN where the vehicle or the run has no such signal.

    Window of every maximum: from 1 s before the wheelset (for `body_...`: the body) enters the first transition to
    3 s after it leaves the last one, or to the end of the run. The arc: while its position lies in the circular arc.

    Attributes:
        vehicle: which vehicle, for example `irw_like`.
        radius_m: of the arc.
        speed_kmh: that the run was asked for.
        y_max_mm: largest lateral displacement of any wheelset's centre from the track's centre line.
        y_curve_mm: largest of the wheelsets' means of that displacement over the last 2 s of the arc.
        attack_angle_max_mrad: largest yaw of any wheelset to the local tangent.
        lateral_force_max_kN: largest sum of Y of the two wheels of any wheelset, 20 Hz low-pass (EN 14363).
        lateral_force_floor_kN: own mass over the number of wheelsets times the unbalanced lateral acceleration.
        wear_index_N: T-gamma, mean of |Fx xi| + |Fy eta| per wheel over the arc and all wheels (J per metre).
        actuator_force_max_kN: largest force of any steering actuator.
        steering_voltage_max_V: largest |u| of Eqs (22, 23) of the paper.
        armature_current_max_A: largest armature current of any motor.
        contact_angle_max_deg: steepest contact patch that carried more than 1 kN.
        yq_max: largest Y/Q of any wheel, Y taken positive where the wheel pushes its rail outwards (left wheel to the
            left, right wheel to the right, the sense in which a flange climbs); 20 Hz low-pass, then the mean over 2 m
            of travel (EN 14363).
        q_min_kN: least vertical wheel force, 20 Hz low-pass (EN 14363); negative only if a wheel were pulled down.
        body_lateral_acc_mps2: largest acceleration of the body's centre of mass along its own lateral axis, as an
            accelerometer reads it, 20 Hz low-pass (EN 14363, quasi-static part included).
        spin_work_N: mean of |Mz phi| per wheel over the arc and all wheels; not part of the wear index.
        flange_contact: `root` or `flange` if a patch steeper than 15 deg carried more than 1 kN for more than 0.1 s
            without a break, `flange` if it was steeper than 60 deg for as long; else empty.
        outcome: `completed`, or what ended the run, where and when.
        notes: what a reader of the numbers should know, mostly nothing.
        realtime_factor: simulated seconds over CPU seconds of the stepping thread.
        wheelsets: the share of each wheelset, by name (not a column).
        after_curve_s: how much of the 3 s behind the curve the run covers for every wheelset (not a column).
        static_wheel_loads: vertical load per wheel at rest [N], empty if not recorded (not a column).
    """

    vehicle: str
    radius_m: float
    speed_kmh: float
    y_max_mm: float
    y_curve_mm: float
    attack_angle_max_mrad: float
    lateral_force_max_kN: float
    lateral_force_floor_kN: float
    wear_index_N: float
    actuator_force_max_kN: float
    steering_voltage_max_V: float
    armature_current_max_A: float
    contact_angle_max_deg: float
    yq_max: float
    q_min_kN: float
    body_lateral_acc_mps2: float
    spin_work_N: float
    flange_contact: str
    outcome: str
    notes: str
    realtime_factor: float
    wheelsets: Mapping[str, WheelsetFigures]
    after_curve_s: float
    static_wheel_loads: Mapping[str, float]

    def row(self) -> dict[str, float | str]:
        """The columns of the summary, in its order."""
        return {name: getattr(self, name) for name in COLUMNS}


COLUMNS = tuple(
    f.name for f in fields(Assessment) if f.name not in ("wheelsets", "after_curve_s", "static_wheel_loads")
)
"""Columns of the summary, in its order."""


@dataclass(frozen=True)
class _Run:
    """A result with its clock and the masks of one body's passage; made once, used by every figure."""

    result: xr.Dataset
    time: Signal
    interval: float

    def window(self, body: str, course: Course) -> Mask:
        entered, left = self._passage(body, course.begin, course.end)
        return np.asarray((self.time >= entered - BEFORE_CURVE) & (self.time <= left + AFTER_CURVE))

    def arc(self, body: str, course: Course) -> Mask:
        s = values(self.result, f"{body}.s")
        return np.asarray((s >= course.arc_begin) & (s <= course.arc_end))

    def steady(self, body: str, course: Course) -> Mask:
        _, left = self._passage(body, course.arc_begin, course.arc_end)
        return np.asarray(self.arc(body, course) & (self.time >= left - STEADY_PART))

    def after(self, body: str, course: Course) -> float:
        _, left = self._passage(body, course.begin, course.end)
        return float(np.clip(self.time[-1] - left, 0.0, AFTER_CURVE))

    def _passage(self, body: str, begin: float, end: float) -> tuple[float, float]:
        """Times at which a body passes two positions; infinite where it does not get there."""
        s = values(self.result, f"{body}.s")
        entered, left = np.interp([begin, end], s, self.time, left=-np.inf, right=np.inf)
        return float(entered), float(left)


def curving(result: xr.Dataset, *, vehicle: str | None = None) -> Assessment:
    """Assess one run through one curve.

    Args:
        result: a run as `klingel.simulate` returns it, channels in SI, recorded at 500 Hz or more.
        vehicle: name for the row; the name of the spec if not given.

    Returns:
        One row of the summary. A run that ended early is assessed as far as it got, with its outcome beside; what it
        did not reach is NaN.

    Raises:
        InputError: a channel or attribute is missing, the track has no single arc, or the samples are too few.

    Source: definitions of the study (project issue 2, item 8); filters of EN 14363; T-gamma as in Perez et al. 2004.
    """
    header = header_of(result)
    time = np.asarray(result["time"].values, dtype=np.float64)
    if len(time) < SAMPLES_MIN:
        raise InputError.single(
            "time", len(time), f"at least {SAMPLES_MIN} samples are needed; the run's outcome: {header.outcome}"
        )
    run = _Run(result, time, float(time[1] - time[0]))
    if run.interval > INTERVAL_MAX * (1.0 + 1e-6):
        raise InputError.single(
            "time",
            run.interval,
            f"samples further apart than {INTERVAL_MAX} s: thinned forces show the wheelsets' ringing as slow motion",
            remedy="assess the run as simulated, or save it with rate=None",
        )
    course = header.course
    windows = {wheelset.name: run.window(wheelset.name, course) for wheelset in header.wheelsets}
    arcs = {wheelset.name: run.arc(wheelset.name, course) for wheelset in header.wheelsets}
    shares = {wheelset.name: _share(run, course, wheelset, windows[wheelset.name]) for wheelset in header.wheelsets}

    def largest(channel: Callable[[Wheelset], Iterable[str]], transform: Callable[[Signal], Signal] = np.abs) -> float:
        """Largest value of channels that every wheelset may or may not have."""
        return _max(
            np.max(transform(values(result, name))[windows[wheelset.name]], initial=-np.inf)
            for wheelset in header.wheelsets
            for name in channel(wheelset)
            if name in result.data_vars
        )

    def filtered(signal: Signal) -> Signal:
        return low_pass(signal, run.interval)

    def mean_in_arc(quantity: str) -> float:
        """Mean over the arc of each wheel, then over all wheels."""
        means = [
            _mean(values(result, f"{wheel}.{quantity}")[arcs[wheelset.name]])
            for wheelset in header.wheelsets
            for wheel in (wheelset.left, wheelset.right)
        ]
        return float(np.mean(means))

    body_window = run.window("body", course)
    body_acceleration = np.abs(filtered(values(result, "body.lateral_acceleration")))
    angle = largest(lambda w: (f"{w.left}.contact_angle", f"{w.right}.contact_angle"))
    return Assessment(
        vehicle=header.name if vehicle is None else vehicle,
        radius_m=round(1.0 / abs(course.curvature), 6),
        speed_kmh=round(header.speed * 3.6, 6),
        y_max_mm=1e3 * _max(share.y_max for share in shares.values()),
        y_curve_mm=1e3 * _max(share.y_curve for share in shares.values()),
        attack_angle_max_mrad=1e3 * _max(share.attack_angle_max for share in shares.values()),
        lateral_force_max_kN=1e-3 * _max(share.lateral_force_max for share in shares.values()),
        lateral_force_floor_kN=1e-3 * lateral_force_floor(header),
        wear_index_N=mean_in_arc("tgamma"),
        actuator_force_max_kN=1e-3
        * largest(lambda w: (f"{w.name}.actuator_left.force", f"{w.name}.actuator_right.force")),
        steering_voltage_max_V=largest(lambda w: (f"{w.name}.steering_voltage",)),
        armature_current_max_A=largest(lambda w: (f"{w.left}.armature_current", f"{w.right}.armature_current")),
        contact_angle_max_deg=math.degrees(angle),
        yq_max=_yq_max(run, header, windows),
        q_min_kN=-1e-3 * largest(lambda w: (f"{w.left}.Q", f"{w.right}.Q"), lambda q: -filtered(q)),
        body_lateral_acc_mps2=_max([np.max(body_acceleration[body_window], initial=-np.inf)]),
        spin_work_N=mean_in_arc("spin_work"),
        flange_contact=flange_contact(result, header.wheelsets, windows, run.interval),
        outcome=header.outcome,
        notes=header.notes,
        realtime_factor=header.realtime_factor,
        wheelsets=shares,
        after_curve_s=min(run.after(wheelset.name, course) for wheelset in header.wheelsets),
        static_wheel_loads=header.static_wheel_loads,
    )


def lateral_force_floor(header: Header) -> float:
    """The lateral force that each wheelset must carry at least if all share alike: own mass / 4 times a_nc [N].

    Example:
        >>> from types import SimpleNamespace
        >>> arc = Course(90.0, 210.0, 390.0, 510.0, 1 / 300, 0.16, 1.5)
        >>> header = SimpleNamespace(course=arc, speed=30.0, gravity=9.81, mass=44482.0, wheelsets=("",) * 4)
        >>> round(lateral_force_floor(header))
        21535
    """
    acceleration = header.course.unbalanced_acceleration(header.speed, header.gravity)
    return abs(header.mass / len(header.wheelsets) * acceleration)


def _share(run: _Run, course: Course, wheelset: Wheelset, window: Mask) -> WheelsetFigures:
    result = run.result
    y = values(result, f"{wheelset.name}.y")
    yaw = values(result, f"{wheelset.name}.yaw")
    force = values(result, f"{wheelset.left}.Y") + values(result, f"{wheelset.right}.Y")
    steady = run.steady(wheelset.name, course)
    return WheelsetFigures(
        y_max=_max([np.max(np.abs(y[window]), initial=-np.inf)]),
        y_curve=abs(_mean(y[steady])),
        attack_angle_max=_max([np.max(np.abs(yaw[window]), initial=-np.inf)]),
        lateral_force_max=_max([np.max(np.abs(low_pass(force, run.interval)[window]), initial=-np.inf)]),
    )


def _yq_max(run: _Run, header: Header, windows: Mapping[str, Mask]) -> float:
    """Largest guiding Y/Q; the quotient is taken of the filtered forces, then averaged over 2 m."""

    def ratio(wheel: str, outwards: float) -> Signal:
        lateral = low_pass(outwards * values(run.result, f"{wheel}.Y"), run.interval)
        vertical = low_pass(values(run.result, f"{wheel}.Q"), run.interval)
        # A lifted wheel guides nothing: below 1 kN the quotient has no meaning, and q_min shows the unloading.
        quotient = np.divide(lateral, vertical, out=np.zeros_like(lateral), where=vertical > CARRYING_FORCE)
        return sliding_mean(quotient, run.interval, header.speed)

    return _max(
        np.max(ratio(wheel, outwards)[windows[wheelset.name]], initial=-np.inf)
        for wheelset in header.wheelsets
        for wheel, outwards in ((wheelset.left, -1.0), (wheelset.right, 1.0))
    )


def _max(numbers: Iterable[float]) -> float:
    """Largest number; NaN where there is none (no such channel, or the run did not reach the window)."""
    largest = max(numbers, default=-math.inf)
    return float(largest) if math.isfinite(largest) else math.nan


def _mean(signal: Signal) -> float:
    return float(np.mean(signal)) if len(signal) else math.nan
