//! Profiles of wheels and rails as densely sampled curves z(y) with slopes.
//! Wheel: y from the tape circle, + to the field side, z = radius increment. Rail: y from its axis, z down from its top.

mod curves;
mod rails;
mod wheels;

/// Spacing of the samples along the curve, m.
pub(super) const STEP: f64 = 5e-5;

/// A profile z(y), metres, y rising; the canonical rail is the right one, its gauge side at negative y.
///
/// Standard ones: [`s1002`](Self::s1002), [`cone`](Self::cone), [`rail_60e1`](Self::rail_60e1),
/// [`rail_54e1`](Self::rail_54e1), [`rail_uic60`](Self::rail_uic60); measured ones: [`from_points`](Self::from_points).
///
/// ```
/// use klingel_physics::contact::Profile;
/// let wheel = Profile::s1002();
/// let (z, slope) = wheel.at(0.0).unwrap();
/// assert!(z.abs() < 1e-12 && (slope + 0.033585).abs() < 1e-6);
/// assert!(wheel.at(0.08).is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub y: Vec<f64>,
    pub z: Vec<f64>,
    /// dz/dy.
    pub slope: Vec<f64>,
}

impl Profile {
    /// (z, dz/dy) at `y`, cubic between the samples; none outside the profile.
    pub fn at(&self, y: f64) -> Option<(f64, f64)> {
        let n = self.y.len();
        if !(y >= self.y[0] && y <= self.y[n - 1]) {
            return None;
        }
        let k = self.y.partition_point(|&p| p <= y).clamp(1, n - 1) - 1;
        Some(self.within(k, y))
    }

    /// (z, dz/dy) at `y` in interval `k`.
    pub(super) fn within(&self, k: usize, y: f64) -> (f64, f64) {
        let (h, dz) = (self.y[k + 1] - self.y[k], self.z[k + 1] - self.z[k]);
        let (t, chord) = ((y - self.y[k]) / h, dz / h);
        let (m0, m1) = (self.slope[k] - chord, self.slope[k + 1] - chord);
        let z = self.z[k] + t * dz + h * t * (1.0 - t) * (m0 * (1.0 - t) - m1 * t);
        (z, chord + m0 * (1.0 - t) * (1.0 - 3.0 * t) + m1 * t * (3.0 * t - 2.0))
    }

    /// The same curve with other samples: each (y, z) is mapped to a new one, y still rising.
    pub(super) fn map(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let points: Vec<_> = (0..self.y.len()).map(|i| f([self.y[i], self.z[i], self.slope[i]])).collect();
        let column = |c: usize| points.iter().map(|p| p[c]).collect();
        Self { y: column(0), z: column(1), slope: column(2) }
    }
}
