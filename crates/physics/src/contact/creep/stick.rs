//! Creepage that needs way to build up: as a spring while a wheel stands, as the quasi-steady creepage while it rolls.
//! Derived in docs/theory/standstill.md.

use crate::Scalar;
use core::f64::consts::PI;

/// Rolling speed, in parts of the least speed, below which the creepage hardly fades.
const RESTING: f64 = 0.01;

/// Relaxation length 8 a/(3 pi) \[m\] of a patch with half length a: the linear force G a b C xi over the stiffness
/// 3 pi G b C/8 of the same patch against a shift as a whole.
pub fn relaxation_length<S: Scalar>(a: S) -> S {
    a * (8.0 / (3.0 * PI))
}

/// One wheel that may stick.
#[derive(Clone, Copy, Debug, Default)]
pub struct StickingContact<S> {
    /// Transient creepages along and across.
    pub creepage: [S; 2],
    /// Velocity of the wheel over the rail, along and across, and of rolling \[m/s\].
    pub slip: [S; 2],
    pub speed: S,
    /// Relaxation length sigma \[m\].
    pub length: S,
    /// The transient creepage xi_max at which the wheel slides.
    pub largest: S,
}

impl<S: Scalar> StickingContact<S> {
    /// Rates \[1/s\] of the transient creepages.
    ///
    /// sigma xi' = w - |V| xi - (w xi)+ xi/(xi_max max(|xi|, xi_max)). The last term keeps them near xi_max, so that a wheel
    /// pushed aside winds nothing up. It fades at speeds beyond `least` \[m/s\], where the quasi-steady creepage w/V is
    /// what remains; rolling slower than a hundredth of that fades too, so that nothing is lost at rest.
    ///
    /// ```
    /// use klingel_physics::contact::creep::StickingContact;
    /// let rolling =
    ///     StickingContact { creepage: [1e-3, 0.0], slip: [0.03, 0.0], speed: 30.0, length: 5e-3, largest: 0.02 };
    /// let [xi, eta] = rolling.rates(0.1);
    /// assert!(xi.abs() < 1e-4 && eta == 0.0); // creepage 0.03/30 is reached
    /// let held = StickingContact { slip: [0.0, 0.0], speed: 0.0, ..rolling };
    /// assert_eq!(held.rates(0.1), [0.0, 0.0]); // as a spring
    /// ```
    pub fn rates(&self, least: f64) -> [S; 2] {
        let [xi, eta] = self.creepage;
        let [rolling, resting] = self.fading(least);
        let size = (xi.square() + eta.square()).sqrt();
        let winding = (self.slip[0] * xi + self.slip[1] * eta).positive();
        let fading = rolling + winding * resting / (self.largest * size.max(self.largest));
        [0, 1].map(|i| (self.slip[i] - fading * self.creepage[i]) / self.length)
    }

    /// The same with slopes for linearly implicit steps, over creepages and slip alone: those of a wheel that slides
    /// already, sigma xi' = w - (|V| + |w|/xi_max) xi, as a step may bring it there from rest.
    pub fn rates_with_secants(&self, least: f64) -> [S; 2] {
        let Self { creepage: [xi, eta], slip: [w_x, w_y], speed, length, largest } = *self;
        let contact = |[xi, eta, w_x, w_y, speed, length, largest]: [f64; 7]| StickingContact {
            creepage: [xi, eta],
            slip: [w_x, w_y],
            speed,
            length,
            largest,
        };
        S::lift_n_lazy(
            [xi, eta, w_x, w_y, speed, length, largest],
            |x| contact(x).rates(least),
            |x| {
                let contact = contact(x);
                let [rolling, resting] = contact.fading(least);
                let fading = rolling + contact.slip[0].hypot(contact.slip[1]) * resting / contact.largest;
                let mut slopes = [[0.0; 7]; 2];
                for i in 0..2 {
                    slopes[i][i] = -fading / contact.length;
                    slopes[i][2 + i] = 1.0 / contact.length;
                }
                (contact.rates(least), slopes)
            },
        )
    }

    /// |V| \[m/s\], nil at rest, and the part of it that is rest.
    fn fading(&self, least: f64) -> [S; 2] {
        let square = self.speed.square();
        let rolling = square / (square + (RESTING * least) * (RESTING * least)).sqrt();
        [rolling, (square / (least * least) + 1.0).recip()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGEST: f64 = 0.02;

    /// Euler in steps of 0.1 ms over some seconds, or over metres at 1 m/s.
    fn after(time: f64, mut creepage: [f64; 2], direction: [f64; 2], speed: f64) -> [f64; 2] {
        let (length, dt) = (5e-3, 1e-4);
        for _ in 0..(time / dt).round() as usize {
            let rates = StickingContact { creepage, slip: direction, speed, length, largest: LARGEST }.rates(0.1);
            (0..2).for_each(|i| creepage[i] += dt * rates[i]);
        }
        creepage
    }

    #[test]
    fn a_standing_wheel_shifts_as_a_spring_and_comes_back() {
        let there = after(10e-3, [0.0; 2], [1e-4, -2e-4], 0.0);
        assert!((there[0] - 1e-6 / 5e-3).abs() < 1e-6 && (there[1] + 2e-6 / 5e-3).abs() < 1e-6, "{there:?}");
        let back = after(10e-3, there, [-1e-4, 2e-4], 0.0);
        assert!(back.iter().all(|x| x.abs() < 1e-6), "{back:?}");
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
    /// Values are the same to the bit, and so are the slopes of a wheel that slides as far as it may.
    #[test]
    fn secants_change_slopes_only() {
        use crate::Dual;
        for creepage in [[2e-3, -1e-3], [0.0, 0.0], [-0.05, 0.01]] {
            let x = [creepage[0], creepage[1], 0.02, -0.01, 0.05, 4e-3, 8e-3];
            let contact = |x: [f64; 7]| StickingContact {
                creepage: [x[0], x[1]],
                slip: [x[2], x[3]],
                speed: x[4],
                length: x[5],
                largest: x[6],
            };
            let d: [Dual<2>; 7] =
                core::array::from_fn(|i| if i < 2 { Dual::variable(x[i], i) } else { Dual::constant(x[i]) });
            let dual = StickingContact {
                creepage: [d[0], d[1]],
                slip: [d[2], d[3]],
                speed: d[4],
                length: d[5],
                largest: d[6],
            };
            let (exact, secant) = (dual.rates(0.1), dual.rates_with_secants(0.1));
            assert_eq!(exact.map(|r| r.value), contact(x).rates(0.1));
            assert_eq!(secant.map(|r| r.value), contact(x).rates(0.1));
            for i in 0..2 {
                assert!(secant[i].slope[i] < 0.0 && secant[i].slope[1 - i] == 0.0);
                assert!(secant[i].slope[i] <= exact[i].slope[i] + 1e-9 || creepage[0] > 0.0);
            }
        }
    }
}
