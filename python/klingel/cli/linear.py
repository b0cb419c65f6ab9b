"""`klingel modes`, `rootlocus` and `critical-speed`: each one picture and one table of a scenario.
The scenario comes from a file, or from a library vehicle and a speed on straight track; single numbers can be set."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from klingel.cli.output import ENDS, TableFile, check, check_table, draw, print_rows, working, write
from klingel.cli.scenario import At, Control, File, Plant, Setting, Speed, Vehicle, Without, scenario_of, where

# Threads of a linear algebra library cost more than they give on matrices of this size; heard if it is not yet loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

if TYPE_CHECKING:
    from klingel.scenario import Scenario

SLOWEST = 15.0
"""Speed at which root loci of hauled vehicles begin [m/s]."""

FASTEST = 80.0
"""Speed at which root loci end [m/s]."""


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
    check(out, "page", "picture")
    check_table(table)
    made = scenario_of(scenario, vehicle, speed, control, settings, without)

    from klingel.linear.modes import modes as modes_of
    from klingel.linear.modes import table as as_table
    from klingel.linear.shapes import Structure
    from klingel.linear.sweep import Sweep

    with working("operating point"):
        linear = Sweep(at=at, controllers=not plant)(made)
        found = modes_of(linear.model, linear.spec, plant=linear.plant)
    title, place = f"Modes of {made.vehicle.name}", where(made, at, plant, settings=settings, without=without)
    if out.suffix in ENDS["page"]:
        from klingel.report.modes import modes_report

        structure = Structure(linear.spec, linear.model, linear.plant)
        modes_report(found, structure, title=title, subtitle=place).save(out)
    else:
        from klingel.plot.linear import modes_figure

        draw(modes_figure(found, title=f"{title}, {place}"), out)
    rows = as_table(tuple(mode for mode in found if mode.swings and mode.frequency <= 30.0))
    print_rows(
        rows.assign(
            frequency=rows["frequency"].map("{:.2f}".format), damping=(100 * rows["damping"]).map("{:.1f}".format)
        ),
        {"name": "mode", "frequency": "Hz", "damping": "damping %", "body": "moves most", "element": "strains most"},
        title=f"{title}, {place}, up to 30 Hz",
    )
    for warning in linear.model.warnings:
        typer.echo(f"near a kink: {warning}")
    write(as_table(found), table)
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
    start: Annotated[
        str | None,
        typer.Option(
            "--from",
            help="First value, with its unit. Default: 15 m/s; of other numbers, half of what they are.",
        ),
    ] = None,
    end: Annotated[
        str | None,
        typer.Option("--to", help="Last value. Default: 80 m/s; of other numbers, twice what they are."),
    ] = None,
    points: Annotated[int, typer.Option(min=2, help="Values, evenly spaced.")] = 60,
    out: Annotated[Path, typer.Option(help="Picture (.png, .svg).", dir_okay=False)] = Path("rootlocus.png"),
    table: TableFile = None,
) -> None:
    """Eigenvalues over the speed, the conicity, the friction or any number of vehicle and controllers.

    Every new conicity compiles its contact table first, which takes some seconds and is kept.
    """
    check(out, "picture")
    check_table(table)
    varies = f"{FASTEST} m/s" if scenario is None and parameter == "speed" else None
    made = scenario_of(scenario, vehicle, speed or varies, control, settings, without)

    import numpy as np

    from klingel.linear import parameters
    from klingel.linear.locus import root_locus
    from klingel.plot.linear import least_damped, locus_figure
    from klingel.plot.scale import labelled, readable

    unit = parameters.unit(made, parameter)
    values = np.linspace(*_ends(made, parameter, unit, start, end), points)
    begun = time.perf_counter()
    with working(f"{points} values of {parameter}") as status:

        def tell(done: int, count: int) -> None:
            status.update(f"{done} of {count} values of {parameter}")

        locus = root_locus(made, parameter, values, at=at, controllers=not plant, step=tell)
    seconds = time.perf_counter() - begun
    place = where(made, at, plant, settings=settings, without=without, speed=parameter != "speed")
    title = f"{made.vehicle.name} over {parameter}" + (f", {place}" if place else "")
    draw(locus_figure(locus, title=title), out)
    shown, per = readable(unit, values)
    rows = [
        {
            "name": locus.names[i],
            "first": f"{100 * locus.damping[0, i]:.1f}",
            "last": f"{100 * locus.damping[-1, i]:.1f}",
            "least": f"{100 * np.nanmin(locus.damping[:, i]):.1f}",
            "at": f"{per * values[np.nanargmin(locus.damping[:, i])]:.4g}",
        }
        for i in least_damped(locus, 12)
    ]

    import pandas as pd

    heads = {
        "name": "mode",
        "first": "damping % first",
        "last": "last",
        "least": "least",
        "at": labelled(f"at {parameter}", shown),
    }
    print_rows(pd.DataFrame(rows, columns=list(heads)), heads, title=f"{title}: least damped")
    write(locus.table(), table)
    typer.echo(f"{out}; {points} values in {seconds:.1f} s")


def _ends(made: Scenario, parameter: str, unit: str, start: str | None, end: str | None) -> tuple[float, float]:
    """First and last value of a root locus, in SI; errors: InputError for a range of one value."""
    from klingel.errors import InputError
    from klingel.linear import parameters
    from klingel.units import to_si

    varies_speed = parameter == "speed"
    if start is not None:
        first = to_si(start, unit, key="--from")
    else:
        first = SLOWEST if varies_speed else 0.5 * parameters.get(made, parameter)
    if end is not None:
        last = to_si(end, unit, key="--to")
    else:
        last = FASTEST if varies_speed else 2.0 * parameters.get(made, parameter)
    if first == last:
        raise InputError.single("--to", last, "is the first value too", remedy=f"give a range of {parameter} [{unit}]")
    return first, last


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
    check(out, "picture")
    check_table(table)
    made = scenario_of(scenario, vehicle, None if scenario else highest, control, settings, without)

    from klingel.linear.critical import critical_speed as find
    from klingel.linear.limit_cycle import bifurcation
    from klingel.plot.linear_critical import critical_figure

    with working("linear critical speed") as status:
        critical = find(made, lowest=lowest, highest=highest, controllers=not plant)
        cycles = None
        if nonlinear:
            cycles = bifurcation(made, begin=begin, lowest=lowest, linear=critical, step=status.update)
    place = where(made, None, plant, settings=settings, without=without, speed=False)
    title = made.vehicle.name + (f", {place}" if place else "")
    draw(critical_figure(critical, title=title, bifurcation=cycles), out)
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

    print_rows(pd.DataFrame(list(found.items()), columns=["what", "found"]), {"what": "", "found": ""}, title=title)
    rows = critical.table() if cycles is None else pd.concat([critical.table(), cycles.table()])
    write(rows.sort_values("speed"), table)
    typer.echo(out)
