"""`klingel modes`, `rootlocus` and `critical-speed`: each one picture and one table of a scenario.
The scenario comes from a file, or from a library vehicle and a speed on straight track; single numbers can be set."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

# Threads of a linear algebra library cost more than they give on matrices of this size; heard if it is not yet loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from rich.status import Status

    from klingel.scenario import Scenario

File = Annotated[Path | None, typer.Argument(help="Scenario file (TOML); or give --vehicle and --speed.")]
Vehicle = Annotated[str | None, typer.Option(help="Of the library, or a vehicle file.")]
Speed = Annotated[str | None, typer.Option(help="Such as '160 km/h'; with a file, instead of its own.")]
Control = Annotated[str | None, typer.Option(help="passive, solid_like or irw_like.")]
Setting = Annotated[
    list[str] | None, typer.Option("--set", help="A number, such as conicity=0.2 or vehicle.body.mass='30 t'.")
]
Without = Annotated[list[str] | None, typer.Option(help="A table that the vehicle can do without: yaw_damper.")]
At = Annotated[str | None, typer.Option(help="Place on the track, such as '500 m', instead of straight level track.")]
Plant = Annotated[bool, typer.Option("--plant", help="The vehicle alone: loops of the controllers open.")]
TableFile = Annotated[Path | None, typer.Option("--table", help="Also write the table (.csv).", dir_okay=False)]

ENDS = {"page": (".html", ".htm"), "picture": (".png", ".svg")}


def modes(
    scenario: File = None,
    vehicle: Vehicle = None,
    speed: Speed = None,
    control: Control = None,
    settings: Setting = None,
    without: Without = None,
    at: At = None,
    plant: Plant = False,
    out: Annotated[Path, typer.Option(help="Page that moves (.html), or picture (.png, .svg).", dir_okay=False)] = Path(
        "modes.html"
    ),
    table: TableFile = None,
) -> None:
    """Modes of a vehicle: frequency, damping, what moves and what strains."""
    _check(out, "page", "picture")
    _check_table(table)
    made = scenario_of(scenario, vehicle, speed, control, settings, without)

    from klingel.linear.modes import modes as modes_of
    from klingel.linear.modes import table as as_table
    from klingel.linear.shapes import Structure
    from klingel.linear.sweep import Sweep

    with _working("operating point"):
        linear = Sweep(at=at, controllers=not plant)(made)
        found = modes_of(linear.model, linear.spec, plant=linear.plant)
    title, where = f"Modes of {made.vehicle.name}", _where(made, at, plant, settings=settings, without=without)
    if out.suffix in ENDS["page"]:
        from klingel.report.modes import modes_report

        structure = Structure(linear.spec, linear.model, linear.plant)
        modes_report(found, structure, title=title, subtitle=where).save(out)
    else:
        from klingel.plot.linear import modes_figure

        _draw(modes_figure(found, title=f"{title}, {where}"), out)
    rows = as_table(tuple(mode for mode in found if mode.swings and mode.frequency <= 30.0))
    _print(
        rows.assign(
            frequency=rows["frequency"].map("{:.2f}".format), damping=(100 * rows["damping"]).map("{:.1f}".format)
        ),
        {"name": "mode", "frequency": "Hz", "damping": "damping %", "body": "moves most", "element": "strains most"},
        title=f"{title}, {where}, up to 30 Hz",
    )
    for warning in linear.model.warnings:
        typer.echo(f"near a kink: {warning}")
    _write(as_table(found), table)
    typer.echo(out)


def rootlocus(
    scenario: File = None,
    vehicle: Vehicle = None,
    speed: Speed = None,
    control: Control = None,
    settings: Setting = None,
    without: Without = None,
    at: At = None,
    plant: Plant = False,
    parameter: Annotated[
        str, typer.Option(help="speed, conicity, friction, vehicle.yaw_damper.damping, control.frequency ...")
    ] = "speed",
    start: Annotated[str, typer.Option("--from", help="First value, with its unit.")] = "15 m/s",
    end: Annotated[str, typer.Option("--to", help="Last value, with its unit.")] = "80 m/s",
    points: Annotated[int, typer.Option(min=2, help="Values, evenly spaced.")] = 60,
    out: Annotated[Path, typer.Option(help="Picture (.png, .svg).", dir_okay=False)] = Path("rootlocus.png"),
    table: TableFile = None,
) -> None:
    """Eigenvalues over the speed, the conicity, the friction or any number of vehicle and controllers.

    Every new conicity compiles its contact table first, which takes some seconds and is kept.
    """
    _check(out, "picture")
    _check_table(table)
    made = scenario_of(
        scenario, vehicle, speed or _speed_that_varies(scenario, parameter, start), control, settings, without
    )

    import numpy as np

    from klingel.linear import parameters
    from klingel.linear.locus import root_locus
    from klingel.plot.linear import least_damped, locus_figure
    from klingel.units import to_si

    unit = parameters.unit(made, parameter)
    values = np.linspace(to_si(start, unit, key="--from"), to_si(end, unit, key="--to"), points)
    begun = time.perf_counter()
    with _working(f"{points} values of {parameter}") as status:

        def tell(done: int, count: int) -> None:
            status.update(f"{done} of {count} values of {parameter}")

        locus = root_locus(made, parameter, values, at=at, controllers=not plant, step=tell)
    seconds = time.perf_counter() - begun
    where = _where(made, at, plant, settings=settings, without=without, speed=parameter != "speed")
    title = f"{made.vehicle.name} over {parameter}" + (f", {where}" if where else "")
    _draw(locus_figure(locus, title=title), out)
    rows = [
        {
            "name": locus.names[i],
            "first": f"{100 * locus.damping[0, i]:.1f}",
            "last": f"{100 * locus.damping[-1, i]:.1f}",
            "least": f"{100 * np.nanmin(locus.damping[:, i]):.1f}",
            "at": f"{values[np.nanargmin(locus.damping[:, i])]:.4g}",
        }
        for i in least_damped(locus, 12)
    ]

    import pandas as pd

    heads = {
        "name": "mode",
        "first": "damping % first",
        "last": "last",
        "least": "least",
        "at": f"at {parameter} [{unit}]",
    }
    _print(pd.DataFrame(rows, columns=list(heads)), heads, title=f"{title}: least damped")
    _write(locus.table(), table)
    typer.echo(f"{out}; {points} values in {seconds:.1f} s")


def critical_speed(
    scenario: File = None,
    vehicle: Vehicle = None,
    control: Control = None,
    settings: Setting = None,
    without: Without = None,
    plant: Plant = False,
    lowest: Annotated[str, typer.Option(help="Where the search begins.")] = "10 m/s",
    highest: Annotated[str, typer.Option(help="Where it ends.")] = "120 m/s",
    nonlinear: Annotated[
        bool, typer.Option("--nonlinear", help="Also the limit cycle: runs that slow down and at constant speed.")
    ] = False,
    begin: Annotated[
        str | None, typer.Option(help="Speed that the slowing run begins at; default: a tenth above the linear one.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Picture (.png, .svg).", dir_okay=False)] = Path("critical_speed.png"),
    table: TableFile = None,
) -> None:
    """Linear critical speed of a vehicle, and with --nonlinear that of its limit cycle with the bifurcation diagram."""
    _check(out, "picture")
    _check_table(table)
    made = scenario_of(scenario, vehicle, None if scenario else lowest, control, settings, without)

    from klingel.linear.critical import critical_speed as find
    from klingel.linear.limit_cycle import bifurcation
    from klingel.plot.linear_critical import critical_figure

    with _working("linear critical speed") as status:
        critical = find(made, lowest=lowest, highest=highest, controllers=not plant)
        cycles = None
        if nonlinear:
            cycles = bifurcation(made, highest=begin, lowest=lowest, linear=critical, step=status.update)
    where = _where(made, None, plant, settings=settings, without=without, speed=False)
    title = made.vehicle.name + (f", {where}" if where else "")
    _draw(critical_figure(critical, title=title, bifurcation=cycles), out)
    mode = critical.mode
    found = {
        "linear critical speed": f"{3.6 * critical.speed:.1f} km/h" if critical.speed else critical.outcome,
        "its mode": f"{mode.name}, {critical.frequency:.2f} Hz",
    }
    if cycles is not None:
        none = "none: comes to rest at every speed"
        found["nonlinear critical speed"] = f"{3.6 * cycles.speed:.1f} km/h" if cycles.speed else none
        if cycles.speed and critical.speed and cycles.speed >= critical.speed:
            found["limit cycles"] = "only above the linear speed, to the resolution of the runs: a soft onset"

    import pandas as pd

    _print(pd.DataFrame(list(found.items()), columns=["what", "found"]), {"what": "", "found": ""}, title=title)
    rows = critical.table() if cycles is None else pd.concat([critical.table(), cycles.table()])
    _write(rows.sort_values("speed"), table)
    typer.echo(out)


def scenario_of(
    file: Path | None,
    vehicle: str | None,
    speed: str | None,
    control: str | None,
    settings: list[str] | None,
    without: list[str] | None,
) -> Scenario:
    """Of a file, or a vehicle at a speed on straight track, with single numbers set; errors: InputError."""
    from klingel import library
    from klingel.errors import InputError
    from klingel.linear import parameters
    from klingel.scenario import Scenario
    from klingel.scenario.files import strategy
    from klingel.track import Track
    from klingel.vehicle import Vehicle as Record

    if file is not None:
        if vehicle is not None:
            raise InputError.single("vehicle", vehicle, "is given beside a scenario file", remedy="give one of the two")
        made = Scenario.read(file)
        made = made if speed is None else parameters.replace(made, "speed", speed)
    elif vehicle is None or speed is None:
        missing = "vehicle" if vehicle is None else "speed"
        raise InputError.single(missing, None, "is missing", remedy="give a scenario file, or --vehicle and --speed")
    else:
        record = Record.read(vehicle) if vehicle.endswith(".toml") else library.vehicle(vehicle)
        made = Scenario(record, Track.straight("1 km"), speed=speed)
    if control is not None:
        made = made.replace(control=strategy({"strategy": control}))
    for table in without or ():
        made = made.replace(vehicle=_without(made.vehicle, table))
    for setting in settings or ():
        name, equals, value = setting.partition("=")
        if not equals:
            raise InputError.single(
                "set", setting, "sets nothing", remedy="give it as name=value, such as conicity=0.2"
            )
        made = parameters.replace(made, name.strip(), value.strip())
    return made


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


def _speed_that_varies(file: Path | None, parameter: str, start: str) -> str | None:
    """Without a file, a locus over the speed needs no other one."""
    return start if file is None and parameter == "speed" else None


def _where(
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


def _check(out: Path, *kinds: Literal["page", "picture"]) -> None:
    """Refuses a file that cannot be written before anything is computed."""
    from klingel.errors import InputError

    ends = [end for kind in kinds for end in ENDS[kind]]
    if out.suffix not in ends:
        raise InputError.single("out", str(out), f"is no {' or '.join(kinds)}", remedy=f"end it in {', '.join(ends)}")
    if not out.parent.is_dir():
        raise InputError.single("out", str(out), "has no folder to be written to", remedy="make it, or choose another")


def _check_table(table: Path | None) -> None:
    from klingel.errors import InputError

    if table is not None and not table.parent.is_dir():
        raise InputError.single("table", str(table), "has no folder to be written to", remedy="make it first")


@contextmanager
def _working(what: str) -> Iterator[Status]:
    """Something that moves while the core works."""
    from rich.console import Console

    with Console(stderr=True).status(what) as status:
        yield status


def _draw(figure: Figure, out: Path) -> None:
    from klingel.plot.style import render
    from klingel.report.files import write_whole

    form: Literal["svg", "png"] = "svg" if out.suffix == ".svg" else "png"
    write_whole(out, render(figure, form, name=out.stem))


def _print(rows: pd.DataFrame, heads: dict[str, str], *, title: str) -> None:
    from rich.console import Console
    from rich.table import Table

    shown = Table(title=title, show_header=any(heads.values()), title_justify="left")
    for i, head in enumerate(heads.values()):
        shown.add_column(head, justify="left" if i == 0 else "right")
    for row in rows[list(heads)].itertuples(index=False):
        shown.add_row(*(str(value) for value in row))
    Console().print(shown)


def _write(rows: pd.DataFrame, path: Path | None) -> None:
    from klingel.report.files import write_whole

    if path is not None:
        write_whole(path, rows.to_csv(index=False).encode())
