"""Dotted paths: every number of a scenario reads and replaces; unknown ones are refused with the nearest."""

import pytest

import klingel as kl
from klingel.errors import InputError
from klingel.linear import parameters


@pytest.fixture(scope="module")
def scenario() -> kl.Scenario:
    vehicle = kl.library.vehicle("mechatronic_irw")
    return kl.Scenario(vehicle, kl.Track.straight("500 m"), speed=30.0, control=kl.control.IRWLike())


def test_every_number_survives_its_own_replacement(scenario: kl.Scenario) -> None:
    paths = parameters.names(scenario)
    assert len(paths) > 100
    assert len(set(paths)) == len(paths)
    for path in paths:
        value = parameters.get(scenario, path)
        assert parameters.replace(scenario, path, value) == scenario, path


@pytest.mark.parametrize(
    ("path", "value", "unit"),
    [
        ("speed", 41.0, "m/s"),
        ("friction", 0.2, "1"),
        ("conicity", 0.1, "1"),
        ("vehicle.secondary.lateral_damper.damping", 4e4, "N s/m"),
        ("vehicle.lateral_stop.force.3", 2000.0, "N"),
        ("radius_mismatch.2", 5e-4, "m"),
        ("control.frequency", 2.0, "Hz"),
        ("control.timing.sample_time", 2e-3, "s"),
        ("control.timing.sensor_samples", 2.0, "1"),
    ],
)
def test_replaces_that_number_alone(scenario: kl.Scenario, path: str, value: float, unit: str) -> None:
    changed = parameters.replace(scenario, path, value)
    assert parameters.get(changed, path) == value
    assert parameters.unit(changed, path) == unit
    common = set(parameters.names(scenario)) & set(parameters.names(changed))
    differing = [p for p in common if parameters.get(changed, p) != parameters.get(scenario, p)]
    assert set(differing) <= {path}


def test_strings_carry_units(scenario: kl.Scenario) -> None:
    assert parameters.get(parameters.replace(scenario, "speed", "108 km/h"), "speed") == 30.0


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("control.freq", 1.0, "did you mean 'control.frequency'"),
        ("vehicle.bodi.mass", 1.0, "did you mean 'vehicle.body.mass'"),
        ("qqq", 1.0, "names lists all"),
        ("vehicle.lateral_stop.force.77", 1.0, "did you mean"),
        ("vehicle.body.mass", -1.0, "vehicle.body.mass = -1.0: must be positive"),
        ("vehicle.primary.stiffness.z", 0.0, "vertical stiffness must be positive"),
        ("control.timing.sensor_samples", 1.5, "control.timing.sensor_samples = 1.5: is no whole number"),
        ("control.frequency", -1.0, "control.frequency"),
        ("speed", "3 kg", "is a mass"),
    ],
)
def test_refuses(scenario: kl.Scenario, path: str, value: float | str, said: str) -> None:
    with pytest.raises(InputError, match=said.replace(".", r"\.")):
        parameters.replace(scenario, path, value)


def test_only_cones_have_a_conicity(scenario: kl.Scenario) -> None:
    with pytest.raises(InputError, match="coned wheels"):
        parameters.get(scenario, "conicity")


def test_all_wheelsets_may_change_together(scenario: kl.Scenario) -> None:
    one = parameters.replace(scenario, "radius_mismatch.0", "0.5 mm")
    assert one.radius_mismatch == (5e-4, 0.0, 0.0, 0.0)
    assert "radius_mismatch" not in parameters.names(one)
    assert parameters.replace(one, "radius_mismatch", "0.2 mm").radius_mismatch == (2e-4,) * 4


def test_sensors_that_are_not_ideal_have_parameters(scenario: kl.Scenario) -> None:
    typical = scenario.replace(sensors=kl.control.Sensors.typical())
    paths = [path for path in parameters.names(typical) if path.startswith("sensors.")]
    for path in paths:
        assert parameters.replace(typical, path, parameters.get(typical, path)) == typical, path
    noisy = parameters.replace(typical, "sensors.gyro.noise", "1 deg/s")
    assert noisy.sensors.gyro is not None
    assert noisy.sensors.gyro.noise == pytest.approx(0.0174533)
    assert parameters.unit(typical, "sensors.load_cell.bias") == "N m"
    assert not [path for path in parameters.names(scenario) if path.startswith("sensors.")]
