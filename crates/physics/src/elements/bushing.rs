//! Spring and damper in parallel in three translations and three rotations (Kelvin-Voigt), with a preload.

use crate::Scalar;
use crate::math::Vec3;

/// F = preload - k u - c u', on the second body, resolved in the frame of the first.
///
/// ```
/// use klingel_physics::{elements::Bushing, math::Vec3};
/// let b = Bushing { stiffness: [1e6, 0.0, 0.0], preload: [0.0, 0.0, -5e4], ..Bushing::default() };
/// let f = b.force::<f64>(Vec3::constant([1e-3, 0.0, 0.0]), Vec3::zero());
/// assert_eq!(f.0, [-1e3, 0.0, -5e4]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bushing {
    /// \[N/m\]
    pub stiffness: [f64; 3],
    /// \[N s/m\]
    pub damping: [f64; 3],
    /// \[N m/rad\]
    pub rotational_stiffness: [f64; 3],
    /// \[N m s/rad\]
    pub rotational_damping: [f64; 3],
    /// \[N\]
    pub preload: [f64; 3],
}

impl Bushing {
    /// Force on the second body \[N\] from deflection u \[m\] and its rate \[m/s\].
    #[inline(always)]
    pub fn force<S: Scalar>(&self, u: Vec3<S>, rate: Vec3<S>) -> Vec3<S> {
        Vec3([0, 1, 2].map(|i| S::constant(self.preload[i]) - u.0[i] * self.stiffness[i] - rate.0[i] * self.damping[i]))
    }

    /// Torque on the second body \[N m\] from the small relative rotation \[rad\] and its rate.
    #[inline(always)]
    pub fn torque<S: Scalar>(&self, angle: Vec3<S>, rate: Vec3<S>) -> Vec3<S> {
        Vec3([0, 1, 2].map(|i| -(angle.0[i] * self.rotational_stiffness[i]) - rate.0[i] * self.rotational_damping[i]))
    }

    /// Whether the three rotations have any law.
    pub fn turns(&self) -> bool {
        self.rotational_stiffness.iter().chain(&self.rotational_damping).any(|&k| k != 0.0)
    }
}
