"""`klingel design`: margins of all loops of a strategy on the full vehicle, and where it is stable, as one page.
The scenario comes from a file, or from a library vehicle and a speed on straight track; single numbers can be set."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from klingel.cli.output import TableFile, check, check_table, print_rows, working, write
from klingel.cli.scenario import At, Control, File, Setting, Vehicle, Without, scenario_of

# Threads of a linear algebra library cost more than they give on matrices of this size; heard if it is not yet loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

FIRST = "108 km/h"
"""Speed of a scenario without a file, which is then set to each of the speeds."""


def design(
    scenario: File = None,
    vehicle: Vehicle = None,
    control: Control = None,
    speeds: Annotated[
        list[str] | None,
        typer.Option("--speed", help="Such as '160 km/h'; may be repeated. Default: those of the five curves."),
    ] = None,
    settings: Setting = None,
    without: Without = None,
    at: At = None,
    out: Annotated[Path, typer.Option(help="Page (.html) to write.", dir_okay=False)] = Path("design.html"),
    table: TableFile = None,
) -> None:
    """Margins of every loop of a strategy on the full vehicle, Bode and Nyquist diagrams, and where it is stable.

    Stability is looked at over speed, conicity and friction on straight track, and in the five curves of the study.
    Every new conicity compiles its contact table first, which takes some seconds and is kept.
    """
    check(out, "page")
    check_table(table)
    made = scenario_of(scenario, vehicle, None if scenario else FIRST, control, settings, without)
    if made.control is None:
        from klingel.errors import InputError

        remedy = "give --control, or a scenario file with [control]"
        raise InputError.single("control", None, "is missing: there is no loop to look at", remedy=remedy)

    from klingel.design.bench import examine
    from klingel.report.design import HEADS, design_report, readable_margins

    with working("design") as status:
        bench = examine(made, speeds=speeds or None, at=at, step=status.update)
    name = type(made.control).__name__
    words = [f"at {at} of its track" if at else "on straight track", *(f"without {each}" for each in without or ())]
    subtitle = ", ".join([*words, *(settings or ())])
    title = f"{name} on {made.vehicle.name}"
    design_report(bench, title=title, subtitle=subtitle).save(out)
    heads = {head: head for head in HEADS.values()}
    print_rows(readable_margins(bench.table), heads, title=f"{title}, {subtitle}")
    for sentence in bench.check.words():
        typer.echo(sentence)
    write(bench.table, table)
    typer.echo(out)
