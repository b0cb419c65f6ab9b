"""Strategies: bad parameters, what they sense and drive, loop margins of the motors, runs through a short curve.
Figures of whole curves are the study's."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import library
from klingel.control import IRWLike, Passive, SolidLike
from klingel.control.basics import WHEELSETS
from klingel.control.common import profile_of, twist_of
from klingel.control.feedforward import ContactDesign, SteeringGeometry, Sway, attack_angle, spin_momentum
from klingel.control.response import controller_response
from klingel.drives import DriveTransfer, WheelPair, operating_point
from klingel.errors import InputError
from klingel.track import Track

VEHICLE = library.vehicle("mechatronic_irw")
GEOMETRY = SteeringGeometry.of(VEHICLE)
CURVE = Track.curve(radius=800.0, cant=0.16, transition=195.0, arc=150.0, straight_before=80.0, straight_after=80.0)
ACTIVE = [SolidLike(), IRWLike(), IRWLike(curvature="database")]
SPEEDS = [v / 3.6 for v in (108, 140, 176, 216, 265)]


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: IRWLike(curvature="map"), "control.curvature = 'map'.*gyro"),  # type: ignore[arg-type]
        (lambda: IRWLike(frequency=-1.0), "control.frequency = -1.0: must be positive"),
        (lambda: SolidLike(coupling=0.0), "control.coupling = 0.0: must be positive"),
    ],
)
def test_bad_parameters_are_named(make: object, word: str) -> None:
    with pytest.raises(InputError, match=word):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("strategy", ACTIVE)
def test_a_passive_vehicle_cannot_be_controlled(strategy: SolidLike | IRWLike) -> None:
    with pytest.raises(InputError, match="manchester_coach is passive"):
        strategy.lower(library.vehicle("manchester_coach"), CURVE, 30.0)
    assert Passive().lower(VEHICLE, CURVE, 30.0) is None


@pytest.mark.parametrize("strategy", ACTIVE)
def test_every_motor_and_actuator_is_driven_and_names_are_unique(strategy: SolidLike | IRWLike) -> None:
    spec = strategy.lower(VEHICLE, CURVE, 30.0)
    sides = ("left.armature_voltage", "right.armature_voltage", "actuator_left.force", "actuator_right.force")
    assert sorted(c["target"] for c in spec["commands"]) == sorted(f"{w.name}.{s}" for w in WHEELSETS for s in sides)
    names = spec["measurements"] + [block["name"] for block in spec["blocks"]]
    assert len(names) == len(set(names))
    probes = {"steering_voltage", "steering_moment_command", "steering_feedback"} | (
        {"within_reach"} if isinstance(strategy, IRWLike) else set()
    )
    assert {p["channel"].rsplit(".", 1)[1] for p in spec["probes"]} == probes


def test_only_the_database_variants_read_the_position_along_the_track() -> None:
    reads = [any(m.endswith(".s") for m in s.lower(VEHICLE, CURVE, 30.0)["measurements"]) for s in ACTIVE]
    assert reads == [True, False, True]


def test_the_database_holds_the_corners_of_the_track() -> None:
    places, curvature = profile_of(CURVE, "curvature")
    assert places == [0.0, 80.0, 275.0, 425.0, 620.0, 700.0]
    np.testing.assert_allclose(curvature, [0.0, 0.0, 1 / 800, 1 / 800, 0.0, 0.0])
    at, twist = twist_of(CURVE)
    s = np.linspace(0.0, 700.0, 70001)
    roll = np.cumsum(np.interp(s, at, twist)) * (s[1] - s[0])
    assert roll.max() == pytest.approx(0.16 / 1.5, rel=2e-3)
    assert roll[-1] == pytest.approx(0.0, abs=1e-4)


def test_attack_angle_is_linear_odd_and_ends_where_friction_does() -> None:
    contact = ContactDesign(inclination=0.0)
    small = attack_angle(100.0, GEOMETRY, contact)
    static = GEOMETRY.mass * 9.81 / 8.0
    stiffness = contact.lateral_creep * (static / contact.load) ** (2.0 / 3.0)
    assert small == pytest.approx(100.0 / (2.0 * stiffness), rel=1e-2)
    assert attack_angle(-2e4, GEOMETRY, contact) == -attack_angle(2e4, GEOMETRY, contact)
    slopes = np.diff([attack_angle(y, GEOMETRY, contact) for y in np.linspace(0.0, 3e4, 20)])
    assert np.all(np.diff(slopes) > 0.0)


def test_the_pair_of_lateral_forces_holds_the_moment_of_the_secondary_suspension() -> None:
    """Wheelsets 1 and 4 carry more, 2 and 3 less; each pair has the arm of the wheelbase."""
    shares = [GEOMETRY.lateral_share(w.bogie, w.number) for w in WHEELSETS]
    assert shares == [shares[0], -shares[0], -shares[0], shares[0]]
    moment = 2.0 * GEOMETRY.half_wheelbase * shares[0]
    assert moment == pytest.approx(GEOMETRY.secondary_yaw * GEOMETRY.half_bogie_spacing)


def test_sway_and_spin_momentum() -> None:
    """Sway of the body by hand: 0.1 of the springs of the body, 0.05 of the axle boxes; both a little less than 0.2."""
    sway = Sway.of(VEHICLE)
    assert 0.12 < sway.body < 0.2
    assert 0.03 < sway.bogie < 0.08
    assert spin_momentum(VEHICLE) == pytest.approx(2.0 * (45.0 - 3.0 * 1.0) / 0.46)
    coach = library.vehicle("manchester_coach")
    assert coach.wheelset is not None
    assert spin_momentum(coach) == pytest.approx(coach.wheelset.inertia.spin / 0.46)


def motor_loop(strategy: SolidLike | IRWLike, speed: float, creep: float, omega: np.ndarray) -> np.ndarray:
    """Loop of one wheel pair's motors on the plants of Eqs (27) and (29), with the core's sample of output and hold."""
    transfer = DriveTransfer.of(VEHICLE.drive, field_current=operating_point(VEHICLE, speed).field_current)
    pair = WheelPair(45.0, 0.46, speed, creep)
    solid = isinstance(strategy, SolidLike)
    plant = transfer.speed_plant(pair) if solid else transfer.current_plant(pair)
    channel = "spin_speed" if solid else "armature_current"
    spec = strategy.lower(VEHICLE, CURVE, speed)
    response = controller_response(spec, {"body.speed": speed}, omega)
    voltage = [c["target"] for c in spec["commands"]].index("bogie1.wheelset1.left.armature_voltage")
    left, right = (spec["measurements"].index(f"bogie1.wheelset1.{side}.{channel}") for side in ("left", "right"))
    half_difference = response[:, voltage, left] - response[:, voltage, right]
    return -half_difference * plant.response(omega) * np.exp(-1.5j * omega * spec["sample_time"])


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("strategy", ACTIVE[:2])
def test_motor_loops_have_a_gain_margin_of_2_and_a_phase_margin_of_45_degrees(
    strategy: SolidLike | IRWLike, speed: float
) -> None:
    """With creep coefficients 30 % off either way. A loop whose gain stays below one needs no phase margin."""
    omega = 2.0 * np.pi * np.geomspace(0.1, 400.0, 3000)
    for creep in (7.0e6, 10.0e6, 13.0e6):
        loop = motor_loop(strategy, speed, creep, omega)
        crosses = (loop.imag[1:] * loop.imag[:-1] < 0.0) & (loop.real[1:] < 0.0)
        assert np.max(np.abs(loop[1:][crosses]), initial=0.0) < 0.5
        unity = (np.abs(loop[1:]) - 1.0) * (np.abs(loop[:-1]) - 1.0) < 0.0
        phases = 180.0 - np.abs(np.degrees(np.angle(loop[1:][unity])))
        assert np.min(phases, initial=180.0) > 45.0


@pytest.mark.parametrize("strategy", ACTIVE)
def test_active_wheelsets_stay_centred_through_a_short_curve(strategy: SolidLike | IRWLike) -> None:
    """R = 800 m at 176 km/h: at most 2 mm anywhere, within the limits of motors and actuators."""
    run = kl.simulate(kl.Scenario(VEHICLE, CURVE, speed="176 km/h", control=strategy, step="1 ms"))
    assert run.attrs["outcome"] == "completed"
    assert VEHICLE.drive is not None
    assert VEHICLE.steering is not None
    for w in WHEELSETS:
        assert np.abs(run[f"{w.name}.y"]).max() < 2.0e-3
        assert np.abs(run[f"{w.name}.actuator_left.force"]).max() < VEHICLE.steering.force_max
        assert np.abs(run[f"{w.name}.left.armature_current"]).max() < 2.0 * VEHICLE.drive.armature_current_rated
        assert np.abs(run[f"{w.name}.steering_voltage"]).max() < 100.0
        check_pair(run, w.name)


def check_pair(run: xr.Dataset, name: str) -> None:
    """Eqs (18) to (23): in the arc wd, half of Eq. (1), is lambda V rho/r0; VaL and VaR are x VaMax + u and - u."""
    left, right, u = (
        run[f"{name}.{part}"].values for part in ("left.armature_voltage", "right.armature_voltage", "steering_voltage")
    )
    np.testing.assert_allclose(left[1:] + right[1:], 1800.0, atol=1e-9)
    np.testing.assert_allclose(0.5 * (left - right)[1:], u[:-1], atol=1e-9)
    arc = run[f"{name}.curvature"].values == 1.0 / 800.0
    wd = 0.5 * (run[f"{name}.left.spin_speed"].values - run[f"{name}.right.spin_speed"].values)[arc]
    assert wd.mean() == pytest.approx(0.75 * 176.0 / 3.6 / 800.0 / 0.46, rel=0.1)
