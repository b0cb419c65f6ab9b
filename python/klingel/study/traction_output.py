"""What the traction study leaves behind: a table as CSV, a figure for every run, the report, a table on the screen.
Every file is written whole or not at all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
from rich import box
from rich.console import Console
from rich.table import Table

import klingel
from klingel.assess import energy
from klingel.plot.style import LOOKS
from klingel.plot.traction import patch_figure, run_figure
from klingel.report.sections import Listed, Picture, Section, sections_report
from klingel.study.folder import write_figure, write_table

if TYPE_CHECKING:
    from klingel.study.traction import Finished

HEADINGS: Mapping[str, tuple[str, float, int]] = {
    "speed_start_kmh": ("v begin [km/h]", 1.0, 1),
    "speed_end_kmh": ("v end [km/h]", 1.0, 1),
    "distance_m": ("distance [m]", 1.0, 0),
    "acceleration_max_mps2": ("acceleration [m/s²]", 1.0, 2),
    "deceleration_max_mps2": ("deceleration [m/s²]", 1.0, 2),
    "torque_max_Nm": ("torque per wheel [N m]", 1.0, 0),
    "armature_current_max_A": ("Ia [A]", 1.0, 0),
    "voltage_max_V": ("Va [V]", 1.0, 0),
    "headroom_min_V": ("left for steering [V]", 1.0, 0),
    "steering_voltage_max_V": ("used by steering [V]", 1.0, 1),
    "creepage_max": ("creepage [%]", 100.0, 2),
    "slip_speed_max_mps": ("slip speed [m/s]", 1.0, 3),
    "y_max_mm": ("|y| [mm]", 1.0, 2),
    "flange_contact": ("flange", 1.0, 0),
    "actuator_force_max_kN": ("actuator [kN]", 1.0, 1),
    "outcome": ("outcome", 1.0, 0),
    "realtime_factor": ("× real time", 1.0, 1),
}
"""Heading, factor and decimals of each column for people; all are extremes of the run."""

PARTS = {
    "launch": (
        "From standstill to 265 km/h",
        "Straight level track. Below the base speed the field is full and the torque limited by the armature current; "
        "above it the field is weakened so that the mean voltage stays below x VaMax, and what remains to "
        "VaMax is kept for steering at every speed.",
    ),
    "stop": (
        "A stop from 160 km/h",
        "Electric braking by the same motors down to standstill: the armature current is reversed, the field grows as "
        "the speed falls.",
    ),
    "curve": (
        "Traction and braking in curves",
        "Full torque in the arc while both strategies steer. The grey band is the time in curvature; the cant "
        "deficiency is 300 mm only at the highest speed, and falls below it.",
    ),
    "patch": (
        "A patch of low adhesion",
        "200 m with friction 0.08. On straight track slip control keeps the creepage and gives the torque back "
        "behind the patch, also where friction falls with slip; there the wheel speeds of I tell nothing of its "
        "displacement, and it wanders off the middle until the patch ends. In the curves at 300 mm deficiency "
        "friction 0.08 cannot carry the lateral force at small contact angles: the wheelsets move to the flange, "
        "whatever steers them, and come back behind the patch.",
    ),
}


def summary(done: Iterable[Finished]) -> pd.DataFrame:
    """One row a run, with the figures of patches behind those of all runs."""
    rows = []
    for each in done:
        row = each.figures.row()
        passed = each.patch
        row["patch_creepage_max"] = passed.creepage_max if passed else float("nan")
        row["patch_recovery_s"] = passed.recovery_s if passed else float("nan")
        row["patch_growth"] = passed.growth if passed else float("nan")
        row["patch_centred_s"] = passed.centred_s if passed else float("nan")
        rows.append(row)
    return pd.DataFrame(rows)


def write(
    folder: Path,
    done: Sequence[Finished],
    table: pd.DataFrame,
    beside: Sequence[Section],
    *,
    failed: Mapping[str, str],
) -> None:
    """`summary.csv`, the figures and `report.html`, with sections beside those of the runs under traction."""
    write_table(folder / "summary.csv", table)
    sections: list[Section] = []
    for group, (title, words) in PARTS.items():
        members = [each for each in done if each.run.group == group]
        if members:
            pictures = tuple(_picture(folder, each) for each in members)
            tables = [Listed("Extremes of each run", _upright(_readable(summary(members))))]
            tables.append(
                Listed(
                    "Energy of each run [kWh]; residual: what does not close, over all that was turned over",
                    _energies(members),
                )
            )
            if group == "patch":
                tables.append(Listed("Passage over the patch", _upright(_passages(members))))
            sections.append(Section(title, (words,), tuple(tables), pictures))
    sections += beside
    if failed:
        rows = pd.DataFrame({"run": list(failed), "reason": list(failed.values())})
        sections.append(Section("Missing runs", (), (Listed("Runs that failed", rows),)))
    page = sections_report(
        sections,
        title="Traction, braking and adhesion of the mechatronic vehicle",
        subtitle="Both strategies of Perez et al. (2004) with the traction loop closed through the motors that steer.",
        version=klingel.__version__,
    )
    page.save(folder / "report.html")


def _picture(folder: Path, each: Finished) -> Picture:
    run = each.run
    vehicle = run.scenario.vehicle
    title = f"{LOOKS[run.strategy].label}: {run.title}"
    if run.patch:
        figure = patch_figure(
            each.series, title=title, begin=run.patch[0], end=run.patch[1], radius=vehicle.geometry.wheel_radius
        )
        caption = "Grey: the leading wheelset's time in the patch; dashed: creepage of 3 %."
    else:
        figure = run_figure(each.series, title=title, drive=vehicle.dc_drive)
        caption = "Torque and voltage of the first wheelset's motors and of all; grey: in the curve."
    return Picture(run.name, write_figure(folder, run.name, figure), f"{title}. {caption}")


def _readable(table: pd.DataFrame) -> pd.DataFrame:
    shown = pd.DataFrame({"run": table["run"].str.replace("_", " ")})
    for name, (heading, factor, digits) in HEADINGS.items():
        column = table[name]
        if pd.api.types.is_numeric_dtype(column):
            shown[heading] = [f"{factor * value:.{digits}f}" for value in column]
        else:
            shown[heading] = [str(value) or "no" for value in column]
    return shown


def _upright(table: pd.DataFrame) -> pd.DataFrame:
    """Runs as columns, which are fewer than what is told of each."""
    return table.set_index("run").T.rename_axis("", axis="index").reset_index()


def _energies(members: Sequence[Finished]) -> pd.DataFrame:
    rows = []
    for each in members:
        account = energy(each.series)
        named = zip(account.index[:-1], account["energy_kWh"], strict=False)
        values = {str(what).replace("_", " "): f"{kwh:.3f}" for what, kwh in named}
        rows.append({"run": each.run.name.replace("_", " "), **values, "residual": f"{account['share'].iloc[-1]:.1e}"})
    return pd.DataFrame(rows)


def _passages(members: Sequence[Finished]) -> pd.DataFrame:
    rows = [(each.run, each.patch) for each in members if each.patch is not None]
    return pd.DataFrame(
        {
            "run": [run.name.replace("_", " ") for run, _ in rows],
            "largest creepage [%]": [f"{100.0 * passed.creepage_max:.2f}" for _, passed in rows],
            "torque back after [s]": [f"{passed.recovery_s:.2f}" for _, passed in rows],
            "swing, last over second quarter [-]": [f"{passed.growth:.2f}" for _, passed in rows],
            "last 1 mm off the middle after [s]": [f"{passed.centred_s:.2f}" for _, passed in rows],
        }
    )


def show(screen: Console, table: pd.DataFrame, folder: Path, elapsed: float) -> None:
    """Print the table."""
    if len(table):
        shown = Table(title="Traction study", title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
        readable = _readable(table)
        for heading in readable.columns:
            shown.add_column(str(heading), justify="left" if heading in ("run", "outcome", "flange") else "right")
        for row in readable.to_numpy().tolist():
            shown.add_row(*map(str, row))
        screen.print(shown)
    screen.print(f"{len(table)} runs in {elapsed:.1f} s, written to {folder}", highlight=False)
