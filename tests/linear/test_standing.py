"""Responses at 0 Hz and at other eigenvalues: finite ones in closed form, infinite ones named, real vehicles."""

import numpy as np
import pytest
from scipy.linalg import expm
from tests.linear.masses import chain, model

import klingel as kl
from klingel.errors import InputError
from klingel.linear.model import LinearModel
from klingel.linear.response import frequency_response, irregularity


def braked() -> LinearModel:
    """A mass of 3 kg on a brake of 6 N s/m: a force gives it 1/6 m/s, and its place grows for ever."""
    A, B = np.array([[0.0, 1.0], [0.0, -2.0]]), np.array([[0.0], [1.0 / 3.0]])
    return model(A, B, np.eye(2), np.zeros((2, 1)), outputs=["place", "speed"], inputs=["force"])


def held(plant: LinearModel, T: float) -> LinearModel:
    n, m = plant.B.shape
    both = expm(np.block([[plant.A, plant.B], [np.zeros((m, n + m))]]) * T)
    names = [signal.name for signal in plant.outputs], [signal.name for signal in plant.inputs]
    return model(
        both[:n, :n],
        both[:n, n:],
        plant.C,
        plant.D,
        states=[signal.name for signal in plant.states],
        outputs=names[0],
        inputs=names[1],
        sample_time=T,
    )


@pytest.mark.parametrize("sample_time", [None, 0.01])
def test_a_free_mass_has_a_speed_and_no_place(sample_time: float | None) -> None:
    made = braked() if sample_time is None else held(braked(), sample_time)
    assert frequency_response(made, "force", "speed", [0.0, 1.0])[0] == pytest.approx(1.0 / 6.0)
    with pytest.raises(InputError, match=r"frequency = 0\.0: .* response of place to force is infinite"):
        frequency_response(made, "force", ["speed", "place"], [1.0, 0.0])


def test_what_goes_on_between_the_samples_at_0_hz() -> None:
    plant = braked()
    found = frequency_response(held(plant, 0.01), "force", "speed", [0.0], plant=plant)
    assert found[0] == pytest.approx(1.0 / 6.0)


def test_a_force_that_nothing_holds_has_no_speed_either() -> None:
    free = model(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]), np.eye(2), np.zeros((2, 1)))
    for output in ("y0", "y1"):
        with pytest.raises(InputError, match=f"response of {output} to u0 is infinite"):
            frequency_response(free, "u0", output, [0.0])


def test_an_undamped_mode_that_is_not_reached() -> None:
    """Two equal masses pushed alike: the mode in which they swing against each other stays at rest."""
    row = chain([1.0, 1.0], [100.0, 300.0], [0.0, 0.0])
    A = row.A.copy()
    A[2:, :2] = -np.array([[400.0, -300.0], [-300.0, 400.0]])
    made = model(A, row.B, row.C, row.D)
    against = np.sqrt(700.0) / (2.0 * np.pi)
    alike = frequency_response(made, {"u0": 1.0, "u1": 1.0}, "y0", [against])
    assert alike[0] == pytest.approx(1.0 / (100.0 - 700.0))
    with pytest.raises(InputError, match="is an eigenvalue"):
        frequency_response(made, {"u0": 1.0, "u1": -1.0}, "y0", [against])


def coach(at: str | None, control: object = None) -> LinearModel:
    name = "manchester_coach" if control is None else "mechatronic_irw"
    curve = kl.Track.curve(radius="800 m", cant="100 mm", transition="60 m")
    return kl.linearise(kl.Scenario(kl.library.vehicle(name), curve, speed=40.0, control=control), at=at)


@pytest.mark.parametrize("control", [None, kl.control.IRWLike()])
def test_steady_gains_of_vehicles(control: object) -> None:
    made = coach("400 m", control)
    outputs = ["body.y", "body.roll", "bogie1.wheelset1.y", "bogie1.wheelset1.left.Q"]
    for name in ("track.cant", "wind.y", "wind.z"):
        still, slow = frequency_response(made, name, outputs, [0.0, 1e-4])
        assert still.real == pytest.approx(slow.real, rel=2e-4, abs=1e-6 * np.abs(slow).max())
        with pytest.raises(InputError, match=rf"response of body\.s to {name} is infinite"):
            frequency_response(made, name, [*outputs, "body.s"], [0.0])


def test_wheels_take_the_wind_at_0_hz() -> None:
    """The sum of all wheel forces holds the wind."""
    made = coach(None)
    wheels = [signal.name for signal in made.outputs if signal.name.endswith(".Q")]
    gain = frequency_response(made, "wind.z", dict.fromkeys(wheels, 1.0), [0.0])
    assert gain[0] == pytest.approx(1.0, rel=1e-3)
    lifted = frequency_response(made, irregularity(made, "vertical", [0.0]), ["body.z", "bogie1.z"], [0.0])
    assert lifted[0] == pytest.approx([1.0, 1.0], rel=1e-6)
