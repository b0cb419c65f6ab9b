"""Smoothing of measured profiles: it filters as its formula says, spares the shape, and refuses spikes."""

import numpy as np
import pytest

from klingel.contact import Profile
from klingel.errors import InputError


def off(one: Profile, other: Profile, least: float, most: float) -> np.ndarray:
    """Distance along the normal [m] between two profiles."""
    y = np.linspace(least, most, 4000)
    slope = np.gradient(other.depth(y), y)
    return (one.depth(y) - other.depth(y)) / np.sqrt(1.0 + slope**2)


def measured(scatter: float) -> Profile:
    """S1002 as a device gives it: a point every quarter of a millimetre, each off along the normal."""
    wheel = Profile.s1002()
    angle = np.arctan(np.gradient(wheel.z, wheel.y))
    away = np.random.default_rng(7).normal(0.0, scatter, len(wheel.y))
    kept = np.nonzero(wheel.y > -0.069)[0][::5]
    return Profile("measured", (wheel.y - away * np.sin(angle))[kept], (wheel.z + away * np.cos(angle))[kept])


@pytest.mark.parametrize(("wavelength", "part"), [(6e-3, 16 / 17), (3e-3, 0.5), (1e-3, 1 / 82)])
def test_waves_keep_their_part(wavelength: float, part: float) -> None:
    y = np.linspace(-0.04, 0.04, 1601)
    wave = 1e-5 * np.cos(2.0 * np.pi * y / wavelength)
    smooth = Profile("wavy", y, y**2 / 0.6 + wave).smoothed("3 mm")
    left = smooth.depth(0.0) - smooth.depth(0.5 * wavelength) + (0.5 * wavelength) ** 2 / 0.6
    assert float(left) == pytest.approx(2e-5 * part, abs=1e-7)


@pytest.mark.parametrize(("cutoff", "root", "tread"), [("1 mm", 0.4e-6, 0.03e-6), ("3 mm", 3e-6, 0.2e-6)])
def test_a_smooth_profile_hardly_moves(cutoff: str, root: float, tread: float) -> None:
    wheel = Profile.s1002()
    smooth = wheel.smoothed(cutoff)
    assert np.abs(off(smooth, wheel, -0.0695, 0.0595)).max() < root
    assert np.abs(off(smooth, wheel, -0.02, 0.0595)).max() < tread


def test_scatter_becomes_smaller_and_curvature_usable() -> None:
    wheel, rough = Profile.s1002(), measured(5e-6)
    smooth = rough.smoothed()
    assert np.std(off(smooth, wheel, -0.03, 0.055)) < 0.5 * 5e-6
    y = np.linspace(-0.02, 0.03, 400)

    def bend(profile: Profile) -> np.ndarray:
        return np.gradient(np.gradient(np.interp(y, profile.y, profile.z), y), y)

    assert np.std(bend(smooth) - bend(wheel)) < 0.05 * np.std(bend(rough) - bend(wheel))


def test_spikes_are_named_and_not_averaged_in() -> None:
    rough = measured(5e-6)
    z = rough.z.copy()
    z[[100, 300]] += [1e-4, -2e-4]
    with pytest.raises(InputError) as caught:
        Profile("spiky", rough.y, z).smoothed()
    text = str(caught.value)
    assert "spiky" in text
    assert "point 101" in text
    assert "point 301" in text
    assert len(caught.value.problems) == 2


@pytest.mark.parametrize(("cutoff", "said"), [("0.05 mm", "outside"), ("5 cm", "outside"), ("0.3 mm", "two steps")])
def test_cutoffs_that_make_no_sense(cutoff: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        measured(5e-6).smoothed(cutoff)
