//! Creepage that needs way to build up: as a spring while a wheel stands, as the quasi-steady creepage while it rolls.
//! Derived in docs/theory/standstill.md.

use crate::Scalar;
use core::f64::consts::PI;

/// Transient creepages stay below this: beyond what any patch needs to slide (3 mu N/(G a b C11) is 0.02 for the largest
/// loads), so that a wheel pushed aside winds nothing up.
const LARGEST: f64 = 0.03;
/// Rolling speed, in parts of the least speed, below which the creepage hardly fades.
const RESTING: f64 = 0.01;

/// Relaxation length 8 a/(3 pi) \[m\] of a patch with half length a: the linear force G a b C xi over the stiffness
/// 3 pi G b C/8 of the same patch against a shift as a whole.
pub fn relaxation_length<S: Scalar>(a: S) -> S {
    a * (8.0 / (3.0 * PI))
}

/// Rates \[1/s\] of the transient creepages (along, across) of a wheel.
///
/// sigma xi' = w - |V| xi - (w xi)+ xi/xi_max^2: `slip` w of the wheel over the rail and rolling speed V \[m/s\],
/// `length` sigma \[m\]. The last term limits them; it and all rolling slower than a hundredth of `least` \[m/s\] fade so
/// that the quasi-steady creepage w/V is what remains at speed, and nothing fades at rest.
///
/// ```
/// use klingel_physics::contact::creep::stick_rates;
/// let [xi, eta] = stick_rates([1e-3, 0.0], [0.03, 0.0], 30.0, 5e-3, 0.1);
/// assert!(xi.abs() < 1e-4 && eta == 0.0); // creepage 0.03/30 is reached
/// assert_eq!(stick_rates([1e-3, 2e-3], [0.0, 0.0], 0.0, 5e-3, 0.1), [0.0, 0.0]); // a spring that is held
/// ```
pub fn stick_rates<S: Scalar>(creepage: [S; 2], slip: [S; 2], speed: S, length: S, least: f64) -> [S; 2] {
    let square = speed.square();
    let rolling = square / (square + (RESTING * least) * (RESTING * least)).sqrt();
    let resting = (square / (least * least) + 1.0).recip();
    let winding = (slip[0] * creepage[0] + slip[1] * creepage[1]).positive();
    let fading = rolling + winding * resting / (LARGEST * LARGEST);
    [0, 1].map(|i| (slip[i] - fading * creepage[i]) / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Euler in steps of length/50 of way.
    fn after(way: f64, mut creepage: [f64; 2], direction: [f64; 2], speed: f64) -> [f64; 2] {
        let (length, dt) = (5e-3, 1e-4);
        for _ in 0..(way / dt).round() as usize {
            let rates = stick_rates(creepage, direction, speed, length, 0.1);
            (0..2).for_each(|i| creepage[i] += dt * rates[i]);
        }
        creepage
    }

    #[test]
    fn a_standing_wheel_shifts_as_a_spring_and_comes_back() {
        let there = after(10e-3, [0.0; 2], [1e-4, -2e-4], 0.0);
        assert!((there[0] - 1e-6 / 5e-3).abs() < 1e-8 && (there[1] + 2e-6 / 5e-3).abs() < 1e-8, "{there:?}");
        let back = after(10e-3, there, [-1e-4, 2e-4], 0.0);
        assert!(back.iter().all(|x| x.abs() < 1e-8), "{back:?}");
    }

    #[test]
    fn a_wheel_pushed_aside_winds_nothing_up() {
        for angle in [0.0_f64, 0.7, 2.0] {
            let [x, y] = after(0.5, [0.0, 0.01], [angle.cos(), angle.sin()], 0.0);
            assert!((x.hypot(y) - LARGEST).abs() < 1e-6 && (y.atan2(x) - angle).abs() < 1e-6, "{x} {y}");
        }
    }

    #[test]
    fn a_rolling_wheel_comes_to_the_quasi_steady_creepage() {
        let [x, y] = after(0.1, [0.0; 2], [2e-3, -1e-3], 1.0);
        assert!((x - 2e-3).abs() < 1e-6 && (y + 1e-3).abs() < 1e-6, "{x} {y}");
        // after one relaxation length 1 - 1/e of it is there
        let [x, _] = after(5e-3, [0.0; 2], [2e-3, -1e-3], 1.0);
        assert!((x / 2e-3 - 0.632).abs() < 0.01, "{x}");
    }
}
