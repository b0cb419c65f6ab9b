"""Irregularity: published spectra against their known r.m.s. values, statuses, ranges, and courses drawn from them."""

import math

import numpy as np
import pytest

from klingel.errors import InputError
from klingel.track.irregularity import KINDS, Quality, synthesise
from klingel.track.spectra import china_ballastless, erri_b176, fra, sncf

ALL = [
    erri_b176("low"),
    erri_b176("high"),
    *(fra(i) for i in range(1, 7)),
    sncf("good"),
    sncf("poor"),
    china_ballastless(),
]

RMS_MM = {  # of the public implementation that the numbers are from: 3-150 m, 3-25 m
    ("low", "vertical"): (2.86, 0.98),
    ("low", "alignment"): (2.08, 0.71),
    ("high", "vertical"): (4.69, 1.61),
    ("high", "alignment"): (3.53, 1.21),
}


@pytest.mark.parametrize(("level", "kind"), RMS_MM)
def test_rms_of_ore_b176(level, kind):
    spectrum = erri_b176(level).spectra[kind]
    whole, short = RMS_MM[level, kind]
    assert 1e3 * spectrum.rms() == pytest.approx(whole, abs=0.006)
    assert 1e3 * spectrum.within("3 m", "25 m").rms() == pytest.approx(short, abs=0.006)


def test_formulas_by_hand():
    """One value of each, written out again from the sources: m2/(rad/m) at 0.5 rad/m."""
    w = 0.5
    Oc, Or, Os = 0.8246**2, 0.0206**2, 0.4380**2
    low = erri_b176("low").spectra
    assert low["vertical"].psd(w) == pytest.approx(4.032e-7 * Oc / ((w**2 + Or) * (w**2 + Oc)))
    angle = 4.032e-7 / 0.75**2 * Oc * w**2 / ((w**2 + Or) * (w**2 + Oc) * (w**2 + Os))
    assert low["crosslevel"].psd(w) == pytest.approx(1.5**2 * angle)
    assert low["gauge"].psd(w) == pytest.approx(5.32e-8 * Oc * w**2 / ((w**2 + Or) * (w**2 + Oc) * (w**2 + Os)))
    six = fra(6).spectra
    assert six["alignment"].psd(w) == pytest.approx(0.25 * 0.0339e-4 * 0.8245**2 / (w**2 * (w**2 + 0.8245**2)))
    both = 4 * 0.25 * 0.0339e-4 * 0.8245**2 / ((w**2 + 0.8245**2) * (w**2 + 0.438**2))
    assert six["crosslevel"].psd(w) == pytest.approx(both)
    n = w / (2 * math.pi)
    assert sncf("good").spectra["vertical"].psd(w) == pytest.approx(1.56772e-4 / (1 + n / 0.0489) ** 3 / (2 * math.pi))
    assert china_ballastless().spectra["gauge"].psd(w) == pytest.approx(5.4978e-8 / n**0.8282 / (2 * math.pi))


def test_pieces_meet():
    for spectrum in china_ballastless().spectra.values():
        for limit in spectrum.law.limits:
            below, above = spectrum.psd(2 * math.pi * limit * np.array([1 - 1e-9, 1 + 1e-9]))
            assert above == pytest.approx(below, rel=0.005)  # as rounded in the standard


def test_better_classes_are_smoother():
    for kind in KINDS:
        rms = [fra(i).spectra[kind].within(3, 25).rms() for i in range(1, 7)]
        assert rms == sorted(rms, reverse=True)


def test_recalled_numbers_say_so():
    assert fra(3).spectra["alignment"].status == "memory"
    assert fra(3).spectra["vertical"].status == "repo"
    assert {s.status for s in fra(5).spectra.values()} == {"repo"}
    assert all(spectrum.source for quality in ALL for spectrum in quality.spectra.values())


@pytest.mark.parametrize("quality", ALL, ids=lambda q: q.name)
def test_ranges_are_refused_outside(quality: Quality):
    for spectrum in quality.spectra.values():
        shortest, longest = spectrum.wavelengths
        assert np.all(spectrum.psd(2 * math.pi / np.array([longest, shortest])) > 0)
        for wavelength in (0.99 * shortest, 1.01 * longest):
            with pytest.raises(InputError, match="is outside the wavenumbers"):
                spectrum.psd(2 * math.pi / wavelength)
        with pytest.raises(InputError, match="are not within"):
            spectrum.within(0.5 * shortest, longest)


def test_frequencies_and_wavenumbers_hold_the_same_energy():
    spectrum = erri_b176("high").spectra["gauge"]
    low, high = spectrum.band(50.0)
    assert (low, high) == (50.0 / 150.0, 50.0 / 3.0)
    f = np.linspace(low, high, 20001)
    assert np.sqrt(np.trapezoid(spectrum.over_frequency(f, speed=50.0), f)) == pytest.approx(spectrum.rms(), rel=1e-5)


def test_unknown_names():
    with pytest.raises(InputError, match="did you mean 'low'"):
        erri_b176("lo")
    with pytest.raises(InputError, match="known: 1, 2, 3"):
        fra(7)


@pytest.mark.parametrize("fade", [0.0, 50.0])
def test_a_course_has_the_spectrum_and_true_slopes(fade):
    spectrum = erri_b176("low").spectra["vertical"]
    course = synthesise(spectrum, length=6000, seed=7, fade=fade)
    assert course.values.std() == pytest.approx(spectrum.rms(), rel=0.02)
    s = np.linspace(0.0, course.length, 5003)[1:-1]
    h = 1e-3
    slope = (course.at(s + h)[0] - course.at(s - h)[0]) / (2 * h)
    np.testing.assert_allclose(course.at(s)[1], slope, atol=2e-6 * np.abs(slope).max())
    w = 2 * math.pi / course.length * np.arange(60, 1500)
    lines = np.abs(np.fft.rfft(course.values) / len(course.values))[60:1500] ** 2 * 2 * course.length / (2 * math.pi)
    if fade == 0.0:
        np.testing.assert_allclose(lines, spectrum.psd(w), rtol=1e-6)


def test_a_course_begins_and_ends():
    spectrum = erri_b176("low").spectra["alignment"]
    faded = synthesise(spectrum, length=400, seed=1)
    values, slopes = faded.at([-3.0, 0.0, 400.0, 403.0])
    np.testing.assert_allclose(values, 0.0, atol=1e-12)
    np.testing.assert_allclose(slopes, 0.0, atol=1e-12)
    endless = synthesise(spectrum, length=400, seed=1, fade=0.0)
    np.testing.assert_allclose(endless.at([-3.0, 12.3]), endless.at([397.0, 412.3]), atol=1e-15)
    other = synthesise(spectrum, length=400, seed=2, fade=0.0)
    assert np.abs(other.values - endless.values).max() > 1e-3


@pytest.mark.parametrize(
    ("changes", "said"),
    [({"length": 200}, "too short"), ({"interval": 1.0}, "too coarse"), ({"fade": 300}, "does not fit")],
)
def test_courses_that_cannot_be(changes, said):
    with pytest.raises(InputError, match=said):
        synthesise(erri_b176("low").spectra["gauge"], **{"length": 400, "seed": 1, **changes})
