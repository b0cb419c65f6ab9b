//! Displacement of the half-space under strips of pressure that is semi-elliptic along the rolling direction (Boussinesq).
//! p = k sqrt(x_l^2 - x^2) over |x| < x_l gives on the line x = 0, at the distance t, k x_l J(t / x_l) a metre of width.

use std::sync::LazyLock;

/// Nodes of the table over z = w / (1 + w), w = sqrt(q), which ends at [`LAST`]; beyond it the strip is a point.
const NODES: usize = 1025;
const LAST: f64 = 0.98;

/// J(q) = integral of cos^2 over sqrt(sin^2 + q^2) from -pi/2 to pi/2, integrated over q from 0, and q J(q).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Influence {
    /// F(q), the integral of J.
    pub integral: f64,
    /// q J(q).
    pub product: f64,
}

static TABLE: LazyLock<Vec<Influence>> = LazyLock::new(|| {
    let place = |i: usize| LAST * i as f64 / (NODES - 1) as f64;
    let q = |z: f64| (z / (1.0 - z)).powi(2);
    let mut table = vec![Influence::default()];
    for i in 1..NODES {
        let (before, here) = (place(i - 1), place(i));
        // Simpson's rule over the z of one step, dq = 2 z dz / (1 - z)^3; the first step holds the logarithm of J.
        let slope = |z: f64| j(q(z)) * 2.0 * z / (1.0 - z).powi(3);
        let step = if i == 1 {
            2.0 * q(here) * (4.0 / q(here)).ln()
        } else {
            (slope(before) + 4.0 * slope(0.5 * (before + here)) + slope(here)) * (here - before) / 6.0
        };
        table.push(Influence { integral: table[i - 1].integral + step, product: q(here) * j(q(here)) });
    }
    table
});

/// J(q) = 2 sqrt(1 + q^2) (K(m) - E(m)), m = 1 / (1 + q^2).
fn j(q: f64) -> f64 {
    let m = 1.0 / (1.0 + q * q);
    let (k, e) = super::hertz::elliptic(m);
    2.0 * (1.0 + q * q).sqrt() * (k - e)
}

/// The table of F(q) and q J(q).
#[derive(Clone, Copy)]
pub(super) struct Influences(&'static [Influence]);

impl Influences {
    pub fn new() -> Self {
        Self(&TABLE)
    }

    /// At w = sqrt(q) >= 0, relative error below 1e-4 (tested).
    #[inline]
    pub fn at(self, w: f64) -> Influence {
        let z = w / (1.0 + w);
        if z >= LAST {
            let integral = self.0[NODES - 1].integral + core::f64::consts::PI * (w * ((1.0 - LAST) / LAST)).ln();
            return Influence { integral, product: core::f64::consts::FRAC_PI_2 };
        }
        let place = z * ((NODES - 1) as f64 / LAST);
        let k = place as usize;
        let (lo, hi, t) = (self.0[k], self.0[k + 1], place - k as f64);
        let integral = lo.integral + t * (hi.integral - lo.integral);
        Influence { integral, product: lo.product + t * (hi.product - lo.product) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral of J over q by substitution: the strip's potential integrated over its width, asinh(q / |sin|).
    fn direct(q: f64) -> f64 {
        let n = 4000;
        (0..n)
            .map(|i| {
                // The angle grows as u^3, which takes the logarithm out.
                let u = (f64::from(i) + 0.5) / f64::from(n);
                let angle = core::f64::consts::FRAC_PI_2 * u.powi(3);
                let step = 2.0 * core::f64::consts::FRAC_PI_2 * 3.0 * u * u / f64::from(n);
                angle.cos().powi(2) * (q / angle.sin()).asinh() * step
            })
            .sum()
    }

    #[test]
    fn influence_is_the_integral_of_boussinesq() {
        for q in [1e-3_f64, 0.02, 0.31, 1.0, 4.7, 60.0, 3e3] {
            let (table, exact) = (Influences::new().at(q.sqrt()), direct(q));
            assert!((table.integral / exact - 1.0).abs() < 3e-4, "{q}: {table:?} {exact}");
            let slope = q * (direct(q * 1.001) - direct(q * 0.999)) / (0.002 * q);
            assert!((table.product / slope - 1.0).abs() < 1e-3, "{q}: {table:?} {slope}");
        }
    }
}
