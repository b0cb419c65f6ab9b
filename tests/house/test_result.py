"""Results: channels with units, files written whole or not at all, reruns from the header, cancelling."""

import json
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import klingel as kl
from klingel import result
from klingel.contact import Profile
from klingel.errors import InputError, RunCancelledError, SimulationError


def scenario(**changes: object) -> kl.Scenario:
    track = kl.Track.curve(radius="800 m", cant="160 mm", transition="195 m", straight_before="60 m")
    coach = kl.library.vehicle("manchester_coach")
    settings: dict[str, object] = {"speed": "176 km/h", "creep_law": "polach", "duration": "0.5 s"}
    return kl.Scenario(coach, track, **(settings | changes))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return kl.simulate(scenario())


def test_channels_have_units_and_the_header_the_spec(run: xr.Dataset) -> None:
    assert run.attrs["outcome"] == "completed"
    assert run.sizes["time"] == 501
    assert run["bogie1.wheelset1.y"].attrs["units"] == "m"
    assert run["bogie2.wheelset2.right.Q"].attrs["units"] == "N"
    assert all(run[channel].attrs["units"] for channel in run.data_vars)
    loads = json.loads(run.attrs["static_wheel_loads"])
    assert sum(loads.values()) == pytest.approx(44482.0 * 9.81, rel=1e-9)
    assert run.attrs["realtime_factor"] > 0.0


def test_rerun_from_the_header_is_the_same_run(run: xr.Dataset) -> None:
    again = kl.simulate_spec(json.loads(run.attrs["spec"]))
    for channel in run.data_vars:
        np.testing.assert_array_equal(again[channel].values, run[channel].values)


@pytest.mark.parametrize(("rate", "every"), [(200.0, 5), (1000.0, 1), (None, 1)])
def test_save_and_load(run: xr.Dataset, tmp_path: Path, rate: float | None, every: int) -> None:
    path = kl.save(run, tmp_path / "deep" / "run.nc", rate=rate)
    assert [p.name for p in path.parent.iterdir()] == ["run.nc"]
    back = kl.load(path)
    kept = run.isel(time=slice(None, None, every))
    assert back.attrs == run.attrs
    assert set(back.data_vars) == set(kept.data_vars)
    np.testing.assert_array_equal(back["time"], kept["time"])
    for channel in kept.data_vars:
        assert back[channel].attrs == kept[channel].attrs
        wanted = kept[channel].values if str(channel).endswith(".s") else kept[channel].values.astype("f4")
        np.testing.assert_array_equal(back[channel].values, wanted)


def test_file_has_one_variable_per_quantity_and_unit(run: xr.Dataset, tmp_path: Path) -> None:
    with xr.open_dataset(kl.save(run, tmp_path / "run.nc")) as packed:
        assert packed["Q"].dims == ("Q_of", "time")
        assert packed["Q"].attrs["units"] == "N"
        one = packed["Q"].sel(Q_of="bogie1.wheelset1.left")
        np.testing.assert_allclose(one.values, run["bogie1.wheelset1.left.Q"].values[::5], rtol=1e-7)


def test_same_quantity_in_two_units_stays_apart(tmp_path: Path) -> None:
    time_axis = np.arange(3.0)
    data = {"a.x": ("time", time_axis, {"units": "m"}), "b.x": ("time", -time_axis, {"units": "N"})}
    both = xr.Dataset(data, coords={"time": ("time", time_axis, {"units": "s"})}, attrs={"format": result.FORMAT})
    xr.testing.assert_identical(kl.load(kl.save(both, tmp_path / "x.nc", rate=None)), both)


@pytest.mark.filterwarnings("error")
def test_numbers_beyond_single_precision_are_kept(tmp_path: Path) -> None:
    values = np.array([0.0, 1e300, np.inf])
    made = xr.Dataset(
        {"a.command": ("time", values, {"units": "N"})}, {"time": [0.0, 1.0, 2.0]}, {"format": result.FORMAT}
    )
    assert kl.load(kl.save(made, tmp_path / "huge.nc", rate=None))["a.command"].values.tolist() == values.tolist()


def test_a_failed_write_leaves_nothing(run: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_text("before")
    unwritable = run.assign_attrs(bad=object())
    with pytest.raises(TypeError):
        kl.save(unwritable, path)
    assert [p.name for p in tmp_path.iterdir()] == ["run.nc"]
    assert path.read_text() == "before"


def test_bad_rates_and_files(run: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not divide"):
        kl.save(run, tmp_path / "run.nc", rate=300.0)
    with pytest.raises(InputError, match="no such file"):
        kl.load(tmp_path / "none.nc")
    text = tmp_path / "text.nc"
    text.write_text("no")
    with pytest.raises(InputError, match="no NetCDF"):
        kl.load(text)
    foreign = tmp_path / "foreign.nc"
    xr.Dataset({"a": ("time", np.zeros(2))}).to_netcdf(foreign)
    with pytest.raises(InputError, match="not written by klingel"):
        kl.load(foreign)


def test_cancel_ends_a_run() -> None:
    watched = kl.progress()
    ended: list[type[BaseException] | None] = []

    def go() -> None:
        try:
            kl.simulate(scenario(duration="8 s", creep_law="fastsim"), progress=watched)
        except RunCancelledError as error:
            ended.append(type(error))

    worker = threading.Thread(target=go)
    worker.start()
    while watched.fraction <= 0.0 and worker.is_alive():
        time.sleep(0.01)
    assert watched.fraction < 0.9
    watched.cancel()
    worker.join(timeout=10.0)
    assert ended == [RunCancelledError]


def test_the_core_says_what_it_refuses(run: xr.Dataset) -> None:
    spec = json.loads(run.attrs["spec"])
    spec["bushings"][0]["joint"]["a"] = "bogi1"
    with pytest.raises(SimulationError, match="bogi1"):
        kl.simulate_spec(spec)
    with pytest.raises(ValueError, match="JSON compliant"):
        kl.simulate_spec(spec | {"speed": float("nan")})


def test_the_hold_hauls_the_coach_against_its_drag(run: xr.Dataset) -> None:
    spec = json.loads(run.attrs["spec"])
    a, b, c = spec["drag"]["coefficients"]
    v = spec["speed"]
    assert run["hold.force"].values[0] == pytest.approx(a + b * v + c * v**2, rel=1e-3)


def test_profiles_as_points_run_as_the_named_ones(run: xr.Dataset) -> None:
    """Points go another way into the core than names: both give the same run."""
    spec = json.loads(run.attrs["spec"])
    for part, profile in (("wheel", Profile.s1002()), ("rail", Profile.rail_60e1())):
        spec["contact_pairs"][0][part] = {"points": {"y": profile.y.tolist(), "z": profile.z.tolist()}}
    points = kl.simulate_spec(spec)
    for channel, tolerance in (("bogie1.wheelset1.y", 2e-6), ("bogie1.wheelset1.left.Q", 20.0)):
        np.testing.assert_allclose(points[channel].values, run[channel].values, atol=tolerance)
