//! Running resistance of a vehicle on straight level track: A + B v + C v^2, the last term against the wind.
//! A turns its sign within a hundredth of a metre a second, so that a vehicle at rest is a smooth state.

use crate::Scalar;

/// R = A v/|v| + B v + C |u| u with the speed u = v + headwind through the air.
///
/// ```
/// use klingel_physics::drives::RunningResistance;
/// let calm = RunningResistance { constant: 400.0, linear: 20.0, quadratic: 3.0, headwind: 0.0 };
/// assert!((calm.force(20.0_f64) - (400.0 + 20.0 * 20.0 + 3.0 * 20.0 * 20.0)).abs() < 1e-4);
/// assert_eq!(calm.force(0.0_f64), 0.0);
/// let blown = RunningResistance { headwind: 10.0, ..calm };
/// assert!((blown.force(20.0_f64) - calm.force(20.0) - 3.0 * (30.0 * 30.0 - 20.0 * 20.0)).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningResistance {
    /// A \[N\]
    pub constant: f64,
    /// B \[N s/m\]
    pub linear: f64,
    /// C \[N s2/m2\]
    pub quadratic: f64,
    /// Of the air along the track, positive against the vehicle \[m/s\].
    pub headwind: f64,
}

/// Speed within which A changes its sign \[m/s\].
const REVERSAL: f64 = 0.01;

impl RunningResistance {
    /// Against the motion at speed v \[m/s\], positive when it brakes a vehicle that runs forward \[N\].
    #[inline]
    pub fn force<S: Scalar>(&self, speed: S) -> S {
        let air = speed + self.headwind;
        let direction = speed / (speed.square() + REVERSAL * REVERSAL).sqrt();
        direction * self.constant + speed * self.linear + air.abs() * air * self.quadratic
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    #[test]
    fn it_is_odd_in_still_air_and_its_dual_slope_is_the_difference_quotient() {
        let law = RunningResistance { constant: 400.0, linear: 20.0, quadratic: 3.0, headwind: 0.0 };
        let blown = RunningResistance { headwind: -5.0, ..law };
        for v in [0.003, 4.9, 30.0] {
            assert_eq!(law.force(-v), -law.force(v));
            assert!(law.force(v) * v > 0.0);
            let d = blown.force(Dual::<1>::variable(v, 0));
            let slope = (blown.force(v + 1e-6) - blown.force(v - 1e-6)) / 2e-6;
            assert!(d.value == blown.force(v) && (d.slope[0] - slope).abs() < 1e-5 * slope.abs());
        }
    }
}
