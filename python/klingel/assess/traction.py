"""Traction and braking of one run: what the motors did, what was left for steering, how far the wheels slipped.
Every figure over the whole run, magnitudes positive."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from klingel.assess.flange import flange_contact
from klingel.assess.header import header_of, values
from klingel.assess.signals import Signal

CREEPAGE_SPEED = 2.0
"""Creepages are read above this speed [m/s]; below it the slip speed tells more."""

SIDES = ("left", "right")

GROWTH_WINDOW = 0.25
"""Quarters of a passage through a patch are compared if they last longer [s]."""

STEADY_SPREAD = 5e-4
"""Creepage that swings by less has no oscillation to speak of [-]."""

CENTRED = 1e-3
"""A wheelset nearer to the middle runs centred [m]."""

GRIPS = 0.005
"""A wheel with less creepage grips [-]."""


@dataclass(frozen=True)
class TractionFigures:
    """One row of the traction study.

    Attributes:
        run: its name.
        speed_start_kmh, speed_end_kmh: of the body.
        distance_m: that the body ran.
        acceleration_max_mps2, deceleration_max_mps2: of the body along the track, means over 0.5 s.
        torque_max_Nm: largest mean torque of a pair of wheels, at the wheel.
        armature_current_max_A: of any motor.
        voltage_max_V: largest armature voltage of any motor.
        headroom_min_V: least of VaMax less the mean voltage of a pair of motors, what is left for steering.
        steering_voltage_max_V: largest |u| of Eqs (22, 23).
        creepage_max: largest longitudinal creepage of any wheel above 2 m/s.
        slip_speed_max_mps: largest of r0 w - V of any wheel.
        y_max_mm: largest lateral displacement of any wheelset.
        flange_contact: `root`, `flange` or empty, as in the curving assessment.
        actuator_force_max_kN: of any steering actuator.
        outcome: `completed`, or what ended the run, where and when.
        realtime_factor: simulated seconds over CPU seconds.
    """

    run: str
    speed_start_kmh: float
    speed_end_kmh: float
    distance_m: float
    acceleration_max_mps2: float
    deceleration_max_mps2: float
    torque_max_Nm: float
    armature_current_max_A: float
    voltage_max_V: float
    headroom_min_V: float
    steering_voltage_max_V: float
    creepage_max: float
    slip_speed_max_mps: float
    y_max_mm: float
    flange_contact: str
    actuator_force_max_kN: float
    outcome: str
    realtime_factor: float

    def row(self) -> dict[str, float | str]:
        """The columns of the table, in its order."""
        return {each.name: getattr(self, each.name) for each in fields(self)}


def traction(result: xr.Dataset, *, name: str = "", radius: float) -> TractionFigures:
    """Assess a run of a driven vehicle.

    Args:
        result: a run as `klingel.simulate` returns it, of a strategy with a traction loop and DC motors.
        name: of the row; that of the spec if empty.
        radius: of the wheels [m].

    Returns:
        One row.

    Raises:
        InputError: a channel or attribute is missing.
    """
    header = header_of(result)
    time = np.asarray(result["time"].values, dtype=np.float64)
    interval = float(time[1] - time[0])
    speed = values(result, "body.speed")
    whole = {w.name: np.ones(len(time), dtype=bool) for w in header.wheelsets}
    wheels = [wheel for w in header.wheelsets for wheel in (w.left, w.right)]
    largest = json.loads(result.attrs["spec"])["drives"][0]["armature_voltage_max"]

    def pair(quantity: str, wheelset: str) -> Signal:
        return 0.5 * (values(result, f"{wheelset}.left.{quantity}") + values(result, f"{wheelset}.right.{quantity}"))

    def most(quantity: str, names: list[str]) -> float:
        return max(float(np.abs(values(result, f"{each}.{quantity}")).max()) for each in names)

    sets = [w.name for w in header.wheelsets]
    rolling = speed > CREEPAGE_SPEED
    acceleration = _mean_slope(speed, interval)
    return TractionFigures(
        run=name or header.name,
        speed_start_kmh=3.6 * float(speed[0]),
        speed_end_kmh=3.6 * float(speed[-1]),
        distance_m=float(values(result, "body.s")[-1] - values(result, "body.s")[0]),
        acceleration_max_mps2=float(max(acceleration.max(), 0.0)),
        deceleration_max_mps2=float(max(-acceleration.min(), 0.0)),
        torque_max_Nm=max(float(np.abs(pair("shaft_torque", each)).max()) for each in sets),
        armature_current_max_A=most("armature_current", wheels),
        voltage_max_V=most("armature_voltage", wheels),
        headroom_min_V=min(float((largest - np.abs(pair("armature_voltage", each))).min()) for each in sets),
        steering_voltage_max_V=most("steering_voltage", sets),
        creepage_max=max(
            float(np.abs(values(result, f"{wheel}.creep_x")[rolling]).max(initial=0.0)) for wheel in wheels
        ),
        slip_speed_max_mps=max(
            float(np.abs(radius * values(result, f"{wheel}.spin_speed") - speed).max()) for wheel in wheels
        ),
        y_max_mm=1e3 * most("y", sets),
        flange_contact=flange_contact(result, header.wheelsets, whole, interval),
        actuator_force_max_kN=1e-3
        * most("force", [f"{each}.actuator_{side}" for each in sets for side in ("left", "right")]),
        outcome=header.outcome,
        realtime_factor=header.realtime_factor,
    )


def _mean_slope(signal: Signal, interval: float, over: float = 0.5) -> Signal:
    """Mean slope of a signal over a time [s]."""
    n = max(1, min(round(over / interval), len(signal) - 1))
    return (signal[n:] - signal[:-n]) / (n * interval)


@dataclass(frozen=True)
class PatchFigures:
    """Passage of a vehicle over a patch of low adhesion.

    Attributes:
        creepage_max: largest |longitudinal creepage| of any wheel from its entry into the patch on.
        recovery_s: how long after it left the patch a wheelset last gave less than 90 % of the torque asked or slipped
            with more than 0.5 % creepage, the longest.
        growth: largest ratio of the swing of creepage (its standard deviation about a straight line) in the last
            quarter of a wheel's time in the patch over that in the second quarter: above one something grows.
        centred_s: how long after it left the patch a wheelset was last more than 1 mm off the middle, the longest.
    """

    creepage_max: float
    recovery_s: float
    growth: float
    centred_s: float


def patch(result: xr.Dataset, begin: float, end: float) -> PatchFigures:
    """What slip control made of a patch between two positions [m].

    Args:
        result: a run that entered the patch.
        begin: arc length where the patch begins [m].
        end: arc length where it ends [m].

    Returns:
        The figures over all wheels.

    Raises:
        InputError: a channel is missing.
    """
    header = header_of(result)
    time = np.asarray(result["time"].values, dtype=np.float64)
    interval = float(time[1] - time[0])
    creepages, recoveries, growths, centred = [0.0], [0.0], [0.0], [0.0]
    asked = values(result, "traction.torque_asked")
    for wheelset in header.wheelsets:
        s = values(result, f"{wheelset.name}.s")
        inside, after = (s >= begin) & (s <= end), s > end
        given = values(result, f"{wheelset.name}.torque_asked")
        slips = np.zeros(len(time), dtype=bool)
        for wheel in (wheelset.left, wheelset.right):
            creepage = values(result, f"{wheel}.creep_x")
            creepages.append(float(np.abs(creepage[inside | after]).max(initial=0.0)))
            slips |= np.abs(creepage) > GRIPS
            within = creepage[inside]
            quarter = len(within) // 4
            if quarter * interval > GROWTH_WINDOW:
                early, late = (_swing(part) for part in (within[quarter : 2 * quarter], within[-quarter:]))
                growths.append(late / max(early, STEADY_SPREAD))
        lacking = after & (slips | (np.abs(given) < 0.9 * np.abs(asked)))
        if lacking.any():
            recoveries.append(float(time[lacking][-1] - time[after][0]))
        off = after & (np.abs(values(result, f"{wheelset.name}.y")) > CENTRED)
        if off.any():
            centred.append(float(time[off][-1] - time[after][0]))
    return PatchFigures(max(creepages), max(recoveries), max(growths), max(centred))


def _swing(signal: Signal) -> float:
    """Standard deviation about the straight line that fits best."""
    place = np.arange(len(signal))
    return float(np.std(signal - np.polyval(np.polyfit(place, signal, 1), place)))
