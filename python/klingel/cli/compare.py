"""`klingel compare`: any strategies through any curves, one's own beside those of the library.
Options to one call of `klingel.study.compare`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from klingel.cli.output import kept
from klingel.cli.scenario import Setting

Strategies = Annotated[
    list[str],
    typer.Argument(
        metavar="STRATEGY...",
        help="Of the library (irw_like), with parameters (irw_like:curvature=database,frequency=1.2), of a Python file "
        "(mine.py:Mine), or a scenario file; NAME=STRATEGY gives it a name.",
    ),
]


def compare(
    strategies: Strategies,
    curve: Annotated[
        list[str] | None,
        typer.Option(
            help="Radius of one of the five curves, 'R=500,cant=160 mm,speed=140 km/h', or a scenario file; may be "
            "repeated. Default: the five."
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for figures, report, tables and time series.")] = Path(
        "out/compare"
    ),
    vehicle: Annotated[
        str | None, typer.Option(help="Of the library, or a vehicle file; default: what each strategy is made for.")
    ] = None,
    settings: Setting = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")] = None,
) -> None:
    """Strategies beside each other through the same curves: one page, one table, five figures."""
    from klingel.cli.scenario import setting
    from klingel.errors import SimulationError
    from klingel.study import compare as body

    chosen = dict(setting(each) for each in settings or ())
    with kept():
        done = body(strategies, curves=curve or None, out=out, vehicle=vehicle, settings=chosen, jobs=jobs)
    if done.failed:
        listed = "\n".join(f"  {name}: {reason}" for name, reason in done.failed.items())
        raise SimulationError(f"{len(done.failed)} of {len(done.table)} runs have no figures\n{listed}")
