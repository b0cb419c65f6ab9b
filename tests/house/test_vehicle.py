"""Vehicle files: the library is complete and sourced, bad files are refused with every problem and its remedy."""

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from klingel import library
from klingel.errors import InputError
from klingel.vehicle import Vehicle

Tables = dict[str, Any]


def tables(name: str = "mechatronic_irw") -> Tables:
    return tomllib.loads(library.text(name))


@pytest.mark.parametrize("name", library.names())
def test_library_round_trip(name: str, tmp_path: Path) -> None:
    for each in library.names():
        (tmp_path / f"{each}.toml").write_text(library.text(each))
    vehicle = library.vehicle(name)
    assert Vehicle.read(tmp_path / f"{name}.toml") == vehicle
    assert Vehicle.model_validate(vehicle.model_dump()) == vehicle


@pytest.mark.parametrize("name", library.names())
def test_every_parameter_has_a_status_and_published_ones_a_source(name: str) -> None:
    for parameter in library.vehicle(name).parameters():
        assert parameter.source or parameter.status in ("memory", "design"), parameter.key
        if parameter.status == "design":
            assert parameter.note, f"{parameter.key}: this project's own choice needs its reason"


@pytest.mark.parametrize("name", library.names())
def test_library_files_give_every_quantity_a_unit(name: str) -> None:
    pure = {"traction_share", "gear_ratio", "damping_ratio", "cars"}

    def bare(table: Tables) -> list[str]:
        found = [key for key, value in table.items() if isinstance(value, float | int) and key not in pure]
        return found + [key for value in table.values() if isinstance(value, dict) for key in bare(value)]

    assert bare(tables(name)) == []


def test_status_of_single_keys() -> None:
    status = {p.key: p.status for p in library.vehicle("mechatronic_irw").parameters()}
    assert status["primary.stiffness.x"] == "design"
    assert status["primary.stiffness.y"] == "repo"
    assert status["primary.series_stiffness.z"] == "memory"


def test_all_vehicles_share_body_bogies_and_secondary() -> None:
    coach = library.vehicle("manchester_coach")
    for name in library.names():
        vehicle = library.vehicle(name)
        for part in ("geometry", "body", "bogie", "secondary", "lateral_stop", "anti_roll_bar", "traction_rod"):
            assert getattr(coach, part) == getattr(vehicle, part)
        assert vehicle.steering is None or vehicle.primary.stiffness.x < coach.primary.stiffness.x


def test_variants_state_what_differs_from_their_base(tmp_path: Path) -> None:
    irw, trailed = library.vehicle("mechatronic_irw"), library.vehicle("trailed_irw")
    assert trailed == irw.replace(name=trailed.name, description=trailed.description, drive=None)
    bad = tmp_path / "bad.toml"
    (tmp_path / "coach.toml").write_text(library.text("manchester_coach"))
    bad.write_text('base = "coach.toml"\nname = "bad"\ndescription = "bad"\nwithout = ["yaw_dampers"]\n')
    with pytest.raises(InputError, match=r"bad\.toml: without = 'yaw_dampers': is not in coach\.toml.*'yaw_damper'"):
        Vehicle.read(bad)
    second = tmp_path / "second.toml"
    second.write_text('base = "bad.toml"\n')
    with pytest.raises(InputError, match=r"has a base itself; name coach\.toml"):
        Vehicle.read(second)


def test_axle_bridge_adds_up() -> None:
    bridge = library.vehicle("mechatronic_irw").axle_bridge
    assert bridge is not None
    assert bridge.total_mass == 2100.0
    assert bridge.total_inertia == pytest.approx((1193.75, 60.0, 1193.75))


def test_a_vehicle_is_immutable() -> None:
    vehicle = library.vehicle("manchester_coach")
    with pytest.raises(ValidationError):
        vehicle.name = "other"  # type: ignore[misc]


def spoil(*path: str, value: object = None) -> Callable[[Tables], None]:
    """Set the key at `path`, or delete it."""

    def act(data: Tables) -> None:
        for key in path[:-1]:
            data = data[key]
        if value is None:
            del data[path[-1]]
        else:
            data[path[-1]] = value

    return act


@pytest.mark.parametrize(
    ("change", "key", "said", "remedy"),
    [
        (spoil("body", "mass", value="-3 kg"), "body.mass", "must be positive", "above zero"),
        (spoil("geometry", "wheel_radius", value="0 m"), "geometry.wheel_radius", "must be positive", "above zero"),
        (spoil("body", "mas", value="3 kg"), "body.mas", "not a known key", "did you mean 'mass'?"),
        (spoil("secondry", value={}), "secondry", "not a known key", "did you mean 'secondary'?"),
        (spoil("primary", "stiffness", "x", value="3 kg"), "primary.stiffness.x", "wanted N/m", "1 N/m"),
        (spoil("primary", "damping", "x", value="-1 N s/m"), "primary.damping.x", "negative", "zero or more"),
        (spoil("bogie", "height"), "bogie.height", "is missing", "add it"),
        (spoil("body", "status", value="guess"), "body.status", "is not known", "'memory'"),
        (spoil("drive", "traction_share", value=1.5), "drive.traction_share", "less than or equal to 1", ""),
        (spoil("lateral_stop", "force", value=["0 N"]), "lateral_stop", "points", "as many of both"),
        (spoil("primary", "stiffness", "z", value="0 N/m"), "primary", "vertical stiffness", "stiffness.z"),
        (spoil("torque_link"), "", "torque_link", "[torque_link]"),
        (spoil("running_resistance"), "", "running_resistance", "[running_resistance]"),
        (spoil("axle_bridge"), "", "either a wheelset or an axle_bridge", "exactly one"),
        (spoil("body", "source", value=["nobody"]), "", "'nobody' is not listed", "[sources]"),
        (spoil("wheel_profile", "name", value="P8"), "wheel_profile.name", "is not known", "S1002"),
    ],
)
def test_bad_files(change: Callable[[Tables], None], key: str, said: str, remedy: str) -> None:
    data = tables()
    change(data)
    with pytest.raises(InputError) as refused:
        Vehicle.from_tables(data, file="my.toml")
    assert [p.key for p in refused.value.problems] == [key]
    text = str(refused.value)
    assert text.startswith("my.toml: ")
    assert said in text
    assert remedy in text


def test_all_problems_at_once() -> None:
    data = tables()
    data["body"]["mass"] = "-1 kg"
    data["bogie"]["mass"] = "1 m"
    data["extra"] = 1
    with pytest.raises(InputError) as refused:
        Vehicle.from_tables(data)
    assert {p.key for p in refused.value.problems} == {"body.mass", "bogie.mass", "extra"}


def test_missing_and_broken_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        Vehicle.read(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("name = 3 4\n")
    with pytest.raises(InputError, match=r"is not TOML.*line 1"):
        Vehicle.read(broken)


def test_unknown_library_vehicle() -> None:
    with pytest.raises(InputError, match="did you mean 'manchester_coach'"):
        library.vehicle("manchester_coch")
