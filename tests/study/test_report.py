"""The reports: complete, self-contained, and honest about what the numbers say.
Claims and targets are tried on tables that fulfil them and on tables that do not."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import numpy as np
import pandas as pd
import pytest

import klingel.report
from klingel import control, library
from klingel.assess import COLUMNS, curving
from klingel.plot import per_radius, render
from klingel.report import StudyPage, study_report
from klingel.report.claims import paper_claims
from klingel.report.files import whole, write_whole
from klingel.report.summary import Summary
from klingel.report.targets import targets

RADII = (300.0, 500.0, 800.0, 1200.0, 1800.0)
PASSIVE = {
    "y_max_mm": (6.3, 6.2, 5.9, 5.1, 4.4),
    "attack_angle_max_mrad": (5.0, 3.4, 2.5, 2.0, 1.7),
    "wear_index_N": (300.0, 180.0, 90.0, 55.0, 42.0),
    "contact_angle_max_deg": (37.0, 32.0, 23.0, 14.0, 8.0),
    "flange_contact": ("root", "root", "root", "", ""),
}


def summary_table(**changes):
    """A table as the study's targets would have it; `changes` replace columns of the active vehicles."""
    rows = []
    for vehicle in ("passive", "solid_like", "irw_like"):
        active = vehicle != "passive"
        for i, radius in enumerate(RADII):
            row = dict.fromkeys(COLUMNS, 0.0) | {
                "vehicle": vehicle, "radius_m": radius, "speed_kmh": 100.0 + i, "y_max_mm": 1.6, "y_curve_mm": 0.05,
                "attack_angle_max_mrad": 1.7, "lateral_force_max_kN": 23.0 + (vehicle == "solid_like") * 0.3,
                "lateral_force_floor_kN": 21.5, "wear_index_N": 33.0 + 0.1 * i, "flange_contact": "",
                "actuator_force_max_kN": 11.0, "steering_voltage_max_V": 40.0, "armature_current_max_A": 200.0,
                "contact_angle_max_deg": 3.0, "outcome": "completed", "realtime_factor": 15.0,
            }  # fmt: skip
            chosen = changes if active else PASSIVE
            row |= {name: values[i] if isinstance(values, tuple) else values for name, values in chosen.items()}
            rows.append(row)
    return pd.DataFrame(rows, columns=list(COLUMNS))


def page(table, **changes):
    parts = {
        "summary": table,
        "variants": pd.DataFrame([{"variant": "friction 0.25", "friction": 0.25, **table.iloc[0].to_dict()}]),
        "figures": {name: render(per_radius(table, name), "svg", name=name) for name in ("fig16", "fig18")},
        "captions": {"fig16": "Displacement.", "fig18": "Force."},
        "operating_points": pd.DataFrame([{"speed [km/h]": "108", "torque per wheel [N m]": "97.3"}]),
        "operating_note": "Running resistance of a stated formula.",
        "vehicles": [library.vehicle("manchester_coach"), library.vehicle("mechatronic_irw")],
        "strategies": {"S": control.SolidLike(), "I": control.IRWLike()},
        "static_wheel_loads": {"passive": {"bogie1.wheelset1.left": 54546.0, "bogie1.wheelset1.right": 54545.0}},
        "method": {"Track": "smooth and rigid"},
        "radius_of_history": 800.0,
        "version": "0.1.0",
        "missing": {},
    }
    return StudyPage(**(parts | changes))


class Checker(HTMLParser):
    """Collects what a page refers to and whether its elements are balanced."""

    VOID = frozenset({"meta", "br", "link", "img", "hr", "input", "use", "path"})

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.links, self.tags = [], [], [], set()

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.ids += [value for name, value in attrs if name == "id"]
        self.links += [value for name, value in attrs if name in ("href", "src", "xlink:href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_startendtag(self, tag, attrs):
        self.ids += [value for name, value in attrs if name == "id"]
        self.links += [value for name, value in attrs if name in ("href", "src", "xlink:href")]


@pytest.fixture(scope="module")
def html():
    return study_report(page(summary_table())).html


def test_report_has_all_its_parts(html):
    for heading in (
        "What the paper states, and what came out", "Figures 15 to 19", "Where the model differs from the paper",
        "Results", "Figures to reach", "Table 1", "Variants: friction", "Wheel loads at rest",
        "Outcome of every run", "Parameters and their sources", "Definitions and method",
    ):  # fmt: skip
        assert re.search(rf"<h2[^>]*>{heading}", html), heading
    assert html.count("<svg") == 2
    assert "97.3" in html
    assert "54.55" in html
    assert "31.391" in html or "3.1391e+07" in html
    assert "Iwnicki1998" in html
    assert "hunting" in html  # the reason of a gain
    assert "friction 0.25" in html


def test_report_is_self_contained_and_well_formed(html):
    checker = Checker()
    checker.feed(html)
    assert checker.open == []
    assert len(checker.ids) == len(set(checker.ids))
    assert all(link.startswith("#") and link[1:] in checker.ids for link in checker.links)
    assert not {"script", "link", "img", "iframe"} & checker.tags
    assert not re.search(r"url\((?!#)", html)
    assert "@import" not in html


def test_report_repeats(html):
    assert study_report(page(summary_table())).html == html


def test_missing_runs_are_named():
    some = study_report(page(summary_table(), missing={"irw_like_R300": "SimulationError: <step>"})).html
    assert "Incomplete" in some
    assert "SimulationError: &lt;step&gt;" in some


def test_report_of_half_a_study():
    table = summary_table()
    some = table[(table["vehicle"] != "irw_like") & (table["radius_m"] > 400.0)]
    html = study_report(page(some)).html
    assert "not run" in html
    assert "nan" not in html.lower().replace("nanometre", "")
    assert study_report(page(table, summary=table[:0], figures={}, static_wheel_loads={})).html


def test_claims_agree_where_the_numbers_do():
    verdicts = [claim.verdict for claim in paper_claims(Summary(summary_table()), 800.0)]
    assert verdicts == [
        "agrees", "agrees", "agrees in part", "agrees", "agrees", "agrees", "agrees", "agrees",
        "agrees in part",
    ]  # fmt: skip


def test_claims_differ_where_the_numbers_do():
    table = summary_table(
        y_max_mm=3.0, y_curve_mm=0.5, attack_angle_max_mrad=6.0, lateral_force_max_kN=40.0,
        wear_index_N=(500.0, 10.0, 10.0, 10.0, 50.0), flange_contact="root",
    )  # fmt: skip
    claims = paper_claims(Summary(table), 800.0)
    verdicts = {(claim.figure, claim.verdict) for claim in claims}
    assert {("15", "differs"), ("16", "differs"), ("17", "differs"), ("18", "differs"), ("19", "differs")} <= verdicts
    assert "contact: root / root" in claims[0].found
    assert "3.00 mm, is beyond" in claims[1].reason


def test_the_reason_follows_the_contact_angle():
    steep = summary_table()
    steep.loc[0, "contact_angle_max_deg"] = 69.0
    before, reached = (paper_claims(Summary(t), 800.0)[2].reason for t in (summary_table(), steep))
    assert "before the 70 deg flank is reached" in before
    assert "37 deg at most" in before
    assert "flank itself is reached" in reached


def test_displacements_below_the_band_agree_in_part():
    below = paper_claims(Summary(summary_table(y_max_mm=(1.5, 1.1, 0.9, 0.8, 1.1))), 800.0)[1]
    assert below.verdict == "agrees in part"
    assert "smaller, down to 0.8 mm" in below.reason


def test_the_order_of_the_forces_is_shown_with_the_database():
    table = summary_table(lateral_force_max_kN=24.35)
    active = table["vehicle"] == "irw_like"
    table.loc[active, "lateral_force_max_kN"] = [24.3, 24.3, 24.71, 24.3, 24.3]
    database = table[active].assign(variant="curvature from the track database", lateral_force_max_kN=24.61)
    shown, alone = (paper_claims(Summary(table), 800.0, v)[5] for v in (database, None))
    assert shown.verdict == "agrees in part"
    assert "At R = 800 m S has 24.35 kN, I 24.71 kN with gyros and 24.61 kN with the database." in shown.reason
    assert "At R" not in alone.reason
    assert "S damps with its motors" in alone.reason


@pytest.mark.parametrize("radius", RADII)
def test_one_curve_says_nothing_about_every_curve(radius):
    table = summary_table()
    one = Summary(table[table["radius_m"] == radius])
    history, *others = paper_claims(one, 800.0)
    assert history.verdict == ("agrees" if radius == 800.0 else "not run")
    assert {claim.verdict for claim in others} == {"not run"}
    verdicts = {target.quantity: target.verdict for target in targets(one, library.vehicle("mechatronic_irw"))}
    assert verdicts["active, every curve: y_max"] == verdicts["S: wear index off its mean"] == "not run"
    assert verdicts["active: actuator force"] == "met"


def test_three_curves_need_both_ends_for_sharp_and_smooth():
    table = summary_table()
    verdicts = [claim.verdict for claim in paper_claims(Summary(table[table["radius_m"] < 1000.0]), 800.0)]
    assert [i for i, verdict in enumerate(verdicts) if verdict == "not run"] == [3, 6, 8]


@pytest.mark.parametrize("vehicle", ["passive", "solid_like", "irw_like"])
def test_a_missing_vehicle_is_not_run(vehicle):
    table = summary_table()
    rest = Summary(table[table["vehicle"] != vehicle])
    claims = paper_claims(rest, 800.0)
    needed = {"passive": [2, 3, 6, 8], "solid_like": [0, 1, 3, 4, 5, 6, 7, 8], "irw_like": [0, 1, 3, 4, 5, 6, 7, 8]}
    assert [i for i, claim in enumerate(claims) if claim.verdict == "not run"] == needed[vehicle]
    found = {target.quantity: target for target in targets(rest, library.vehicle("mechatronic_irw"))}
    assert {target.verdict for target in found.values()} == {"met", "not run"}
    if vehicle == "passive":
        assert "contact: – / – / – / – / –" in claims[2].found
        assert found["passive, R = 300 m: root or flange contact"].found == "–"
    else:
        assert "no flange contact" not in claims[0].found
        assert found["active, every curve: flange contact"].found == "–"


def test_a_run_that_ended_early_misses_its_target():
    table = summary_table(y_curve_mm=np.nan)
    assert targets(Summary(table), library.vehicle("mechatronic_irw"))[2].verdict == "not met"


def test_notes_are_in_plain_words():
    note = "Running resistance by the formula sncf_general for tgv stock."
    html = study_report(page(summary_table(), operating_note=note, vehicles=[])).html
    assert "the general formula of the SNCF for TGV stock" in html
    assert "sncf_general" not in html


def test_targets():
    vehicle = library.vehicle("mechatronic_irw")
    good = targets(Summary(summary_table()), vehicle)
    assert [target.quantity for target in good if not target.met] == []
    table = summary_table(y_max_mm=2.01, armature_current_max_A=361.0, realtime_factor=9.0)
    missed = [target.quantity for target in targets(Summary(table), vehicle) if not target.met]
    assert len(missed) == 3
    assert "y_max" in missed[0]
    missing = summary_table(y_max_mm=np.nan)
    assert not targets(Summary(missing), vehicle)[1].met


def test_short_report(synthetic, tmp_path):
    page = klingel.report(curving(synthetic.run(), vehicle="mine"), title="One <run>")
    path = page.save(tmp_path / "page.html")
    assert "One &lt;run&gt;" in path.read_text(encoding="utf-8")
    assert "mine" in page._repr_html_()
    assert "bogie2.wheelset2" in page.html


def test_files_are_written_whole_or_not_at_all(tmp_path):
    path = write_whole(tmp_path / "a.csv", b"old")
    with pytest.raises(ZeroDivisionError), whole(path) as temporary:
        temporary.write_bytes(b"half" * (1 // 0))
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]
