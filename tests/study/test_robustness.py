"""Robustness: drawn inputs, what they do to a scenario, rows that survive an interruption, figures of many runs."""

import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rich.console import Console
from scipy import stats

import klingel as kl
from klingel import Scenario, Track, cli, control, library
from klingel.errors import InputError, SimulationError
from klingel.lower import lower
from klingel.result import COMPLETED
from klingel.study import robustness, robustness_output
from klingel.study.robustness_effects import EFFECTS, changed
from klingel.study.robustness_figures import correlations, explained, probabilities, ranges, rank_correlation, worst
from klingel.study.robustness_inputs import Distribution, draw, inputs, levels
from klingel.study.robustness_pairs import PAIRS, conicities, with_conicity
from klingel.study.robustness_rows import ROWS, Rows

CURVE = Track.curve(
    radius="300 m",
    cant="100 mm",
    transition="60 m",
    arc="60 m",
    straight_before="40 m",
    straight_after="40 m",
    name="short",
)


def passive() -> Scenario:
    return Scenario(library.vehicle("manchester_coach"), CURVE, speed="90 km/h", step="1 ms")


def active() -> Scenario:
    vehicle = library.vehicle("mechatronic_irw")
    return Scenario(vehicle, CURVE, speed="90 km/h", step="1 ms", control=control.IRWLike())


class Idle:
    """A controller in Python that does nothing."""

    def reset(self) -> None: ...

    def step(self, t: float, measurements: dict[str, float]) -> list[float]:
        return [0.0]


def quiet() -> Console:
    return Console(file=io.StringIO(), width=150)


def test_the_listed_pairs_cover_the_conicities_evenly() -> None:
    found = list(conicities(passive()).values())
    assert found == sorted(found)
    assert found[0] == pytest.approx(0.05, abs=2e-3)
    assert found[-1] == pytest.approx(0.4, abs=2e-3)
    assert max(np.diff(found)) < 0.06
    assert len({pair.name for pair in PAIRS}) == len(PAIRS)


def test_a_conicity_takes_the_nearest_pair() -> None:
    assert with_conicity(passive(), 0.18).gauge == 1.435
    plan = robustness.plan_of(passive(), runs=4)
    ran = robustness_output.of_pairs(pd.DataFrame({"conicity": [0.18, np.nan]}), plan)["conicity"]
    assert ran[0] == conicities(passive())[PAIRS[3]]
    assert np.isnan(ran[1])
    worn = with_conicity(passive(), 0.4)
    assert worn.wheel is not None
    assert "worn 1 mm" in worn.wheel.name


@pytest.mark.parametrize(
    ("made", "known"),
    [
        (Distribution("uniform", -1.0, 3.0), stats.uniform(-1.0, 4.0)),
        (Distribution("triangular", 0.0, 4.0, (1.0,)), stats.triang(0.25, 0.0, 4.0)),
        (Distribution("normal", 0.0, 4.0, (1.0, 2.0)), stats.truncnorm(-0.5, 1.5, 1.0, 2.0)),
    ],
)
def test_quantiles_are_those_of_scipy(made: Distribution, known: stats.rv_continuous) -> None:
    share = np.linspace(0.0, 1.0, 21)
    assert made.quantile(share) == pytest.approx(known.ppf(share), abs=1e-12)


def test_draws_repeat_fill_the_range_and_go_on() -> None:
    table = inputs()
    few, many = draw(table, 100, 7), draw(table, 256, 7)
    assert few == many[:100] == draw(table, 100, 7) != draw(table, 100, 8)[:100]
    for name, each in table.items():
        values = np.array([run[name] for run in many])
        assert values.min() >= each.low
        assert values.max() <= each.high
        assert np.median(values) == pytest.approx(float(each.quantile(0.5)), abs=0.01 * (each.high - each.low))


def test_every_input_has_an_effect_a_distribution_and_a_reason() -> None:
    table = inputs()
    assert list(table) == list(EFFECTS)
    assert all(each.reason for each in table.values())
    assert all(len(tried) == 5 for tried in levels(table).values())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "[frction]\ndistribution = 'uniform'\nlow = 0\nhigh = 1\nreason = ''",
            "frction: is no input of this study; did",
        ),
        ("[friction]\ndistribution = 'uniform'\nlow = 0.4\nhigh = 0.3\nreason = ''", "is not above low"),
        ("[friction]\ndistribution = 'triangular'\nlow = 0.1\nhigh = 0.3\nreason = ''", "friction.mode: is missing"),
        (
            "[friction]\ndistribution = 'uniform'\nlow = 0.1\nhigh = 0.3\nmode = 0.2\nreason = ''",
            "not of this distribution",
        ),
        ("[friction]\ndistribution = 'uniform'\nlow = 0.1\nhigh = 3\nreason = ''", "is out of range"),
        ("[payload]\ndistribution = 'uniform'\nlow = 0\nhigh = '3 m'\nreason = ''", "payload.high"),
        ("[payload]\ndistribution = 'odd'\nlow = 0\nhigh = 3\nreason = ''", "payload.distribution"),
    ],
)
def test_a_file_of_distributions_is_checked(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=said):
        inputs(path)


def test_a_file_replaces_what_it_names(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    numbers = "low = '0 t'\nhigh = '9 t'\nmean = '3 t'\ndeviation = '1 t'"
    path.write_text(f"[payload]\ndistribution = 'normal'\n{numbers}\nreason = 'counted'")
    table = inputs(path, only=["friction", "payload"])
    assert table["payload"].numbers == (3000.0, 1000.0)
    assert table["friction"] == inputs()["friction"]
    with pytest.raises(InputError, match="paylod"):
        inputs(only=["paylod"])


def test_payload_weighs_on_the_springs_and_is_unknown_to_the_strategy() -> None:
    light, heavy = (lower(changed(active(), {"payload": load})) for load in (0.0, 8e3))
    body = {spec["bodies"][0]["mass"] for spec in (light, heavy)}
    assert body == {32e3, 40e3}
    assert heavy["bodies"][0]["inertia"] == pytest.approx([1.25 * i for i in light["bodies"][0]["inertia"]])
    load = [next(b for b in s["bushings"] if "secondary" in b["name"])["preload"][2] for s in (light, heavy)]
    assert load[1] / load[0] == pytest.approx(1.25)
    assert heavy["control"] == light["control"] == lower(active())["control"]


def test_creep_reduction_keeps_fastsim_and_else_takes_polach() -> None:
    made = lower(changed(passive(), {"creep_reduction": 0.5}))["creep"]
    assert (made["law"], made["reduction"], made["slope"]) == ("polach", [0.5, 0.5], None)
    made = lower(changed(passive().replace(creep_law="fastsim"), {"creep_reduction": 0.5}))["creep"]
    assert (made["law"], made["reduction"], made["slope"]) == ("fastsim", None, [0.5, 1.0, 1.0])


def test_errors_of_a_strategy_are_left_out_where_there_is_none() -> None:
    chosen = robustness.plan_of(passive(), runs=1).chosen
    assert "friction" in chosen
    assert not any(EFFECTS[name].through for name in chosen)
    by_gyro = robustness.plan_of(active(), runs=1)
    assert by_gyro.left_out == ("curvature_error", "position_error", "load_cell_bias")
    database = active().replace(control=control.IRWLike(curvature="database"))
    assert robustness.plan_of(database, runs=1).left_out == ("load_cell_bias",)
    with pytest.raises(InputError, match="are not felt by this strategy"):
        robustness.plan_of(passive(), chosen=inputs(only=["delay"]))


def test_errors_reach_the_sensors_and_the_database() -> None:
    given = {
        "delay": 12.4e-3,
        "encoder_noise": 0.01,
        "gyro_bias": 1e-3,
        "position_error": -30.0,
        "curvature_error": 0.1,
    }
    made = changed(active(), given | {"radius_mismatch": 5e-4}, seed=5)
    sensors = made.sensors
    assert sensors.seed == 5
    assert (sensors.encoder.noise, sensors.encoder.delay) == (0.01, 0.012)  # type: ignore[union-attr]
    assert (sensors.gyro.bias, sensors.position.bias) == (1e-3, -30.0)  # type: ignore[union-attr]
    assert sensors.current is None
    assert made.radius_mismatch == (5e-4,) * 4
    assert made.database is not None
    assert float(made.database.curvature(130.0)) == pytest.approx(1.1 * float(CURVE.curvature(130.0)))
    lower(made)


def test_every_drawn_run_has_its_own_noise_and_the_others_share_one() -> None:
    plan = robustness.plan_of(active(), runs=2)
    seeds = [plan.of(name).sensors.seed for name in ("drawn_0", "drawn_1", "nominal", "alone_encoder_noise_4")]
    assert len(set(seeds[:2])) == 2
    assert seeds[2] == seeds[3] == 0


def test_a_plan_needs_one_curve() -> None:
    with pytest.raises(InputError, match="exactly one arc"):
        robustness.plan_of(passive().replace(track=Track.straight("500 m")))
    with pytest.raises(InputError, match="is no run of this study"):
        robustness.plan_of(passive(), runs=1).of("drawn_1")


def test_rows_survive_an_interruption(tmp_path: Path) -> None:
    rows = Rows(tmp_path, {"what": 1}, ("y", "outcome"))
    rows.add("b", {"y": 1.0 / 3.0, "outcome": "ended,\nearly"})
    rows.add("a", {"y": float("nan"), "outcome": COMPLETED})
    with (tmp_path / ROWS).open("a") as file:
        file.write("c,0.1")  # cut off in the middle
    again = Rows(tmp_path, {"what": 1}, ("y", "outcome"))
    assert len(again) == 2
    assert "c" not in again
    table = again.table(["a", "b", "c"])
    assert table["run"].tolist() == ["a", "b"]
    assert table["y"].tolist()[1] == 1.0 / 3.0
    assert table["outcome"].tolist() == [COMPLETED, "ended, early"]
    again.sort(["a", "b"])
    assert (tmp_path / ROWS).read_text().splitlines()[1:] == ["a,nan,completed", 'b,0.3333333333333333,"ended, early"']


def test_a_controller_in_python_runs_and_its_code_is_part_of_the_plan() -> None:
    idle = control.PythonController(
        Idle(), sample_time="10 ms", measurements=["bogie1.yaw_rate"], commands=["bogie1.wheelset1.actuator_left.force"]
    )
    plan = robustness.plan_of(active().replace(control=idle, duration="0.1 s"), runs=1)
    assert "curvature_error" in plan.left_out
    assert "return [0.0]" in robustness.asked(plan)["code"]
    simulated, row = robustness.one_run(plan, "nominal")
    assert simulated == pytest.approx(0.1)
    assert row["outcome"] == COMPLETED


def test_rows_of_another_study_are_not_mixed(tmp_path: Path) -> None:
    Rows(tmp_path, {"what": 1}, ("y",)).add("a", {"y": 1.0})
    with pytest.raises(InputError, match="holds the runs of another study"):
        Rows(tmp_path, {"what": 2}, ("y",))
    assert len(Rows(tmp_path, {"what": 2}, ("y",), fresh=True)) == 0


def drawn() -> pd.DataFrame:
    """400 runs whose displacement grows with the amount of one input and does not feel the other."""
    points = draw({"friction": Distribution("uniform", 0.1, 0.5), "payload": Distribution("uniform", 0.0, 1.0)}, 400, 1)
    table = pd.DataFrame(points)
    table["y_max_mm"] = 10.0 * (table["friction"] - 0.1) / 0.4
    for name in ("lateral_force_max_kN", "attack_angle_max_mrad", "wear_index_N", "actuator_force_max_kN"):
        table[name] = 1.0
    return table.assign(run=[f"drawn_{i}" for i in range(400)], flange_contact="", outcome=COMPLETED)


def test_probabilities_have_intervals_that_hold_them() -> None:
    found = probabilities(drawn()).iloc[0]
    assert found["probability"] == pytest.approx(0.4, abs=0.01)
    assert found["low"] < 0.4 < found["high"]
    assert found["high"] - found["low"] == pytest.approx(2 * 1.96 * np.sqrt(0.4 * 0.6 / 400), rel=0.1)
    never = probabilities(drawn().assign(y_max_mm=0.0)).iloc[0]
    assert (never["low"], never["high"]) == (0.0, pytest.approx(1.0 - 0.025 ** (1 / 400)))


def test_correlations_tell_what_matters() -> None:
    chosen = {"friction": Distribution("uniform", 0.1, 0.5), "payload": Distribution("uniform", 0.0, 1.0)}
    found = correlations(drawn(), chosen).set_index("input")
    assert found.index[0] == "friction"
    assert found.loc["friction", "y_max_mm"] == pytest.approx(1.0)
    assert abs(found.loc["payload", "y_max_mm"]) < 0.1
    assert found.loc["friction", "explained"] > 0.95
    assert found.loc["payload", "explained"] < 0.05
    assert np.isnan(found.loc["friction", "wear_index_N"])


def test_rank_correlation_is_that_of_scipy_and_leaves_gaps_out() -> None:
    random = np.random.default_rng(3)
    a, b = random.normal(size=50), random.normal(size=50)
    assert rank_correlation(a, b) == pytest.approx(stats.spearmanr(a, b).statistic)
    gap = np.where(np.arange(50) == 7, np.nan, b)
    assert rank_correlation(a, gap) == pytest.approx(rank_correlation(np.delete(a, 7), np.delete(b, 7)))
    assert np.isnan(explained(a[:20], b[:20]))


def test_the_worst_runs_are_those_that_ended_early() -> None:
    table = drawn()
    table.loc[5, "outcome"] = "derailed, at 3.000 s"
    assert worst(table, 3)["run"].tolist()[0] == "drawn_5"
    assert worst(table, 3)["y_max_mm"].tolist()[1] == table["y_max_mm"].max()


def test_ranges_span_what_lies_between_and_the_nominal_value() -> None:
    alone = pd.DataFrame({"input": ["friction"] * 3, "friction": [0.1, 0.2, 0.3], "y_max_mm": [3.0, 1.0, 2.0]})
    found = ranges(alone, pd.Series({"y_max_mm": 4.0}), "y_max_mm").iloc[0]
    assert found.tolist() == ["friction", 3.0, 2.0, 1.0, 4.0]


def test_a_small_study_goes_on_and_repeats_to_the_byte(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = inputs(only=["friction"])
    first, second = tmp_path / "first", tmp_path / "second"
    simulate, refused = kl.result.simulate, draw(chosen, 3, 1)[2]["friction"]

    def refuses_one(scenario: Scenario, **other: object) -> object:
        if scenario.friction == refused:
            raise SimulationError("no equilibrium")
        return simulate(scenario, **other)  # type: ignore[arg-type]

    monkeypatch.setattr(kl.result, "simulate", refuses_one)
    monkeypatch.setattr(robustness_output, "MERITS", ("y_max_mm",))  # fewer pictures
    made = robustness.run(passive(), first, runs=3, chosen=chosen, jobs=2, console=quiet())
    assert made.drawn["outcome"].tolist() == [COMPLETED, COMPLETED, "refused: no equilibrium"]
    assert probabilities(made.drawn).iloc[0]["runs"] >= 1
    assert made.alone["input"].tolist() == ["friction"] * 5
    assert made.alone["y_max_mm"].notna().all()

    second.mkdir()
    (second / "plan.json").write_bytes((first / "plan.json").read_bytes())
    (second / ROWS).write_text((first / ROWS).read_text()[:-40])  # the last row is cut off
    screen = quiet()
    robustness.run(passive(), second, runs=3, chosen=chosen, jobs=1, console=screen)
    assert "9 of 10 runs are there already" in screen.file.getvalue()  # type: ignore[attr-defined]
    files = sorted(p.name for p in first.iterdir() if p.is_file())
    assert {"runs.csv", "plan.json", "report.html", "tornado_y_max_mm.svg", "exceedance.png"} <= set(files)
    assert [(second / name).read_bytes() == (first / name).read_bytes() for name in files] == [True] * len(files)
    page = (first / "report.html").read_text()
    assert "Which inputs explain it" in page
    assert "http" not in page.replace("http://www.w3.org", "")


def test_a_page_is_made_of_what_there_is_after_an_early_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuses(scenario: Scenario, **other: object) -> object:
        raise SimulationError("no equilibrium")

    monkeypatch.setattr(kl.result, "simulate", refuses)
    robustness.run(passive(), tmp_path, runs=2, chosen=inputs(only=["friction"]), alone=False, console=quiet())
    assert "2 of 2" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "is needed, or a scenario file"),
        (["--control", "irw_like"], "curve: is missing"),
        (["--control", "irw_lik", "--curve", "R300"], "did you mean 'irw_like'?"),
        (["--control", "irw_like", "--curve", "R310"], "310"),
        (["--control", "irw_like", "--curve", "R300", "--only", "frction"], "frction"),
        (["--control", "irw_like", "--curve", "R300", "--run", "drawn_x"], "is no run of this study"),
    ],
)
def test_the_command_says_what_is_wrong(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["robustness", *arguments]) == 2
    assert said in " ".join(capsys.readouterr().err.split())
