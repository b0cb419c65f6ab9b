"""Blocks that sensors are made of, in runs and in linear models: they repeat, and steady states do not see them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import klingel as kl
from klingel.control import Composed, Diagram, Timing

MEASURED = "bogie1.wheelset1.left.spin_speed"
COMMAND = "bogie1.wheelset1.actuator_left.force"


@dataclass(frozen=True, kw_only=True)
class Sensed(Composed):
    """Pushes by a force that follows a wheel's speed, measured with errors or without."""

    timing: Timing = Timing(1e-3, 0, 0)  # noqa: RUF009, immutable
    seed: int | None = 3

    def build(self, d: Diagram, vehicle: kl.Vehicle, track: kl.Track, speed: float) -> None:
        signal = d.measure(MEASURED)
        if self.seed is not None:
            noisy = d.sum("noisy", {signal: 1.0, d.noise("noise", 0.02, self.seed): 1.0})
            signal = d.hold("held", d.quantise("rounded", noisy, 0.01), 5)
        d.probe("measured", "rad/s", signal)
        d.command(COMMAND, d.sum("force", {signal: 10.0}))


def scenario(seed: int | None, duration: float = 1.0) -> kl.Scenario:
    vehicle = kl.library.vehicle("trailed_irw")
    track = kl.Track.straight("500 m")
    return kl.Scenario(vehicle, track, speed="40 m/s", control=Sensed(seed=seed), duration=duration)


def test_a_run_measures_what_the_blocks_make_of_it_and_repeats_bit_by_bit() -> None:
    run = kl.simulate(scenario(3))
    # a run begins as if it had always been steady: errors come with the first sample that the hold takes, the fifth
    measured, true = run["measured"].to_numpy()[5:-1], run[MEASURED].to_numpy()[5:-1]
    np.testing.assert_allclose(measured, 0.01 * np.round(measured / 0.01), atol=1e-9)
    held = measured.reshape(-1, 5)
    assert (held == held[:, :1]).all()
    errors = (measured - true)[::5]
    # 199 draws: their standard deviation is known to 5 %, rounding adds 0.01/sqrt(12)
    expected = np.hypot(0.02, 0.01 / np.sqrt(12.0))
    assert 0.8 * expected < errors.std() < 1.2 * expected
    assert abs(errors.mean()) < 4.0 * expected / np.sqrt(len(errors))
    again = kl.simulate(scenario(3))
    assert all(run[name].equals(again[name]) for name in run.data_vars)
    other = kl.simulate(scenario(4))["measured"].to_numpy()[5:-1] - true
    assert abs(np.corrcoef(errors, other[::5])[0, 1]) < 0.3


def test_a_linear_model_has_the_mean_of_the_hold_and_neither_noise_nor_steps() -> None:
    plain, sensed = (kl.linearise(scenario(seed)) for seed in (None, 3))
    np.testing.assert_allclose(sensed.y, plain.y, atol=1e-9, rtol=1e-9)
    slow = np.exp(2j * np.pi * 0.5 * 1e-3)
    responses = [m.C @ np.linalg.solve(slow * np.eye(len(m.A)) - m.A, m.B) + m.D for m in (plain, sensed)]
    scale = np.abs(responses[0]).max(axis=1, keepdims=True) + 1e-300
    # two samples of lag at 0.5 Hz
    np.testing.assert_allclose(responses[1] / scale, responses[0] / scale, atol=0.01)
