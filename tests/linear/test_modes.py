"""Modes: known oscillators first, then a vehicle made by hand, then the real ones."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

import klingel as kl
from klingel import cli
from klingel.cli.scenario import scenario_of
from klingel.errors import InputError
from klingel.linear.blocks import eigen, eigenvalues, lives
from klingel.linear.kinematics import Placement, UniformTrack, joint_jacobian
from klingel.linear.model import LinearModel, Signal
from klingel.linear.modes import Mode, modes, table
from klingel.linear.names import by_kind
from klingel.linear.shapes import Structure
from klingel.linear.sweep import Sweep
from klingel.lower import lower
from klingel.report.modes import modes_report

from .synthetic import model_of

M1, M2, K = 3.0, 5.0, 700.0


def model(A: np.ndarray, states: list[str], sample_time: float | None = None) -> LinearModel:
    n = len(A)
    nothing = np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0))
    signals = tuple(Signal(name, "") for name in states)
    x, none = np.zeros(n), np.zeros(0)
    return LinearModel("two masses", 10.0, signals, (), (), A, *nothing, x, none, none, sample_time)


def two_masses(damping: float) -> tuple[LinearModel, dict[str, Any]]:
    """Two free masses joined by a spring and a damper across the track."""
    a = np.array([1.0 / M1, -1.0 / M2])  # force K (y2 - y1) on the first, its reaction on the second
    row = np.array([-1.0, 1.0])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [K * np.outer(a, row), damping * np.outer(a, row)]])
    bodies = [
        {"name": name, "mass": mass, "inertia": [1.0, 1.0, 1.0], "position": [0.0, 0.0, 0.0]}
        for name, mass in (("first", M1), ("second", M2))
    ]
    joint = {"a": "first", "b": "second", "point": [0.0, 0.0, 0.0]}
    bushing = {"name": "spring", "joint": joint, "stiffness": [0.0, K, 0.0], "damping": [0.0, damping, 0.0]}
    spec = {"name": "two masses", "bodies": bodies, "bushings": [bushing], "track": {"cant_base": 1.5}}
    return model(A, ["first.y", "second.y", "first.vy", "second.vy"]), spec


def only(found: tuple[Mode, ...]) -> Mode:
    (mode,) = [m for m in found if m.oscillates]
    return mode


@pytest.mark.parametrize("damping", [0.0, 8.0])
@pytest.mark.parametrize("sample_time", [None, 1e-3])
def test_two_masses(damping: float, sample_time: float | None) -> None:
    plant, spec = two_masses(damping)
    seen = (
        plant
        if sample_time is None
        else model(expm(plant.A * sample_time), [s.name for s in plant.states], sample_time)
    )
    mode = only(modes(seen, spec))
    reduced = M1 * M2 / (M1 + M2)
    omega = np.sqrt(K / reduced)
    zeta = damping / (2.0 * np.sqrt(K * reduced))
    assert mode.damping == pytest.approx(zeta, abs=1e-9)
    assert mode.frequency == pytest.approx(omega * np.sqrt(1.0 - zeta**2) / (2.0 * np.pi), rel=1e-9)
    # the lighter mass moves further: energies are as the other's mass
    assert mode.bodies == pytest.approx({"first": M2 / (M1 + M2), "second": M1 / (M1 + M2)})
    assert mode.elements == pytest.approx({"spring": 1.0})
    assert mode.parts == {"bodies": pytest.approx(1.0)}
    first, second = mode.shape[:2]
    assert M1 * first == pytest.approx(-M2 * second)


def test_without_losses_kinetic_and_elastic_energy_are_equal() -> None:
    plant, spec = two_masses(0.0)
    mode = only(modes(plant, spec))
    structure = Structure(spec, plant)
    kinetic, elastic = structure.kinetic(mode.shape), structure.potential(mode.shape)
    assert sum(kinetic.values()) == pytest.approx(1.0)
    assert sum(elastic.values()) == pytest.approx(1.0, rel=1e-12)


def test_a_model_alone_does_not_say_what_moves() -> None:
    with pytest.raises(InputError, match="give `of`"):
        modes(two_masses(0.0)[0])


@pytest.mark.parametrize(
    ("of", "other", "said"),
    [
        ("manchester_coach", "mechatronic_irw", "the model has no state bogie1.wheelset1.left.spin_speed"),
        ("mechatronic_irw", "manchester_coach", "the model has no state bogie1.wheelset1.spin.spin_speed"),
    ],
)
def test_a_scenario_of_another_vehicle_is_refused(of: str, other: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        modes(kl.linearise(scenario(of)), scenario(other))


def test_a_model_with_further_bodies_is_refused() -> None:
    plant, spec = two_masses(0.0)
    with pytest.raises(InputError, match="of = 'two masses': is not what the model was made of: it has no body second"):
        modes(plant, spec | {"bodies": spec["bodies"][:1], "bushings": []})


def test_joints_on_a_canted_curve_against_differences() -> None:
    track = UniformTrack(1.0 / 300.0, 0.1)
    a = np.array([20.0, 0.02, -0.6, 0.01, 0.002, -0.003])
    b = np.array([29.4, -0.14, -1.8, 0.02, -0.001, 0.004])
    points = np.array([0.1, -1.0, -0.2]), np.array([-9.4, -1.0, 1.0])
    u, J = joint_jacobian(track, Placement(a, points[0]), Placement(b, points[1]))
    q, h = np.concatenate([a, b]), 1e-6
    for k, step in enumerate(h * np.eye(12)):
        ahead, back = (
            joint_jacobian(track, Placement((q + s)[:6], points[0]), Placement((q + s)[6:], points[1]))[0]
            for s in (step, -step)
        )
        assert J[:, k] == pytest.approx((ahead - back) / (2.0 * h), abs=2e-8), k
    assert np.all(np.isfinite(u))


def test_joints_are_at_rest_in_the_design_position() -> None:
    a, b = np.array([3.0, 0.0, -0.6, 0, 0, 0]), np.array([1.0, 0.0, -1.8, 0, 0, 0])
    u, _ = joint_jacobian(
        UniformTrack(), Placement(a, np.array([0.5, 1.0, 0.1])), Placement(b, np.array([2.5, 1.0, 1.3]))
    )
    assert u == pytest.approx(np.zeros(6), abs=1e-15)


@pytest.fixture(scope="module")
def by_hand() -> tuple[LinearModel, dict[str, Any]]:
    scenario = kl.Scenario(kl.library.vehicle("manchester_coach"), kl.Track.straight("500 m"), speed=40.0)
    spec = lower(scenario)
    return model_of(spec), spec


def test_eigenvectors_by_halves_are_those_of_the_whole(by_hand: tuple[LinearModel, dict[str, Any]]) -> None:
    made, _ = by_hand
    values, left, right = eigen(made)
    n = len(made.states)
    assert len(values) == n - 1  # the free position along the track is taken out
    assert np.abs(left.conj().T @ right - np.eye(n - 1)).max() < 1e-9
    scale = 1.0 + np.abs(values)
    assert np.abs((made.A @ right - right * values) / scale / np.linalg.norm(right, axis=0)).max() < 1e-9
    assert np.abs((made.A.T @ left.conj() - left.conj() * values) / scale / np.linalg.norm(left, axis=0)).max() < 1e-9
    whole = np.linalg.eigvals(made.A)
    alone = eigenvalues(made)
    for each in (values, alone):
        assert max(np.abs(whole - s).min() / (1.0 + abs(s)) for s in each) < 1e-8


def test_names_of_a_coach_by_hand(by_hand: tuple[LinearModel, dict[str, Any]]) -> None:
    found = modes(*by_hand)
    names = [mode.name for mode in found]
    for once in ("lower sway", "upper sway", "body bounce", "body pitch", "body yaw", "speed hold"):
        assert names.count(once) == 1, once
    for mode in found:
        assert sum(mode.bodies.values()) == pytest.approx(1.0) or not mode.bodies
        assert sum(abs(s) for s in mode.elements.values()) == pytest.approx(1.0)
    hunting = [mode for mode in found if mode.name.startswith("bogie hunting") and mode.swings]
    # a rigid bogie's kinematic wavelength: 2 pi sqrt(r b/gamma (1 + (a/b)^2)), softened by the suspension
    wavelength = 2.0 * np.pi * np.sqrt(0.46 * 0.75 / 0.1 * (1.0 + (1.28 / 0.75) ** 2))
    assert any(40.0 / mode.frequency == pytest.approx(wavelength, rel=0.2) for mode in hunting)


def scenario(name: str, control: Any = None, speed: float = 40.0) -> kl.Scenario:
    return kl.Scenario(kl.library.vehicle(name), kl.Track.straight("1 km"), speed=speed, control=control)


@pytest.fixture(scope="module")
def coach() -> tuple[Mode, ...]:
    return modes(scenario("manchester_coach"))


def named(found: tuple[Mode, ...], name: str) -> Mode:
    (mode,) = [m for m in found if m.name == name]
    return mode


@pytest.mark.parametrize(
    ("name", "low", "high", "body", "element"),
    [
        ("lower sway", 0.5, 0.7, "body", "secondary"),
        ("upper sway", 0.9, 1.3, "body", "secondary"),
        ("body bounce", 1.0, 1.15, "body", "secondary"),
        ("body pitch", 1.2, 1.4, "body", "secondary"),
        ("body yaw", 0.6, 0.8, "body", "secondary"),
        ("bogie bounce, in phase", 7.0, 8.0, "bogie1", "primary"),
        ("bogie hunting, in phase", 2.0, 4.0, "body", "primary"),
        ("wheelset bounce, front bogie", 150.0, 250.0, "bogie1.wheelset1", "contact"),
    ],
)
def test_modes_of_the_coach(
    coach: tuple[Mode, ...], name: str, low: float, high: float, body: str, element: str
) -> None:
    # a name with `front bogie` belongs to both of its wheelsets
    mode = next(m for m in coach if m.name == name)
    assert low < mode.frequency < high
    assert mode.bodies[body] > 0.15
    assert next(iter(by_kind(mode.elements))) == element


def test_body_bounce_is_that_of_a_mass_on_springs(coach: tuple[Mode, ...]) -> None:
    vehicle = kl.library.vehicle("manchester_coach")
    secondary, primary = 4.0 * vehicle.secondary.stiffness.z, 8.0 * vehicle.primary.stiffness.z
    stiffness = 1.0 / (1.0 / secondary + 1.0 / primary)
    undamped = np.sqrt(stiffness / vehicle.body.mass) / (2.0 * np.pi)
    mode = named(coach, "body bounce")
    assert abs(mode.eigenvalue) / (2.0 * np.pi) == pytest.approx(undamped, rel=0.02)


@pytest.mark.parametrize(("at", "tolerance"), [(None, 1e-6), ("400 m", 2e-4)])
def test_springs_are_the_jacobian_of_the_model(at: str | None, tolerance: float) -> None:
    """The stiffness of the elements on body and bogies is what the core's exact Jacobian has, in a curve too.

    There the vehicle leans on its bump stops; what is left is the geometric stiffness of the preloads.
    """
    curve = kl.Track.curve(radius="300 m", cant="100 mm", transition="60 m")
    made = Sweep(at=at)(kl.Scenario(kl.library.vehicle("manchester_coach"), curve, speed="70 km/h"))
    structure = Structure(made.spec, made.plant)
    for body in structure.bodies[:3]:
        for coordinate in (1, 2):  # y, z: no weight turns with these
            place = body.at[coordinate]
            stiffness = sum(
                spring.stiffness[spring.at.index(place), spring.at.index(place)]
                for spring in structure.springs
                if place in spring.at
            )
            assert -body.mass * made.plant.A[body.rates[coordinate], place] == pytest.approx(stiffness, rel=tolerance)


def test_modes_of_the_mechatronic_vehicle_with_its_controllers() -> None:
    made = scenario("mechatronic_irw", kl.control.IRWLike())
    found = modes(made)
    names = {mode.name.partition(",")[0].partition(" #")[0] for mode in found}
    expected = {"lower sway", "upper sway", "body bounce", "body pitch", "axle wind-up", "wheelset steering"}
    assert expected | {"motor and shaft torsion", "steering actuator", "controller", "motor"} <= names
    assert all(mode.eigenvalue.real < 0.0 for mode in found)
    torsion = [mode for mode in found if mode.name.startswith("motor and shaft torsion")]
    assert {round(mode.frequency, -1) for mode in torsion} == {50.0, 70.0}
    alone = modes(made, controllers=False)
    assert not any(mode.name.startswith("controller") for mode in alone)


@pytest.mark.parametrize(("name", "control"), [("manchester_coach", None), ("mechatronic_irw", kl.control.IRWLike())])
def test_only_groups_share_a_name(name: str, control: Any) -> None:
    found = modes(scenario(name, control))
    for mode in found:
        for other in found:
            if mode.name == other.name:
                assert abs(mode.eigenvalue - other.eigenvalue) < 0.04 * abs(mode.eigenvalue), mode.name


def test_memory_of_controllers_is_no_mode() -> None:
    made = Sweep()(scenario("mechatronic_irw", kl.control.SolidLike())).model
    values = eigenvalues(made)
    kept = values[lives(values, made.sample_time)]
    assert len(kept) < len(values)
    assert kept.real.max() < 0.0
    assert np.all(np.isfinite(table(modes(scenario("mechatronic_irw", kl.control.SolidLike())))["real"]))


def test_the_page_holds_everything_it_shows() -> None:
    made = Sweep()(scenario("manchester_coach"))
    found = modes(made.model, made.spec, plant=made.plant)
    structure = Structure(made.spec, made.model, made.plant)
    page = modes_report(found, structure, title="Modes", subtitle="at 144 km/h").html
    assert page == modes_report(found, structure, title="Modes", subtitle="at 144 km/h").html
    outside = {link for link in re.findall(r"https?://[^\s\"'<>]+", page) if "w3.org" not in link}
    assert outside == set()
    assert "lower sway" in page
    scene = json.loads(re.search(r"const scene = (\{.*\});", page).group(1))  # type: ignore[union-attr]
    assert [part["name"] for part in scene["parts"]][:3] == ["body", "bogie1", "bogie2"]
    assert len(scene["modes"]) == page.count('<tr class="pick">')
    assert all(len(move) == 16 for shape in scene["modes"] for move in shape)


@pytest.mark.parametrize("end", ["html", "png"])
def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], end: str) -> None:
    out, rows = tmp_path / f"m.{end}", tmp_path / "m.csv"
    options = ["--vehicle", "manchester_coach", "--speed", "160 km/h", "--out", str(out), "--table", str(rows)]
    assert cli.run(["modes", *options]) == 0
    assert "lower sway" in capsys.readouterr().out
    assert out.stat().st_size > 20_000
    assert rows.read_text().splitlines()[0] == "name,frequency,damping,real,imag,body,element"


def test_strategies_have_parameters_and_bring_their_vehicle() -> None:
    text = "irw_like:curvature=database,frequency=1.2"
    made = scenario_of(None, None, "108 km/h", text, None, None)
    assert made.vehicle.name == "mechatronic_irw"
    assert (made.control.frequency, made.control.curvature) == (1.2, "database")
    assert scenario_of(None, "trailed_irw", "30 m/s", "passive", None, None).vehicle.name == "trailed_irw"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--speed", "160 km/h"], "vehicle: is missing"),
        (["--vehicle", "manchester_coach"], "speed: is missing"),
        (["--control", "irw_like"], "speed: is missing"),
        (["--control", "irw_like:frequenzy=2", "--speed", "40 m/s"], "did you mean 'frequency'"),
        (["--control", "irw_like:frequency", "--speed", "40 m/s"], "control = 'irw_like:frequency': 'frequency' sets"),
        (["--vehicle", "manchester_coach", "--speed", "40 m/s", "--out", "m.txt"], "end it in .html"),
        (["--vehicle", "manchester_coach", "--speed", "40 m/s", "--set", "conicity"], "give it as name=value"),
        (["--vehicle", "manchester_coach", "--speed", "40 m/s", "--without", "drive"], "yaw_damper"),
    ],
)
def test_command_refuses(capsys: pytest.CaptureFixture[str], options: list[str], said: str) -> None:
    assert cli.run(["modes", *options]) == 2
    assert said in capsys.readouterr().err
