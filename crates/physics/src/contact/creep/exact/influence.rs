//! Displacement of the surface by a uniform traction on a rectangle: the integrals of Boussinesq and Cerruti.
//! Two equal half-spaces, displacement difference of the upper over the lower body, tractions on the upper body.

use core::f64::consts::PI;

/// Influence of one rectangle: displacement along x by a traction along x, along y by y, and along one by the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Influence {
    pub xx: f64,
    pub yy: f64,
    pub xy: f64,
}

impl Influence {
    /// At (x, y) from the middle of a rectangle with the sides `sides`, times the shear modulus.
    ///
    /// A point load p at the origin displaces the surfaces by [(1 - nu)/R + nu x^2/R^3] p/(pi G) along itself and by
    /// nu x y/R^3 p/(pi G) across. The integrals of 1/R, x^2/R^3 and x y/R^3 over the rectangle are the alternating
    /// sums over its corners of y ln(x + R) + x ln(y + R), y ln(x + R) and -R.
    pub fn of_rectangle(x: f64, y: f64, sides: [f64; 2], poisson: f64) -> Self {
        let mut sum = Self::default();
        for (i, j) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let (x, y) = (x + 0.5 * i * sides[0], y + 0.5 * j * sides[1]);
            // ln(x + R) = asinh(x/|y|) + ln|y|; the second part cancels between the two corners of the same y.
            let (along, across) = (y * (x / y.abs()).asinh(), x * (y / x.abs()).asinh());
            sum.xx += i * j * (along + (1.0 - poisson) * across);
            sum.yy += i * j * (across + (1.0 - poisson) * along);
            sum.xy -= i * j * poisson * x.hypot(y);
        }
        Self { xx: sum.xx / PI, yy: sum.yy / PI, xy: sum.xy / PI }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoint sum over the rectangle's n x n parts.
    fn summed(x: f64, y: f64, sides: [f64; 2], nu: f64, n: usize) -> Influence {
        let mut sum = Influence::default();
        for i in 0..n {
            for j in 0..n {
                let part = |k: usize, side: f64| ((k as f64 + 0.5) / n as f64 - 0.5) * side;
                let (dx, dy) = (x - part(i, sides[0]), y - part(j, sides[1]));
                let r = dx.hypot(dy);
                let weight = sides[0] * sides[1] / (n * n) as f64 / PI;
                sum.xx += weight * ((1.0 - nu) / r + nu * dx * dx / r.powi(3));
                sum.yy += weight * ((1.0 - nu) / r + nu * dy * dy / r.powi(3));
                sum.xy += weight * nu * dx * dy / r.powi(3);
            }
        }
        sum
    }

    #[test]
    fn closed_integrals_are_the_sums_of_point_loads() {
        let sides = [0.3, 0.2];
        for (x, y) in [(0.3, 0.0), (0.0, 0.4), (-0.6, 0.2), (2.1, -1.4), (-0.3, -0.2)] {
            let (own, sum) = (Influence::of_rectangle(x, y, sides, 0.28), summed(x, y, sides, 0.28, 400));
            for (own, sum) in [(own.xx, sum.xx), (own.yy, sum.yy), (own.xy, sum.xy)] {
                assert!((own - sum).abs() < 1e-5 * 0.06, "{x} {y}: {own} {sum}");
            }
        }
        // At its own middle the integrand is singular; the sum converges like 1/n.
        let (own, sum) = (Influence::of_rectangle(0.0, 0.0, sides, 0.28), summed(0.0, 0.0, sides, 0.28, 400));
        assert!((own.xx / sum.xx - 1.0).abs() < 5e-3 && (own.yy / sum.yy - 1.0).abs() < 5e-3 && own.xy.abs() < 1e-15);
    }

    #[test]
    fn loads_act_on_each_other_alike() {
        // Maxwell and Betti: two equal rectangles, and the two directions of one plane.
        let at = |x: f64, y: f64| Influence::of_rectangle(x, y, [0.1, 0.1], 0.3);
        let (here, there, turned) = (at(0.5, 0.2), at(-0.5, -0.2), at(0.2, 0.5));
        assert!((here.xx - there.xx).abs() < 1e-15 && (here.xy - there.xy).abs() < 1e-15);
        assert!((here.xx - turned.yy).abs() < 1e-15 && (here.xy - turned.xy).abs() < 1e-15);
    }
}
