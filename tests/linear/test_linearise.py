"""The linear model against small runs of the same spec, and against central differences.
Random inputs of every kind, two seconds, the passive vehicle and both strategies."""

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

import klingel as kl
from klingel.control import IRWLike, SolidLike
from klingel.errors import InputError
from klingel.linear import LinearModel, linearise, steady_spec
from klingel.linear.statespace import held
from klingel.result import simulate_spec

STRAIGHT = kl.Track.straight("1 km")
CURVE = kl.Track.curve(radius="800 m", cant="160 mm", transition="195 m", arc="300 m")
INTERVAL = 1e-3
DURATION = 2.0
STEP = 1e-4
"""So short that the scheme is exact for the wheelsets' bouncing on the contact springs near 180 Hz as well."""
SIZES = {"V": 0.03, "N": 0.3, "m": 1e-8, "m/s": 1e-8, "1/m": 3e-11, "N m": 10.0, "rad": 1e-8}
SPEED = 1e-3
"""Of the random inputs, and of the held speed [m/s]: so small that what is left of the nonlinearity stays below the
limit, so large that rounding does as well (10 m of arc are known to 2e-15 m, and primary springs have 3e7 N/m)."""
BAND = 20.0
"""Of the random inputs [Hz]: what a vehicle follows. White ones shake the wheelsets on their contact springs, and the
creep forces' bend there, averaged, is no longer small beside the little that the bodies feel."""
BRANCHING = ("contact_angle", "steep_force", "slender_force", "tgamma", "spin_work")
"""Channels that are no linear functions of small motions: the steepest patch, sums of absolute values."""


def scenario(vehicle: str, control: Any, track: kl.Track, speed: str = "176 km/h") -> kl.Scenario:
    return kl.Scenario(kl.library.vehicle(vehicle), track, speed=speed, control=control)


def excited(spec: dict[str, Any], inputs: dict[str, np.ndarray]) -> dict[str, Any]:
    spec = copy.deepcopy(spec)
    spec["run"] |= {"duration": DURATION, "record_interval": INTERVAL, "step": STEP}
    spec["run"]["excitations"] = [
        {"input": name, "interval": INTERVAL, "values": values.tolist()} for name, values in inputs.items()
    ]
    return spec


def predicted(model: LinearModel, inputs: dict[str, np.ndarray]) -> np.ndarray:
    """Outputs of the linear model, one row a sample, inputs held."""
    chosen = model.select(inputs=list(inputs))
    u = np.array(list(inputs.values())).T
    phi, gamma = (chosen.A, chosen.B) if chosen.sample_time else held(chosen, INTERVAL)
    x = np.zeros(len(phi))
    rows = []
    for now in u:
        rows.append(chosen.C @ x + chosen.D @ now)
        x = phi @ x + gamma @ now
    return np.array(rows)


CASES = [
    ("manchester_coach", None, STRAIGHT, None),
    ("manchester_coach", None, CURVE, "500 m"),
    ("mechatronic_irw", IRWLike(), STRAIGHT, None),
    ("mechatronic_irw", IRWLike(), CURVE, "500 m"),
    ("mechatronic_irw", SolidLike(), STRAIGHT, None),
    ("mechatronic_irw", SolidLike(), CURVE, "500 m"),
]


@pytest.mark.parametrize(("vehicle", "control", "track", "at"), CASES)
def test_small_runs_follow_the_linear_model(vehicle: str, control: Any, track: kl.Track, at: str | None) -> None:
    run = scenario(vehicle, control, track)
    model = linearise(run, at=at)
    inputs = random_inputs(model)
    spec = steady_spec(run, at=at)
    still, moved = (simulate_spec(excited(spec, i)) for i in ({}, inputs))
    expected = predicted(model, inputs)
    errors, sizes = {}, {}
    for k, output in enumerate(model.outputs):
        quantity = output.name.rpartition(".")[2]
        if quantity in BRANCHING or quantity == "s":
            continue
        seen = (moved[output.name] - still[output.name]).to_numpy()[: len(expected)]
        errors[output.name] = rms(seen - expected[:, k])
        sizes[quantity] = max(sizes.get(quantity, 0.0), rms(seen))
    relative = {name: error / sizes[name.rpartition(".")[2]] for name, error in errors.items() if error > 0.0}
    largest = max(relative, key=lambda name: relative[name])
    assert relative[largest] < 1e-3, (largest, relative[largest])


def test_white_wind_on_a_controlled_vehicle_too() -> None:
    """Controllers are settled before the first gust: what it makes them measure is not where their filters rest."""
    run = scenario("mechatronic_irw", IRWLike(), STRAIGHT)
    model = linearise(run)
    gusts = {"wind.y": 10.0 * np.random.default_rng(2).standard_normal(round(DURATION / INTERVAL))}
    spec = steady_spec(run)
    still, moved = (simulate_spec(excited(spec, i)) for i in ({}, gusts))
    outputs = ["bogie1.wheelset1.y", "body.y", "bogie1.wheelset1.actuator_left.command"]
    expected = predicted(model.select(outputs=outputs), gusts)
    for k, name in enumerate(outputs):
        seen = (moved[name] - still[name]).to_numpy()[: len(expected)]
        assert rms(seen - expected[:, k]) < 1e-3 * rms(seen), name


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def random_inputs(model: LinearModel) -> dict[str, np.ndarray]:
    random = np.random.default_rng(5)
    low = butter(4, BAND, fs=1.0 / INTERVAL, output="sos")
    count = round(DURATION / INTERVAL)
    sizes = {s.name: SPEED if s.name == "hold.speed" else SIZES[s.unit] for s in model.inputs}
    return {name: size * sosfilt(low, random.standard_normal(count)) for name, size in sizes.items()}


def test_a_kink_is_named() -> None:
    from klingel.linear import steady_state

    track = kl.Track.curve(radius="1200 m", cant="160 mm", transition="285 m", arc="300 m")
    near = steady_state(scenario("manchester_coach", None, track, "223.2 km/h"), at="600 m")
    assert any("lateral_stop is near a corner" in text for text in near.warnings)
    assert steady_state(scenario("manchester_coach", None, STRAIGHT)).warnings == ()


def test_files_and_python_control_hold_the_same_model(tmp_path: Path) -> None:
    from scipy.io import loadmat

    whole = linearise(scenario("mechatronic_irw", IRWLike(), STRAIGHT))
    model = whole.select(inputs=["wind.y"], outputs=["body.lateral_acceleration", "bogie1.wheelset1.y"])
    read = json.loads(model.to_json(tmp_path / "model.json").read_text())
    assert np.array_equal(read["A"], model.A)
    assert read["inputs"] == [["wind.y", "N"]]
    mat = loadmat(model.to_mat(tmp_path / "model.mat"))
    assert np.array_equal(mat["A"], model.A)
    assert float(mat["Ts"].item()) == model.sample_time == 1e-3
    system = model.to_control()
    assert system.output_labels == ["body_lateral_acceleration", "bogie1_wheelset1_y"]
    assert np.array_equal(system.B, model.B)
    assert not list(tmp_path.glob("*.tmp"))


def test_unknown_names_are_refused_with_the_nearest() -> None:
    model = linearise(scenario("manchester_coach", None, STRAIGHT))
    with pytest.raises(InputError, match="did you mean"):
        model.select(inputs=["wind.x"])
    with pytest.raises(InputError, match="outside the track"):
        linearise(scenario("manchester_coach", None, CURVE), at="99 km")


def test_without_controllers_commands_are_inputs_of_a_continuous_model() -> None:
    run = scenario("mechatronic_irw", IRWLike(), CURVE)
    plant, closed = (linearise(run, at="500 m", controllers=c) for c in (False, True))
    n = len(plant.states)
    assert plant.sample_time is None
    assert np.array_equal(closed.x[:n], plant.x)  # about the same, controlled operating point
    force = plant.u[[s.name for s in plant.inputs].index("bogie1.wheelset1.actuator_left.force")]
    assert abs(force) > 100.0
