"""The commands. Each reads its options, calls one function of the package and prints what came out.
Heavy imports happen inside the commands, so that `--help` and `--version` stay quick."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from klingel.cli import design, linear
from klingel.cli.compare import compare
from klingel.cli.output import kept, print_table
from klingel.cli.robustness import robustness

app = typer.Typer(
    name="klingel",
    help="Simulator and design bench for mechatronic railway vehicles.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
study = typer.Typer(help="Run a study: all its runs, figures and the report.", no_args_is_help=True)
app.add_typer(study, name="study")
app.command()(linear.modes)
app.command()(linear.rootlocus)
app.command("critical-speed")(linear.critical_speed)
app.command()(compare)
app.command()(design.design)
app.command()(robustness)


def _version(wanted: bool) -> None:
    if wanted:
        from klingel import __version__

        typer.echo(f"klingel {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Simulator and design bench for mechatronic railway vehicles."""


@study.command()
def perez2004(
    out: Annotated[Path, typer.Option(help="Folder for figures, report, tables and time series.")] = Path(
        "out/perez2004"
    ),
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")] = None,
    only: Annotated[
        list[float] | None, typer.Option(help="Only the curve of this radius [m]; may be repeated.")
    ] = None,
    variants: Annotated[bool, typer.Option(help="Also friction 0.25 and 0.30 and the curvature database.")] = True,
) -> None:
    """Combined active steering and traction: three vehicles, five curves (Perez et al. 2004)."""
    from klingel.study import perez2004 as body

    with kept():
        body.run(out, jobs=jobs, radii=only or None, friction_variants=variants, database_variant=variants)


@study.command()
def traction(
    out: Annotated[Path, typer.Option(help="Folder for figures, report, table and time series.")] = Path(
        "out/traction"
    ),
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(help="Only this part: launch, stop, curve, patch, drives or rig; may be repeated."),
    ] = None,
) -> None:
    """Traction, braking and adhesion: launch, stop, curves under torque, patches of low adhesion."""
    from klingel.study import traction as body
    from klingel.study.traction_cases import PARTS

    with kept():
        body.run(out, jobs=jobs, parts=only or PARTS)


@study.command()
def errors(
    strategies: Annotated[
        list[str] | None,
        typer.Argument(metavar="[STRATEGY]...", help="As for compare; default: S, I with gyros and database, trailed."),
    ] = None,
    curve: Annotated[list[str] | None, typer.Option(help="As for compare; may be repeated. Default: the five.")] = None,
    out: Annotated[Path, typer.Option(help="Folder for figure, report and table.")] = Path("out/errors"),
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")] = None,
) -> None:
    """Each error alone: unequal wheels, delay, wrong curvature and position, noise; which strategy withstands it."""
    from klingel.study import errors as body

    with kept():
        body.run(out, strategies=strategies or body.STRATEGIES, curves=curve or None, jobs=jobs)


@app.command()
def run(
    scenario: Annotated[Path, typer.Argument(help="Scenario file (TOML).")],
    out: Annotated[Path | None, typer.Option(help="NetCDF file of the result; default: beside the scenario.")] = None,
    rate: Annotated[float, typer.Option(min=1.0, help="Sample rate of the file [Hz].")] = 200.0,
) -> None:
    """Run one scenario and save its time series."""
    from klingel.cli.progress import preparing, simulate_with_bar
    from klingel.errors import InputError
    from klingel.result import COMPLETED, prepare, save
    from klingel.scenario import Scenario

    read = Scenario.read(scenario)
    try:
        with preparing():
            tables = prepare(read)
        for table in tables:
            typer.echo(table)
        result = simulate_with_bar(read, scenario.stem)
    except InputError as error:  # what only the vehicle at its speed shows to be wrong, such as too little voltage
        raise error if error.file else error.in_file(str(scenario)) from None
    path = save(result, out or scenario.with_suffix(".nc"), rate=rate)
    outcome = result.attrs["outcome"]
    typer.echo(f"{outcome}; {result.attrs['realtime_factor']:.1f} times real time; {path}")
    if notes := result.attrs["notes"]:
        typer.echo(notes)
    if outcome != COMPLETED:
        raise typer.Exit(1)


@app.command()
def profile(
    wheel: Annotated[str, typer.Option(help="Wheel profile: a standard name or a file of measured points.")] = "S1002",
    rail: Annotated[str, typer.Option(help="Rail profile: a standard name or a file of measured points.")] = "60E1",
    out: Annotated[Path, typer.Option(help="Page (.html) or picture (.png, .svg) to write.", dir_okay=False)] = Path(
        "profile.html"
    ),
    inclination: Annotated[str, typer.Option(help="Of the rails, such as 1:40, 0.025 or 0.")] = "1:40",
    gauge: Annotated[str, typer.Option(help="14 mm below the top of rail.")] = "1435 mm",
    flange_back: Annotated[str, typer.Option(help="Distance of the wheels' flange backs.")] = "1360 mm",
    radius: Annotated[str, typer.Option(help="Of the wheel at its tape circle.")] = "460 mm",
    load: Annotated[str, typer.Option(help="Vertical force of each wheel.")] = "50 kN",
    normal: Annotated[str, typer.Option(help="Normal contact: kik_piotrowski or hertz.")] = "kik_piotrowski",
    units: Annotated[str | None, typer.Option(help="Of the files, m or mm, where they do not say it.")] = None,
) -> None:
    """Contact of a wheel on a rail: points, rolling radius difference, conicity, contact angle."""
    from klingel.cli.profile import draw

    path = draw(
        wheel, rail, out, inclination, gauge, flange_back, radius, load=load, normal=normal, units=units, say=typer.echo
    )
    typer.echo(path)


@app.command("contact-table")
def contact_table(
    out: Annotated[Path | None, typer.Option(help="File to write.", show_default="creep_table.bin")] = None,
    work: Annotated[
        Path | None, typer.Option(help="Folder for finished parts; default: in the user's cache folder.")
    ] = None,
    elements: Annotated[str | None, typer.Option(help="Of a patch, along x across.", show_default="40x40")] = None,
    intervals: Annotated[
        str | None, typer.Option(help="Of three creepages and of the semi-axes' ratio, such as 12x16x40x22.")
    ] = None,
    poisson: Annotated[float | None, typer.Option(help="Poisson's ratio of both bodies.", show_default="0.28")] = None,
    check: Annotated[bool, typer.Option("--check", help="Check the built-in table instead, as it was made.")] = False,
) -> None:
    """Make the table of creep forces with exact theory, on all cores; another start goes on where the last one ended.

    In a checkout, `--out crates/physics/data/creep_table.bin` and `make build` put it into the package.
    """
    if check:
        from klingel.cli.table_check import check_built_in, refuse

        refuse({"out": out, "work": work, "elements": elements, "intervals": intervals, "poisson": poisson})
        check_built_in(typer.echo)
    else:
        from klingel.cli.contact_table import Shape, make

        shape = Shape(0.28 if poisson is None else poisson, elements or "40x40", intervals)
        make(out or Path("creep_table.bin"), work, shape, typer.echo)


@app.command()
def vehicles(
    name: Annotated[str | None, typer.Argument(help="Show the parameters of this one, with status and source.")] = None,
) -> None:
    """List the library's vehicles, or the parameters of one."""
    from rich.table import Table

    from klingel import library

    if name is None:
        table = Table("vehicle", r"mass \[t]", "wheels", "description")
        for each in library.names():
            vehicle = library.vehicle(each)
            wheels = "independent" if vehicle.independent_wheels else "solid"
            table.add_row(each, f"{vehicle.total_mass / 1e3:.1f}", wheels, vehicle.description)
    else:
        table = Table("parameter", "value", "unit", "status", "source", title=name)
        for p in library.vehicle(name).parameters():
            value = ", ".join(f"{v:g}" for v in p.value) if isinstance(p.value, tuple) else f"{p.value:g}"
            table.add_row(p.key, value, "" if p.unit == "1" else p.unit, p.status, ", ".join(p.source))
    print_table(table)


@app.command()
def doctor() -> None:
    """Check this installation: extension, packages, library files."""
    from rich.table import Table

    from klingel.doctor import examine

    findings = examine()
    table = Table("", "what", "found")
    for finding in findings:
        table.add_row("[green]ok[/]" if finding.good else "[red]no[/]", finding.what, finding.found)
    print_table(table)
    if not all(finding.good for finding in findings):
        sys.exit(1)
