"""What the study leaves behind: tables as CSV, figures as SVG and PNG, the report, and a summary on the screen.
Every file is written whole or not at all, and the same results give the same bytes, measured run times apart."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
from rich import box
from rich.console import Console
from rich.table import Table

import klingel
from klingel import control, drives, library
from klingel.assess import COLUMNS, Assessment
from klingel.report.page import StudyPage, study_report
from klingel.study.cases import FRICTION, STEP, VEHICLES, Run
from klingel.study.folder import write_table
from klingel.study.screen import print_runs

if TYPE_CHECKING:
    from klingel.scenario import Scenario
    from klingel.vehicle import Vehicle

SHOWN = (
    "vehicle", "radius_m", "speed_kmh", "y_max_mm", "y_curve_mm", "attack_angle_max_mrad", "lateral_force_max_kN",
    "lateral_force_floor_kN", "wear_index_N", "actuator_force_max_kN", "steering_voltage_max_V",
    "contact_angle_max_deg", "flange_contact", "outcome", "realtime_factor",
)  # fmt: skip
"""Columns on the screen; the file has all."""


def summary(rows: Iterable[tuple[Run, Assessment]]) -> pd.DataFrame:
    """The main runs as a table, ordered by vehicle and radius, columns of `klingel.assess.COLUMNS`."""
    table = pd.DataFrame([assessment.row() for _, assessment in rows], columns=list(COLUMNS))
    return _ordered(table)


def variants(rows: Iterable[tuple[Run, Assessment]]) -> pd.DataFrame:
    """The other runs as a table, with `variant` and `friction` in front."""
    records = [{"variant": r.variant, "friction": r.friction, **assessment.row()} for r, assessment in rows]
    table = pd.DataFrame(records, columns=["variant", "friction", *COLUMNS])
    return _ordered(table, first=["variant"])


def _ordered(table: pd.DataFrame, *, first: Sequence[str] = ()) -> pd.DataFrame:
    rank = table["vehicle"].map({vehicle: i for i, vehicle in enumerate(VEHICLES)})
    ordered = table.assign(rank=rank).sort_values([*first, "rank", "radius_m"], kind="stable")
    return ordered.drop(columns="rank").reset_index(drop=True)


def operating_points(vehicle: Vehicle, speeds: Iterable[float]) -> pd.DataFrame:
    """Table 1 of the paper: what the motors do at each speed [m/s], headings with units."""
    return pd.DataFrame(
        [
            {
                "speed [km/h]": f"{3.6 * point.speed:.0f}",
                "torque per wheel [N m]": f"{point.wheel_torque:.1f}",
                "If normalised [-]": f"{point.field_current_normalised:.4f}",
                "If [A]": f"{point.field_current:.3f}",
                "Ia [A]": f"{point.armature_current:.2f}",
                "KT [N m/A]": f"{point.torque_constant:.4f}",
                "x VaMax [V]": f"{point.armature_voltage:.0f}",
                "largest torque per wheel [N m]": f"{point.wheel_torque_max:.0f}",
            }
            for point in drives.operating_table(vehicle, speeds)
        ]
    )


def write_tables(folder: Path, main: pd.DataFrame, beside: pd.DataFrame, points: pd.DataFrame) -> None:
    """`summary.csv`, `summary_variants.csv` and `table1.csv`."""
    for name, table in (("summary", main), ("summary_variants", beside), ("table1", points)):
        write_table(folder / f"{name}.csv", table)


CAPTIONS = {
    "fig15": "Lateral displacement of the wheelsets from the track centre line. Grey: transitions, and darker the arc, "
    "as the leading wheelset passes them. The active vehicles share one scale; the passive vehicle has its own.",
    "fig16": "Largest lateral displacement of any wheelset, from 1 s before the curve to 3 s after it.",
    "fig17": "Largest attack angle of any wheelset, its yaw to the local tangent of the track.",
    "fig18": "Largest lateral force of any wheelset on the track. Dotted: the least achievable, a wheelset's share of "
    "the vehicle's mass times the unbalanced lateral acceleration in the arc.",
    "fig19": "Wear index, the mean over all wheels of |Fx ξ| + |Fy η| in the arc.",
}
"""Below the figures."""


def write_report(
    folder: Path,
    *,
    summary: pd.DataFrame,
    variants: pd.DataFrame,
    figures: Mapping[str, bytes],
    points: pd.DataFrame,
    loads: Mapping[str, Mapping[str, float]],
    scenario: Scenario,
    failed: Mapping[str, str],
    runs: int,
    history_radius: float,
) -> None:
    """`report.html`, one page with everything in it."""
    vehicle = library.vehicle("mechatronic_irw")
    assert vehicle.running_resistance is not None
    drive, resistance = vehicle.dc_drive, vehicle.running_resistance
    page = StudyPage(
        summary=summary,
        variants=variants,
        figures=figures,
        captions=CAPTIONS,
        operating_points=points,
        operating_note=(
            f"Running resistance by the formula {resistance.formula} for {resistance.stock} stock, a train of "
            f"{resistance.cars:g} such cars, shared evenly by all wheels. Field current from Eq. (5), larger root, at "
            f"x VaMax = {drive.traction_share * drive.armature_voltage_max:.0f} V; normalised by its rated "
            f"{drive.field_current_rated:g} A. Motors of this project's own design, see the parameters."
        ),
        vehicles=[library.vehicle("manchester_coach"), vehicle],
        strategies={"Solid-wheelset-like (S)": control.SolidLike(), "IRW-like (I)": control.IRWLike()},
        static_wheel_loads=loads,
        method=_method(scenario, runs, len(summary) + len(variants)),
        radius_of_history=history_radius,
        version=klingel.__version__,
        missing=failed,
    )
    study_report(page).save(folder / "report.html")


def _method(scenario: Scenario, asked: int, made: int) -> dict[str, str]:
    rail = scenario.rail if isinstance(scenario.rail, str) else scenario.rail.name
    return {
        "Runs": f"{made} of {asked}",
        "Curves": "R = 300, 500, 800, 1200, 1800 m at 108, 140, 176, 216, 265 km/h, cant 160 mm, linear ramps of "
        "curvature and cant; R = 500 and 1200 m and the cant are inferred, they reproduce all five speeds of the paper",
        "Track": "smooth and rigid",
        "Profiles": f"S1002 on {rail} at 1:{1.0 / scenario.rail_inclination:.0f}, gauge {1e3 * scenario.gauge:.0f} mm",
        "Contact": f"elastic, tabulated over shift and roll; creep forces by {_creep(scenario)}, one "
        f"coefficient of friction, {FRICTION:.2f} in the main runs",
        "Integration": f"step {1e3 * STEP['passive']:g} ms, in the main runs of solid_like "
        f"{1e3 * STEP['solid_like']:g} ms, as at R = 300 m with free wheels; "
        "controllers sampled at 1 kHz; runs start from the static equilibrium",
        "Speed": "held by a slow ideal force on the body; the motors of the active vehicles give the torque of Table 1",
    }


def _creep(scenario: Scenario) -> str:
    """The creep law in words."""
    if scenario.creep_law == "table":
        return "exact theory (steady rolling), from a table"
    elements = " by ".join(str(n) for n in scenario.creep_elements)
    grid = f" with blended flexibility, {elements} elements" if scenario.creep_law == "fastsim" else ""
    return f"{scenario.creep_law.upper()}{grid}"


def show(
    console: Console,
    main: pd.DataFrame,
    beside: pd.DataFrame,
    points: pd.DataFrame,
    folder: Path,
    elapsed: float,
) -> None:
    """Print Table 1 and the summaries."""
    table = Table(
        title="Table 1: operating points of the motors", title_justify="left", title_style="bold", box=box.SIMPLE_HEAD
    )
    for heading in points.columns:
        table.add_column(str(heading), justify="right")
    for row in points.astype(str).to_numpy().tolist():
        table.add_row(*row)
    console.print(table)
    if len(main):
        print_runs(console, main, "Main runs, friction 0.35", SHOWN)
    for name, rows in beside.groupby("variant", sort=False):
        print_runs(console, rows, str(name), SHOWN)
    console.print(f"{len(main) + len(beside)} runs in {elapsed:.1f} s, written to {folder}", highlight=False)
