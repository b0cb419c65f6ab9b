"""How the summary's columns are shown to people: heading, unit and digits of each.
Shared by the reports and by the table that the study prints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Heading:
    """Heading of a column: name, unit, digits behind the point, and the definition in short."""

    name: str
    unit: str
    digits: int
    meaning: str


HEADINGS: Mapping[str, Heading] = {
    "vehicle": Heading("vehicle", "", 0, "passive: solid wheelsets; solid_like: strategy S; irw_like: strategy I"),
    "radius_m": Heading("R", "m", 0, "radius of the arc"),
    "speed_kmh": Heading("V", "km/h", 0, "speed"),
    "y_max_mm": Heading("y max", "mm", 2, "largest lateral displacement of any wheelset from the track centre line"),
    "y_curve_mm": Heading("y arc", "mm", 3, "largest of the wheelsets' means over the last 2 s of the arc"),
    "attack_angle_max_mrad": Heading("α max", "mrad", 2, "largest yaw of any wheelset to the local tangent"),
    "lateral_force_max_kN": Heading("ΣY max", "kN", 2, "largest sum of Y of a wheelset, 20 Hz low-pass"),
    "lateral_force_floor_kN": Heading("ΣY floor", "kN", 2, "own mass / 4 times the unbalanced lateral acceleration"),
    "wear_index_N": Heading("Tγ", "N", 1, "mean of |Fx ξ| + |Fy η| per wheel in the arc"),
    "actuator_force_max_kN": Heading("F act", "kN", 2, "largest force of any steering actuator"),
    "steering_voltage_max_V": Heading("|u|", "V", 1, "largest steering voltage of Eqs (22, 23)"),
    "armature_current_max_A": Heading("Ia", "A", 0, "largest armature current"),
    "contact_angle_max_deg": Heading("δ max", "°", 1, "steepest contact patch that carried more than 1 kN"),
    "yq_max": Heading("Y/Q", "", 2, "largest guiding Y/Q, 20 Hz low-pass and mean over 2 m, positive outwards"),
    "q_min_kN": Heading("Q min", "kN", 1, "least vertical wheel force, 20 Hz low-pass"),
    "body_lateral_acc_mps2": Heading("ÿ body", "m/s²", 2, "largest lateral acceleration of the body, 20 Hz low-pass"),
    "spin_work_N": Heading("Mz φ", "N", 1, "mean of |Mz φ| per wheel in the arc, not part of Tγ"),
    "flange_contact": Heading(
        "flange",
        "",
        0,
        "a patch steeper than 15° carried more than 1 kN for more than 0.1 s: root, or flange above 60°",
    ),
    "outcome": Heading("outcome", "", 0, "completed, or what ended the run, where and when"),
    "notes": Heading("notes", "", 0, "what a reader of the numbers should know"),
    "realtime_factor": Heading("× real time", "", 1, "simulated seconds over CPU seconds of the stepping thread"),
}
"""Heading of every column of the summary, in its order."""


def cell(column: str, value: object) -> str:
    """One value as text: rounded for reading, a dash where there is none.

    Args:
        column: of the summary.
        value: number or word.

    Returns:
        The text.

    Example:
        >>> cell("y_max_mm", 1.234), cell("y_max_mm", float("nan")), cell("flange_contact", "")
        ('1.23', '–', '–')
    """
    if isinstance(value, str):
        return value or "–"
    number = float(value)  # type: ignore[arg-type]
    return "–" if math.isnan(number) else f"{number:.{HEADINGS[column].digits}f}"


PLAIN = {"the formula sncf_general": "the general formula of the SNCF", "tgv stock": "TGV stock"}
"""Names in the vehicles' files to what a reader calls them."""


def plain(text: str) -> str:
    """A text without names that only the vehicles' files use.

    Args:
        text: of a note.

    Returns:
        The text in plain words.

    Example:
        >>> plain("Running resistance by the formula sncf_general for tgv stock")
        'Running resistance by the general formula of the SNCF for TGV stock'
    """
    for name, words in PLAIN.items():
        text = text.replace(name, words)
    return text
