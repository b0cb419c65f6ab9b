//! Creep forces of one elliptic contact patch, chosen by `CreepLaw`: from the linear theory to FASTSIM.
//! Creepages of the wheel over the rail; a positive creepage gives a negative force on the wheel.

#[cfg(test)]
mod accuracy;
mod error;
mod exact;
mod fastsim;
mod flexibility;
mod kalker;
mod linear;
mod options;
mod polach;
mod shen;
mod stick;
mod table;
#[cfg(test)]
mod tests;

pub use error::CreepError;
pub use exact::{Exact, ExactSolution, exact_force, exact_forces};
pub use fastsim::MOST_ELEMENTS;
pub use kalker::Kalker;
pub use options::{CreepOptions, FallingFriction, PolachReduction, SlopeReduction};
pub use stick::{StickingContact, relaxation_length};
pub use table::{CREEP_TABLE, CreepTable, Maker, Provenance};

use super::Material;
use crate::{Dual, Scalar};
use error::out_of_range;
use fastsim::{Grid, Strip};

/// How creep forces are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CreepLaw {
    /// Kalker's linear theory, without a friction limit.
    Linear,
    /// Shen, Hedrick and Elkins: the linear force under a friction limit, for little spin; gives no moment.
    ShenHedrickElkins,
    /// Polach's closed form; gives no moment.
    Polach,
    /// Kalker's simplified theory with `nx` elements along each of `ny` strips.
    Fastsim { nx: usize, ny: usize },
    /// Kalker's full theory, from a table.
    Table,
}

impl CreepLaw {
    /// The names that `named` knows.
    pub const NAMES: [&'static str; 5] = ["linear", "shen_hedrick_elkins", "polach", "fastsim", CreepTable::NAME];

    /// The law of a name; `nx` and `ny` are for those that divide the patch.
    pub fn named(name: &str, [nx, ny]: [usize; 2]) -> Option<Self> {
        let laws = [Self::Linear, Self::ShenHedrickElkins, Self::Polach, Self::Fastsim { nx, ny }, Self::Table];
        laws.into_iter().find(|law| law.name() == name)
    }

    /// The name, as in files and in Python.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::ShenHedrickElkins => "shen_hedrick_elkins",
            Self::Polach => "polach",
            Self::Fastsim { .. } => "fastsim",
            Self::Table => CreepTable::NAME,
        }
    }
}

impl Default for CreepLaw {
    fn default() -> Self {
        Self::Fastsim { nx: 16, ny: 16 }
    }
}

/// One rolling contact patch.
#[derive(Clone, Copy, Debug, Default)]
pub struct RollingContact<S> {
    /// Semi-axes along and across the rolling direction, m.
    pub a: S,
    pub b: S,
    /// Normal force, N, positive.
    pub normal_force: S,
    /// Friction coefficient.
    pub friction: S,
    /// Longitudinal and lateral creepage, and spin (1/m) about the z axis (down).
    pub xi: S,
    pub eta: S,
    pub phi: S,
}

/// A creep law made ready for one material.
///
/// ```
/// use klingel_physics::contact::{CreepForce, CreepLaw, Material};
/// use klingel_physics::contact::creep::RollingContact;
/// let law = CreepForce::new(CreepLaw::default(), &Material::STEEL).unwrap();
/// let patch = RollingContact { a: 6e-3, b: 4e-3, normal_force: 5e4, friction: 0.3, xi: 1e-3, eta: 0.0, phi: 0.0 };
/// let [fx, fy, mz] = law.force(&patch);
/// assert!(fx < -5e3 && fx > -1.5e4 && fy == 0.0 && mz.abs() < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct CreepForce {
    law: CreepLaw,
    options: CreepOptions,
    shear_modulus: f64,
    kalker: Kalker,
    grid: Grid,
}

impl CreepForce {
    /// The law as published, without options.
    ///
    /// # Errors
    /// No elements or more than `MOST_ELEMENTS` either way; Poisson's ratio outside 0 to 0.5, or not the table's.
    pub fn new(law: CreepLaw, material: &Material) -> Result<Self, CreepError> {
        Self::with_options(law, CreepOptions::default(), material)
    }

    /// The law with its options.
    ///
    /// # Errors
    /// Those of `new`; options of another law or out of their range.
    pub fn with_options(law: CreepLaw, options: CreepOptions, material: &Material) -> Result<Self, CreepError> {
        options.check(law.name())?;
        if !(0.0..=0.5).contains(&material.poisson) {
            return Err(out_of_range("Poisson's ratio", material.poisson, [0.0, 0.5], "steel has 0.28"));
        }
        let (nx, ny) = if let CreepLaw::Fastsim { nx, ny } = law { (nx, ny) } else { (1, 1) };
        let most = MOST_ELEMENTS as f64;
        if let Some(&n) = [nx, ny].iter().find(|&&n| n == 0 || n > MOST_ELEMENTS) {
            return Err(out_of_range("number of FASTSIM elements", n as f64, [1.0, most], "16 x 16 is usual"));
        }
        if law == CreepLaw::Table {
            CreepTable::built_in().check(material.poisson)?;
        }
        let (kalker, grid) = (Kalker::new(material.poisson), Grid::new(nx, ny));
        Ok(Self { law, options, shear_modulus: material.shear_modulus(), kalker, grid })
    }

    /// [Fx, Fy, Mz] on the wheel, N and N m, in the axes of the contact plane (x forward, y right, z down).
    pub fn force<S: Scalar>(&self, c: &RollingContact<S>) -> [S; 3] {
        // A narrow dual pass and the chain rule: wide duals would run every strip with all their slopes.
        S::lift_n_lazy(
            [c.a, c.b, c.normal_force, c.friction, c.xi, c.eta, c.phi],
            |x| self.evaluate(x),
            |x| {
                let f = self.evaluate(core::array::from_fn(|i| Dual::<7>::variable(x[i], i)));
                (f.map(|f| f.value), f.map(|f| f.slope))
            },
        )
    }

    /// The same forces with slopes for linearly implicit steps: over the creepages along and across those of the linear
    /// theory, scaled as far as friction has lowered its force; none over the rest. A slope of the law itself vanishes in
    /// sliding, and a step that trusts it leaps across all of adhesion to sliding back; such a secant brings it to rest.
    pub fn force_with_secants<S: Scalar>(&self, c: &RollingContact<S>) -> [S; 3] {
        S::lift_n_lazy(
            [c.a, c.b, c.normal_force, c.friction, c.xi, c.eta, c.phi],
            |x| self.evaluate(x),
            |x| {
                let force = self.evaluate(x);
                let [a, b, normal_force, friction, xi, eta, phi] = x;
                let c = RollingContact { a, b, normal_force, friction, xi, eta, phi };
                let [x, y, _] = linear::linear(&self.kalker, self.shear_modulus, &c);
                // a newton on both keeps the whole slope where there is no creepage
                let share = ((force[0].hypot(force[1]) + 1.0) / (x.hypot(y) + 1.0)).min(1.0);
                let [c11, c22, ..] = self.kalker.at(a / b).map(|c| -share * self.shear_modulus * a * b * c);
                let mut slopes = [[0.0; 7]; 3];
                (slopes[0][4], slopes[1][5]) = (c11, c22);
                (force, slopes)
            },
        )
    }

    /// G a b C11 \[N\]: longitudinal force over creepage of a patch in adhesion.
    pub fn stiffness<S: Scalar>(&self, a: S, b: S) -> S {
        let [c11, ..] = self.kalker.at(a / b);
        a * b * c11 * self.shear_modulus
    }

    fn evaluate<T: Strip>(&self, [a, b, normal_force, friction, xi, eta, phi]: [T; 7]) -> [T; 3] {
        let c = RollingContact { a, b, normal_force, friction, xi, eta, phi };
        let (kalker, g) = (&self.kalker, self.shear_modulus);
        match self.law {
            CreepLaw::Linear => linear::linear(kalker, g, &c),
            CreepLaw::ShenHedrickElkins => shen::shen_hedrick_elkins(kalker, g, &c),
            CreepLaw::Polach => {
                let full = PolachReduction { adhesion: 1.0, slip: 1.0 };
                polach::polach(kalker, g, self.options.reduction.unwrap_or(full), &c)
            }
            CreepLaw::Fastsim { .. } => {
                let (bound, CreepOptions { slope, blended, .. }) = (fastsim::bound(&c), self.options);
                let stiffness = flexibility::stiffness(kalker, g, slope, blended, &c, bound);
                fastsim::fastsim(&self.grid, &stiffness, bound, &c)
            }
            CreepLaw::Table => CreepTable::built_in().force(kalker, g, &c),
        }
    }
}
