"""Drives: the traps of the paper, Table 1 against independent numbers, transfer functions against the simulated motor.
Equation numbers are those of Perez et al. (2004)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import lsim

from klingel import library
from klingel.drives import (
    DriveTransfer,
    WheelPair,
    field_current,
    operating_point,
    operating_table,
    sncf_general,
    wheel_torque,
    wheel_torque_max,
)
from klingel.errors import InputError

Rates = Callable[[np.ndarray, float], np.ndarray]
Output = Callable[[np.ndarray, float], float]

VEHICLE = library.vehicle("mechatronic_irw")
DRIVE = VEHICLE.drive
SPEED = 176.0 / 3.6
POINT = operating_point(VEHICLE, SPEED)
TRANSFER = DriveTransfer.of(DRIVE, field_current=POINT.field_current)
PAIR = WheelPair(wheel_inertia=45.0, radius=0.46, speed=SPEED, longitudinal_creep=10.0e6)

# Speed [km/h], wheel torque [N m], normalised field current, armature current [A] of this motor under one coach of an
# eight-car train of 356 t: computed apart from this code when the motor was sized (status "design").
SIZED = [
    (108, 90.5, 0.989, 7.42),
    (140, 126.7, 0.762, 13.36),
    (176, 175.9, 0.605, 23.12),
    (216, 241.4, 0.492, 38.64),
    (265, 336.9, 0.399, 65.75),
]


def test_table_1_against_the_numbers_the_motor_was_sized_with() -> None:
    """The vehicle is 2.6 % heavier than the coach of the sizing, of which the torque takes up to 1.2 %."""
    points = operating_table(VEHICLE, [v / 3.6 for v, *_ in SIZED])
    for point, (_, torque, field, current) in zip(points, SIZED, strict=True):
        assert point.wheel_torque == pytest.approx(torque, rel=0.015)
        assert point.field_current_normalised == pytest.approx(field, abs=0.001)
        assert point.armature_current == pytest.approx(current, rel=0.015)


def test_sncf_formula_of_an_eight_car_train() -> None:
    """Per wheel of 64, independent numbers: 196.8 N at 108 km/h, 732.5 N at 265 km/h."""
    train = sncf_general(mass=355.856e3, axle_load=11120.5, front_area=10, perimeter=10, length=200, stock="tgv")
    assert train.share(64)(108 / 3.6) == pytest.approx(196.8, abs=0.1)
    assert train.share(64)(265 / 3.6) == pytest.approx(732.5, abs=0.1)
    with pytest.raises(InputError, match=r"stock = 'maglev'.*tgv, passenger, freight"):
        sncf_general(mass=1e5, axle_load=1e4, front_area=10, perimeter=10, length=100, stock="maglev")


def test_eq_5_takes_the_motor_speed_and_has_two_roots() -> None:
    torque, motor = 200.0, POINT.motor_speed
    larger = field_current(DRIVE, torque, motor)
    smaller = DRIVE.traction_share * DRIVE.armature_voltage_max / (DRIVE.emf_constant * motor) - larger
    assert larger > smaller
    for current in (larger, smaller):
        assert wheel_torque(DRIVE, current, motor) == pytest.approx(torque)
    assert motor == pytest.approx(SPEED / 0.46 / DRIVE.gear_ratio)
    assert wheel_torque(DRIVE, larger, motor * DRIVE.gear_ratio) > 10.0 * torque


def test_largest_torque_of_eq_5() -> None:
    limit = wheel_torque_max(DRIVE, POINT.motor_speed)
    fields = np.linspace(0.1, 10.0, 2000)
    assert max(wheel_torque(DRIVE, i, POINT.motor_speed) for i in fields) == pytest.approx(limit, rel=1e-5)
    with pytest.raises(InputError, match="more than the motor gives"):
        field_current(DRIVE, 1.001 * limit, POINT.motor_speed)


@pytest.mark.parametrize(("speed", "word"), [(-1.0, "must not be negative"), (25.0, "above the base speed")])
def test_speeds_without_an_operating_point(speed: float, word: str) -> None:
    with pytest.raises(InputError, match=word):
        operating_point(VEHICLE, speed)
    with pytest.raises(InputError, match="drive"):
        operating_point(library.vehicle("manchester_coach"), 30.0)


def test_at_rest_nothing_is_put_out() -> None:
    point = operating_point(VEHICLE, 0.0)
    assert (point.armature_voltage, point.wheel_torque, point.field_current_normalised) == (0.0, 0.0, 1.0)


def motor_rates(state: np.ndarray, voltage: float, wheel_speed: float) -> tuple[np.ndarray, float]:
    """Eqs (2), (4) and (7) to (11), deviations from steady running; the shaft torque beside."""
    current, motor_speed, twist = state
    kt, n = TRANSFER.torque_constant, DRIVE.gear_ratio
    slip = n * motor_speed - wheel_speed
    torque = DRIVE.transmission_stiffness * twist + DRIVE.transmission_damping * slip
    return np.array(
        [
            (voltage - DRIVE.armature_resistance * current - kt * motor_speed) / DRIVE.armature_inductance,
            (kt * current - DRIVE.rotor_damping * motor_speed - n * torque) / DRIVE.rotor_inertia,
            slip,
        ]
    ), torque


def steady_amplitude(rates: Rates, size: int, omega: float, output: Output) -> complex:
    """Complex amplitude of an output once the transients of a unit sine input have died away.

    The equations are linear, so their columns are what they answer to unit states and a unit input.
    """
    states = np.eye(size)
    a = np.column_stack([rates(x, 0.0) for x in states])
    b = rates(np.zeros(size), 1.0)[:, None]
    c = np.array([[output(x, 0.0) for x in states]])
    d = np.array([[output(np.zeros(size), 1.0)]])
    period = 2.0 * np.pi / omega
    count = int(np.ceil(0.8 / period)) + 2
    times = np.linspace(0.0, count * period, 400 * count + 1)
    _, values, _ = lsim((a, b, c, d), np.sin(omega * times), times)
    last = slice(-801, -1)
    return complex(2j * np.mean(np.squeeze(values)[last] * np.exp(-1j * omega * times[last])))


OMEGA = [5.0, 40.0, 120.0, 340.0]


@pytest.mark.parametrize("omega", OMEGA)
def test_eqs_12_to_17_against_the_simulated_motor(omega: float) -> None:
    """Gu with the wheel held, Gv with the voltage held: amplitude and phase of the torque."""
    voltage = steady_amplitude(lambda x, u: motor_rates(x, u, 0.0)[0], 3, omega, lambda x, u: motor_rates(x, u, 0.0)[1])
    wheel = steady_amplitude(lambda x, w: motor_rates(x, 0.0, w)[0], 3, omega, lambda x, w: motor_rates(x, 0.0, w)[1])
    assert voltage == pytest.approx(TRANSFER.Gu(1j * omega), rel=1e-4)
    assert wheel == pytest.approx(TRANSFER.Gv(1j * omega), rel=1e-4)


@pytest.mark.parametrize("omega", OMEGA)
def test_eqs_26_to_29_against_the_simulated_wheel_pair(omega: float) -> None:
    creep = PAIR.longitudinal_creep * PAIR.radius**2 / PAIR.speed

    def rates(state: np.ndarray, u: float) -> np.ndarray:
        motor, torque = motor_rates(state[:3], u, state[3])
        return np.append(motor, (torque - creep * state[3]) / PAIR.wheel_inertia)

    def simulated(output) -> complex:
        return steady_amplitude(rates, 4, omega, output)

    s = 1j * omega
    assert simulated(lambda x, u: x[3]) == pytest.approx(TRANSFER.speed_plant(PAIR)(s), rel=1e-4)
    assert simulated(lambda x, u: motor_rates(x[:3], u, x[3])[1]) == pytest.approx(
        TRANSFER.torque_plant(PAIR)(s), rel=1e-4
    )
    assert simulated(lambda x, u: x[0]) == pytest.approx(TRANSFER.current_plant(PAIR)(s), rel=1e-4)
    assert TRANSFER.speed_plant(PAIR)(s) == pytest.approx(TRANSFER.torque_plant(PAIR)(s) * PAIR.Gw(s))


@pytest.mark.parametrize("omega", [5.0, 40.0])
def test_eqs_25_and_28_close_the_loops(omega: float) -> None:
    """A proportional controller around the simulated motor gives the torque the two equations state."""
    s, gain = 1j * omega, 0.005
    gu, gv = TRANSFER.Gu(s), TRANSFER.Gv(s)

    def held(command: float, x: np.ndarray) -> float:
        """The voltage of a torque loop with the wheel held: u = K (Td,command - Td)."""
        return gain * (command - motor_rates(x, 0.0, 0.0)[1])

    torque = steady_amplitude(
        lambda x, c: motor_rates(x, held(c, x), 0.0)[0], 3, omega, lambda x, c: motor_rates(x, 0.0, 0.0)[1]
    )
    assert torque == pytest.approx(gu * gain / (1.0 + gu * gain), rel=1e-3)
    turned = steady_amplitude(
        lambda x, w: motor_rates(x, -50.0 * w, w)[0], 3, omega, lambda x, w: motor_rates(x, 0.0, w)[1]
    )
    assert turned == pytest.approx(gv - gu * 50.0, rel=1e-3)


def test_signs_gv_minus_gw_plus() -> None:
    """A wheel that runs ahead is held back; a torque forward turns the wheel forward."""
    assert TRANSFER.Gv(0.01j).real < 0.0
    assert TRANSFER.Gu(0.01j).real > 0.0
    assert PAIR.Gw(0.01j).real > 0.0
    assert max(TRANSFER.speed_plant(PAIR).poles().real) < 0.0


def test_python_control_reads_them() -> None:
    control = pytest.importorskip("control")
    plant = TRANSFER.speed_plant(PAIR).to_control()
    assert isinstance(plant, control.TransferFunction)
    assert plant(40j) == pytest.approx(TRANSFER.speed_plant(PAIR)(40j))
