"""`klingel robustness`: many runs of one scenario with drawn inputs, each input alone, or one of these runs again.
Options to one call of `klingel.study.robustness`."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from klingel.cli.output import kept
from klingel.cli.scenario import Setting

if TYPE_CHECKING:
    from klingel.scenario import Scenario
    from klingel.study.robustness import Plan

File = Annotated[Path | None, typer.Argument(help="Scenario file (TOML) through one curve; or give --control.")]


def robustness(
    file: File = None,
    control: Annotated[
        str | None,
        typer.Option(
            help="Strategy of the library (irw_like), with parameters (irw_like:curvature=database), or mine.py:Mine."
        ),
    ] = None,
    curve: Annotated[
        str | None,
        typer.Option(help="Radius of one of the five curves (R300), or 'R=500,cant=160 mm,speed=140 km/h'."),
    ] = None,
    runs: Annotated[
        int, typer.Option(min=0, help="Runs with drawn inputs; more of them later go on with these.")
    ] = 200,
    seed: Annotated[int, typer.Option(min=0, help="Of the draws.")] = 1,
    only: Annotated[list[str] | None, typer.Option(help="Only this input, such as friction; may be repeated.")] = None,
    table: Annotated[
        Path | None, typer.Option("--inputs", help="File (TOML) with distributions in place of the shipped ones.")
    ] = None,
    alone: Annotated[bool, typer.Option(help="Also try each input alone.")] = True,
    out: Annotated[Path, typer.Option(help="Folder for rows, tables, figures and report.")] = Path("out/robustness"),
    vehicle: Annotated[
        str | None, typer.Option(help="Of the library, or a vehicle file; default: what the strategy is made for.")
    ] = None,
    step: Annotated[str, typer.Option(help="Of the integration; with a file, its own.")] = "1 ms",
    settings: Setting = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at a time; default: one per processor.")] = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="Begin anew, whatever the folder holds.")] = False,
    run: Annotated[
        str | None, typer.Option(help="Only this run again, such as drawn_7, with its time series in the folder.")
    ] = None,
) -> None:
    """How robust a strategy is: drawn friction, conicity, load, errors of sensors; probabilities, tornado charts."""
    from klingel.cli.scenario import setting
    from klingel.linear import parameters
    from klingel.study import robustness as body
    from klingel.study.robustness_inputs import inputs

    scenario = _scenario(file, control, curve, vehicle, step)
    for each in settings or ():
        scenario = parameters.replace(scenario, *setting(each))
    chosen = inputs(table, only=only or None)
    if run is not None:
        plan = body.plan_of(scenario, runs=runs, seed=seed, chosen=chosen, alone=alone)
        _again(plan, run, out)
        return
    given: list[tuple[str, object]] = [
        ("--control", control), ("--curve", curve), ("--vehicle", vehicle), ("--inputs", table),
        *(("--only", name) for name in only or ()), *(("--set", each) for each in settings or ()),
        ("--runs", runs), ("--seed", seed), ("--step", None if file else step), ("--out", out),
    ]  # fmt: skip
    words = ["klingel", "robustness", *([str(file)] if file else [])]
    words += [word for name, value in given if value is not None for word in (name, str(value))]
    with kept():
        body.run(
            scenario,
            out,
            runs=runs,
            seed=seed,
            chosen=chosen,
            alone=alone,
            jobs=jobs,
            fresh=fresh,
            again=shlex.join(words),
        )


def _scenario(file: Path | None, control: str | None, curve: str | None, vehicle: str | None, step: str) -> Scenario:
    """Of a file, or a strategy on its vehicle through a curve; errors: InputError."""
    from klingel.errors import InputError
    from klingel.study.compare_cases import contenders
    from klingel.study.compare_curves import curves

    if (file is None) == (control is None):
        given = None if file is None else str(file)
        raise InputError.single("control", given, "is needed, or a scenario file", remedy="give one of the two")
    if file is None and curve is None:
        raise InputError.single("curve", None, "is missing", remedy="give one, such as --curve R300")
    if file is not None and curve is None:
        from klingel.scenario import Scenario

        return contenders({"file": Scenario.read(file)}, curves(None)[0], vehicle=vehicle)[0].scenario
    assert curve is not None
    bare = re.fullmatch(r"R(\d+(?:\.\d+)?)", curve.strip())
    case = curves([float(bare[1]) if bare else curve])[0]
    found = contenders({"strategy": control or str(file)}, case, vehicle=vehicle)[0].through(case)
    return found if file is not None else found.replace(step=step)


def _again(plan: Plan, name: str, out: Path) -> None:
    """One run again: its row on the screen, its time series in the folder."""
    from klingel import result
    from klingel.assess import curving
    from klingel.cli.progress import preparing, simulate_with_bar
    from klingel.study.folder import study_folder

    scenario = plan.of(name)
    with preparing():
        result.prepare(scenario)
    series = simulate_with_bar(scenario, name)
    path = result.save(series, study_folder(out) / "runs" / f"{name}.nc", rate=None)
    for key, value in curving(series).row().items():
        typer.echo(f"{key}: {value}")
    typer.echo(path)
