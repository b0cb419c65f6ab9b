//! Bump stop: force over deflection as a measured curve, odd, continued with its last slope.

use crate::Scalar;
use thiserror::Error;

/// Piecewise linear, from (0, F0) upwards; the same with the other sign below.
///
/// ```
/// use klingel_physics::elements::Stop;
/// let s = Stop::new(&[0.0, 0.025, 0.035], &[0.0, 0.0, 2000.0]).unwrap();
/// assert_eq!(s.force(0.02), 0.0);
/// assert!((s.force(0.045) - 4000.0).abs() < 1e-9 && (s.force(-0.045) + 4000.0).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    deflection: Vec<f64>,
    force: Vec<f64>,
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum StopError {
    #[error("a stop needs at least two points and as many forces as deflections; it has {deflections} and {forces}")]
    Count { deflections: usize, forces: usize },
    #[error("stop deflections must start at 0 and rise: point {index} is {value} m")]
    Order { index: usize, value: f64 },
    #[error("stop forces must not fall: point {index} is {value} N")]
    Falling { index: usize, value: f64 },
}

impl Stop {
    /// Deflections \[m\] from zero upwards, forces \[N\] not falling.
    pub fn new(deflection: &[f64], force: &[f64]) -> Result<Self, StopError> {
        if deflection.len() < 2 || deflection.len() != force.len() {
            return Err(StopError::Count { deflections: deflection.len(), forces: force.len() });
        }
        for (index, &value) in deflection.iter().enumerate() {
            let rises = if index == 0 { value == 0.0 } else { value > deflection[index - 1] };
            if !rises {
                return Err(StopError::Order { index, value });
            }
        }
        for (index, &value) in force.iter().enumerate() {
            let falls = if index == 0 { value != 0.0 } else { value < force[index - 1] };
            if falls || !value.is_finite() {
                return Err(StopError::Falling { index, value });
            }
        }
        Ok(Self { deflection: deflection.to_vec(), force: force.to_vec() })
    }

    /// Resisting force \[N\], positive for a positive deflection \[m\].
    #[inline]
    pub fn force<S: Scalar>(&self, deflection: S) -> S {
        deflection.lift(|u| {
            let x = u.abs();
            let last = self.deflection.len() - 2;
            let i = self.deflection[1..].iter().position(|&d| x < d).unwrap_or(last).min(last);
            let (x0, x1) = (self.deflection[i], self.deflection[i + 1]);
            let slope = (self.force[i + 1] - self.force[i]) / (x1 - x0);
            let f = self.force[i] + slope * (x - x0);
            (if u < 0.0 { -f } else { f }, slope)
        })
    }
}

impl Stop {
    /// Elastic energy at a deflection \[J\]: the area under the curve.
    pub fn stored<S: Scalar>(&self, deflection: S) -> S {
        deflection.lift(|u| {
            let (x, force) = (u.abs(), self.force(u));
            let inside = self.deflection.partition_point(|&d| d < x).max(1);
            let area =
                |i: usize| 0.5 * (self.force[i] + self.force[i - 1]) * (self.deflection[i] - self.deflection[i - 1]);
            let last = 0.5 * (force.abs() + self.force[inside - 1]) * (x - self.deflection[inside - 1]);
            ((1..inside).map(area).sum::<f64>() + last, force)
        })
    }

    /// How far a deflection \[m\] lies from the nearest corner of the curve, over the width of the interval behind it.
    pub fn kink(&self, deflection: f64) -> Option<f64> {
        let slope = |i: usize| (self.force[i + 1] - self.force[i]) / (self.deflection[i + 1] - self.deflection[i]);
        let corner = |i: &usize| slope(*i) != slope(i - 1);
        let off = |i: usize| {
            let width = self.deflection[i] - self.deflection[i - 1];
            (deflection.abs() - self.deflection[i]).abs() / width
        };
        (1..self.deflection.len() - 1).filter(corner).map(off).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_where_the_stiffness_jumps() {
        let s = Stop::new(&[0.0, 0.02, 0.03, 0.04], &[0.0, 0.0, 10.0, 20.0]).unwrap();
        assert!((s.kink(-0.021).unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(Stop::new(&[0.0, 1.0], &[0.0, 1.0]).unwrap().kink(0.3), None);
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let s = Stop::new(&[0.0, 0.02, 0.03, 0.04], &[0.0, 10.0, 500.0, 2000.0]).unwrap();
        assert_eq!(s.stored(0.0), 0.0);
        for u in [-0.05, -0.01, 0.005, 0.025, 0.035, 0.06] {
            let slope = (s.stored(u + 1e-7) - s.stored(u - 1e-7)) / 2e-7;
            assert!((slope - s.force(u)).abs() < 1e-4, "{u}: {slope}");
            assert_eq!(s.stored(crate::Dual::<1>::variable(u, 0)).slope[0], s.force(u));
        }
    }

    #[test]
    fn bad_curves_are_named() {
        assert!(matches!(Stop::new(&[0.0], &[0.0]), Err(StopError::Count { .. })));
        assert!(matches!(Stop::new(&[0.0, 0.0], &[0.0, 1.0]), Err(StopError::Order { index: 1, .. })));
        assert!(matches!(Stop::new(&[0.0, 1.0, 2.0], &[0.0, 2.0, 1.0]), Err(StopError::Falling { index: 2, .. })));
    }
}
