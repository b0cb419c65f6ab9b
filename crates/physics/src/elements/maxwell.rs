//! Damper with a spring in series (Maxwell), with an optional blow-off: its force is a state.

use crate::Scalar;

/// F' = k (u' - v(F)): the spring k stretches by what the damper does not follow.
/// v(F) = F/c up to the blow-off force, then the steeper (|F| - Fb)/c2 + Fb/c.
///
/// ```
/// use klingel_physics::elements::Maxwell;
/// let d = Maxwell { stiffness: 8e6, damping: 2e5, blow_off: None };
/// assert_eq!(d.rate(0.0, 0.1), 8e5);             // at first all spring
/// assert_eq!(d.rate(2e5 * 0.1, 0.1), 0.0);       // at last all damper
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maxwell {
    /// \[N/m\]
    pub stiffness: f64,
    /// \[N s/m\]
    pub damping: f64,
    pub blow_off: Option<BlowOff>,
}

/// Beyond `force` \[N\] the damper has `damping` \[N s/m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlowOff {
    pub force: f64,
    pub damping: f64,
}

impl Maxwell {
    /// Velocity of the damper \[m/s\] under the tensile force F \[N\].
    #[inline(always)]
    pub fn velocity<S: Scalar>(&self, force: S) -> S {
        let below = force / self.damping;
        match self.blow_off {
            None => below,
            Some(b) => {
                let excess = force - force.clamp(-b.force, b.force);
                below + excess * (1.0 / b.damping - 1.0 / self.damping)
            }
        }
    }

    /// F' \[N/s\] under the elongation rate u' \[m/s\].
    #[inline(always)]
    pub fn rate<S: Scalar>(&self, force: S, elongation_rate: S) -> S {
        (elongation_rate - self.velocity(force)) * self.stiffness
    }

    /// Elastic energy of the spring \[J\].
    pub fn stored<S: Scalar>(&self, force: S) -> S {
        force.square() * (0.5 / self.stiffness)
    }

    /// Power that the damper turns to heat \[W\].
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, force: S) -> S {
        force * self.velocity(force)
    }

    /// The pole k/c \[1/s\] that the integrator takes exactly.
    pub fn pole(&self) -> f64 {
        self.stiffness / self.damping
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blow_off_is_continuous_and_odd_and_dissipates() {
        let d = Maxwell { stiffness: 8e6, damping: 2e5, blow_off: Some(BlowOff { force: 12e3, damping: 1e4 }) };
        assert!((d.velocity(12e3) - 0.06).abs() < 1e-15);
        assert!((d.velocity(13e3) - (0.06 + 0.1)).abs() < 1e-12);
        for f in [-3e4, -1e3, 5.0, 2e4] {
            assert_eq!(d.velocity(-f), -d.velocity(f));
            assert!(d.dissipated(f) > 0.0);
        }
    }

    /// What the element takes up is stored in its spring or turned to heat, blown off or not.
    #[test]
    fn power_balances() {
        let d = Maxwell { stiffness: 8e6, damping: 2e5, blow_off: Some(BlowOff { force: 12e3, damping: 1e4 }) };
        for (f, rate) in [(5e3, 0.2), (2e4, 0.3), (-2e4, 0.1)] {
            let h = 1e-9;
            let grown = d.stored(f + h * d.rate(f, rate)) - d.stored(f - h * d.rate(f, rate));
            assert!((f * rate - grown / (2.0 * h) - d.dissipated(f)).abs() < 1e-4 * f.abs());
        }
    }
}
