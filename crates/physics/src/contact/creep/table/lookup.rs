//! The table's spline: tensor quadratic B-splines over the ball of creepages and the slenderness, mirrored by sign.
//! Three forces lie beside each other, and the slenderness runs fastest: one sum over 27 rows gives all of it.

use super::coordinates::RIM;
use crate::Scalar;

/// Numbers a node: three forces and one to fill the registers.
pub(super) const WIDTH: usize = 4;
/// Numbers that three neighbours along the slenderness take.
const ROW: usize = 3 * WIDTH;

/// Coefficients, with one node beyond either end of each axis.
pub(super) struct Spline {
    /// Intervals from the middle of the ball to its surface, and over the whole slenderness.
    pub intervals: [usize; 4],
    /// Factors of the creepages, coefficients along the slenderness.
    pub scale: Vec<[f64; 3]>,
    /// Over u1 from -1 step, u2 from -1 - step, u3 from -1 step, q from -RIM - step, then forces.
    pub nodes: Vec<f32>,
}

impl core::fmt::Debug for Spline {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Spline").field("intervals", &self.intervals).finish_non_exhaustive()
    }
}

/// The three nodes about a place, their weights and the weights' slopes over the place counted in steps.
struct Stencil {
    first: usize,
    weight: [f64; 3],
    slope: [f64; 3],
}

impl Stencil {
    /// `place` in steps from the second node of the axis, not negative.
    #[inline(always)]
    fn new(place: f64, last: usize) -> Self {
        let nearest = ((place + 0.5) as usize).min(last);
        let f = place - nearest as f64;
        let (l, r) = (0.5 - f, 0.5 + f);
        Self { first: nearest, weight: [0.5 * l * l, 0.75 - f * f, 0.5 * r * r], slope: [-l, -2.0 * f, r] }
    }
}

/// Stencils about a place of the positive quarter, the signs of Fx and of Fy with Mz there, and which are not nil by them.
struct Place {
    stencils: [Stencil; 4],
    signs: [f64; 2],
    present: [f64; 2],
}

impl Place {
    /// Forces with their signs.
    #[inline(always)]
    fn turned(&self, f: [f64; 3]) -> [f64; 3] {
        let ([along, across], [x, y]) = (self.signs, self.present);
        [along * x * f[0], across * y * f[1], across * y * f[2]]
    }
}

impl Spline {
    /// Nodes along each axis.
    pub fn lengths([n1, n2, n3, nq]: [usize; 4]) -> [usize; 4] {
        [n1 + 3, 2 * n2 + 3, n3 + 3, nq + 3]
    }

    #[inline(always)]
    fn slender(&self, q: f64) -> Stencil {
        let n = self.intervals[3];
        Stencil::new((q + RIM) * (n as f64 / (2.0 * RIM)), n)
    }

    /// Factors of the creepages at a slenderness within the table.
    #[inline]
    pub fn scales<S: Scalar>(&self, q: S) -> [S; 3] {
        let sum = |first: usize, w: &[f64; 3]| -> [f64; 3] {
            let [a, b, c] = [0, 1, 2].map(|i| &self.scale[first + i]);
            core::array::from_fn(|k| w[0] * a[k] + w[1] * b[k] + w[2] * c[k])
        };
        S::lift_n_lazy(
            [q],
            |[q]| {
                let s = self.slender(q);
                sum(s.first, &s.weight)
            },
            |[q]| {
                let (s, steps) = (self.slender(q), self.intervals[3] as f64 / (2.0 * RIM));
                (sum(s.first, &s.weight), sum(s.first, &s.slope).map(|slope| [slope * steps]))
            },
        )
    }

    /// Fx and Fy over mu N (before the limiter) and Mz over mu N (a + b)/2 at (u1, u2, u3, q).
    #[inline]
    pub fn at<S: Scalar>(&self, x: [S; 4]) -> [S; 3] {
        S::lift_n_lazy(x, |x| self.values(x), |x| self.slopes(x))
    }

    /// The quarter u1 >= 0, u3 >= 0 holds everything: Fx turns with the sign of u1, Fy and Mz with that of (u2, u3).
    #[inline(always)]
    fn place(&self, [u1, u2, u3, q]: [f64; 4]) -> Place {
        let [n1, n2, n3, _] = self.intervals;
        let along = if u1 < 0.0 { -1.0 } else { 1.0 };
        let across = if u3 < 0.0 || (u3 == 0.0 && u2 < 0.0) { -1.0 } else { 1.0 };
        let stencils = [
            Stencil::new(u1.abs() * n1 as f64, n1),
            Stencil::new((across * u2 + 1.0) * n2 as f64, 2 * n2),
            Stencil::new(u3.abs() * n3 as f64, n3),
            self.slender(q),
        ];
        // A sum over mirror images is nil but for rounding where it turns its sign.
        let present = [u1 != 0.0, u2 != 0.0 || u3 != 0.0].map(|there| f64::from(u8::from(there)));
        Place { stencils, signs: [along, across], present }
    }

    #[inline]
    fn values(&self, x: [f64; 4]) -> [f64; 3] {
        #[cfg(target_arch = "x86_64")]
        {
            /// The same operations for wider registers; without fused operations the result is the same bitwise.
            #[target_feature(enable = "avx2")]
            fn wide(spline: &Spline, x: [f64; 4]) -> [f64; 3] {
                spline.values_any(x)
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the feature was just found.
                return unsafe { wide(self, x) };
            }
        }
        self.values_any(x)
    }

    #[inline(always)]
    fn values_any(&self, x: [f64; 4]) -> [f64; 3] {
        let place = self.place(x);
        let [a, b, c, d] = &place.stencils;
        let row = self.rows([a, b, c, d], [&a.weight, &b.weight, &c.weight]);
        place.turned(last(&row, &d.weight))
    }

    /// The values of `values`, bitwise, and their Jacobian.
    fn slopes(&self, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        let place = self.place(x);
        let ([a, b, c, d], [along, across]) = (&place.stencils, place.signs);
        let all = [a, b, c, d];
        let row = self.rows(all, [&a.weight, &b.weight, &c.weight]);
        let f = last(&row, &d.weight);
        let turned = [along, across, across];
        let steps = [self.intervals[0], self.intervals[1], self.intervals[2]].map(|n| n as f64);
        let change = [
            last(&self.rows(all, [&a.slope, &b.weight, &c.weight]), &d.weight).map(|s| s * steps[0] * along),
            last(&self.rows(all, [&a.weight, &b.slope, &c.weight]), &d.weight).map(|s| s * steps[1] * across),
            last(&self.rows(all, [&a.weight, &b.weight, &c.slope]), &d.weight).map(|s| s * steps[2] * across),
            last(&row, &d.slope).map(|s| s * (self.intervals[3] as f64 / (2.0 * RIM))),
        ];
        (place.turned(f), core::array::from_fn(|k| core::array::from_fn(|m| turned[k] * change[m][k])))
    }

    /// Three neighbours along the slenderness, each the sum over 27 nodes of the ball.
    #[inline(always)]
    fn rows(&self, [a, b, c, d]: [&Stencil; 4], [u, v, w]: [&[f64; 3]; 3]) -> [f64; ROW] {
        let [_, l2, l3, lq] = Self::lengths(self.intervals);
        let step3 = lq * WIDTH;
        let step2 = l3 * step3;
        let step1 = l2 * step2;
        let first = a.first * step1 + b.first * step2 + c.first * step3 + d.first * WIDTH;
        // A sum for each node of u3: one alone would be a chain of 27 additions, each waiting for the one before.
        let mut sums = [[0.0; ROW]; 3];
        for (i, u) in u.iter().enumerate() {
            for (j, v) in v.iter().enumerate() {
                let (plane, start) = (u * v, first + i * step1 + j * step2);
                for (k, (sum, w)) in sums.iter_mut().zip(w).enumerate() {
                    let weight = plane * w;
                    let row = &self.nodes[start + k * step3..][..ROW];
                    for (sum, &node) in sum.iter_mut().zip(row) {
                        *sum += weight * f64::from(node);
                    }
                }
            }
        }
        let [mut sum, second, third] = sums;
        for n in 0..ROW {
            sum[n] = (sum[n] + second[n]) + third[n];
        }
        sum
    }
}

/// The sum along the slenderness.
#[inline(always)]
fn last(row: &[f64; ROW], w: &[f64; 3]) -> [f64; 3] {
    core::array::from_fn(|k| w[0] * row[k] + w[1] * row[WIDTH + k] + w[2] * row[2 * WIDTH + k])
}
