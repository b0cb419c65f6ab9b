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

    /// Elastic energy \[J\] with zero at rest in the design position. A rotation about one axis by theta, which the law
    /// sees as sin theta, stores k (1 - cos theta); about several axes the law has a potential where their stiffnesses
    /// are equal, else to second order in the angles.
    pub fn stored<S: Scalar>(&self, u: Vec3<S>, angle: Vec3<S>) -> S {
        (0..3).fold(S::zero(), |sum, i| {
            let sine = angle.0[i].square();
            let lifted = sine / ((S::one() - sine).sqrt() + 1.0);
            sum + (u.0[i] * (0.5 * self.stiffness[i]) - self.preload[i]) * u.0[i]
                + lifted * self.rotational_stiffness[i]
        })
    }

    /// Power that turns to heat \[W\].
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, rate: Vec3<S>, spin: Vec3<S>) -> S {
        (0..3).fold(S::zero(), |sum, i| {
            sum + rate.0[i].square() * self.damping[i] + spin.0[i].square() * self.rotational_damping[i]
        })
    }

    /// Whether it turns anything to heat.
    pub fn damps(&self) -> bool {
        self.damping.iter().chain(&self.rotational_damping).any(|&c| c != 0.0)
    }

    /// Whether the three rotations have any law.
    pub fn turns(&self) -> bool {
        self.rotational_stiffness.iter().chain(&self.rotational_damping).any(|&k| k != 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Bushing = Bushing {
        stiffness: [3e6, 1e6, 5e5],
        damping: [2e3, 0.0, 4e3],
        rotational_stiffness: [2e4, 0.0, 1e4],
        rotational_damping: [0.0, 30.0, 0.0],
        preload: [0.0, 100.0, -5e4],
    };

    /// What the force takes up is stored or turned to heat.
    #[test]
    fn power_balances() {
        let (u, rate) = (Vec3([1e-3, -2e-3, 4e-3]), Vec3([0.1, 0.2, -0.3]));
        let h = 1e-6;
        let grown = LAW.stored(u + rate * h, Vec3::zero()) - LAW.stored(u - rate * h, Vec3::zero());
        let taken = -LAW.force(u, rate).dot(rate);
        assert!((taken - grown / (2.0 * h) - LAW.dissipated(rate, Vec3::zero())).abs() < 1e-6 * taken.abs());
    }

    /// A turn about one axis: the torque sees the sine, the energy is k (1 - cos).
    #[test]
    fn a_rotation_is_stored_exactly() {
        let (theta, spin) = (0.3_f64, 0.7);
        let turned = |theta: f64| Vec3([theta.sin(), 0.0, 0.0]);
        assert!((LAW.stored(Vec3::zero(), turned(theta)) - 2e4 * (1.0 - theta.cos())).abs() < 1e-9);
        let rate = Vec3([0.0, spin, 0.0]);
        let (taken, lost) = (-LAW.torque(Vec3::zero(), rate).dot(rate), LAW.dissipated(Vec3::zero(), rate));
        assert!((taken - lost).abs() < 1e-12 * lost);
    }
}
