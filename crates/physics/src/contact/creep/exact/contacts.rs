//! Exact theory of contacts in their own units: one, or many on all cores.
//! Contacts of one aspect ratio that follow each other share their ellipse.

use super::super::{CreepError, RollingContact};
use super::{Exact, check};
use crate::contact::Material;
use rayon::prelude::*;

/// [Fx, Fy, Mz] on the wheel of one contact, N and N m, axes and signs as everywhere (x forward, y right, z down).
///
/// ```
/// use klingel_physics::contact::{Material, creep::{RollingContact, exact_force}};
/// let patch = RollingContact { a: 6e-3, b: 4e-3, normal_force: 5e4, friction: 0.3, xi: 1e-3, eta: 0.0, phi: 0.0 };
/// let [fx, fy, _] = exact_force(&patch, &Material::STEEL, [12, 12]).unwrap();
/// assert!(fx < -5e3 && fx > -1.5e4 && fy.abs() < 1.0);
/// ```
///
/// # Errors
/// As `Exact::new` and `Exact::solve`; a negative load or friction coefficient.
pub fn exact_force(c: &RollingContact<f64>, material: &Material, elements: [usize; 2]) -> Result<[f64; 3], CreepError> {
    force(c, material, elements, &mut None)
}

/// The same for many contacts, on all cores; each force is the one that `exact_force` gives.
///
/// ```
/// use klingel_physics::contact::{Material, creep::{RollingContact, exact_forces}};
/// let patch = RollingContact { a: 6e-3, b: 4e-3, normal_force: 5e4, friction: 0.3, xi: 1e-3, eta: 0.0, phi: 0.0 };
/// let forces = exact_forces(&[patch, RollingContact { xi: -1e-3, ..patch }], &Material::STEEL, [8, 8]).unwrap();
/// assert!((forces[0][0] + forces[1][0]).abs() < 1.0);
/// let (index, _) = exact_forces(&[patch, RollingContact { b: 1e-6, ..patch }], &Material::STEEL, [8, 8]).unwrap_err();
/// assert_eq!(index, 1);
/// ```
///
/// # Errors
/// As `exact_force`, with the index of a contact that fails.
pub fn exact_forces(
    contacts: &[RollingContact<f64>],
    material: &Material,
    elements: [usize; 2],
) -> Result<Vec<[f64; 3]>, (usize, CreepError)> {
    let one = |last: &mut Option<(f64, Exact)>, (i, c): (usize, &RollingContact<f64>)| {
        force(c, material, elements, last).map_err(|error| (i, error))
    };
    contacts.par_iter().enumerate().map_init(|| None, one).collect()
}

/// The force; `last` is the ellipse of the contact before, with its ratio, and then the one of this contact.
fn force(
    c: &RollingContact<f64>,
    material: &Material,
    elements: [usize; 2],
    last: &mut Option<(f64, Exact)>,
) -> Result<[f64; 3], CreepError> {
    check("semi-axis a", c.a, [f64::MIN_POSITIVE, f64::MAX], "it is a length in metres")?;
    check("semi-axis b", c.b, [f64::MIN_POSITIVE, f64::MAX], "it is a length in metres")?;
    check("normal force", c.normal_force, [0.0, f64::MAX], "a wheel only presses")?;
    check("friction coefficient", c.friction, [0.0, f64::MAX], "dry rails have 0.3 to 0.5")?;
    let ratio = c.a / c.b;
    let (_, ellipse) = match last.take() {
        Some(same) if same.0 == ratio => last.insert(same),
        _ => last.insert((ratio, Exact::new(ratio, material.poisson, elements)?)),
    };
    let (limit, mean) = (c.friction * c.normal_force, (c.a * c.b).sqrt());
    if limit == 0.0 {
        return Ok([0.0; 3]);
    }
    let scale = material.shear_modulus() * mean * mean / limit;
    let [fx, fy, mz] = ellipse.solve([c.xi * scale, c.eta * scale, c.phi * mean * scale])?.force;
    Ok([fx * limit, fy * limit, mz * limit * mean])
}
