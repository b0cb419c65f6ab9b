"""Margins of the default gains on the full linear vehicle, each loop opened alone and all others closed; conicity.
Figures of every speed are in docs/theory/control.md."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import klingel as kl
from klingel.control import IRWLike, SolidLike
from klingel.control.basics import WHEELSETS, Timing
from klingel.linear.margins import margins
from klingel.linear.model import LinearModel
from klingel.linear.parameters import replace
from klingel.linear.random import continuous_poles
from klingel.linear.response import all_outputs, points
from klingel.scenario import Scenario

FREQUENCIES = np.unique(np.concatenate([np.geomspace(0.05, 450.0, 250), np.geomspace(0.5, 4.0, 80)]))
STRATEGIES = {"solid": SolidLike(), "gyro": IRWLike(), "database": IRWLike(curvature="database")}
INDUCTION = kl.library.drive("induction_160kw")

Loops = dict[str, list[NDArray[np.complex128]]]


def scenario(name: str, speed: float) -> Scenario:
    vehicle = kl.library.vehicle("mechatronic_irw")
    return Scenario(vehicle, kl.Track.straight("1 km"), speed=speed / 3.6, control=STRATEGIES[name])


def loops(model: LinearModel) -> Loops:
    """L of the steering and of the motors of every wheelset; the sum of what is sent and what is added is u/(1 + L)."""
    pairs = {
        "steering": ("actuator_left.force", "actuator_right.force", "actuator_left.command", "actuator_right.command"),
        "motors": ("left.armature_voltage", "right.armature_voltage") * 2,
    }
    if not any(i.name.endswith("armature_voltage") for i in model.inputs):
        pairs["motors"] = ("left.torque_command", "right.torque_command") * 2
    rows: dict[str, list[tuple[str, ...]]] = {
        kind: [tuple(f"{w.name}.{signal}" for signal in signals) for w in WHEELSETS] for kind, signals in pairs.items()
    }
    every = [names for kind in rows for names in rows[kind]]
    inputs = [name for names in every for name in names[:2]]
    chosen = model.select(inputs=inputs, outputs=[name for names in every for name in names[2:]])
    u = np.zeros((len(inputs), len(FREQUENCIES), len(every)), dtype=np.complex128)
    for k in range(len(every)):
        u[2 * k, :, k], u[2 * k + 1, :, k] = 1.0, -1.0
    sent = all_outputs(chosen, points(chosen, FREQUENCIES), u)
    found = [2.0 / (sent[2 * k, :, k] - sent[2 * k + 1, :, k]) - 1.0 for k in range(len(every))]
    return {"steering": found[: len(WHEELSETS)], "motors": found[len(WHEELSETS) :]}


def delay_margin(L: NDArray[np.complex128]) -> float:
    """Least delay [s] that brings a crossing of |L| = 1 to -1."""
    size, angle = np.log(np.abs(L)), np.unwrap(np.angle(L))
    i = np.flatnonzero(size[:-1] * size[1:] < 0.0)
    share = size[i] / (size[i] - size[i + 1])
    f = FREQUENCIES[i] + share * (FREQUENCIES[i + 1] - FREQUENCIES[i])
    room = np.mod(angle[i] + share * (angle[i + 1] - angle[i]) + np.pi, 2.0 * np.pi)
    return float(np.min(room / (2.0 * np.pi * f), initial=np.inf))


def least(found: list[NDArray[np.complex128]]) -> tuple[float, float, float]:
    """Least gain margin, phase margin [degrees] and delay margin [ms] of several loops."""
    each = [margins(L, FREQUENCIES) for L in found]
    phase = np.degrees(min(m.phase for m in each))
    return min(m.gain for m in each), float(phase), 1e3 * min(delay_margin(L) for L in found)


@pytest.mark.parametrize("speed", [108.0, 140.0, 176.0, 216.0, 265.0])
@pytest.mark.parametrize("name", STRATEGIES)
def test_margins_on_the_full_vehicle(name: str, speed: float) -> None:
    """With room to the figures that are asked for: 2, 50 ms; 2, 45 degrees, 10 ms."""
    found = loops(kl.linearise(scenario(name, speed)))
    gain, phase, delay = least(found["steering"])
    assert gain > 2.4
    assert phase > 22.0
    if name != "database":  # at low speed its loop crosses one again where the wheelset yaws on its springs
        assert delay > 60.0
    gain, phase, delay = least(found["motors"])
    assert gain > 2.6
    assert phase > 47.0
    assert delay > 20.0


@pytest.mark.parametrize("speed", [108.0, 265.0])
def test_margins_with_induction_motors(speed: float) -> None:
    of = scenario("solid", speed)
    found = loops(kl.linearise(of.replace(vehicle=of.vehicle.replace(drive=INDUCTION))))
    assert least(found["steering"])[0] > 2.5
    gain, phase, delay = least(found["motors"])
    assert gain > 2.2
    assert phase > 45.0
    assert delay > 20.0


@pytest.mark.parametrize("conicity", [0.05, 0.35])
@pytest.mark.parametrize("name", STRATEGIES)
def test_straight_track_is_stable_at_any_conicity(name: str, conicity: float) -> None:
    for speed in (108.0, 176.0, 265.0):
        assert damping(replace(scenario(name, speed), "conicity", conicity)) > 0.04


@pytest.mark.parametrize("name", STRATEGIES)
def test_every_corner_of_conicity_and_friction_is_stable_on_the_straight_and_in_the_arcs(name: str) -> None:
    found = kl.design.check(scenario(name, 108.0), conicities=(0.05, 0.4), frictions=(0.3, 0.5))
    assert len(found.table) == 30
    assert found.stable, found.words()
    assert found.table["damping"].min() > 0.008


@pytest.mark.parametrize("speed", [20.0, 45.0, 70.0])
@pytest.mark.parametrize("name", STRATEGIES)
def test_low_speeds_are_damped(name: str, speed: float) -> None:
    assert damping(scenario(name, speed)) > 0.04


def test_gyro_steering_bears_30_ms_more_in_every_sensor() -> None:
    """Through a short curve of R = 800 m: the wheelsets stay far from their flanges."""
    late = IRWLike(timing=Timing(sensor_samples=31))
    curve = kl.Track.curve(
        radius=800.0, cant=0.16, transition=195.0, arc=50.0, straight_before=50.0, straight_after=60.0
    )
    run = kl.simulate(
        Scenario(kl.library.vehicle("mechatronic_irw"), curve, speed="176 km/h", control=late, step="1 ms")
    )
    assert run.attrs["outcome"] == "completed"
    assert max(float(np.abs(run[f"{w.name}.y"]).max()) for w in WHEELSETS) < 2.5e-3


def damping(of: Scenario) -> float:
    """Least damping ratio of the oscillations of 0.1 to 50 Hz."""
    s = continuous_poles(kl.linearise(of))
    s = s[(s.imag > 2.0 * np.pi * 0.1) & (s.imag < 2.0 * np.pi * 50.0)]
    return float(np.min(-s.real / np.abs(s)))
