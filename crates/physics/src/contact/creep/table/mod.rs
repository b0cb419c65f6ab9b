//! Exact creep forces from a table: the full theory of rolling contact at the cost of a spline.
//! Coordinates, symmetries, the limiter and how the table is made are derived in docs/theory/creep_table.md.

mod coordinates;
mod file;
mod fit;
mod lookup;
mod maker;
#[cfg(test)]
mod tests;

use super::error::out_of_range;
use super::kalker::Kalker;
use super::polach::limit;
use super::{CreepError, RollingContact};
use crate::{Mask, Scalar};
use coordinates::{RIM, contraction, inside, limited, scales, slenderness};
pub use file::Provenance;
use lookup::{Spline, bounded};
pub use maker::Maker;
use std::sync::OnceLock;

/// The file of the table in the package, made by `klingel contact-table`.
pub static CREEP_TABLE: &[u8] = include_bytes!("../../../../data/creep_table.bin");

/// Scaled creepages below this count as none, so that the size of the slip has a slope.
const LEAST_CREEPAGE: f64 = 1e-14;

/// Forces of the exact theory over all creepages and a/b from 1/36 to 36, for one Poisson's ratio.
///
/// ```
/// use klingel_physics::contact::creep::CreepTable;
/// let table = CreepTable::built_in();
/// assert!((table.provenance().poisson - 0.28).abs() < 1e-12);
/// ```
#[derive(Debug)]
pub struct CreepTable {
    provenance: Provenance,
    spline: Spline,
}

impl CreepTable {
    /// The name of the law in files and in Python.
    pub const NAME: &'static str = "table";
    /// Least and largest a/b. Beyond them the shape of the end goes on with Kalker's coefficients of the true ratio.
    pub const RATIOS: [f64; 2] = [1.0 / 36.0, 36.0];

    /// The table of the package.
    ///
    /// # Panics
    /// If what was compiled in is damaged, which a test excludes.
    pub fn built_in() -> &'static Self {
        static TABLE: OnceLock<CreepTable> = OnceLock::new();
        TABLE.get_or_init(|| Self::from_bytes(CREEP_TABLE).expect("the table in the package is whole"))
    }

    /// A table from its file.
    ///
    /// # Errors
    /// A file of another kind or version; a check sum that does not fit.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CreepError> {
        let (provenance, spline) = file::read(bytes)?;
        Ok(Self { provenance, spline })
    }

    /// Refuses another material than the table's.
    ///
    /// # Errors
    /// Another Poisson's ratio.
    pub fn check(&self, poisson: f64) -> Result<(), CreepError> {
        let own = self.provenance.poisson;
        let same = (poisson - own).abs() < 1e-9;
        let what = "Poisson's ratio of the creep table";
        if same { Ok(()) } else { Err(out_of_range(what, poisson, [own, own], "choose fastsim for other materials")) }
    }

    /// Refuses an ellipse beyond the table, for those who ask for numbers of the theory itself.
    ///
    /// # Errors
    /// a/b outside `RATIOS`.
    pub fn check_ratio(ratio: f64) -> Result<(), CreepError> {
        let what = "ratio of the semi-axes a/b of the creep table";
        if Self::holds(ratio) {
            Ok(())
        } else {
            Err(out_of_range(what, ratio, Self::RATIOS, "choose exact or fastsim"))
        }
    }

    /// Whether it holds ellipses of this a/b.
    pub fn holds(ratio: f64) -> bool {
        let [least, most] = Self::RATIOS;
        (least * (1.0 - 1e-12)..=most * (1.0 + 1e-12)).contains(&ratio)
    }

    /// What it was made of.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// [Fx, Fy, Mz] on the wheel, N and N m.
    pub(super) fn force<S: Scalar>(&self, kalker: &Kalker, shear_modulus: f64, c: &RollingContact<S>) -> [S; 3] {
        let (limit, sum, mut q) = (limit(c), c.a + c.b, slenderness(c.a, c.b));
        let within = inside(q);
        if !within.all() {
            q = q.clamp(-RIM, RIM);
        }
        let mut scale = self.spline.scales(q);
        if !within.all() {
            let ratio = c.a / c.b;
            let beyond = bounded(scales(kalker, ratio), ratio);
            scale = core::array::from_fn(|i| S::select(within, scale[i], beyond[i]));
        }
        // As the factors are bounded ones, v has G a (a + b)/(mu N).
        let stiffness = c.a * sum * shear_modulus / limit;
        let v = [c.xi * stiffness * scale[0], c.eta * stiffness * scale[1], c.phi * sum * stiffness * scale[2]];
        let square = (v[0].square() + v[1].square()) + (v[2].square() + LEAST_CREEPAGE * LEAST_CREEPAGE);
        let inward = contraction(square);
        let [fx, fy, mz] = self.spline.at([v[0] * inward, v[1] * inward, v[2] * inward, q]);
        let [fx, fy] = limited([fx, fy]);
        [fx * limit, fy * limit, mz * limit * sum * 0.5]
    }
}
