//! The Python face of the core: specs in as JSON, arrays out; the interpreter is free while the core works.
//! Every message of the core is passed on as it is; `klingel.errors` sorts them.

mod creep;
mod creep_table;
mod external;
mod linear;
mod pair;

use klingel_engine::{EngineError, Spec};
use klingel_physics::contact::ContactError;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::sync::Arc;

create_exception!(_core, CoreError, PyValueError, "The core refuses a spec or finds no start for it.");
create_exception!(_core, Cancelled, PyException, "A run was cancelled through its Progress.");

/// How far a run is; `cancel()` ends it at its next look.
#[pyclass(frozen)]
struct Progress(Arc<klingel_engine::Progress>);

#[pymethods]
impl Progress {
    #[new]
    fn new() -> Self {
        Self(Arc::default())
    }
    /// 0 to 1.
    #[getter]
    fn fraction(&self) -> f64 {
        self.0.fraction()
    }
    fn cancel(&self) {
        self.0.cancel();
    }
}

fn raised(error: &EngineError) -> PyErr {
    match error {
        EngineError::Cancelled { .. } => Cancelled::new_err(error.to_string()),
        _ => CoreError::new_err(error.to_string()),
    }
}

fn refused(error: &ContactError) -> PyErr {
    CoreError::new_err(error.to_string())
}

fn parse(spec: &str) -> Result<Spec, EngineError> {
    Ok(serde_json::from_str(spec)?)
}

/// Runs a spec (JSON) and returns a dict: channels (names), units, time (n), data (n x channels), fault (None or
/// (time, message)), static_wheel_loads, cpu_time and evaluations. `externals`: controllers outside the core by the names
/// of their blocks, with reset() and step(time, inputs) -> outputs.
#[pyfunction]
#[pyo3(signature = (spec, progress=None, externals=None))]
fn simulate<'py>(
    py: Python<'py>,
    spec: &str,
    progress: Option<&Progress>,
    externals: Option<HashMap<String, Py<PyAny>>>,
) -> PyResult<Bound<'py, PyDict>> {
    let progress = progress.map_or_else(Arc::default, |p| Arc::clone(&p.0));
    let externals = external::boxed(externals.unwrap_or_default());
    let run = || parse(spec).and_then(|s| klingel_engine::simulate(&s, externals, &progress));
    let series = py.detach(run).map_err(|e| raised(&e))?;
    let (names, units): (Vec<String>, Vec<String>) = series.channels.into_iter().unzip();
    let (rows, columns) = (series.time.len(), names.len());
    let data: Bound<'py, PyArray2<f64>> = PyArray1::from_vec(py, series.rows).reshape([rows, columns])?;
    let result = PyDict::new(py);
    result.set_item("channels", names)?;
    result.set_item("units", units)?;
    result.set_item("time", series.time.into_pyarray(py))?;
    result.set_item("data", data)?;
    result.set_item("fault", series.fault.map(|(t, f)| (t, f.to_string())))?;
    result.set_item("static_wheel_loads", series.static_wheel_loads)?;
    result.set_item("cpu_time", series.cpu_time)?;
    result.set_item("evaluations", series.evaluations)?;
    Ok(result)
}

/// Compiles a spec (contact tables included) without running it.
#[pyfunction]
fn check(py: Python<'_>, spec: &str) -> PyResult<()> {
    py.detach(|| parse(spec).and_then(|s| klingel_engine::compile(&s))).map_err(|e| raised(&e))?;
    Ok(())
}

/// The contact tables of a spec, one a pair: (compiled, disk or memory; seconds; why it could not be kept on disk).
#[pyfunction]
fn prepare(py: Python<'_>, spec: &str) -> PyResult<Vec<(&'static str, f64, Option<String>)>> {
    let tables = py.detach(|| parse(spec).and_then(|s| klingel_engine::prepare(&s))).map_err(|e| raised(&e))?;
    Ok(tables.iter().map(pair::note).collect())
}

/// Name, bytes, whether the check sum is right.
type Kept = (String, u64, bool);

/// Folder of the compiled contact tables and its tables (name, bytes, whether the check sum is right); none without one.
#[pyfunction]
fn cache(py: Python<'_>) -> Option<(String, Vec<Kept>)> {
    let folder = klingel_engine::tables::disk::folder()?;
    let tables = py.detach(|| klingel_engine::tables::disk::check(&folder));
    Some((folder.display().to_string(), tables))
}

type Column<'py> = Bound<'py, PyArray1<f64>>;

/// Points (y, z) of a standard profile \[m\]: `s1002`, `60e1`, `uic60`.
#[pyfunction]
fn profile<'py>(py: Python<'py>, name: &str) -> PyResult<(Column<'py>, Column<'py>)> {
    let profile = klingel_engine::named_profile("profile", name).map_err(|e| raised(&e))?;
    Ok((profile.y.into_pyarray(py), profile.z.into_pyarray(py)))
}

/// Version, source hash, profile and CPU features of this build.
#[pyfunction]
fn build_info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("version", env!("CARGO_PKG_VERSION"))?;
    info.set_item("source_hash", env!("KLINGEL_SOURCE_HASH"))?;
    info.set_item("profile", env!("KLINGEL_PROFILE"))?;
    info.set_item("cpu_features", cpu_features())?;
    Ok(info)
}

#[cfg(target_arch = "x86_64")]
fn cpu_features() -> Vec<&'static str> {
    let mut found = vec!["sse2"];
    for (name, has) in [
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ] {
        if has {
            found.push(name);
        }
    }
    found
}

#[cfg(not(target_arch = "x86_64"))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}

#[pymodule]
fn _core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<Progress>()?;
    m.add_function(wrap_pyfunction!(simulate, m)?)?;
    m.add_class::<pair::ContactPair>()?;
    m.add_function(wrap_pyfunction!(check, m)?)?;
    m.add_function(wrap_pyfunction!(prepare, m)?)?;
    m.add_function(wrap_pyfunction!(cache, m)?)?;
    m.add_function(wrap_pyfunction!(profile, m)?)?;
    m.add_function(wrap_pyfunction!(creep::creep_force, m)?)?;
    m.add_function(wrap_pyfunction!(creep::creep_laws, m)?)?;
    m.add_class::<linear::OperatingPoint>()?;
    m.add_function(wrap_pyfunction!(linear::operating_point, m)?)?;
    m.add_function(wrap_pyfunction!(linear::linearise, m)?)?;
    m.add_class::<creep_table::CreepTableMaker>()?;
    m.add_function(wrap_pyfunction!(creep_table::creep_table, m)?)?;
    m.add_function(wrap_pyfunction!(creep_table::cache_folder, m)?)?;
    m.add_function(wrap_pyfunction!(build_info, m)?)?;
    m.add("CoreError", m.py().get_type::<CoreError>())?;
    m.add("Cancelled", m.py().get_type::<Cancelled>())?;
    Ok(())
}
