"""What the reasons of the report refer to beyond the summary: the passive coach's hunting, and the variants.
The texts hold for the vehicles and runs of the study as they are shipped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from klingel.report.summary import ACTIVE, Summary

if TYPE_CHECKING:
    import pandas as pd

ESTIMATE = (
    "An independent quasi-static estimate of the leading wheelset at friction 0.30 has 6.3 / 6.2 / 5.9 / 5.1 / 4.4 mm "
    "and 37 / 32 / 23 / 14 / 8 deg for R = 300 to 1800 m. The figures here are the largest displacement of the four "
    "wheelsets and the steepest patch of any wheel: at R = 1800 m the trailing wheelsets of both bogies run further "
    "out than the leading ones, and the leading wheelset alone has 5.9 mm at R = 1200 m and 4.8 mm at R = 1800 m at "
    "friction 0.30."
)
"""The passive coach of the library beside a calculation that shares nothing with the simulator."""

HUNTING = (
    "In the arc of R = 1800 m at 265 km/h the passive coach hunts lightly: at friction 0.35 its trailing bogie keeps "
    "up a limit cycle of 2 Hz and 1.8 mm peak to peak, also in an arc of 20 s and at half the step. Yaw dampers from "
    "100 to 400 kN s/m do not cure it; at 70 m/s it dies out, and on straight track the coach is calm. At R = 1200 m, "
    "and at R = 1800 m with friction 0.30, a slower motion of 0.7 Hz and up to 0.9 mm, left from the transition, lasts "
    "to the end of the arc; in the longer arc it dies out."
)
"""What the passive coach of the library does in the smoothest curves; measured on its runs, not in the summary."""


def with_database(variants: pd.DataFrame | None) -> Summary | None:
    """The runs of I with the curvature from the track database."""
    if variants is None or not len(variants):
        return None
    rows = variants[variants["variant"].str.contains("database")]
    return Summary(rows) if len(rows) else None


def database_beside(summary: Summary, database: Summary | None) -> str:
    """S, and I with either source of the curvature, where S is best against I."""
    if database is None or not summary.several:
        return ""
    column = "lateral_force_max_kN"
    radius = min(
        summary.radii, key=lambda r: summary.value("solid_like", r, column) / summary.value("irw_like", r, column)
    )
    s, gyro = (summary.value(v, radius, column) for v in ACTIVE)
    known = database.value("irw_like", radius, column)
    if not s < known < gyro:
        return ""
    return f" At R = {radius:.0f} m S has {s:.2f} kN, I {gyro:.2f} kN with gyros and {known:.2f} kN with the database."
