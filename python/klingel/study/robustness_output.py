"""What a study of robustness leaves behind: tables as CSV, figures, one page, a summary on the screen.
Every file is written whole or not at all, and the same runs give the same bytes."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

import klingel
from klingel.plot.robustness import InputWords, exceedance, over_inputs, tornado
from klingel.report.columns import HEADINGS, cell
from klingel.report.sections import Listed, Picture, Section, sections_report
from klingel.study.folder import write_figure, write_table
from klingel.study.robustness_effects import EFFECTS, DesignedFor
from klingel.study.robustness_figures import (
    FAILED,
    MERITS,
    PERCENTILES,
    Y_LIMIT,
    correlations,
    failed,
    least_significant,
    percentiles,
    probabilities,
    ranges,
    two_sided,
    worst,
)
from klingel.study.robustness_pairs import conicities, nearest_pair

if TYPE_CHECKING:
    from klingel.study.robustness import Plan, Robustness

LIMITS = {"y_max_mm": Y_LIMIT}
"""Of figures of merit, drawn in the pictures."""

DISTINCT = ("y_max_mm", "lateral_force_max_kN", "attack_angle_max_mrad", "wear_index_N")
"""Figures whose distribution is drawn."""

WIDEST = 32
"""Characters of a cell in the table of the worst runs."""


def input_words(plan: Plan) -> dict[str, InputWords]:
    """How each input is written in figures."""
    return {
        name: InputWords(e.title, e.shown, e.factor, e.text(d.low).removesuffix(e.shown).rstrip(), e.text(d.high))
        for name, d in plan.chosen.items()
        for e in [EFFECTS[name]]
    }


def heading(figure: str) -> str:
    """Of a figure of merit, with its unit."""
    if figure == FAILED:
        return "failing"
    known = HEADINGS[figure]
    return f"{known.name} [{known.unit}]" if known.unit else known.name


def sentence(text: str) -> str:
    """A text with a capital in front, all else as it is.

    >>> sentence("mean of |Fx| below 20 Hz"), sentence("|Fx|")
    ('Mean of |Fx| below 20 Hz', '|Fx|')
    """
    return text[:1].upper() + text[1:]


def write(made: Robustness, plan: Plan, *, again: str) -> None:
    """All files of the study but its rows; `again`: command that runs one of the runs again, empty for none."""
    merits = tuple(m for m in MERITS if made.drawn[m].notna().any() or made.alone[m].notna().any())
    sections = [_asked(made, plan)]
    if len(made.drawn):
        sections += [_often(made, merits), _why(made, plan, merits), _worst(made, plan, again)]
    if len(made.alone):
        sections.append(_alone(made, plan, merits))
    sections.append(_nominal(made, merits))
    scenario = plan.scenario
    page = sections_report(
        sections,
        title=f"Robustness: {strategy_of(plan)}, {scenario.track.name or 'curve'}, {3.6 * scenario.speed:.0f} km/h",
        subtitle=f"{len(made.drawn)} runs with drawn inputs, {len(made.alone)} with one input away from nominal.",
        version=klingel.__version__,
    )
    page.save(made.out / "report.html")


def strategy_of(plan: Plan) -> str:
    """Of the vehicle, in words."""
    control = plan.scenario.control
    held = control.strategy if isinstance(control, DesignedFor) else control
    return plan.scenario.vehicle.name if held is None else type(held).__name__


def of_pairs(rows: pd.DataFrame, plan: Plan) -> pd.DataFrame:
    """Rows with the conicities of the pairs of profiles that ran in the place of those that were drawn."""
    if "conicity" not in plan.chosen:
        return rows
    found = conicities(plan.scenario)
    ran = [v if np.isnan(v) else found[nearest_pair(plan.scenario, v)] for v in rows["conicity"]]
    return rows.assign(conicity=ran)


def _asked(made: Robustness, plan: Plan) -> Section:
    rows = [
        {
            "input": EFFECTS[name].title,
            "low": EFFECTS[name].text(each.low),
            "high": EFFECTS[name].text(each.high),
            "distribution": _shape(name, each.kind, each.numbers),
            "nominal": "of the scenario" if (n := EFFECTS[name].nominal) is None else EFFECTS[name].text(n),
        }
        for name, each in plan.chosen.items()
    ]
    tables = [Listed("Inputs and their distributions", pd.DataFrame(rows))]
    if "conicity" in plan.chosen:
        found = conicities(plan.scenario)
        listed = pd.DataFrame({"pair": [p.name for p in found], "conicity": [f"{c:.3f}" for c in found.values()]})
        tables.append(
            Listed("Pairs of profiles (EN 15302 at 3 mm); a run has the nearest, and its conicity below", listed)
        )
    scenario = plan.scenario
    facts = {
        "Vehicle": scenario.vehicle.name,
        "Strategy": strategy_of(plan),
        "Track": f"{scenario.track.name or 'of the scenario'}, {scenario.track.length:.0f} m",
        "Speed": f"{3.6 * scenario.speed:.0f} km/h",
        "Nominal friction": f"{scenario.friction:g}",
        "Draws": f"Sobol points, scrambled with seed {plan.seed}",
        "Step": f"{1e3 * scenario.step:g} ms",
    }
    words = (
        "Inputs are independent of each other. The strategy is designed for the nominal vehicle in every run: what is "
        "drawn is unknown to it.",
    )
    if plan.left_out:
        titles = ", ".join(EFFECTS[name].title for name in plan.left_out)
        facts["Left out"] = f"{titles}: the strategy measures nothing that they change"
    facts |= {f"Range of {EFFECTS[name].title}": f"{each.reason} ({each.status})" for name, each in plan.chosen.items()}
    return Section("What was asked", words, tuple(tables), facts=facts)


def _shape(name: str, kind: str, numbers: Sequence[float]) -> str:
    words = {"uniform": (), "triangular": ("mode",), "normal": ("mean", "deviation")}[kind]
    return ", ".join([kind, *(f"{w} {EFFECTS[name].text(x)}" for w, x in zip(words, numbers, strict=True))])


def _often(made: Robustness, merits: tuple[str, ...]) -> Section:
    chances, spread = probabilities(made.drawn), percentiles(made.drawn, merits)
    write_table(made.out / "probabilities.csv", chances)
    write_table(made.out / "percentiles.csv", spread)
    shown = [merit for merit in DISTINCT if merit in merits]
    meanings = "; ".join(f"{HEADINGS[merit].name}: {HEADINGS[merit].meaning}" for merit in shown)
    pictures: tuple[Picture, ...] = ()
    if shown:
        figure = exceedance(
            {heading(merit): made.drawn[merit].to_numpy(dtype=np.float64) for merit in shown},
            {heading(merit): limit for merit, limit in LIMITS.items()},
            title="How many runs reach a value",
        )
        caption = f"Share of the drawn runs at or above each value. {meanings}."
        pictures = (_picture(made, "exceedance", figure, caption),)
    tables = (
        Listed("How often, with the 95 % interval of Clopper and Pearson", shown_probabilities(chances)),
        Listed("Percentiles over the runs that have the figure", shown_percentiles(spread)),
    )
    words = "A run that ended early counts with what it reached; in the first line it counts as failed."
    return Section("How often, how much", (words,), tables, pictures)


def shown_probabilities(chances: pd.DataFrame) -> pd.DataFrame:
    """Probabilities in per cent, as people read them."""
    return pd.DataFrame(
        {
            "event": chances["event"],
            "runs": [f"{k} of {n}" for k, n in zip(chances["runs"], chances["of"], strict=True)],
            "probability": [f"{100.0 * p:.1f} %" for p in chances["probability"]],
            "95 % interval": [
                f"{100.0 * a:.1f} to {100.0 * b:.1f} %" for a, b in zip(chances["low"], chances["high"], strict=True)
            ],
        }
    )


def shown_percentiles(spread: pd.DataFrame) -> pd.DataFrame:
    """Percentiles rounded for reading."""
    columns = {"figure": [heading(figure) for figure in spread["figure"]], "runs": list(spread["runs"])}
    for p in PERCENTILES:
        columns[f"{p} %"] = [cell(f, v) for f, v in zip(spread["figure"], spread[f"p{p}"], strict=True)]
    return pd.DataFrame(columns)


def _why(made: Robustness, plan: Plan, merits: tuple[str, ...]) -> Section:
    found = correlations(made.drawn, plan.chosen, merits)
    write_table(made.out / "correlations.csv", found)
    shown: dict[str, list[str]] = {
        "input": [f"|{EFFECTS[n].title}|" if two_sided(n, plan.chosen) else EFFECTS[n].title for n in found["input"]]
    }
    for column in (*merits, FAILED):
        shown[heading(column).partition(" [")[0]] = [_signed(v) for v in found[column]]
    shown["explains of y max"] = ["–" if np.isnan(v) else f"{100.0 * v:.0f} %" for v in found["explained"]]
    least = least_significant(len(made.drawn))
    caption = (
        f"Rank correlations of inputs with figures and with failing; chance gives less than {least:.2f} in 19 of 20"
    )
    words = (
        "Rank correlation is 1 where the figure rises with the input in every pair of runs, -1 where it falls. Of "
        "errors to both sides, written between bars, the amount counts. The last column is the share of the spread of "
        "y max that the input explains alone, whether it rises or not; what is missing to 100 % is done by inputs "
        "together.",
    )
    picture = _picture(
        made,
        "over_inputs",
        over_inputs(
            of_pairs(made.drawn, plan),
            list(found["input"]),
            input_words(plan),
            figure_name="y_max_mm",
            label=heading("y_max_mm"),
            failed=failed(made.drawn),
            limit=Y_LIMIT,
            title="Largest displacement over each input, most telling first",
        ),
        "Every drawn run. Crosses: failed runs; those without a figure are on top.",
    )
    return Section("Which inputs explain it", words, (Listed(caption, pd.DataFrame(shown)),), (picture,))


def _signed(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:+.2f}"


def _worst(made: Robustness, plan: Plan, again: str) -> Section:
    rows = of_pairs(worst(made.drawn), plan)
    shown: dict[str, list[str]] = {"run": list(rows["run"])}
    for name in plan.chosen:
        shown[EFFECTS[name].title] = [EFFECTS[name].text(v) for v in rows[name]]
    for figure in ("y_max_mm", "lateral_force_max_kN", "attack_angle_max_mrad", "flange_contact", "outcome"):
        # one long reason would widen all columns
        shown[heading(figure)] = [shorten(cell(figure, v), WIDEST, placeholder=" …") for v in rows[figure]]
    words = [
        "Long outcomes are whole in runs.csv.",
        f"Run one of them again: {again} --run {rows['run'].iloc[0]}" if again else "",
        "From Python: klingel.study.robustness.plan_of(...).of(name) is the scenario of a run.",
    ]
    table = pd.DataFrame(shown).set_index("run").T.rename_axis("", axis="index").reset_index()
    return Section("The worst runs", tuple(w for w in words if w), (Listed("Inputs and figures", table),))


def _alone(made: Robustness, plan: Plan, merits: tuple[str, ...]) -> Section:
    pictures = tuple(
        _picture(
            made,
            f"tornado_{figure}",
            tornado(
                ranges(made.alone, made.nominal, figure),
                float(made.nominal[figure]),
                input_words(plan),
                title=f"One input at a time: {HEADINGS[figure].name}",
                label=heading(figure),
                limit=LIMITS.get(figure),
            ),
            f"{sentence(HEADINGS[figure].meaning)}. All other inputs nominal.",
        )
        for figure in merits
    )
    ended = of_pairs(made.alone[failed(made.alone)], plan)
    tables: tuple[Listed, ...] = ()
    if len(ended):
        listed = pd.DataFrame(
            {
                "input": [EFFECTS[n].title for n in ended["input"]],
                "value": [EFFECTS[n].text(ended.loc[i, n]) for i, n in zip(ended.index, ended["input"], strict=True)],
                heading("y_max_mm"): [cell("y_max_mm", v) for v in ended["y_max_mm"]],
                "outcome": list(ended["outcome"]),
            }
        )
        tables = (Listed("Failed alone", listed),)
    words = "Each input at five values evenly over its range, the others nominal."
    return Section("One input at a time", (words,), tables, pictures)


def _nominal(made: Robustness, merits: tuple[str, ...]) -> Section:
    rows = {"the scenario as given": made.given, "all inputs nominal": made.nominal}
    shown: dict[str, list[str]] = {"run": list(rows)}
    for figure in (*merits, "flange_contact", "outcome"):
        shown[heading(figure)] = [cell(figure, row[figure]) for row in rows.values()]
    words = (
        "They differ only in the creep law: a share of Kalker's slope needs a law that takes one, which is Polach's "
        "unless the scenario has FASTSIM.",
    )
    return Section("Nominal runs", words, (Listed("Figures", pd.DataFrame(shown)),))


def _picture(made: Robustness, name: str, figure: Any, caption: str) -> Picture:
    return Picture(name, write_figure(made.out, name, figure), caption)


def show(screen: Console, made: Robustness, plan: Plan, cost: Sequence[tuple[float, float]]) -> None:
    """Print what matters most, and what the runs cost: (simulated, CPU) seconds of each."""
    if len(made.drawn):
        title = f"{strategy_of(plan)}: {len(made.drawn)} drawn runs"
        _print(screen, title, shown_probabilities(probabilities(made.drawn)))
        _print(screen, "Percentiles", shown_percentiles(percentiles(made.drawn)))
    if cost:
        simulated, spent = (float(sum(column)) for column in zip(*cost, strict=True))
        screen.print(
            f"{len(cost)} runs, {simulated:.0f} s simulated in {spent:.0f} s of processors: "
            f"{simulated / spent:.1f} times real time a core; {made.elapsed:.0f} s in all",
            highlight=False,
        )
    screen.print(f"written to {made.out}", highlight=False)


def _print(screen: Console, title: str, rows: pd.DataFrame) -> None:
    table = Table(title=escape(title), title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    for i, column in enumerate(rows.columns):
        table.add_column(escape(str(column)), justify="left" if i == 0 else "right")
    for row in rows.astype(str).to_numpy().tolist():
        table.add_row(*map(escape, row))
    screen.print(table)
