"""Random response: one mass in closed form, bands, and a synthesised course in a time simulation."""

import numpy as np
import pytest
from scipy.linalg import expm
from tests.linear.masses import chain, model, on_two_axles

from klingel.errors import InputError
from klingel.linear.model import LinearModel
from klingel.linear.random import excitations, random_response
from klingel.track.irregularity import Quality, Rational, Spectrum, synthesise
from klingel.track.spectra import erri_b176


def level(value: float, shortest: float, longest: float) -> Quality:
    """A quality with an even vertical spectrum [m2/(rad/m)]."""
    even = Spectrum("even", "vertical", Rational(value, 0.0, ()), (shortest, longest), "design", ())
    return Quality("even", {"vertical": even})


def one_mass(m: float, k: float, c: float, *, speed: float) -> LinearModel:
    """A mass on spring and damper over one wheel, which the rail reaches through the spring only."""
    bare = chain([m], [k], [c])
    B = np.hstack((k * bare.B, np.zeros((2, 1))))
    names = ["w.left.rail_z", "w.left.rail_z_rate"]
    A, B = np.block([[bare.A, np.zeros((2, 1))], [np.zeros((1, 3))]]), np.vstack((B, np.zeros((1, 2))))
    return model(A, B, np.eye(1, 3), np.zeros((1, 2)), states=["z", "vz", "w.s"], inputs=names, speed=speed)


def test_one_mass_under_white_noise() -> None:
    """With S(f) = G, r.m.s.^2 = G k^2/(4 c k) over all frequencies; the band from f0/100 to 100 f0 misses under 2 %."""
    m, k, c, V = 2.0, 800.0, 2.0, 20.0
    f0 = np.sqrt(k / m) / (2.0 * np.pi)
    S = 1e-6
    found = random_response(one_mass(m, k, c, speed=V), level(S, V / (100.0 * f0), 100.0 * V / f0))
    G = 2.0 * np.pi / V * S
    missed = G * f0 / 100.0  # below the band the mass follows the rail
    assert found.rms()["y0"] ** 2 == pytest.approx(G * k / (4.0 * c) - missed, rel=2e-4)


def beam(speed: float = 40.0) -> LinearModel:
    return on_two_axles(mass=4e4, inertia=2e6, stiffness=1e6, damping=4e4, half_base=9.0, speed=speed)


def vertical(quality: Quality) -> Quality:
    return Quality(quality.name, {"vertical": quality.spectra["vertical"]})


def test_grid_resolves_the_density() -> None:
    """r.m.s. on the model's own grid and on one ten times finer."""
    quality = vertical(erri_b176("low"))
    coarse = random_response(beam(), quality)
    f = np.linspace(coarse.frequencies[0], coarse.frequencies[-1], 40001)
    fine = random_response(beam(), quality, frequencies=f)
    for name, value in coarse.rms().items():
        assert value == pytest.approx(fine.rms()[name], rel=1e-4)


def test_rms_of_bands_adds_up() -> None:
    found = random_response(beam(), vertical(erri_b176("low")), outputs=["z"])
    f = found.frequencies
    parts = [found.rms((f[0], 2.0))["z"], found.rms((2.0, f[-1]))["z"]]
    assert np.hypot(*parts) == pytest.approx(found.rms()["z"], rel=1e-4)
    with pytest.raises(InputError, match="not within"):
        found.rms((0.0, 1.0))


def test_time_simulation_of_a_synthesised_course() -> None:
    """A course without seam, settled: its r.m.s. is the sum over its lines, to the error of the hold."""
    V, h, L = 40.0, 2e-3, 3000.0
    quality = vertical(erri_b176("high"))
    course = synthesise(quality.spectra["vertical"], length=L, seed=4, fade=0.0)
    n = round(2.0 * L / V / h)
    behind = {"a.left": 0.0, "b.left": 18.0}
    entries = excitations([course], behind, speed=V, duration=n * h, interval=h)
    u = np.array([entry["values"] for entry in sorted(entries, key=lambda e: order(e["input"]))])
    continuous = beam(V)
    both = expm(np.block([[continuous.A, continuous.B], [np.zeros((4, 10))]]) * h)
    x, z = np.zeros(6), np.zeros((n, 2))
    for i in range(n):
        z[i] = continuous.C @ x
        x = both[:6, :6] @ x + both[:6, 6:] @ (0.5 * (u[:, i] + u[:, i + 1]))
    settled = z[n // 2 :]
    lines = np.arange(20, 1001) / L  # 150 m to 3 m
    found = random_response(continuous, quality, frequencies=lines * V)
    expected = np.sqrt(np.sum(found.psd * V / L, axis=0))
    np.testing.assert_allclose(settled.std(axis=0), expected, rtol=1e-3)
    whole = random_response(continuous, quality)
    assert settled[:, 0].std() == pytest.approx(whole.rms()["z"], rel=0.05)  # 1000 lines of random strength of G


def order(name: str) -> int:
    return [i.name for i in beam().inputs].index(name)


def test_what_cannot_be_answered() -> None:
    with pytest.raises(InputError, match="wavelengths from 3 m to 150 m"):
        random_response(beam(), vertical(erri_b176("low")), frequencies=[0.1])
    with pytest.raises(InputError, match="do not rise"):
        random_response(beam(), vertical(erri_b176("low")), frequencies=[1.0, 1.0])
    with pytest.raises(InputError, match="grows"):
        random_response(one_mass(1.0, 1.0, -1.0, speed=20.0), vertical(erri_b176("low")))
    course = synthesise(erri_b176("low").spectra["gauge"], length=500.0, seed=1)
    with pytest.raises(InputError, match="a kind twice"):
        excitations([course, course], {"a.left": 0.0}, speed=10.0, duration=1.0, interval=0.1)


def test_excitations_of_both_rails() -> None:
    gauge = synthesise(erri_b176("low").spectra["gauge"], length=500.0, seed=1)
    line = synthesise(erri_b176("low").spectra["alignment"], length=500.0, seed=2)
    found = excitations([gauge, line], {"a.left": 0.0, "a.right": 0.0}, speed=20.0, duration=20.0, interval=0.01)
    values = {entry["input"]: np.array(entry["values"]) for entry in found}
    s = 20.0 * np.arange(2001) * 0.01
    np.testing.assert_allclose(values["a.right.rail_y"] - values["a.left.rail_y"], gauge.at(s)[0], atol=1e-15)
    np.testing.assert_allclose(values["a.right.rail_y_rate"] + values["a.left.rail_y_rate"], 40.0 * line.at(s)[1])
