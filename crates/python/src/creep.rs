//! Creep forces of many contact patches at once, for people who look at the laws themselves.
//! What the numbers may be is checked in Python; what the laws and their options may be, in the laws.

use crate::CoreError;
use klingel_physics::contact::Material;
use klingel_physics::contact::creep::{
    CreepError, CreepForce, CreepLaw, CreepOptions, CreepTable, Exact, FallingFriction, PolachReduction,
    RollingContact, SlopeReduction, exact_forces,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;

type Column<'py> = Bound<'py, PyArray1<f64>>;

/// Patches that one thread takes at least: below that, starting others costs more than it saves.
const LEAST_SHARE: usize = 512;

/// Names of the laws.
#[pyfunction]
pub fn creep_laws() -> Vec<&'static str> {
    CreepLaw::NAMES.into_iter().chain([Exact::NAME]).collect()
}

/// Fx, Fy and Mz of patches given as equally long columns: a, b, xi, eta, phi, normal force, friction, speed; all SI.
///
/// `reduction` is (kA, kS), `slope` (k0, alpha, beta), `falling` (A, B). An error about one patch carries its index
/// beside the message.
#[pyfunction]
#[pyo3(signature = (law, columns, *, shear_modulus, poisson, elements, reduction, blended, slope, falling))]
#[allow(clippy::too_many_arguments)] // one for each keyword of the Python function
pub fn creep_force<'py>(
    py: Python<'py>,
    law: &str,
    columns: [PyReadonlyArray1<'py, f64>; 8],
    shear_modulus: f64,
    poisson: f64,
    elements: [usize; 2],
    reduction: Option<[f64; 2]>,
    blended: bool,
    slope: Option<[f64; 3]>,
    falling: Option<[f64; 2]>,
) -> PyResult<[Column<'py>; 3]> {
    let options = CreepOptions {
        reduction: reduction.map(|[adhesion, slip]| PolachReduction { adhesion, slip }),
        blended,
        slope: slope.map(|[initial, limit, decay]| SlopeReduction { initial, limit, decay }),
    };
    let material = Material { youngs_modulus: 2.0 * shear_modulus * (1.0 + poisson), poisson };
    let falling = falling.map(|[ratio, decay]| FallingFriction::new(ratio, decay)).transpose().map_err(refused)?;
    let mut slices = [[].as_slice(); 8];
    for (slice, column) in slices.iter_mut().zip(&columns) {
        *slice = column.as_slice()?;
    }
    let forces: Vec<[f64; 3]> = if law == Exact::NAME {
        options.check(law).and_then(|()| Exact::check(poisson, elements)).map_err(refused)?;
        py.detach(|| exact_forces(&patches(&slices, falling.as_ref()).collect::<Vec<_>>(), &material, elements))
            .map_err(|(index, error)| CoreError::new_err((error.to_string(), index)))?
    } else {
        let law = CreepLaw::named(law, elements).ok_or_else(|| CoreError::new_err(format!("no creep law {law}")))?;
        let force = CreepForce::with_options(law, options, &material).map_err(refused)?;
        if law == CreepLaw::Table {
            for (index, (a, b)) in core::iter::zip(slices[0], slices[1]).enumerate() {
                CreepTable::check_ratio(a / b).map_err(|error| CoreError::new_err((error.to_string(), index)))?;
            }
        }
        py.detach(|| patches(&slices, falling.as_ref()).with_min_len(LEAST_SHARE).map(|c| force.force(&c)).collect())
    };
    Ok([0, 1, 2].map(|k| forces.iter().map(|f| f[k]).collect::<Vec<f64>>().into_pyarray(py)))
}

fn refused(error: CreepError) -> PyErr {
    CoreError::new_err(error.to_string())
}

/// The patches of the columns, each with the friction at its slip velocity.
fn patches(
    columns: &[&[f64]; 8],
    falling: Option<&FallingFriction>,
) -> impl IndexedParallelIterator<Item = RollingContact<f64>> {
    (0..columns[0].len()).into_par_iter().map(move |i| {
        let [a, b, xi, eta, phi, normal_force, friction, speed] = columns.map(|column| column[i]);
        let friction = falling.map_or(friction, |falling| falling.at_creepage(friction, speed, xi, eta));
        RollingContact { a, b, normal_force, friction, xi, eta, phi }
    })
}
