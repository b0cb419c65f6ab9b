//! A wheel-rail pair for people: contact points, rolling radii and conicity as columns of numbers.
//! The table is compiled, or read from the cache, when a load first asks for it; many places go through it in parallel.

use crate::{CoreError, refused};
use klingel_engine::spec::PairSpec;
use klingel_engine::tables::{self, Origin, Prepared};
use klingel_physics::contact::{
    ContactError, ContactPoint, Material, NormalContact, PairGeometry, RigidWheelset, WheelsetContact, Zone,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Two wheels on their rails: `ContactPair(spec)` with the JSON of a spec's contact pair.
#[pyclass(frozen)]
pub struct ContactPair {
    geometry: PairGeometry,
    normal: NormalContact,
    rigid: RigidWheelset,
    rail_top: f64,
    prepared: OnceLock<Prepared>,
}

impl ContactPair {
    fn table(&self) -> Result<&Prepared, ContactError> {
        if let Some(prepared) = self.prepared.get() {
            return Ok(prepared);
        }
        let made = tables::contact_table(&self.geometry, &Material::STEEL, self.normal)?;
        Ok(self.prepared.get_or_init(|| made))
    }

    /// Both wheels at every `y`, rigid without a load.
    fn at(&self, y: &[f64], yaw: f64, load: Option<f64>) -> Result<Vec<WheelsetContact>, ContactError> {
        let Some(load) = load else {
            let rigid = |&y: &f64| Ok(self.rigid.at(y)?.contact(&self.geometry, self.rail_top, y, yaw));
            return y.par_iter().map(rigid).collect();
        };
        let table = &self.table()?.table;
        y.par_iter().map(|&y| table.contact(&self.geometry, y, yaw, load)).collect()
    }

    fn differences(&self, y: &[f64], load: Option<f64>) -> Result<Vec<f64>, ContactError> {
        let Some(load) = load else {
            return y.par_iter().map(|&y| self.rigid.rolling_radius_difference(y)).collect();
        };
        let table = &self.table()?.table;
        let difference = |&y: &f64| Ok(table.wheelset_at(&self.geometry, y, 0.0, load)?.rolling_radius_difference());
        y.par_iter().map(difference).collect()
    }
}

/// Index of the place, side, patch.
type Row<'a> = (usize, usize, &'a ContactPoint);

/// A column of numbers.
type Float = (&'static str, fn(&ContactPoint) -> f64);

const FLOATS: [Float; 13] = [
    ("x", |p| p.x),
    ("y_wheel", |p| p.y_wheel),
    ("z_wheel", |p| p.z_wheel),
    ("y_rail", |p| p.y_rail),
    ("z_rail", |p| p.z_rail),
    ("angle", |p| p.angle),
    ("rolling_radius", |p| p.radius),
    ("a", |p| p.a),
    ("b", |p| p.b),
    ("area", |p| p.area),
    ("pressure", |p| p.pressure),
    ("normal_force", |p| p.normal_force),
    ("penetration", |p| p.penetration),
];

type Column<'py> = Bound<'py, PyArray1<f64>>;
type Values<'py> = PyReadonlyArray1<'py, f64>;

#[pymethods]
impl ContactPair {
    #[new]
    fn new(spec: &str) -> PyResult<Self> {
        let spec: PairSpec = serde_json::from_str(spec).map_err(|e| CoreError::new_err(e.to_string()))?;
        let geometry = klingel_engine::pair_geometry(0, &spec).map_err(|e| CoreError::new_err(e.to_string()))?;
        let rigid = RigidWheelset::new(&geometry).map_err(|e| refused(&e))?;
        let rail_top = geometry.rail_top().map_err(|e| refused(&e))?;
        Ok(Self { geometry, normal: spec.normal.into(), rigid, rail_top, prepared: OnceLock::new() })
    }

    /// (origin: compiled, disk or memory; seconds; why it could not be kept on disk) of the contact table.
    fn prepare(&self, py: Python<'_>) -> PyResult<(&'static str, f64, Option<String>)> {
        let prepared = py.detach(|| self.table()).map_err(|e| refused(&e))?;
        Ok(note(prepared))
    }

    /// Columns of every patch at every y \[m\]; `place` is the index of its y, `side` 0 left and 1 right, `zone` 0 tread,
    /// 1 root, 2 flange and -1 in the rigid view, which is that without a load.
    fn contact<'py>(
        &self,
        py: Python<'py>,
        y: Values<'py>,
        yaw: f64,
        load: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let y = y.as_slice()?;
        let states = py.detach(|| self.at(y, yaw, load)).map_err(|e| refused(&e))?;
        let rows: Vec<Row<'_>> = states
            .iter()
            .enumerate()
            .flat_map(|(i, s)| (0..2).flat_map(move |side| s.wheels[side].iter().map(move |p| (i, side, p))))
            .collect();
        let columns = PyDict::new(py);
        let index = |f: fn(&Row<'_>) -> i64| rows.iter().map(f).collect::<Vec<i64>>().into_pyarray(py);
        columns.set_item("place", index(|row| row.0 as i64))?;
        columns.set_item("side", index(|row| row.1 as i64))?;
        columns.set_item("zone", index(|row| row.2.zone.map_or(-1, zone_number)))?;
        for (name, value) in FLOATS {
            columns.set_item(name, rows.iter().map(|row| value(row.2)).collect::<Vec<f64>>().into_pyarray(py))?;
        }
        let roll: Vec<f64> = rows.iter().map(|(i, _, _)| states[*i].roll).collect();
        columns.set_item("roll", roll.into_pyarray(py))?;
        Ok(columns)
    }

    /// Right less left rolling radius \[m\] at every y \[m\].
    fn rolling_radius_difference<'py>(
        &self,
        py: Python<'py>,
        y: Values<'py>,
        load: Option<f64>,
    ) -> PyResult<Column<'py>> {
        let y = y.as_slice()?;
        Ok(py.detach(|| self.differences(y, load)).map_err(|e| refused(&e))?.into_pyarray(py))
    }

    /// Equivalent conicity at every amplitude \[m\].
    fn equivalent_conicity<'py>(&self, py: Python<'py>, amplitude: Values<'py>) -> PyResult<Column<'py>> {
        let amplitude = amplitude.as_slice()?;
        let all = || amplitude.par_iter().map(|&a| self.rigid.equivalent_conicity(a)).collect::<Result<Vec<f64>, _>>();
        Ok(py.detach(all).map_err(|e| refused(&e))?.into_pyarray(py))
    }
}

fn zone_number(zone: Zone) -> i64 {
    match zone {
        Zone::Tread => 0,
        Zone::Root => 1,
        Zone::Flange => 2,
    }
}

/// What Python says about a table: where it came from, how long that took, why it was not kept.
pub fn note(prepared: &Prepared) -> (&'static str, f64, Option<String>) {
    let origin = match prepared.origin {
        Origin::Compiled => "compiled",
        Origin::Disk => "disk",
        Origin::Memory => "memory",
    };
    (origin, prepared.seconds, prepared.unkept.clone())
}
