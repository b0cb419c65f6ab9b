"""The runs of the study: which vehicle with which strategy, in which curve, at which friction.
Pure data; nothing here simulates."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from klingel import control, library
from klingel.errors import InputError
from klingel.lower import explicit_step
from klingel.scenario import Scenario, Strategy
from klingel.track.cases import Case, perez2004

FRICTION = 0.35
"""Coefficient of friction of the main runs; dry rail, and enough for the sharpest curve at 300 mm deficiency."""

FRICTION_BESIDE = (0.30, 0.25)
"""Printed beside the main runs."""

STEP = {"passive": 1e-3, "solid_like": 0.5e-3, "irw_like": 1e-3}
"""Of the integration in the main runs [s]. Halving it changes no figure of the summary by more than 1 % (or 0.01 mm,
0.01 mrad, 0.05 kN, 0.1 V); the speed loop of `solid_like` hears the wheels ring on their contact springs, so that its
peak voltage asks for the shorter step. Where free wheels would need implicit steps it is halved (R = 300 m)."""

STEP_BESIDE = 1e-3
"""Of the integration in the variants [s]: within the same bounds but for that peak voltage, up to 5 % lower."""

VEHICLES = ("passive", "solid_like", "irw_like")
"""In the order of the tables."""

MAIN = "main"
DATABASE = "curvature from the track database"


@dataclass(frozen=True)
class Run:
    """One run of the study.

    Attributes:
        vehicle: `passive`, `solid_like` or `irw_like`.
        case: the curve and its speed.
        friction: coefficient of all contacts [-].
        variant: `main`, or what differs, as a heading of the report.
        curvature: what the strategy takes the curvature from, `gyro` or `database`; for `irw_like` only.
    """

    vehicle: str
    case: Case
    friction: float = FRICTION
    variant: str = MAIN
    curvature: Literal["gyro", "database"] = "gyro"

    @property
    def name(self) -> str:
        """Of its file, unique in the study.

        Example:
            >>> Run("irw_like", perez2004()[0]).name
            'irw_like_R300'
            >>> Run("passive", perez2004()[0], friction=0.25, variant="friction 0.25").name
            'passive_R300_mu025'
        """
        parts = [self.vehicle, f"R{self.case.radius:.0f}"]
        if self.friction != FRICTION:
            parts.append(f"mu{100 * self.friction:03.0f}")
        if self.curvature == "database":
            parts.append("database")
        return "_".join(parts)

    def scenario(self) -> Scenario:
        """Vehicle, track, speed, strategy and contact settings of this run: S1002 on 60E1 at 1:40, FASTSIM."""
        strategies: dict[str, Strategy | None] = {
            "passive": None,
            "solid_like": control.SolidLike(),
            "irw_like": control.IRWLike(curvature=self.curvature),
        }
        vehicle = library.vehicle("manchester_coach" if self.vehicle == "passive" else "mechatronic_irw")
        return Scenario(
            vehicle,
            self.case.track,
            speed=self.case.speed,
            control=strategies[self.vehicle],
            friction=self.friction,
            step=explicit_step(vehicle, self.case.speed, STEP[self.vehicle] if self.variant == MAIN else STEP_BESIDE),
        )


def study_runs(
    radii: Iterable[float] | None = None,
    *,
    vehicles: Iterable[str] = VEHICLES,
    friction_variants: bool = True,
    database_variant: bool = True,
) -> list[Run]:
    """All runs of the study, the main ones first, the active vehicles before the passive.

    Args:
        radii: curves to run, all five if not given [m].
        vehicles: to run.
        friction_variants: also run at the other coefficients of friction.
        database_variant: also run `irw_like` with the curvature from the track database.

    Returns:
        The runs in the order to begin them: those that matter most, and take longest, first.

    Raises:
        InputError: a radius or vehicle that is not in the study.

    Example:
        >>> len(study_runs()), len(study_runs([300.0], friction_variants=False))
        (50, 4)
    """
    known = perez2004()
    wanted = {case.radius for case in known} if radii is None else set(radii)
    chosen = set(vehicles)
    for key, unknown, all_known in (
        ("radii", wanted - {case.radius for case in known}, ", ".join(f"{case.radius:.0f} m" for case in known)),
        ("vehicles", chosen - set(VEHICLES), ", ".join(VEHICLES)),
    ):
        if unknown:
            raise InputError.single(key, sorted(unknown), "not in this study", remedy=f"choose from {all_known}")
    cases = [case for case in known if case.radius in wanted]
    ordered = [vehicle for vehicle in reversed(VEHICLES) if vehicle in chosen]
    runs = [Run(vehicle, case) for vehicle in ordered for case in cases]
    if database_variant and "irw_like" in ordered:
        runs += [Run("irw_like", case, variant=DATABASE, curvature="database") for case in cases]
    if friction_variants:
        runs += [
            Run(vehicle, case, friction=friction, variant=f"friction {friction:.2f}")
            for friction in FRICTION_BESIDE
            for vehicle in ordered
            for case in cases
        ]
    return runs
