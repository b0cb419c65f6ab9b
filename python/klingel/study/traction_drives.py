"""The part of the traction study about the drives: the limits of the motor, its equations measured on the roller rig,
the design plants on the whole vehicle, and the five curves with both kinds of motor."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from klingel import control, drives, library
from klingel.linear.rig import plant_departure, rig_responses, torque_response
from klingel.plot import drives as figures
from klingel.plot.style import render
from klingel.report.sections import Listed, Picture, Section
from klingel.scenario import Scenario
from klingel.track.cases import Case, perez2004

INDUCTION = "induction_160kw"
RIG_SPEEDS = (108.0 / 3.6, 176.0 / 3.6, 265.0 / 3.6)
"""At which the rig is run [m/s]."""

TOP_SPEED = 265.0 / 3.6
"""Of the operating characteristic [m/s]."""


@dataclass(frozen=True)
class DriveRun:
    """One curve with one strategy and one kind of motor, `dc` or `induction`."""

    case: Case
    strategy: str
    motor: str

    @property
    def name(self) -> str:
        """Of its file, unique in the study."""
        return f"{self.motor}_R{self.case.radius:.0f}_{self.strategy}"

    def scenario(self) -> Scenario:
        """The run, as in the study of the five curves."""
        vehicle = library.vehicle("mechatronic_irw")
        if self.motor == "induction":
            vehicle = vehicle.replace(drive=library.drive(INDUCTION))
        strategy = control.SolidLike() if self.strategy == "solid_like" else control.IRWLike()
        return Scenario(vehicle, self.case.track, speed=self.case.speed, control=strategy, step=0.5e-3)


def drive_runs(strategies: Iterable[str]) -> list[DriveRun]:
    """Five curves, the strategies, both kinds of motor.

    Example:
        >>> len(drive_runs(["irw_like"]))
        10
    """
    return [
        DriveRun(case, strategy, motor)
        for strategy in strategies
        for case in perez2004()
        for motor in ("dc", "induction")
    ]


def comparison(largest: dict[str, float]) -> pd.DataFrame:
    """y_max of the five curves with both kinds of motor [mm], from largest displacements by name of the run [m]."""
    rows = []
    for name, y in largest.items():
        motor, _, rest = name.partition("_")
        if motor == "dc" and f"induction_{rest}" in largest:
            other = largest[f"induction_{rest}"]
            rows.append((rest.replace("_", " "), 1e3 * y, 1e3 * other, 1e3 * (other - y)))
    return pd.DataFrame(rows, columns=["run", "DC [mm]", "induction [mm]", "difference [mm]"])


def curves_section(largest: dict[str, float]) -> Section:
    """The five curves with both kinds of motor."""
    table = comparison(largest)
    shown = table.assign(
        **{column: table[column].map(lambda v: f"{v:.3f}") for column in table.columns if column != "run"}
    )
    words = (
        "The paper replaces the AC drive by a DC motor, expecting that nothing changes. Here the five curves are run "
        "with both: S commands induction motors the torque of the same damping between the wheels, I equal torques."
    )
    return Section("Induction motors in the five curves", (words,), (Listed("Largest displacement", shown),))


def rig_section() -> Section:
    """Measures the drives on the rig and on the whole vehicle, and draws all."""
    vehicle = library.vehicle("mechatronic_irw")
    other = vehicle.replace(drive=library.drive(INDUCTION))
    pictures = []

    def add(name: str, figure: object, caption: str) -> None:
        pictures.append(Picture(name, render(figure, "svg", name=name), caption))  # type: ignore[arg-type]

    speeds = np.linspace(TOP_SPEED / 200.0, TOP_SPEED, 200)
    table = drives.operating_characteristic(vehicle, speeds)
    points = [case.speed for case in perez2004()]
    add(
        "fig6",
        figures.characteristic(table, title="Operating characteristic of the motors (Fig. 6)", points=points),
        "Limits of rated currents and x VaMax; line of the running resistance with the speeds of the five curves.",
    )
    rows = []
    for speed in RIG_SPEEDS:
        found = rig_responses(vehicle, speed)
        kmh = f"{3.6 * speed:.0f} km/h"
        for equation, (level, angle) in found.worst().items():
            rows.append((f"Eq. {equation}", kmh, f"{level:.2f}", f"{angle:.1f}"))
        add(
            f"rig{3.6 * speed:.0f}",
            figures.rig(found, title=f"Equations of the drive on the roller rig, {kmh}"),
            "Lines: equations. Points: measured on runs of the simulator, one wheelset of which only wheels turn.",
        )
    answers = {}
    for speed in (RIG_SPEEDS[0], RIG_SPEEDS[-1]):
        kmh = f"{3.6 * speed:.0f} km/h"
        direct, induction = torque_response(vehicle, speed), torque_response(other, speed)
        answers[f"DC, {kmh}"], answers[f"induction, {kmh}"] = direct, induction
        ratio = induction[1] / direct[1]
        level, angle = np.abs(20.0 * np.log10(np.abs(ratio))).max(), np.abs(np.degrees(np.angle(ratio))).max()
        rows.append(("induction over DC drive, below 15 Hz", kmh, f"{level:.2f}", f"{angle:.1f}"))
    add(
        "torque_answers",
        figures.torque_answers(answers, title="Torque over commanded torque, both drives"),
        "Shaft torque of one wheel on the rig; DC motors by voltage with a lead for the armature, induction motors by "
        "their torque command.",
    )
    frequencies = np.geomspace(0.5, 100.0, 300)
    for speed in (RIG_SPEEDS[0], RIG_SPEEDS[-1]):
        away = plant_departure(vehicle, speed, frequencies)
        add(
            f"plants{3.6 * speed:.0f}",
            figures.departure(away, title=f"Design plants against the whole vehicle, {3.6 * speed:.0f} km/h"),
            "Eq. (26) drops yaw and lateral motion of the wheelset. With wd at nil the pair is a solid wheelset; its "
            "hardly damped kinematic oscillation is a zero of wd/u on the whole vehicle, at 3 to 8 Hz.",
        )
    listed = Listed(
        "Largest departures, 1 to 100 Hz", pd.DataFrame(rows, columns=["response", "speed", "level [dB]", "phase [°]"])
    )
    words = (
        "The equations of the drive are measured from runs of the simulator, one wheelset on a roller rig with linear "
        "creep; asked for are 1 dB and 5 degrees up to 100 Hz, and 1 dB and 10 degrees between both drives below 15 Hz."
    )
    return Section("Drives", (words,), (listed,), tuple(pictures))
