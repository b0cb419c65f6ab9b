//! Wheel-rail contact: profile -> geometry of the pair -> elastic normal contact (tables) -> creep forces.
//! Everything is written for the right wheel; the left one is its mirror image (y -> -y, roll -> -roll).

mod build;
mod bytes;
pub mod creep;
pub mod geometry;
pub mod hertz;
mod influence;
mod level;
pub mod loaded;
mod normal;
mod penetration;
mod points;
pub mod profile;
pub mod rigid;
mod spline;
pub mod table;
#[cfg(test)]
mod tests;
mod view;
pub mod zones;

pub use creep::{CreepForce, CreepLaw, RollingContact};
pub use geometry::PairGeometry;
pub use loaded::LoadedState;
pub use normal::{NormalContact, PatchDetail};
pub use profile::Profile;
pub use rigid::{RigidContact, RigidState, RigidWheelset};
pub use table::{ContactTable, OutsideTable, Patch};
pub use view::{ContactPoint, WheelsetContact};
pub use zones::Zone;

/// What a profile, a pair or a table can be refused for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    #[error("{what}: {count} points given, at least {least} are needed; give more points of the profile")]
    TooFewPoints { what: String, count: usize, least: usize },
    #[error("{what}: y has {y} and z has {z} values; give one z for every y")]
    UnequalLengths { what: String, y: usize, z: usize },
    #[error("{what}: point {index} is (y {y}, z {z}); every coordinate must be a finite number in metres")]
    NotFinite { what: String, index: usize, y: f64, z: f64 },
    #[error("{what}: y does not rise steadily at point {index} (y = {y} m); sort the points or cut overhanging parts")]
    NotMonotone { what: String, index: usize, y: f64 },
    #[error("{what}: the profile is {width} m wide; profiles are given in metres (millimetres were probably meant)")]
    WrongUnits { what: String, width: f64 },
    #[error("{what}: {value} is outside {least} to {most}; {remedy}")]
    OutOfRange { what: String, value: f64, least: f64, most: f64, remedy: String },
    #[error("wheel and rail never meet at a shift of {shift} m and a roll of {roll} rad; check profiles and gauge")]
    NoContact { shift: f64, roll: f64 },
    #[error(transparent)]
    OutsideTable(#[from] OutsideTable),
}

/// Elastic constants of wheel and rail, which are taken as equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Material {
    /// Steel as in the Manchester benchmark examples of CONTACT: E 210 GPa, nu 0.28.
    pub const STEEL: Self = Self { youngs_modulus: 2.1e11, poisson: 0.28 };

    /// Shear modulus E / (2 (1 + nu)), Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson))
    }
    /// Plane-strain modulus of the pair E / (2 (1 - nu^2)), Pa.
    pub fn pair_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 - self.poisson * self.poisson))
    }
}
