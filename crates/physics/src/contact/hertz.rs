//! Hertz's contact of two bodies with gap A x^2 + B y^2, exact by elliptic integrals.
//! The shape depends on A/B alone and is tabulated over its logarithm; source: Johnson, Contact Mechanics, sec. 4.2.

use std::sync::LazyLock;

/// The contact ellipse that belongs to curvatures A (along x) and B (along y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// a/b, the semi-axis along x over the one along y.
    pub ratio: f64,
    /// B b^2 / approach: the virtual penetration factor.
    pub epsilon: f64,
    /// N / (E* approach b), E* = E / (2 (1 - nu^2)).
    pub load: f64,
}

/// Complete elliptic integrals K and E of modulus k, by the arithmetic-geometric mean.
pub(super) fn elliptic(k2: f64) -> (f64, f64) {
    let (mut a, mut b, mut c2, mut power, mut sum) = (1.0, (1.0 - k2).sqrt(), k2, 0.5, 0.5 * k2);
    while c2 > 1e-32 {
        (a, b, c2) = (0.5 * (a + b), (a * b).sqrt(), (0.5 * (a - b)).powi(2));
        power *= 2.0;
        sum += power * c2;
    }
    let k = core::f64::consts::FRAC_PI_2 / a;
    (k, k * (1.0 - sum))
}

/// (A/B, ellipse) of a given ratio g = b/a <= 1.
fn slender(g: f64) -> (f64, Ellipse) {
    let e2 = 1.0 - g * g;
    let (k, e) = elliptic(e2);
    // (K - E)/e^2 and (E - g^2 K)/e^2 both tend to pi/4 for the circle.
    let (along, across) = if e2 < 1e-6 {
        (core::f64::consts::FRAC_PI_4 * (1.0 + 0.375 * e2), core::f64::consts::FRAC_PI_4 * (1.0 + 0.125 * e2))
    } else {
        ((k - e) / e2, (e - g * g * k) / e2)
    };
    let load = 2.0 / 3.0 * core::f64::consts::PI / (g * k);
    (g * g * along / across, Ellipse { ratio: 1.0 / g, epsilon: across / k, load })
}

/// The ellipse of A/B by bisection on its axes: exact, slow.
fn solve(a_over_b: f64) -> Ellipse {
    if a_over_b > 1.0 {
        // Swap the axes; then epsilon = 1 - (epsilon of the other axis) does not hold, so both are written out.
        let g = bisect(1.0 / a_over_b);
        let (_, other) = slender(g);
        let epsilon = a_over_b.recip() * other.epsilon * other.ratio.powi(2);
        return Ellipse { ratio: g, epsilon, load: other.load * g };
    }
    slender(bisect(a_over_b)).1
}

/// b/a of the ellipse whose A/B is `target` <= 1.
fn bisect(target: f64) -> f64 {
    let (mut lo, mut hi) = (1e-9_f64, 1.0_f64);
    for _ in 0..80 {
        let mid = (lo * hi).sqrt();
        if slender(mid).0 < target { lo = mid } else { hi = mid }
    }
    (lo * hi).sqrt()
}

const LIMIT: f64 = 14.0;
const NODES: usize = 2801;
/// (ln ratio, ln epsilon, ln load) over ln(A/B) from -LIMIT to LIMIT.
static TABLE: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
    (0..NODES)
        .map(|i| {
            let e = solve((LIMIT * (2.0 * i as f64 / (NODES - 1) as f64 - 1.0)).exp());
            [e.ratio.ln(), e.epsilon.ln(), e.load.ln()]
        })
        .collect()
});

/// The contact ellipse for curvatures `a` (along x) and `b` (along y), 1/m, both positive.
///
/// From a table (relative error below 1e-5, tested) for A/B within e^-14..e^14, solved exactly outside it.
///
/// ```
/// let circle = klingel_physics::contact::hertz::ellipse(2.0, 2.0);
/// assert!((circle.ratio - 1.0).abs() < 1e-6 && (circle.epsilon - 0.5).abs() < 1e-6);
/// ```
pub fn ellipse(a: f64, b: f64) -> Ellipse {
    let x = (a / b).ln();
    if x.abs() >= LIMIT {
        return solve(a / b);
    }
    let place = (x + LIMIT) / (2.0 * LIMIT) * (NODES - 1) as f64;
    let k = place as usize;
    let (lo, hi, t) = (&TABLE[k], &TABLE[k + 1], place - k as f64);
    let [ratio, epsilon, load] = core::array::from_fn(|i| (lo[i] + t * (hi[i] - lo[i])).exp());
    Ellipse { ratio, epsilon, load }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// theta (degrees), m, n, r of the classical tables, computed independently with elliptic integrals.
    const CLASSICAL: [[f64; 4]; 6] = [
        [5.0, 11.23806, 0.23814, 0.29689],
        [20.0, 3.81601, 0.41215, 0.60384],
        [30.0, 2.73065, 0.49306, 0.72631],
        [60.0, 1.48582, 0.71710, 0.93759],
        [85.0, 1.06087, 0.94422, 0.99831],
        [90.0, 1.0, 1.0, 1.0],
    ];

    #[test]
    fn ellipse_meets_the_classical_tables_on_both_sides_of_the_circle() {
        for [theta, m, n, r] in CLASSICAL {
            let cos = theta.to_radians().cos();
            let (small, large) = (0.5 * (1.0 - cos), 0.5 * (1.0 + cos));
            // With A + B = 1 and q = 1: semi-axes m, n, approach r, load N = 4/3 E* (q = (3 N / (4 E* (A+B)))^(1/3)).
            for (a, b, ratio, along_y) in [(small, large, m / n, n), (large, small, n / m, m)] {
                let e = ellipse(a, b);
                assert!((e.ratio / ratio - 1.0).abs() < 3e-5, "{theta} {e:?}");
                assert!((e.epsilon / (b * along_y * along_y / r) - 1.0).abs() < 1e-4, "{theta} {e:?}");
                assert!((e.load / (4.0 / 3.0 / (r * along_y)) - 1.0).abs() < 3e-5, "{theta} {e:?}");
            }
        }
    }

    #[test]
    fn table_is_the_exact_solution_to_its_stated_error() {
        for i in 0..200 {
            let x = (f64::from(i) * 0.1377 - 13.7).exp();
            let (t, e) = (ellipse(x, 1.0), solve(x));
            for (t, e) in [(t.ratio, e.ratio), (t.epsilon, e.epsilon), (t.load, e.load)] {
                assert!((t / e - 1.0).abs() < 1e-5, "{x}: {t} {e}");
            }
        }
    }
}
