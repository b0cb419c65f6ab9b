//! Making the table of creep forces part by part, and what is known of the one in this build.
//! `klingel contact-table` keeps the parts in files; which points they hold and what becomes of them is the core's.

use crate::CoreError;
use klingel_physics::contact::creep::{CREEP_TABLE, CreepError, CreepTable, Maker};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

fn refused(error: CreepError) -> PyErr {
    CoreError::new_err(error.to_string())
}

/// The parts of a table and the file made of them.
#[pyclass(frozen)]
pub struct CreepTableMaker(Maker);

#[pymethods]
impl CreepTableMaker {
    /// Intervals of u1, u2, u3 and of the slenderness; those of the table in the package unless given.
    #[new]
    #[pyo3(signature = (*, poisson, elements, intervals=None))]
    fn new(poisson: f64, elements: [usize; 2], intervals: Option<[usize; 4]>) -> PyResult<Self> {
        Maker::new(poisson, elements, intervals.unwrap_or(Maker::INTERVALS)).map(Self).map_err(refused)
    }

    /// Changes with everything that shapes the numbers.
    #[getter]
    fn key(&self) -> String {
        self.0.key()
    }

    /// How many there are.
    #[getter]
    fn parts(&self) -> usize {
        self.0.parts()
    }

    /// Points of a part.
    fn part_len(&self, part: usize) -> PyResult<usize> {
        self.known(part).map(|part| self.0.part_len(part))
    }

    /// The patch and its division, in words.
    fn describe(&self, part: usize) -> PyResult<String> {
        self.known(part).map(|part| self.0.describe(part))
    }

    /// Fx, Fy, Mz of every point of a part, as `finish` wants them; some seconds on all cores.
    fn solve<'py>(&self, py: Python<'py>, part: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let part = self.known(part)?;
        let forces = py.detach(|| self.0.solve(part)).map_err(refused)?;
        let rows = forces.len();
        forces.into_flattened().into_pyarray(py).reshape([rows, 3])
    }

    /// The bytes of the table's file, made of all parts in their order.
    fn finish<'py>(&self, py: Python<'py>, parts: Vec<PyReadonlyArray2<'py, f64>>) -> PyResult<Bound<'py, PyBytes>> {
        let parts = parts.iter().map(rows).collect::<PyResult<Vec<_>>>()?;
        let file = py.detach(|| self.0.finish(&parts)).map_err(refused)?;
        Ok(PyBytes::new(py, &file))
    }
}

impl CreepTableMaker {
    fn known(&self, part: usize) -> PyResult<usize> {
        let parts = self.0.parts();
        let message = || CoreError::new_err(format!("part: {part} is not known; there are {parts}, from 0"));
        if part < parts { Ok(part) } else { Err(message()) }
    }
}

fn rows(part: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 3]>> {
    let (rows, _) = part.as_slice()?.as_chunks();
    let message = "parts: not three numbers a point; give what `solve` gave";
    if part.shape()[1] == 3 { Ok(rows.to_vec()) } else { Err(CoreError::new_err(message)) }
}

/// What the table in this build was made of, its check sum found right: poisson, coarse and fine (elements),
/// intervals, ratios (least and largest a/b), checksum, solver, by_this_solver (whether its sources are those of this
/// build).
#[pyfunction]
pub fn creep_table(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let table = CreepTable::from_bytes(CREEP_TABLE).map_err(refused)?;
    let provenance = table.provenance();
    let info = PyDict::new(py);
    info.set_item("poisson", provenance.poisson)?;
    info.set_item("coarse", provenance.coarse)?;
    info.set_item("fine", provenance.fine)?;
    info.set_item("intervals", provenance.intervals)?;
    info.set_item("ratios", CreepTable::RATIOS)?;
    info.set_item("checksum", &provenance.checksum)?;
    info.set_item("solver", &provenance.solver)?;
    info.set_item("by_this_solver", provenance.solver == Maker::solver())?;
    Ok(info)
}

/// Where files are kept that may be made again; none if `KLINGEL_CACHE` is off.
#[pyfunction]
pub fn cache_folder() -> Option<String> {
    klingel_engine::tables::disk::folder().map(|folder| folder.display().to_string())
}
