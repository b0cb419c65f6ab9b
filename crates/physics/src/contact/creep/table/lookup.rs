//! The table's spline: tensor quadratic B-splines over the ball of creepages and the slenderness, mirrored by sign.
//! Three forces lie beside each other, and the slenderness runs fastest: one sum over 27 rows gives all of it.

use super::coordinates::RIM;
use crate::Scalar;

/// Numbers a node: three forces and one to fill the registers.
const WIDTH: usize = 4;
/// Numbers that three neighbours along the slenderness take.
pub(super) const ROW: usize = 3 * WIDTH;

/// Coefficients, with one node beyond either end of each axis.
pub(super) struct Spline {
    /// Intervals from the middle of the ball to its surface, and over the whole slenderness.
    pub intervals: [usize; 4],
    /// Bounded factors of the creepages, coefficients along the slenderness.
    pub scale: Vec<[f64; 3]>,
    /// For each step of q, over u1 from -1 step, u2 from -1 - step and u3 from -1 step, the rows of its three neighbours.
    ///
    /// So every number is there three times, but what one contact reads lies in a few pages of memory, not in dozens.
    pub nodes: Vec<f32>,
}

impl core::fmt::Debug for Spline {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Spline").field("intervals", &self.intervals).finish_non_exhaustive()
    }
}

/// What the spline holds of the creepages' factors: S1 b/(a + b), S2 b/(a + b), S3 b c/(a + b)^2 with c = sqrt(ab).
///
/// The factors themselves rise towards slender ellipses faster than a spline can follow.
pub(super) fn bounded<S: Scalar>([s1, s2, s3]: [S; 3], ratio: S) -> [S; 3] {
    let share = (S::one() + ratio).recip();
    [s1 * share, s2 * share, s3 * share.square() * ratio.sqrt()]
}

/// The three nodes about a place: the first of them, and how far in steps the place lies behind the middle one.
#[derive(Clone, Copy)]
struct Stencil {
    first: usize,
    off: f64,
}

/// 1.5 * 2^52: added to a small number, it leaves the nearest whole one in the last bits, sooner than a conversion would.
const WHOLE: f64 = 6_755_399_441_055_744.0;

impl Stencil {
    /// `place` in steps from the second node of the axis, not negative.
    #[inline(always)]
    fn new(place: f64, last: usize) -> Self {
        let shifted = place + WHOLE;
        Self { first: (shifted.to_bits() as u32 as usize).min(last), off: place - (shifted - WHOLE) }
    }

    #[inline(always)]
    fn weights(self) -> [f64; 3] {
        let (l, r) = (0.5 - self.off, 0.5 + self.off);
        [0.5 * l * l, 0.75 - self.off * self.off, 0.5 * r * r]
    }

    /// Slopes of the weights over the place counted in steps.
    #[inline(always)]
    fn slopes(self) -> [f64; 3] {
        [self.off - 0.5, -2.0 * self.off, self.off + 0.5]
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

    /// Bounded factors of the creepages at a slenderness within the table.
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
                sum(s.first, &s.weights())
            },
            |[q]| {
                let (s, steps) = (self.slender(q), self.intervals[3] as f64 / (2.0 * RIM));
                (sum(s.first, &s.weights()), sum(s.first, &s.slopes()).map(|slope| [slope * steps]))
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
        let place = self.place(x);
        let [a, b, c, d] = place.stencils;
        let row = self.rows(place.stencils, [a.weights(), b.weights(), c.weights()]);
        place.turned(last(&row, &d.weights()))
    }

    /// The values of `values`, bitwise, and their Jacobian.
    fn slopes(&self, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        let place = self.place(x);
        let (all, [along, across]) = (place.stencils, place.signs);
        let ([a, b, c, d], [da, db, dc, dd]) = (all.map(Stencil::weights), all.map(Stencil::slopes));
        let row = self.rows(all, [a, b, c]);
        let turned = [along, across, across];
        let steps = self.intervals.map(|n| n as f64);
        let change = [
            last(&self.rows(all, [da, b, c]), &d).map(|s| s * steps[0] * along),
            last(&self.rows(all, [a, db, c]), &d).map(|s| s * steps[1] * across),
            last(&self.rows(all, [a, b, dc]), &d).map(|s| s * steps[2] * across),
            last(&row, &dd).map(|s| s * (steps[3] / (2.0 * RIM))),
        ];
        (place.turned(last(&row, &d)), core::array::from_fn(|k| core::array::from_fn(|m| turned[k] * change[m][k])))
    }

    /// Three neighbours along the slenderness, each the sum over 27 nodes of the ball.
    #[inline]
    fn rows(&self, [a, b, c, d]: [Stencil; 4], weights: [[f64; 3]; 3]) -> [f64; ROW] {
        let [l1, l2, l3, _] = Self::lengths(self.intervals);
        let (step1, step2) = (l2 * l3 * ROW, l3 * ROW);
        let first = d.first * l1 * step1 + a.first * step1 + b.first * step2 + c.first * ROW;
        let nodes = &self.nodes[first..first + 2 * (step1 + step2) + 3 * ROW];
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            // SAFETY: the features were just found.
            return unsafe { rows_avx2(nodes, [step1, step2], weights) };
        }
        rows_any(nodes, [step1, step2], weights)
    }
}

/// Sums of rows that begin at multiples of the steps. There is a sum for each node of u3: one alone would be a chain of 27
/// additions, each waiting for the one before.
#[inline]
fn rows_any(nodes: &[f32], [step1, step2]: [usize; 2], [u, v, w]: [[f64; 3]; 3]) -> [f64; ROW] {
    let mut sums = [[0.0; ROW]; 3];
    for (i, u) in u.iter().enumerate() {
        for (j, v) in v.iter().enumerate() {
            for (k, (sum, w)) in sums.iter_mut().zip(w).enumerate() {
                let row = &nodes[i * step1 + j * step2 + k * ROW..][..ROW];
                let weight = u * v * w;
                for (sum, &node) in sum.iter_mut().zip(row) {
                    *sum = weight.mul_add(f64::from(node), *sum);
                }
            }
        }
    }
    let [first, second, third] = sums;
    core::array::from_fn(|n| (first[n] + second[n]) + third[n])
}

/// The same operations four at a time. A fused one rounds once wherever it is computed, so the result is the same bitwise.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn rows_avx2(nodes: &[f32], [step1, step2]: [usize; 2], [u, v, w]: [[f64; 3]; 3]) -> [f64; ROW] {
    use core::arch::x86_64::{
        _mm_loadu_ps, _mm256_add_pd, _mm256_cvtps_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_setzero_pd,
        _mm256_storeu_pd,
    };
    assert!(nodes.len() >= 2 * (step1 + step2) + 3 * ROW);
    let mut sums = [[_mm256_setzero_pd(); ROW / 4]; 3];
    for (i, u) in u.iter().enumerate() {
        for (j, v) in v.iter().enumerate() {
            for (k, (sum, w)) in sums.iter_mut().zip(w).enumerate() {
                let (start, weight) = (i * step1 + j * step2 + k * ROW, _mm256_set1_pd(u * v * w));
                for (four, sum) in sum.iter_mut().enumerate() {
                    // SAFETY: the last row ends within the nodes, as was just seen.
                    let node = unsafe { _mm_loadu_ps(nodes.as_ptr().add(start + 4 * four)) };
                    *sum = _mm256_fmadd_pd(weight, _mm256_cvtps_pd(node), *sum);
                }
            }
        }
    }
    let mut row = [0.0; ROW];
    let [first, second, third] = sums;
    for (n, four) in row.chunks_exact_mut(4).enumerate() {
        let sum = _mm256_add_pd(_mm256_add_pd(first[n], second[n]), third[n]);
        // SAFETY: four numbers of the row.
        unsafe { _mm256_storeu_pd(four.as_mut_ptr(), sum) };
    }
    row
}

/// The sum along the slenderness.
#[inline(always)]
fn last(row: &[f64; ROW], w: &[f64; 3]) -> [f64; 3] {
    core::array::from_fn(|k| w[0] * row[k] + w[1] * row[WIDTH + k] + w[2] * row[2 * WIDTH + k])
}
