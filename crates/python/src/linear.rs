//! Steady states and linear models of a spec: arrays with names and units.
//! What they mean in railway words, and how plant and controllers are joined, is in Python.

use crate::{parse, raised};
use klingel_engine::{EngineError, LinearControl, LinearModel, Model, Steady, Wiring, compile, linearisable};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A compiled spec at a steady state; the neighbour's is the start for the next.
#[pyclass(frozen)]
pub struct OperatingPoint {
    model: Arc<Model>,
    wiring: Option<Wiring>,
    steady: Steady,
}

/// Solves the steady state of a spec, controllers settled; `near` is that of a neighbour (another speed, another curve).
#[pyfunction]
#[pyo3(signature = (spec, near=None))]
pub fn operating_point(py: Python<'_>, spec: &str, near: Option<&OperatingPoint>) -> PyResult<OperatingPoint> {
    let solve = || -> Result<OperatingPoint, EngineError> {
        let spec = parse(spec)?;
        let model = compile(&spec)?;
        let wiring = spec.control.as_ref().map(|c| Wiring::new(&model, c)).transpose()?;
        wiring.as_ref().map_or(Ok(()), linearisable)?;
        let start = near.map(|n| &n.steady).filter(|s| s.x.len() == model.state_count());
        let steady = klingel_engine::steady(&model, wiring.as_ref(), start)?;
        Ok(OperatingPoint { model: Arc::new(model), wiring, steady })
    };
    py.detach(solve).map_err(|e| raised(&e))
}

#[pymethods]
impl OperatingPoint {
    /// Newton steps that it took.
    #[getter]
    fn iterations(&self) -> usize {
        self.steady.iterations
    }

    /// The linear model there as a dict: states, inputs, outputs (name, unit each), a, b, c, d, x, u, y, kinks and
    /// control (None or a dict of sample_time, states, measured, driven, a, b, c, d, z).
    fn linearise<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let made = py.detach(|| klingel_engine::linearise(&self.model, self.wiring.as_ref(), &self.steady));
        plant(py, made.map_err(|e| raised(&e))?)
    }
}

/// The linear model of a spec at its steady state, as `OperatingPoint.linearise`.
#[pyfunction]
pub fn linearise<'py>(py: Python<'py>, spec: &str) -> PyResult<Bound<'py, PyDict>> {
    operating_point(py, spec, None)?.linearise(py)
}

/// Writes a, b, c, d of n states, m inputs and p outputs.
fn set_matrices(
    py: Python<'_>,
    into: &Bound<'_, PyDict>,
    [a, b, c, d]: [Vec<f64>; 4],
    [n, m, p]: [usize; 3],
) -> PyResult<()> {
    for (name, values, rows, columns) in [("a", a, n, n), ("b", b, n, m), ("c", c, p, n), ("d", d, p, m)] {
        let matrix: Bound<'_, PyArray2<f64>> = PyArray1::from_vec(py, values).reshape([rows, columns])?;
        into.set_item(name, matrix)?;
    }
    Ok(())
}

fn plant(py: Python<'_>, model: LinearModel) -> PyResult<Bound<'_, PyDict>> {
    let LinearModel { states, inputs, outputs, a, b, c, d, x, u, y, control, kinks, iterations } = model;
    let sizes = [states.len(), inputs.len(), outputs.len()];
    let result = PyDict::new(py);
    result.set_item("states", states)?;
    result.set_item("inputs", inputs)?;
    result.set_item("outputs", outputs)?;
    set_matrices(py, &result, [a, b, c, d], sizes)?;
    result.set_item("x", x.into_pyarray(py))?;
    result.set_item("u", u.into_pyarray(py))?;
    result.set_item("y", y.into_pyarray(py))?;
    result.set_item("kinks", kinks)?;
    result.set_item("iterations", iterations)?;
    result.set_item("control", control.map(|c| controller(py, c)).transpose()?)?;
    Ok(result)
}

fn controller(py: Python<'_>, control: LinearControl) -> PyResult<Bound<'_, PyDict>> {
    let LinearControl { sample_time, states, measured, driven, a, b, c, d, z } = control;
    let sizes = [states.len(), measured.len(), driven.len()];
    let result = PyDict::new(py);
    result.set_item("sample_time", sample_time)?;
    result.set_item("states", states)?;
    result.set_item("measured", measured)?;
    result.set_item("driven", driven)?;
    set_matrices(py, &result, [a, b, c, d], sizes)?;
    result.set_item("z", z.into_pyarray(py))?;
    Ok(result)
}
