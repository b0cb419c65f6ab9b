"""The scenario of a linear command: its options, what is made of them, and how a title says it.
It comes from a file, or from a library vehicle and a speed on straight track; single numbers can be set."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from klingel.scenario import Scenario

File = Annotated[Path | None, typer.Argument(help="Scenario file (TOML); or give --vehicle and --speed.")]
Vehicle = Annotated[
    str | None, typer.Option(help="Of the library, or a vehicle file; default: what --control is made for.")
]
Speed = Annotated[str | None, typer.Option(help="Such as '160 km/h'; with a file, instead of its own.")]
Control = Annotated[str | None, typer.Option(help="A strategy: irw_like, irw_like:frequency=1.2, file.py:Name.")]
Setting = Annotated[
    list[str] | None, typer.Option("--set", help="A number, such as conicity=0.2 or vehicle.body.mass='30 t'.")
]
Without = Annotated[list[str] | None, typer.Option(help="A table that the vehicle can do without: yaw_damper.")]
At = Annotated[str | None, typer.Option(help="Place on the track, such as '500 m', instead of straight level track.")]
Plant = Annotated[bool, typer.Option("--plant", help="The vehicle alone: loops of the controllers open.")]


def scenario_of(
    file: Path | None,
    vehicle: str | None,
    speed: str | None,
    control: str | None,
    settings: list[str] | None,
    without: list[str] | None,
) -> Scenario:
    """Of a file, or a vehicle at a speed on straight track, with single numbers set; errors: InputError.

    control: as in a comparison, `what[:key=value,...]`; without file and vehicle on the vehicle that it is made for.
    """
    from klingel import library
    from klingel.errors import InputError
    from klingel.linear import parameters
    from klingel.scenario import Scenario
    from klingel.track import Track
    from klingel.vehicle import Vehicle as Record

    steering, record = None, None
    if vehicle is not None and file is None:
        record = Record.read(vehicle) if vehicle.endswith(".toml") else library.vehicle(vehicle)
    if control is not None:
        from klingel.study.compare_cases import made_for, strategy_of  # slow to import

        steering = strategy_of(control, key="control")
        record = made_for(steering) if record is None and file is None else record
    if file is not None:
        if vehicle is not None:
            raise InputError.single("vehicle", vehicle, "is given beside a scenario file", remedy="give one of the two")
        made = Scenario.read(file)
        made = made if speed is None else parameters.replace(made, "speed", speed)
    elif record is None or speed is None:
        missing = "vehicle" if record is None else "speed"
        raise InputError.single(missing, None, "is missing", remedy="give a scenario file, or --vehicle and --speed")
    else:
        made = Scenario(record, Track.straight("1 km"), speed=speed)
    if steering is not None:
        made = made.replace(control=steering)
    for table in without or ():
        made = made.replace(vehicle=_without(made.vehicle, table))
    for each in settings or ():
        made = parameters.replace(made, *setting(each))
    return made


def setting(text: str) -> tuple[str, str]:
    """Name and value of a `--set` option; errors: InputError."""
    from klingel.errors import InputError

    name, equals, value = text.partition("=")
    if not equals:
        raise InputError.single("set", text, "sets nothing", remedy="give it as name=value, such as conicity=0.2")
    return name.strip(), value.strip()


def _without(vehicle: object, table: str) -> object:
    """The vehicle without one of its optional tables."""
    from klingel.errors import InputError, nearest
    from klingel.vehicle import Vehicle as Record

    assert isinstance(vehicle, Record)
    tables = vehicle.model_dump(exclude_none=True)
    optional = [key for key, field in Record.model_fields.items() if field.default is None and key in tables]
    if table not in optional:
        raise InputError.single("without", table, "is no table that can be left out", remedy=nearest(table, optional))
    return Record.from_tables({key: value for key, value in tables.items() if key != table})


def where(
    made: Scenario,
    at: str | None,
    plant: bool,
    *,
    settings: list[str] | None,
    without: list[str] | None,
    speed: bool = True,
) -> str:
    """The operating point, and what was changed of the vehicle, in words."""
    control = "" if made.control is None else f"{type(made.control).__name__}{', loops open' if plant else ''}"
    words = [f"{3.6 * made.speed:.0f} km/h" if speed else "", control, f"at {at} of its track" if at else ""]
    words += [f"without {table}" for table in without or ()] + list(settings or ())
    return ", ".join(word for word in words if word)
