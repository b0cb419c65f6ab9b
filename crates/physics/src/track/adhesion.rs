//! Friction of both rails along the track: straight lines between points, the first and last value held beyond them.
//! It is the coefficient of a standing contact; laws of falling friction lower it with the slip velocity.

use crate::Scalar;
use thiserror::Error;

/// Coefficient of friction over arc length, one line a rail.
///
/// ```
/// use klingel_physics::track::Adhesion;
/// let wet = Adhesion::new(&[100.0, 110.0], &[0.35, 0.08], &[0.35, 0.35]).unwrap();
/// assert!((wet.at(105.0_f64, -1.0) - 0.215).abs() < 1e-15);
/// assert_eq!((wet.at(0.0, -1.0), wet.at(500.0, -1.0), wet.at(500.0, 1.0)), (0.35, 0.08, 0.35));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Adhesion {
    s: Vec<f64>,
    left: Vec<f64>,
    right: Vec<f64>,
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum AdhesionError {
    #[error("adhesion needs as many values of each rail as places; it has {places} places, {left} left, {right} right")]
    Count { places: usize, left: usize, right: usize },
    #[error("places of adhesion must rise: place {index} is {value} m")]
    Order { index: usize, value: f64 },
    #[error("friction must lie between 0 and 1.5: place {index} has {value}")]
    Friction { index: usize, value: f64 },
}

/// No dry rail has more.
const FRICTION_MAX: f64 = 1.5;

impl Adhesion {
    /// Places \[m\] that rise, and the friction of both rails there.
    pub fn new(s: &[f64], left: &[f64], right: &[f64]) -> Result<Self, AdhesionError> {
        if s.is_empty() || left.len() != s.len() || right.len() != s.len() {
            return Err(AdhesionError::Count { places: s.len(), left: left.len(), right: right.len() });
        }
        for (index, &value) in s.iter().enumerate() {
            if !value.is_finite() || (index > 0 && value <= s[index - 1]) {
                return Err(AdhesionError::Order { index, value });
            }
            for value in [left[index], right[index]] {
                if !(value > 0.0 && value <= FRICTION_MAX) {
                    return Err(AdhesionError::Friction { index, value });
                }
            }
        }
        Ok(Self { s: s.to_vec(), left: left.to_vec(), right: right.to_vec() })
    }

    /// Friction at arc length `s` \[m\] of the left rail (`sign` negative) or the right one.
    #[inline]
    pub fn at<S: Scalar>(&self, s: S, sign: f64) -> S {
        let values = if sign < 0.0 { &self.left } else { &self.right };
        s.lift(|s| {
            let next = self.s.partition_point(|&place| place <= s);
            if next == 0 || next == self.s.len() {
                return (values[next.min(self.s.len() - 1)], 0.0);
            }
            let slope = (values[next] - values[next - 1]) / (self.s[next] - self.s[next - 1]);
            (values[next - 1] + slope * (s - self.s[next - 1]), slope)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    #[test]
    fn it_is_continuous_and_its_dual_slope_is_the_line() {
        let a = Adhesion::new(&[10.0, 14.0, 20.0], &[0.4, 0.1, 0.3], &[0.2; 3]).unwrap();
        for s in [10.0, 14.0, 20.0] {
            assert!((a.at(s - 1e-9, -1.0) - a.at(s + 1e-9, -1.0)).abs() < 1e-9);
        }
        let d = a.at(Dual::<1>::variable(11.0, 0), -1.0);
        assert!((d.value - 0.325).abs() < 1e-15 && (d.slope[0] + 0.075).abs() < 1e-15);
        assert_eq!(a.at(Dual::<1>::variable(25.0, 0), -1.0).slope[0], 0.0);
        assert_eq!(a.at(12.0, 1.0), 0.2);
    }

    #[test]
    fn bad_lines_are_named() {
        assert!(matches!(Adhesion::new(&[0.0], &[0.3], &[]), Err(AdhesionError::Count { right: 0, .. })));
        assert!(matches!(Adhesion::new(&[0.0, 0.0], &[0.3; 2], &[0.3; 2]), Err(AdhesionError::Order { index: 1, .. })));
        assert!(matches!(Adhesion::new(&[0.0], &[0.3], &[0.0]), Err(AdhesionError::Friction { index: 0, .. })));
    }
}
