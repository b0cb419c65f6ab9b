"""Margins of loops: textbook loops, and those of the full vehicle by closing the loop at its edge and just beyond."""

import numpy as np
import pytest

import klingel as kl
from klingel.design import Loop, margins_of
from klingel.design.loops import loops
from klingel.design.margins import Margins, margins_of_all, of_response
from klingel.errors import InputError
from klingel.linear.blocks import eigenvalues, lives
from klingel.linear.margins import loop_gain
from klingel.linear.model import LinearModel

from .conftest import scenario

Opened = dict[str, dict[str, Loop]]
FIRST = "bogie1.wheelset1"


def grown(model: LinearModel) -> float:
    """Largest real part of the eigenvalues [1/s]."""
    s = eigenvalues(model)
    return float(s[lives(s, model.sample_time)].real.max())


def swings(model: LinearModel, frequency: float) -> float:
    """Real part of the eigenvalue next to a frequency [Hz]."""
    s = eigenvalues(model)
    return float(s[np.argmin(np.abs(s - 2j * np.pi * frequency))].real)


@pytest.fixture(scope="module")
def found(opened: Opened) -> dict[tuple[str, str], Margins]:
    names = {"S": ["steering", "motors"], "I gyro": ["steering", "motors"]}
    return {
        (strategy, kind): margins_of(opened[strategy][f"{FIRST}.{kind}"])
        for strategy, kinds in names.items()
        for kind in kinds
    }


@pytest.mark.parametrize("strategy", ["S", "I gyro"])
@pytest.mark.parametrize("kind", ["steering", "motors"])
def test_the_edge_is_where_the_eigenvalues_say(
    strategy: str, kind: str, opened: Opened, found: dict[tuple[str, str], Margins]
) -> None:
    """One percent before the margin the closed loop is stable, one percent beyond it is not, and swings as it says."""
    loop, edge = opened[strategy][f"{FIRST}.{kind}"], found[strategy, kind]
    assert edge.stable
    assert edge.gain < np.inf
    assert grown(loop.scaled(0.99 * edge.gain)) < 0.0 < grown(loop.scaled(1.01 * edge.gain))
    assert abs(swings(loop.scaled(edge.gain), edge.gain_frequency)) < 1e-3 * 2.0 * np.pi * edge.gain_frequency
    if edge.gain_down > 0.0:
        assert grown(loop.scaled(edge.gain_down / 0.99)) < 0.0 < grown(loop.scaled(edge.gain_down / 1.01))
    else:
        assert grown(loop.scaled(1e-2)) < 0.0
    samples = edge.delay / loop.closed.sample_time
    assert grown(loop.scaled(delay=int(0.99 * samples))) < 0.0 < grown(loop.scaled(delay=int(1.01 * samples) + 1))


def test_a_delay_of_whole_samples_turns_the_response(opened: Opened) -> None:
    """The models that are made to look past the edge are what they say."""
    loop = opened["S"][f"{FIRST}.steering"]
    f = np.geomspace(0.05, 100.0, 20)
    later = loops(loop.closed.model)
    assert [each.name for each in later][:2] == [f"{FIRST}.steering", f"{FIRST}.motors"]
    L = loop.response(f)
    b = loop.scaled(gain=2.0, delay=3)
    z = np.exp(2j * np.pi * f * loop.closed.sample_time)
    one = loop.scaled(gain=0.0, delay=0).A
    for i in (3, 12):
        whole = np.linalg.det((z[i] * np.eye(len(one)) - one) / z[i])
        turned = np.linalg.det((z[i] * np.eye(len(b.A)) - b.A) / z[i])
        assert turned / whole == pytest.approx(1.0 + 2.0 * L[i] * z[i] ** -3, rel=1e-6)


def test_loops_are_those_of_the_closed_channels(opened: Opened) -> None:
    """Against the response of the whole model from the inputs to the channels that hold what is commanded."""
    f = np.geomspace(0.02, 490.0, 40)
    model = kl.linearise(scenario("I gyro"))
    for kind, inputs, total in (
        ("steering", "actuator_{}.force", "actuator_{}.command"),
        ("motors", "{}.armature_voltage", "{}.armature_voltage"),
    ):
        u = {f"{FIRST}.{inputs.format(side)}": sign for side, sign in (("left", 1.0), ("right", -1.0))}
        y = {f"{FIRST}.{total.format(side)}": sign for side, sign in (("left", 0.5), ("right", -0.5))}
        L = opened["I gyro"][f"{FIRST}.{kind}"].response(f)
        np.testing.assert_allclose(L, loop_gain(model, u, y, f), rtol=1e-6, atol=1e-7)


def test_which_loops_there_are() -> None:
    """Steering and motors of every wheelset; with a traction loop also the means of motors and of fields."""
    driven = kl.control.SolidLike(traction=kl.control.Traction.follow([0.0, 10.0], [40.0, 40.0]))
    kinds = [loop.kind for loop in loops(scenario().replace(control=driven, speed=40.0, duration=5.0))]
    assert {kind: kinds.count(kind) for kind in kinds} == {"steering": 4, "motors": 4, "traction": 4, "field": 4}
    assert [loop.kind for loop in loops(scenario())] == ["steering", "motors"] * 4
    assert loops(scenario().replace(control=None)) == ()


def test_sharp_resonances_are_not_missed() -> None:
    """A resonance of 0.02 % damping, narrower than any even grid, has the least gain margin."""
    w, zeta = 2.0 * np.pi * 40.0, 2e-4

    def sharp(f: np.ndarray) -> np.ndarray:
        s = 2j * np.pi * np.asarray(f)
        return np.asarray(
            2.0 / s * np.exp(-0.01 * s) + 1.2e-4 * w**2 * np.exp(-s / 160.0) / (s**2 + 2.0 * zeta * w * s + w**2)
        )

    about = w / (2.0 * np.pi) * (1.0 + zeta * np.array([-2.0, -0.8, -0.3, 0.0, 0.3, 0.8, 2.0]))
    f = np.unique(np.concatenate([np.geomspace(2e-3, 500.0, 160), about]))
    edge = of_response(sharp, f, sharp(f))
    fine = np.linspace(39.9, 40.1, 400001)
    L = sharp(fine)
    change = np.flatnonzero((np.diff(np.sign(L.imag)) != 0.0) & (L.real[:-1] < 0.0))
    assert edge.gain == pytest.approx(float((-1.0 / L.real[change]).min()), rel=1e-3)
    assert edge.sensitivity == pytest.approx(float(np.abs(1.0 / (1.0 + L)).max()), rel=1e-3)


def test_a_loop_that_holds_an_unstable_plant_has_a_lower_gain_margin() -> None:
    """3/(s - 1) closes to a pole at -2: it bears any larger gain and phase up to acos(1/3), and a third of its gain."""

    def held(f: np.ndarray) -> np.ndarray:
        return np.asarray(3.0 / (2j * np.pi * np.asarray(f) - 1.0))

    f = np.concatenate(([1e-5], np.geomspace(2e-3, 50.0, 200)))
    edge = of_response(held, f, held(f))
    assert edge.gain == np.inf
    assert edge.gain_down == pytest.approx(1.0 / 3.0, rel=1e-3)
    assert edge.crossover == pytest.approx(np.sqrt(8.0) / (2.0 * np.pi), rel=1e-3)
    assert edge.phase == pytest.approx(np.arccos(1.0 / 3.0), rel=1e-3)
    assert edge.delay == pytest.approx(np.arccos(1.0 / 3.0) / np.sqrt(8.0), rel=1e-3)


def test_the_disk_margin_of_an_integrator() -> None:
    """L = 1/s: S - T = (s - 1)/(s + 1) has the size one everywhere, alpha = 2, which is any gain and 90 degrees."""

    def integrator(f: np.ndarray) -> np.ndarray:
        return np.asarray(1.0 / (2j * np.pi * np.asarray(f)))

    f = np.geomspace(2e-3, 50.0, 100)
    edge = of_response(integrator, f, integrator(f))
    assert edge.disk == pytest.approx(2.0, rel=1e-6)
    assert edge.disk_gain == pytest.approx((0.0, np.inf), abs=1e-6) or edge.disk_gain[1] > 1e6
    assert edge.disk_phase == pytest.approx(np.pi / 2.0, rel=1e-6)
    assert edge.gain == np.inf


def test_the_disk_margin_is_inside_the_others(found: dict[tuple[str, str], Margins]) -> None:
    for edge in found.values():
        low, high = edge.disk_gain
        assert edge.gain_down <= low * 1.0001
        assert high <= edge.gain * 1.0001
        assert edge.disk_phase <= edge.phase * 1.0001
        assert edge.sensitivity >= 1.0


def test_an_unstable_loop_has_no_margins(opened: Opened) -> None:
    """Beyond the gain margin all loops of the vehicle are closed around an unstable one."""
    loop = opened["S"][f"{FIRST}.steering"]
    beyond = margins_of(loops(loop.scaled(20.0))[0])
    assert not beyond.stable
    assert beyond.growth > 0.0
    assert np.isnan([beyond.gain, beyond.phase, beyond.delay, beyond.disk]).all()


def test_a_model_without_controllers_has_no_loops_to_open() -> None:
    plant = kl.linearise(scenario(), controllers=False)
    assert loops(plant) == ()
    from klingel.design.loops import Closed

    with pytest.raises(InputError, match="no sampled controllers"):
        Closed(plant, [{}])


def test_filters_at_half_the_sample_rate_are_no_crossings() -> None:
    """The bilinear filters of a hard coupling have poles at z = -1, where nothing is to be seen."""
    hard = scenario(speed=265.0 / 3.6).replace(control=kl.control.SolidLike(coupling=0.5))
    found = [loop for loop in loops(hard) if loop.kind == "motors"]
    for edge in margins_of_all(found):
        assert not edge.crossover > 100.0
        assert not edge.sensitivity_frequency > 200.0
