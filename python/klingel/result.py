"""Running a scenario and what comes out: one xarray.Dataset a run, dotted channels with units, the spec in its header.
On disk one two-dimensional variable per quantity and unit, written whole or not at all."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Hashable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from klingel.contact import Prepared
from klingel.core import core
from klingel.errors import InputError, RunCancelledError, SimulationError
from klingel.lower import Spec, lower
from klingel.scenario import Scenario

if TYPE_CHECKING:
    from klingel._core import Progress
    from klingel.control.own import Called

DISK_RATE = 200.0
"""Default sample rate of files [Hz]."""

COMPLETED = "completed"
"""Outcome of a run that reached its end."""

FORMAT = "klingel-result-1"
"""Layout of the files, in their attribute `format`."""

COMPRESSION: dict[str, Any] = {"zlib": True, "complevel": 1, "shuffle": True}
"""Quick and understood by every reader of NetCDF."""

_WRITING = threading.Lock()  # the netCDF library is not safe for threads


def progress() -> Progress:
    """How far a run is (`.fraction`, 0 to 1) and the wish to end it (`.cancel()`), for `simulate`."""
    made: Progress = core().Progress()
    return made


def simulate(scenario: Scenario, *, progress: Progress | None = None, strict: bool = False) -> xr.Dataset:
    """Run a scenario.

    progress: shared with whoever watches or cancels; strict: raise when the run did not complete.
    Returns a Dataset over `time` [s], one variable a channel with attribute `units`; attributes `spec` (JSON),
    `outcome` ("completed", or what happened where and when), `realtime_factor` (simulated over CPU seconds of the
    stepping thread), `static_wheel_loads` (JSON, N), `notes` (what a reader should know, mostly nothing). Ctrl-C ends
    the run.
    Errors: SimulationError for a spec that the core refuses or has no equilibrium for, and if `strict` for a run that
    did not complete; RunCancelledError.
    """
    spec = lower(scenario)
    externals: dict[str, Called] = getattr(scenario.control, "externals", dict)()
    result = simulate_spec(spec, progress=progress, strict=strict, externals=externals)
    notes = [result.attrs["notes"], *scenario.sensors.notes(spec["control"])]
    result.attrs["notes"] = "; ".join(note for note in notes if note)
    return result


def prepare(scenario: Scenario) -> list[Prepared]:
    """Compile the contact tables of a scenario, or read them from the cache, so that its runs start at once.

    Done by `simulate` as well; a study does it before its runs. Errors: SimulationError as `simulate`.
    """
    extension = core()
    try:
        return [Prepared(*each) for each in extension.prepare(json.dumps(lower(scenario), allow_nan=False))]
    except extension.CoreError as error:
        raise SimulationError(str(error)) from None


def simulate_spec(
    spec: Spec,
    *,
    progress: Progress | None = None,
    strict: bool = False,
    externals: Mapping[str, Called] | None = None,
) -> xr.Dataset:
    """Run a spec, such as that of an earlier result, `json.loads(result.attrs["spec"])`; otherwise as `simulate`.

    externals: its controllers outside the core by the names of their blocks, `PythonController(...).externals()`; one
    that fails ends the run as an outcome. Errors: those of `simulate`; SimulationError for one that is missing.
    """
    extension = core()
    text = json.dumps(spec, allow_nan=False)
    watched = progress if progress is not None else extension.Progress()
    try:
        raw = _interruptible(lambda: extension.simulate(text, watched, externals), watched)
    except extension.Cancelled as error:
        raise RunCancelledError(str(error)) from None
    except extension.CoreError as error:
        raise SimulationError(str(error)) from None
    result = _dataset(raw, text)
    if strict and result.attrs["outcome"] != COMPLETED:
        raise SimulationError(f"{spec['name']}: {result.attrs['outcome']}")
    return result


def _interruptible(run: Callable[[], dict[str, Any]], watched: Progress) -> dict[str, Any]:
    """Run in a thread of its own while the main thread, the only one that Ctrl-C reaches, keeps listening."""
    if threading.current_thread() is not threading.main_thread():
        return run()
    with ThreadPoolExecutor(1) as pool:
        future: Future[dict[str, Any]] = pool.submit(run)
        try:
            while True:
                try:
                    return future.result(timeout=0.1)
                except NotYet:
                    if future.done():
                        raise
        except KeyboardInterrupt:
            watched.cancel()
            raise


def _dataset(raw: Mapping[str, Any], spec: str) -> xr.Dataset:
    fault = raw["fault"]
    time = raw["time"]
    columns = np.ascontiguousarray(raw["data"].T)
    attrs = {
        "format": FORMAT,
        "spec": spec,
        "outcome": COMPLETED if fault is None else f"{fault[1]}, at {fault[0]:.3f} s",
        "realtime_factor": float(time[-1] / raw["cpu_time"]) if len(time) and raw["cpu_time"] > 0.0 else 0.0,
        "cpu_time": float(raw["cpu_time"]),
        "evaluations": int(raw["evaluations"]),
        "static_wheel_loads": json.dumps(dict(raw["static_wheel_loads"])),
    }
    variables = {
        name: ("time", values, {"units": unit})
        for name, unit, values in zip(raw["channels"], raw["units"], columns, strict=True)
    }
    result = xr.Dataset(variables, coords={"time": ("time", time, {"units": "s"})}, attrs=attrs)
    result.attrs["notes"] = "; ".join(_notes(result, json.loads(spec)))
    return result


def _notes(result: xr.Dataset, spec: Spec) -> Iterator[str]:
    """What a reader of the numbers should know."""
    wheels = [str(name) for name in result.data_vars if str(name).endswith(".slender_force")]
    if spec["creep"]["law"] == "table" and wheels and result.sizes["time"]:
        forces = np.array([result[wheel].to_numpy() for wheel in wheels])
        place, when = np.unravel_index(np.argmax(forces), forces.shape)
        if (most := forces[place, when]) > 0.0:
            yield (
                f"creep table: beyond its a/b of 1/36 to 36 in {(forces > 0.0).mean():.2%} of the samples of all "
                f"wheels, with at most {most / 1e3:.2f} kN at {wheels[int(place)].removesuffix('.slender_force')} "
                f"at {float(result.time[when]):.2f} s; there the shape of its end goes on"
            )


def save(result: xr.Dataset, path: str | Path, *, rate: float | None = DISK_RATE) -> Path:
    """Write a run as NetCDF, whole or not at all.

    rate: of the samples in the file [Hz], None for all; samples are taken as they are, not filtered, and kept in
    single precision, arc lengths and what single precision cannot hold in double.
    The file has one variable per quantity and unit over (channel, time): `Q` holds the vertical force of every wheel,
    its coordinate `Q_of` their names. Errors: InputError for a rate that does not divide that of the result.
    """
    path = Path(path)
    every = _every(result, rate)
    packed = _pack(result, every)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}-{threading.get_ident()}.tmp")
    encoding = {name: COMPRESSION | {"dtype": _precision(name, each)} for name, each in packed.data_vars.items()}
    try:
        with _WRITING:
            packed.to_netcdf(part, engine="netcdf4", encoding=encoding)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def load(path: str | Path) -> xr.Dataset:
    """Read a saved run: one variable a channel, as `simulate` gives it; errors: InputError for a missing or file."""
    path = Path(path)
    if not path.is_file():
        raise InputError.single("", None, "no such file", remedy="check the path", file=str(path))
    try:
        with _WRITING, xr.open_dataset(path, engine="netcdf4") as opened:
            packed = opened.load()
    except (OSError, ValueError) as error:
        raise InputError.single("", None, f"is no NetCDF file ({error})", file=str(path)) from None
    if packed.attrs.get("format") != FORMAT:
        message = "was not written by klingel.save"
        raise InputError.single(
            "format", packed.attrs.get("format"), message, remedy=f"wanted {FORMAT}", file=str(path)
        )
    return _unpack(packed)


def _every(result: xr.Dataset, rate: float | None) -> int:
    if rate is None or result.sizes["time"] < 2:
        return 1
    interval = float(result["time"][1] - result["time"][0])
    every = 1.0 / (rate * interval)
    if every < 0.999 or abs(every - round(every)) > 1e-6 * every:
        remedy = f"give {1.0 / interval:g} Hz over a whole number"
        raise InputError.single("rate", rate, "does not divide the rate of the result [Hz]", remedy=remedy)
    return round(every)


def _precision(name: Hashable, values: xr.DataArray) -> str:
    """Of a variable in the file: a controller may command numbers that single precision has not got."""
    finite = values.to_numpy()
    large = np.abs(finite, where=np.isfinite(finite), out=np.zeros_like(finite)).max(initial=0.0)
    return "f8" if name == "s" or large > np.finfo(np.float32).max else "f4"


def _pack(result: xr.Dataset, every: int) -> xr.Dataset:
    """One variable per quantity and unit, of every `every`-th sample."""
    columns = result.variables
    groups: dict[tuple[str, str], list[str]] = {}
    for channel in map(str, result.data_vars):
        groups.setdefault((channel.rpartition(".")[2], columns[channel].attrs["units"]), []).append(channel)
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {"time": ("time", columns["time"].values[::every], columns["time"].attrs)}
    for (quantity, unit), channels in groups.items():
        name = quantity if quantity not in variables else f"{quantity}_{len(variables)}"
        of = f"{name}_of"
        coordinates[of] = (of, [c.rpartition(".")[0] for c in channels])
        values = np.stack([columns[c].values[::every] for c in channels])
        variables[name] = ((of, "time"), values, {"units": unit, "quantity": quantity})
    return xr.Dataset(variables, coords=coordinates, attrs=result.attrs)


def _unpack(packed: xr.Dataset) -> xr.Dataset:
    variables: dict[str, Any] = {}
    for name, variable in packed.data_vars.items():
        units = {"units": variable.attrs["units"]}
        for owner, values in zip(packed[f"{name}_of"].values, variable.values, strict=True):
            quantity = variable.attrs["quantity"]
            variables[f"{owner}.{quantity}" if owner else quantity] = ("time", values, units)
    return xr.Dataset(variables, coords={"time": packed["time"]}, attrs=packed.attrs)
