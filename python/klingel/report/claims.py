"""What the paper states beside what came out, each with a verdict and, where they differ, the reason.
Numbers come from the summary; a reason is given only if the numbers bear it out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from klingel.assess.flange import FLANGE_ANGLE
from klingel.report.notes import ESTIMATE, HUNTING, database_beside, with_database
from klingel.report.summary import ACTIVE, SHORT, Summary, joined

if TYPE_CHECKING:
    import pandas as pd

FLANGE = math.degrees(FLANGE_ANGLE)

SHARPEST, SMOOTHEST = 300.0, 1800.0
"""Radii of the sharpest and the smoothest curve of the study [m]."""

Verdict = Literal["agrees", "agrees in part", "differs", "not run"]


@dataclass(frozen=True)
class Claim:
    """One statement of the paper and its fate here.

    Attributes:
        figure: of the paper.
        statement: what the paper says.
        found: what came out, with numbers.
        verdict: in one word.
        reason: why it differs, or what carries the agreement.
    """

    figure: str
    statement: str
    found: str
    verdict: Verdict
    reason: str


def paper_claims(summary: Summary, radius_of_history: float, variants: pd.DataFrame | None = None) -> list[Claim]:
    """All statements of the paper that the study can check.

    Args:
        summary: of the main runs.
        radius_of_history: radius of the curve that Fig. 15 shows [m].
        variants: the runs beside the main ones, for the reasons; with the column `variant`.

    Returns:
        The claims in the order of the figures. A claim whose runs are missing has the verdict `not run`; so has a
        claim about every curve with fewer than three of them, or about a curve that was not run.
    """
    return [
        _history(summary, radius_of_history),
        _active_displacement(summary),
        _passive_flange(summary),
        _attack_angles(summary),
        _lateral_force(summary),
        _force_order(summary, with_database(variants)),
        _wear_sharpest(summary),
        _wear_constant(summary),
        _wear_smoothest(summary),
    ]


def _verdict(numbers: np.ndarray | list[float], holds: bool, partly: bool = False, *, curves: bool = True) -> Verdict:
    """`curves`: whether the curves that the statement is about were run."""
    if not curves or not np.all(np.isfinite(numbers)):
        return "not run"
    return "agrees" if holds else "agrees in part" if partly else "differs"


def _history(summary: Summary, radius: float) -> Claim:
    y_max = [summary.value(v, radius, "y_max_mm") for v in ACTIVE]
    y_curve = [summary.value(v, radius, "y_curve_mm") for v in ACTIVE]
    contact = [summary.contact(v, radius) for v in ACTIVE]
    free = all(word == "none" for word in contact)
    return Claim(
        "15",
        f"R = {radius:.0f} m: the active wheelsets stay within about 1.5 mm, return to zero in the constant curve, "
        "and touch no flange.",
        f"S and I: at most {joined(np.array(y_max), 2)} mm; {joined(np.array(y_curve), 3)} mm in the constant curve; "
        f"{'no flange contact' if free else 'contact: ' + ' / '.join(contact)}.",
        _verdict(y_max + y_curve, max(y_max) <= 2.0 and max(y_curve) <= 0.2 and free, max(y_curve) <= 0.2),
        "Zero in the arc is the work of the integrators: each wheelset then carries its share of the lateral force by "
        "an attack angle alone. What remains in the transitions is what the feedforward does not foresee.",
    )


def _active_displacement(summary: Summary) -> Claim:
    both = np.concatenate([summary.over_radii(v, "y_max_mm") for v in ACTIVE])
    top = float(np.max(both))
    feedforward = (
        "a feedforward of the steering moment, which the paper does not mention, does most of the work, and the loops "
        "correct what it misses."
    )
    within = bool(np.all((both >= 1.5) & (both <= 2.0)))
    if top > 2.0:
        reason = f"The largest, {top:.2f} mm, is beyond the paper's band."
    elif within:
        reason = f"Within the paper's band: {feedforward}"
    else:
        reason = f"Within the paper's limit, but smaller, down to {np.min(both):.1f} mm: {feedforward}"
    return Claim(
        "16",
        "With both strategies the largest displacement is 1.5 to 2 mm in every curve.",
        f"S: {summary.list('solid_like', 'y_max_mm', 2)} mm; I: {summary.list('irw_like', 'y_max_mm', 2)} mm "
        f"({_radii(summary)}).",
        _verdict(both, within, bool(np.median(both) <= 2.0), curves=summary.several),
        reason,
    )


def _passive_flange(summary: Summary) -> Claim:
    angles = summary.over_radii("passive", "contact_angle_max_deg")
    contacts = [summary.contact("passive", radius) for radius in summary.radii]
    shown = " / ".join(contacts)
    touched = sum(contact in ("root", "flange") for contact in contacts)
    steepest = float(np.max(angles))
    reason = (
        f"S1002 on 60E1 has no corner between tread and flange: as the wheelset moves out the contact climbs the root, "
        f"here to {steepest:.0f} deg at most, and the root's slope together with the friction there carries the "
        "lateral force "
    )
    reason += (
        "before the 70 deg flank is reached: contact in the root where the paper speaks of the flange. "
        if steepest < FLANGE
        else "until, in the sharpest curves, the flank itself is reached. "
    )
    if touched < len(contacts):
        reason += (
            "In the smoother curves the wheelset runs nearly radially and needs little help of the root, so nothing "
            "steeper than 15 deg carries load. The paper does not print its profiles; a coned or worn pair with a "
            "sharper root touches earlier. "
        )
    if summary.made("passive", SMOOTHEST):
        reason += f"{ESTIMATE} {HUNTING}"
    return Claim(
        "16",
        "The passive vehicle runs in flange contact.",
        f"max |y| {summary.list('passive', 'y_max_mm', 1)} mm; steepest contact {joined(angles, 0)} deg; "
        f"contact: {shown} ({_radii(summary)}). The angle is that of the steepest patch that carries more than 1 kN.",
        _verdict(angles, touched == len(contacts) and "flange" in contacts, touched > 0, curves=summary.several),
        reason,
    )


def _attack_angles(summary: Summary) -> Claim:
    column = "attack_angle_max_mrad"
    ratios = {v: summary.ratio(column, v, "passive") for v in ACTIVE}
    sharp = float(np.max([r[0] for r in ratios.values()]))
    smooth = [float(r[-1]) for r in ratios.values()]
    similar = all(0.7 <= r <= 1.3 for r in smooth)
    reason = (
        "In sharp curves the stiff primary suspension keeps the passive wheelsets from the radial position; the active "
        "ones need only the attack angle that carries their share of the lateral force by creepage, and the constant "
        "cant deficiency makes that share, and so the angle, nearly the same in every curve."
    )
    uneven = _over_floor(summary, "passive")
    if max(smooth) < 0.7 and uneven > 1.3:
        reason += (
            " In the smoothest curve the passive angle stays larger, because the axles, held parallel, share the force "
            f"unevenly: the most loaded one carries {uneven:.1f} times its share, and the angle goes with the force."
        )
    if max(smooth) > 1.3:
        reason += (
            f" In the smoothest curve the active vehicles run at {max(smooth):.1f} times the passive attack angle: "
            "centred on the track, they have no slope of the profiles to lean on and carry all of the lateral force "
            "by creepage, while the passive wheelset has moved out and leans on its root."
        )
    if summary.made("passive", SMOOTHEST):
        reason += (
            f" There the passive angle, being a maximum, includes the hunting of R = {SMOOTHEST:.0f} m (see Fig. 16), "
            "whose yaw swings by 0.5 mrad peak to peak at the trailing bogie."
        )
    return Claim(
        "17",
        "Attack angles are reduced in sharp curves and similar in smooth ones.",
        f"passive: {summary.list('passive', column, 2)}; S: {summary.list('solid_like', column, 2)}; "
        f"I: {summary.list('irw_like', column, 2)} mrad. S and I over passive: {_one(sharp, 2)} at most "
        f"at R = {summary.radii[0]:.0f} m, {joined(np.array(smooth), 2)} at R = {summary.radii[-1]:.0f} m.",
        _verdict([sharp, *smooth], sharp < 0.9 and similar, sharp < 0.9 or similar, curves=_both_ends(summary)),
        reason,
    )


def _lateral_force(summary: Summary) -> Claim:
    column, floor = "lateral_force_max_kN", "lateral_force_floor_kN"
    over = {v: summary.over_radii(v, column) / summary.over_radii(v, floor) for v in (*ACTIVE, "passive")}
    worst = float(np.max([over[v] for v in ACTIVE]))
    return Claim(
        "18",
        "The lateral forces of the active vehicles are near the least achievable.",
        "; ".join(f"{SHORT[v]}: {joined(ratios, 2)}" for v, ratios in over.items())
        + f" times the own mass / 4 times the unbalanced acceleration ({_radii(summary)}).",
        _verdict(np.concatenate([over[v] for v in ACTIVE]), worst <= 1.25, worst <= 1.5, curves=summary.several),
        "Where the excess grows with curvature it is the yaw moment of the secondary suspension and of the yaw dampers "
        "on the bogie: it loads the outer wheelsets 1 and 4 more and 2 and 3 less, whatever the steering does within "
        "the bogie. In the transitions the body's roll and sway add to it.",
    )


def _force_order(summary: Summary, database: Summary | None) -> Claim:
    ratio = summary.ratio("lateral_force_max_kN", "solid_like", "irw_like")
    return Claim(
        "18",
        "S is slightly worse than I.",
        f"S over I: {joined(ratio, 3)} ({_radii(summary)}).",
        _verdict(ratio, bool(np.all(ratio >= 1.0)), bool(np.median(ratio) >= 1.0), curves=summary.several),
        "The paper gives the lower bandwidth of S as the reason. Here both strategies feed the same steering moment "
        "forward, which leaves little between them. How they know the curve explains a part: S reads it from the track "
        "database, without delay; I senses it with gyros, whose filters delay it most where the transitions are "
        f"sharpest.{database_beside(summary, database)} The rest is the different feedback in the transitions, where "
        "S damps with its motors.",
    )


def _wear_sharpest(summary: Summary) -> Claim:
    saved = {v: 1.0 - summary.ratio("wear_index_N", v, "passive") for v in ACTIVE}
    holds = all(int(np.argmax(s)) == 0 for s in saved.values()) if _finite(*saved.values()) else False
    return Claim(
        "19",
        "Wear is reduced most in the sharpest curve.",
        f"reduction, S: {_percent(saved['solid_like'])}; I: {_percent(saved['irw_like'])} ({_radii(summary)}).",
        _verdict(np.concatenate(list(saved.values())), holds, curves=_both_ends(summary)),
        "There the passive wheelsets lack rolling radius difference and attack the rail, and every active one has "
        "neither fault.",
    )


def _wear_constant(summary: Summary) -> Claim:
    spreads = {v: _spread(summary.over_radii(v, "wear_index_N")) for v in ACTIVE}
    widest = max(spreads.values())
    return Claim(
        "19",
        "With active control the wear is nearly constant over the curvature.",
        f"S: {summary.list('solid_like', 'wear_index_N', 1)} N; I: {summary.list('irw_like', 'wear_index_N', 1)} N; "
        f"at most {_percent(np.array(list(spreads.values())))} off their means.",
        _verdict(list(spreads.values()), widest <= 0.15, widest <= 0.3, curves=summary.several),
        "An active wheelset has little creepage along the rail; what is left is lateral creepage, whose work is about "
        "Y squared over twice the lateral creep coefficient, and Y follows from the cant deficiency, the same in all "
        "curves.",
    )


def _wear_smoothest(summary: Summary) -> Claim:
    ratios = [float(summary.ratio("wear_index_N", v, "passive")[-1]) for v in ACTIVE]
    uneven = _over_floor(summary, "passive")
    halved = (
        f"The passive axles share the lateral force unevenly, the most loaded one carries {_one(uneven, 1)} times its "
        "share, and the work of creepage grows with the square of the force; their longitudinal creepage adds to it."
    )
    floor = (
        "The passive wheelset steers nearly radially in the smoothest curve and pays for the same lateral force; "
        "the active ones save what its longitudinal creepage costs, not the work of the lateral force, which no "
        "strategy that stays centred can avoid. Half would need a passive vehicle that curves worse, as one with "
        "harder suspension or flange contact does."
    )
    hunting = (
        f" The passive wear at R = {SMOOTHEST:.0f} m includes what the light hunting in this arc adds (see Fig. 16), "
        "which is not told apart."
        if summary.made("passive", SMOOTHEST)
        else ""
    )
    return Claim(
        "19",
        "In the smoothest curve wear is still halved.",
        f"S and I over passive: {joined(np.array(ratios), 2)} at R = {summary.radii[-1]:.0f} m.",
        _verdict(ratios, max(ratios) <= 0.6, max(ratios) < 1.0, curves=_both_ends(summary)),
        (floor if max(ratios) > 0.6 else halved) + hunting,
    )


def _both_ends(summary: Summary) -> bool:
    """Whether the sharpest and the smoothest curve of the study were run, and one between."""
    return summary.several and summary.radii[0] <= SHARPEST and summary.radii[-1] >= SMOOTHEST


def _over_floor(summary: Summary, vehicle: str) -> float:
    """Largest lateral force over the least achievable, in the smoothest curve."""
    force = summary.over_radii(vehicle, "lateral_force_max_kN")
    return float(force[-1] / summary.over_radii(vehicle, "lateral_force_floor_kN")[-1])


def _radii(summary: Summary) -> str:
    return "R = " + " / ".join(f"{radius:.0f}" for radius in summary.radii) + " m"


def _one(number: float, digits: int) -> str:
    return joined(np.array([number]), digits)


def _percent(shares: np.ndarray) -> str:
    return joined(100.0 * shares, 0) + " %"


def _spread(numbers: np.ndarray) -> float:
    """Largest deviation from the mean, relative to it."""
    mean = float(np.mean(numbers))
    return float(np.max(np.abs(numbers - mean)) / mean) if mean else math.nan


def _finite(*arrays: np.ndarray) -> bool:
    return all(bool(np.all(np.isfinite(array))) for array in arrays)
