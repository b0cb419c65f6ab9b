"""Compensators: theory's limit cases, what the synthesis promises against the closed loop, and the full vehicle."""

import math

import numpy as np
import pytest

from klingel.design import Compensator, loop_shaping, loops, lqg
from klingel.design.compensator import Compensated, Made
from klingel.design.opening import STEERING, WHEELSETS, attached, base, cut
from klingel.design.synthesis import closed_of, norm_of, robust
from klingel.errors import InputError
from klingel.linear.blocks import eigenvalues, lives
from klingel.linear.model import LinearModel
from klingel.linear.response import frequency_response

from .conftest import scenario

MEASURED = {f"{w}.{side}.spin_speed": 0.05 for w in WHEELSETS for side in ("left", "right")}
MEASURED |= {f"{w}.yaw_rate": 5e-3 for w in WHEELSETS}
CENTRED = {f"{w}.y": 2e-3 for w in WHEELSETS}
FAST = 176.0 / 3.6


@pytest.fixture(scope="module")
def optimal() -> Compensator:
    return lqg(scenario("S", FAST).replace(control=None), regulated=CENTRED, measurements=MEASURED, command_size=2e3)


@pytest.fixture(scope="module")
def opened() -> LinearModel:
    return base(scenario("S", FAST).replace(control=None), STEERING, 1e-3).model


def grown(model: LinearModel) -> float:
    s = eigenvalues(model)
    return float(s[lives(s, model.sample_time)].real.max())


def test_the_cut_plant_is_the_vehicle(opened: LinearModel) -> None:
    """From the steering of the first wheelset to its yaw, as the whole vehicle does it; half of it is left out."""
    plant = cut(opened, STEERING, [f"{WHEELSETS[0]}.yaw", f"{WHEELSETS[0]}.left.spin_speed"])
    assert 0.4 * len(opened.A) < len(plant.A) < 0.7 * len(opened.A)
    f = np.geomspace(0.1, 400.0, 30)
    outputs = [f"{WHEELSETS[0]}.yaw", f"{WHEELSETS[0]}.left.spin_speed"]
    expected = frequency_response(opened, STEERING[f"{WHEELSETS[0]}.steering"], outputs, f)
    found = frequency_response(plant, f"{WHEELSETS[0]}.steering", outputs, f)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_lqg_promises_what_the_closed_loop_has(optimal: Compensator) -> None:
    assert optimal.promised == pytest.approx(optimal.norm, rel=1e-3)
    assert optimal.reduced_growth < 0.0
    assert optimal.order < 40
    assert len(optimal.a) == optimal.order


def test_lqg_holds_the_full_vehicle_where_it_was_designed(optimal: Compensator) -> None:
    assert len(optimal.full) == 4
    assert optimal.full["stable"].all()
    assert (optimal.full["gain"] > 2.0).all()
    assert optimal.full["growth"].max() < -0.1


def test_lqg_says_where_it_fails(optimal: Compensator) -> None:
    """Designed at 176 km/h without a schedule, it does not hold at 265 km/h."""
    words = " ".join(optimal.words())
    assert words.startswith(f"LQG on {optimal.order} states; {optimal.left_out} were left out")
    assert optimal.check.name == "LQG"
    assert not optimal.check.stable
    assert "at 265 km/h" in words


def test_less_of_the_plant_is_told(optimal: Compensator) -> None:
    """With ten states the bound of the error is larger, and the verdict is still that of the full vehicle."""
    open_scenario = scenario("S", FAST).replace(control=None)
    small = lqg(open_scenario, regulated=CENTRED, measurements=MEASURED, command_size=2e3, order=12)
    assert small.order == 12
    assert small.bound > optimal.bound
    assert small.left_out == optimal.left_out + optimal.order - 12


def test_a_compensator_as_python_control(optimal: Compensator) -> None:
    """Closed around the vehicle by hand with the StateSpace: the same eigenvalues as those of the full rows."""
    system = optimal.system
    assert system.dt == 1e-3
    assert (system.ninputs, system.noutputs) == (12, 8)
    assert optimal.driven[:2] == (f"{WHEELSETS[0]}.actuator_left.force", f"{WHEELSETS[0]}.actuator_right.force")
    np.testing.assert_allclose(system.D[0], -system.D[1])
    np.testing.assert_allclose(system.C[::2], optimal.c)


def test_an_attached_compensator_closes_the_loop(opened: LinearModel) -> None:
    """A gain from yaw rate to the first steering: L is the gain times the vehicle's own response, a sample later."""
    gain, f = -2e4, np.geomspace(0.2, 200.0, 20)
    commands = {name: dict(weights) for name, weights in list(STEERING.items())[:1]}
    K = (np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([[gain]]))
    closed = attached(opened, commands, [f"{WHEELSETS[0]}.yaw_rate"], K)
    (loop,) = loops(closed)
    assert loop.name == f"{WHEELSETS[0]}.steering"
    P = frequency_response(opened, commands[f"{WHEELSETS[0]}.steering"], f"{WHEELSETS[0]}.yaw_rate", f)
    z = np.exp(2j * np.pi * f * 1e-3)
    np.testing.assert_allclose(loop.response(f), -gain * P / z, rtol=1e-6)


def test_other_loops_go_on_around_a_compensator() -> None:
    """Steering cut out of I, its motors still closed: nothing of the old steering is left."""
    irw = scenario("I gyro", FAST)
    K = (np.zeros((0, 0)), np.zeros((0, 12)), np.zeros((4, 0)), np.zeros((4, 12)))
    made = Made(K, STEERING, tuple(MEASURED), 1e-3, 0.0, 0.0, 0.0)
    model = Compensated(made)(irw).model
    assert {loop.kind for loop in loops(model)} == {"motors"}
    assert not any("steering" in state.name or "M.integral" in state.name for state in model.states)


def test_loop_shaping_keeps_its_promise() -> None:
    shaped = loop_shaping(
        scenario("S", FAST).replace(control=None), measurements=MEASURED, command_size=500.0, integral=0.05
    )
    assert shaped.norm == pytest.approx(shaped.promised, rel=0.02)
    assert shaped.reduced_growth < 0.0
    assert shaped.full["stable"].all()
    assert shaped.full["disk"].min() > 2.0 / shaped.norm * 0.4


def test_robust_against_theory() -> None:
    """Of k/s gamma is sqrt 2 at least, for any k, with a static gain of one; of an unstable pole it is more."""
    for k in (0.3, 20.0):
        plant = (np.array([[1.0]]), np.array([[1e-3 * k]]), np.array([[1.0]]), np.array([[0.0]]))
        K, gamma = robust(*plant, 1e-3)
        assert gamma / 1.1 == pytest.approx(math.sqrt(2.0), rel=0.01)
        assert norm_of(plant, K) <= gamma * 1.001
        assert np.abs(np.linalg.eigvals(closed_of(plant, K))).max() < 1.0
    unstable = (np.array([[np.exp(1e-3 * 5.0)]]), np.array([[1e-3]]), np.array([[1.0]]), np.array([[0.0]]))
    K, gamma = robust(*unstable, 1e-3)
    assert gamma > 5.0
    assert norm_of(unstable, K) <= gamma * 1.001


def test_the_norm_is_that_of_python_control() -> None:
    """Against the peak of python-control's frequency response of the same four blocks."""
    import control

    plant = (np.array([[0.9, 0.1], [-0.2, 0.95]]), np.array([[0.0], [0.1]]), np.array([[1.0, 0.0]]), np.zeros((1, 1)))
    K, _ = robust(*plant, 0.01)
    P, C = control.ss(*plant, 0.01), control.ss(*K, 0.01)
    omega = np.geomspace(1e-2, np.pi / 0.01, 3000)
    p, c = (np.ravel(system.frequency_response(omega).complex) for system in (P, C))
    S = 1.0 / (1.0 - p * c)
    blocks = np.array([[c * S * p, c * S], [S * p, S]]).transpose(2, 0, 1)
    assert norm_of(plant, K) == pytest.approx(float(np.linalg.svd(blocks, compute_uv=False).max()), rel=1e-3)


def test_bad_synthesis_is_refused() -> None:
    free = scenario("S", FAST).replace(control=None)
    with pytest.raises(InputError, match="must be positive"):
        lqg(free, regulated=CENTRED, measurements=MEASURED, command_size=0.0)
    with pytest.raises(InputError, match="is no input"):
        lqg(free, regulated=CENTRED, measurements=MEASURED, command_size=1.0, commands={"u": {"motor": 1.0}})
    with pytest.raises(InputError, match="is not the strategy's"):
        lqg(scenario(), regulated=CENTRED, measurements=MEASURED, command_size=1.0, sample_time=2e-3)
    with pytest.raises(InputError, match="is no order"):
        lqg(free, regulated=CENTRED, measurements=MEASURED, command_size=1e3, order=1000)
