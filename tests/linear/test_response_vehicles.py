"""Responses, reduction, sensitivities of the real vehicles: against the simulator, opened loops, limits of theory."""

import dataclasses

import numpy as np
import pytest

import klingel as kl
from klingel.errors import InputError
from klingel.linear import steady_spec
from klingel.linear.margins import loop_gain, margins
from klingel.linear.measured import measured_response, sampled
from klingel.linear.model import LinearModel
from klingel.linear.parameters import get, replace
from klingel.linear.random import continuous_poles, excitations, random_response
from klingel.linear.reduce import ROUNDING, hankel_values, reduced
from klingel.linear.response import frequency_response, irregularity, positions
from klingel.linear.sensitivity import eigenvalue_sensitivities, steady_sensitivities
from klingel.result import simulate_spec
from klingel.track.irregularity import Course, Quality, synthesise
from klingel.track.spectra import erri_b176

SPEED = 160.0 / 3.6
FIRST = "bogie1.wheelset1"


def coach(speed: float = SPEED) -> kl.Scenario:
    curve = kl.Track.curve(radius="1200 m", cant="100 mm", transition="150 m")
    return kl.Scenario(kl.library.vehicle("manchester_coach"), curve, speed=speed)


def active() -> kl.Scenario:
    vehicle = kl.library.vehicle("mechatronic_irw")
    return kl.Scenario(vehicle, kl.Track.straight("1 km"), speed=SPEED, control=kl.control.SolidLike())


@pytest.fixture(scope="module")
def passive() -> LinearModel:
    return kl.linearise(coach())


@pytest.fixture(scope="module")
def closed() -> LinearModel:
    return kl.linearise(active())


@pytest.fixture(scope="module")
def plant() -> LinearModel:
    return kl.linearise(active(), controllers=False)


def test_long_waves_carry_the_vehicle_along(passive: LinearModel) -> None:
    """Body and wheelsets follow waves of 2 km, the body half the vehicle's axle distance behind the first wheelset."""
    f = np.array([SPEED / 2000.0])
    half = max(positions(passive).values()) / 2.0
    assert half == pytest.approx(9.5 + 1.28)
    delay = np.exp(-2j * np.pi * half / 2000.0)
    for kind, body, wheelset in (("vertical", "body.z", f"{FIRST}.z"), ("alignment", "body.y", f"{FIRST}.y")):
        found = frequency_response(passive, irregularity(passive, kind, f), [body, wheelset], f)[0]
        np.testing.assert_allclose(found, [delay, 1.0], rtol=0.01)


def test_symmetric_irregularities_move_nothing_sideways(passive: LinearModel) -> None:
    f = np.geomspace(0.3, 20.0, 30)
    for kind, still, moving in (
        ("vertical", "body.lateral_acceleration", "body.vertical_acceleration"),
        ("alignment", "body.vertical_acceleration", "body.lateral_acceleration"),
    ):
        found = np.abs(frequency_response(passive, irregularity(passive, kind, f), [still, moving], f))
        assert found[:, 0].max() < 1e-9 * found[:, 1].max()


def test_many_frequencies_against_direct_solves(closed: LinearModel) -> None:
    """The S vehicle, 256 states: every tenth of 300 frequencies by numpy's own solver."""
    f = np.geomspace(0.05, 400.0, 300)
    u = {f"{FIRST}.left.armature_voltage": 1.0, f"{FIRST}.right.armature_voltage": -1.0}
    found = frequency_response(closed, u, [f"{FIRST}.yaw", f"{FIRST}.left.shaft_torque"], f)
    chosen = closed.select(inputs=list(u), outputs=[f"{FIRST}.yaw", f"{FIRST}.left.shaft_torque"])
    b, d = chosen.B @ [1.0, -1.0], chosen.D @ [1.0, -1.0]
    for i in range(0, 300, 10):
        z = np.exp(2j * np.pi * f[i] * closed.sample_time)
        expected = chosen.C @ np.linalg.solve(z * np.eye(len(closed.A)) - closed.A, b) + d
        assert (np.abs(found[i] - expected) < 1e-9 * np.abs(found).max(axis=0)).all()


def test_simulated_wind_on_the_coach(passive: LinearModel) -> None:
    outputs = ["body.lateral_acceleration", f"{FIRST}.y"]
    found = measured_response(
        steady_spec(coach()), "wind.y", outputs, amplitude=100.0, band=(0.5, 20.0), period=6.0, courses=2
    )
    expected = frequency_response(sampled(passive, 1e-3), "wind.y", outputs, found.frequencies)
    error = np.sqrt(np.sum(np.abs(found.response - expected) ** 2, axis=0) / np.sum(np.abs(expected) ** 2, axis=0))
    np.testing.assert_array_less(error, 3e-3)  # what is left of the transients after 6 s
    assert found.coherence.min() > 0.999


def test_simulated_motor_voltage_under_control(closed: LinearModel) -> None:
    """All loops closed at 1 kHz; from voltage to current."""
    voltage, current = f"{FIRST}.left.armature_voltage", f"{FIRST}.left.armature_current"
    found = measured_response(
        steady_spec(active()), voltage, [current], amplitude=0.5, band=(0.5, 200.0), period=6.0, courses=2
    )
    expected = frequency_response(closed, voltage, current, found.frequencies)
    error = np.abs(found.response[:, 0] - expected)
    assert np.sqrt(np.sum(error**2) / np.sum(np.abs(expected) ** 2)) < 1e-3
    assert found.coherence.min() > 0.999
    with pytest.raises(InputError, match="sampled already"):
        sampled(closed, 1e-3)


def test_loop_gain_is_that_of_the_opened_loop(closed: LinearModel) -> None:
    """L of a motor pair, from the closed model, and with the voltages that are put out cut off from the plant."""
    wheels = [f"{FIRST}.left.armature_voltage", f"{FIRST}.right.armature_voltage"]
    half = {wheels[0]: 0.5, wheels[1]: -0.5}
    f = np.geomspace(0.1, 450.0, 200)
    L = loop_gain(closed, {wheels[0]: 1.0, wheels[1]: -1.0}, half, f)
    places = [closed.state(f"{wheel}.put_out") for wheel in wheels]
    cut, direct = closed.A.copy(), closed.C.copy()
    cut[:, places] = 0.0
    direct[:, places] = 0.0
    rows = [[o.name for o in closed.outputs].index(wheel) for wheel in wheels]
    direct[rows, places] = 1.0
    opened = dataclasses.replace(closed, A=cut, C=direct, D=np.zeros_like(closed.D))
    u = {wheels[0]: 1.0, wheels[1]: -1.0}
    np.testing.assert_allclose(L, -frequency_response(opened, u, half, f), rtol=1e-6, atol=1e-9)
    found = margins(L, f)
    assert found.gain > 1.5
    assert found.distance > 0.3


def test_random_response_of_the_coach_against_a_run() -> None:
    """A fiftieth of ORE B176 on track that repeats after 200 m: the last of four turns, line by line.

    Vertical and alignment, which the vehicle's symmetry keeps apart: the wheel forces' mean and half difference are the
    shares of one and of the other.
    """
    V, turn, size, interval = 50.0, 200.0, 0.02, 5e-4
    scenario = coach(V)
    model = kl.linearise(scenario)
    low = erri_b176("low").within("5 m", "60 m")
    quality = Quality("two kinds", {kind: low.spectra[kind] for kind in ("vertical", "alignment")})
    courses = [synthesise(each, length=turn, seed=3, fade=0.0) for each in quality.spectra.values()]
    small = [Course(c.kind, c.interval, size * c.values, size * c.slopes, repeats=True) for c in courses]
    duration = 4.0 * turn / V
    entries = excitations(small, positions(model), speed=V, duration=duration, interval=interval)
    rise = np.minimum(1.0, np.arange(len(entries[0]["values"])) * interval)
    for entry in entries:
        entry["values"] = (rise * entry["values"]).tolist()
    spec = steady_spec(scenario)
    spec["run"] |= {"duration": duration, "excitations": entries}
    run = simulate_spec(spec).isel(time=slice(-round(turn / V / 1e-3) - 1, -1))

    accelerations = ["body.vertical_acceleration", "body.lateral_acceleration", "bogie1.lateral_acceleration"]
    left, right = f"{FIRST}.left.Q", f"{FIRST}.right.Q"
    channels = [*accelerations, f"{FIRST}.y", left]
    lines = np.arange(np.ceil(turn / 60.0), turn / 5.0 + 1.0) * V / turn
    found = random_response(model, quality, frequencies=lines, outputs=channels)
    by_lines = dict(zip(channels, size * np.sqrt(found.psd.sum(axis=0) * V / turn), strict=True))
    whole = random_response(model, quality, outputs=channels).rms()
    for channel in channels[:-1]:
        simulated = float(run[channel].std())
        assert simulated == pytest.approx(by_lines[channel], rel=5e-3), channel
        assert simulated == pytest.approx(size * whole[channel], rel=0.25), channel  # one course of many
    wheel = {kind: size * np.sqrt(share[:, -1].sum() * V / turn) for kind, share in found.shares.items()}
    assert float((run[left] - run[right]).std()) / 2.0 == pytest.approx(wheel["alignment"], rel=5e-3)
    # the step of 0.5 ms is coarse for the contact springs' part; with 0.1 ms it is 0.1 %
    assert float((run[left] + run[right]).std()) / 2.0 == pytest.approx(wheel["vertical"], rel=0.03)


def test_long_waves_are_curves_and_cant(passive: LinearModel) -> None:
    """A wave a of alignment has the curvature a'' = -k^2 a, a wave of crosslevel is a cant; seen from the middle."""
    wave = 5000.0
    f = np.array([SPEED / wave])
    outputs = ["body.lateral_acceleration", f"{FIRST}.left.Q", f"{FIRST}.right.Q"]
    middle = np.exp(2j * np.pi * max(positions(passive).values()) / 2.0 / wave)
    curvature = -((2.0 * np.pi / wave) ** 2)
    for kind, track, scale in (("alignment", "track.curvature", curvature), ("crosslevel", "track.cant", 1.0)):
        found = middle * frequency_response(passive, irregularity(passive, kind, f), outputs, f)[0]
        expected = scale * frequency_response(passive, track, outputs, f)[0]
        assert found[0] == pytest.approx(expected[0], rel=1e-3)
        # the first wheelset is ahead of the middle, and the track is twisted along the vehicle
        assert found[2] - found[1] == pytest.approx(expected[2] - expected[1], rel=0.1)


def test_random_response_under_control_needs_the_plant(closed: LinearModel, plant: LinearModel) -> None:
    """Wheel forces of a sampled vehicle are those of rails that go on between the samples."""
    quality = Quality("low", {"vertical": erri_b176("low").spectra["vertical"]})  # which the controllers do not touch
    with pytest.raises(InputError, match="plant: is missing"):
        random_response(closed, quality)
    found = random_response(closed, quality, outputs=[f"{FIRST}.left.Q"], plant=plant)
    alone = random_response(plant, quality, outputs=[f"{FIRST}.left.Q"])
    assert found.rms()[f"{FIRST}.left.Q"] == pytest.approx(alone.rms()[f"{FIRST}.left.Q"], rel=1e-3)


@pytest.mark.parametrize(("name", "order"), [("passive", 24), ("closed", 40)])
def test_reduction_is_within_its_bound(name: str, order: int, request: pytest.FixtureRequest) -> None:
    """From the front wheelset's rails to the ride: 24 states of 119, 40 of 256."""
    whole = request.getfixturevalue(name).select(
        inputs=[f"{FIRST}.left.rail_y", f"{FIRST}.left.rail_z"],
        outputs=["body.lateral_acceleration", "body.vertical_acceleration"],
    )
    kept, hankel = hankel_values(whole)
    small, bound = reduced(whole, order)
    f = np.geomspace(0.01, 200.0 if whole.sample_time is None else 499.0, 1500)
    outputs = [signal.name for signal in whole.outputs]
    columns = [
        frequency_response(whole, u.name, outputs, f) - frequency_response(small, u.name, outputs, f)
        for u in whole.inputs
    ]
    error = float(np.linalg.svd(np.stack(columns, axis=-1), compute_uv=False).max())
    assert bound == pytest.approx(2.0 * hankel[order - kept :].sum() + ROUNDING * hankel[0])
    assert error <= bound
    assert bound < 0.05 * hankel[0]


def test_sensitivities_of_the_coach_are_those_of_its_eigenvalues() -> None:
    """All modes of 0.5 to 2 Hz; effects against the eigenvalues' own differences."""
    scenario = coach()
    poles = continuous_poles(kl.linearise(scenario))
    slow = poles[(poles.imag > 3.0) & (poles.imag < 12.0)]
    assert len(slow) >= 3
    paths = ["vehicle.secondary.stiffness.y", "vehicle.body.mass", "vehicle.secondary.vertical_damper.damping"]
    table = eigenvalue_sensitivities(scenario, paths, eigenvalues=list(slow))
    assert len(table) == len(slow) * len(paths)
    for s, rows in table.groupby("eigenvalue"):
        sizes = rows["effect"].abs().to_numpy()
        assert (np.diff(sizes) <= 0.0).all()
        assert (rows["error"][sizes > 1e-4 * abs(s)] < 1e-5).all()
    for path in paths:
        near = [
            continuous_poles(kl.linearise(replace(scenario, path, get(scenario, path) * d))) for d in (0.9999, 1.0001)
        ]
        rows = table[table["parameter"] == path]
        for s, effect in zip(rows["eigenvalue"], rows["effect"], strict=True):
            low, high = (each[np.argmin(np.abs(each - s))] for each in near)
            assert effect == pytest.approx((high - low) / 2e-4, rel=1e-4, abs=1e-6)


def test_sensitivities_of_a_controller() -> None:
    """The mode of the transmissions, 55 Hz: the notch filter of the torque loops moves it, the axle's mass hardly."""
    paths = ["vehicle.axle_bridge.mass", "control.notch_frequency"]
    table = eigenvalue_sensitivities(active(), paths, eigenvalues=[-25.0 + 345.0j])
    assert list(table["parameter"]) == ["control.notch_frequency", "vehicle.axle_bridge.mass"]
    assert (table["error"] < 1e-5).all()
    assert table["frequency"].iloc[0] == pytest.approx(54.9, abs=0.5)


def test_sensitivities_of_steady_curving() -> None:
    channels = [f"{FIRST}.y", f"{FIRST}.left.Q"]
    table = steady_sensitivities(coach(), channels, ["speed", "friction", "vehicle.body.height"], at=400.0)
    assert (table["error"] < 1e-5).all()
    load = table[table["channel"] == f"{FIRST}.left.Q"].set_index("parameter")
    assert load.loc["speed", "effect"] > 0.0  # the outer wheel of a right-hand curve is loaded more
    assert load.loc["vehicle.body.height", "effect"] > 0.0
    with pytest.raises(InputError, match="is no channel"):
        steady_sensitivities(coach(), ["body.pitching"], ["speed"])
