//! The table's spline: tensor quadratic B-splines over the ball of creepages and the slenderness, mirrored by sign.
//! Three forces lie beside each other, and the slenderness runs fastest: one contact reads nine runs of nine nodes.

use super::coordinates::RIM;
use crate::Scalar;
use crate::contact::spline::{slopes, weights};

/// Numbers a node: three forces and one to fill the registers.
const WIDTH: usize = 4;
/// Numbers that three neighbours along the slenderness take.
pub(super) const ROW: usize = 3 * WIDTH;

/// Coefficients, with one node beyond either end of each axis.
pub(super) struct Spline {
    /// Intervals from the middle of the ball to its surface, and over the whole slenderness; the same as steps per unit.
    intervals: [usize; 4],
    steps: [f64; 4],
    /// Numbers from one node to the next along u1, u2 and the slenderness.
    strides: [usize; 3],
    /// Bounded factors of the creepages, coefficients along the slenderness.
    scale: Vec<[f64; 3]>,
    /// For each step of q, over u1 from -1 step, u2 from -1 - step and u3 from -1 step, the rows of its three neighbours.
    ///
    /// So every number is there three times, but what one contact reads lies in a few pages of memory, not in dozens.
    nodes: Vec<f32>,
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
    pub fn new(intervals: [usize; 4], scale: Vec<[f64; 3]>, nodes: Vec<f32>) -> Self {
        let [s1, s2, s3, sq] = intervals.map(|n| n as f64);
        let [l1, l2, l3, _] = Self::lengths(intervals);
        let strides = [l2 * l3 * ROW, l3 * ROW, l1 * l2 * l3 * ROW];
        Self { intervals, steps: [s1, s2, s3, sq / (2.0 * RIM)], strides, scale, nodes }
    }

    /// Nodes along each axis.
    pub fn lengths([n1, n2, n3, nq]: [usize; 4]) -> [usize; 4] {
        [n1 + 3, 2 * n2 + 3, n3 + 3, nq + 3]
    }

    #[inline(always)]
    fn slender(&self, q: f64) -> Stencil {
        Stencil::new((q + RIM) * self.steps[3], self.intervals[3])
    }

    /// Bounded factors of the creepages at a slenderness within the table.
    #[inline(always)]
    pub fn scales<S: Scalar>(&self, q: S) -> [S; 3] {
        let sum = |first: usize, [u, v, w]: [f64; 3]| -> [f64; 3] {
            let three = &self.scale[first..first + 3];
            core::array::from_fn(|k| u * three[0][k] + v * three[1][k] + w * three[2][k])
        };
        S::lift_n_lazy(
            [q],
            |[q]| {
                let s = self.slender(q);
                sum(s.first, weights(s.off))
            },
            |[q]| {
                let s = self.slender(q);
                (sum(s.first, weights(s.off)), sum(s.first, slopes(s.off)).map(|slope| [slope * self.steps[3]]))
            },
        )
    }

    /// Fx and Fy over mu N (before the limiter) and Mz over mu N (a + b)/2 at (u1, u2, u3, q).
    #[inline(always)]
    pub fn at<S: Scalar>(&self, x: [S; 4]) -> [S; 3] {
        S::lift_n_lazy(x, |x| self.values(x), |x| self.slopes(x))
    }

    #[inline]
    fn values(&self, x: [f64; 4]) -> [f64; 3] {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn wide(spline: &Spline, u1: f64, u2: f64, u3: f64, q: f64) -> [f64; 3] {
                spline.values_by::<Avx2>([u1, u2, u3, q])
            }
            if Avx2::there() {
                let [u1, u2, u3, q] = x;
                // SAFETY: the features were just found. Single numbers stay in registers, an array would not.
                return unsafe { wide(self, u1, u2, u3, q) };
            }
        }
        self.values_by::<Any>(x)
    }

    /// The values of `values`, bitwise, and their Jacobian.
    #[inline]
    fn slopes(&self, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn wide(spline: &Spline, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
                spline.slopes_by::<Avx2>(x)
            }
            if Avx2::there() {
                // SAFETY: the features were just found.
                return unsafe { wide(self, x) };
            }
        }
        self.slopes_by::<Any>(x)
    }

    /// The quarter u1 >= 0, u3 >= 0 holds everything: Fx turns with the sign of u1, Fy and Mz with that of (u2, u3).
    #[inline(always)]
    fn place(&self, [u1, u2, u3, q]: [f64; 4]) -> Place {
        let ([n1, n2, n3, _], [s1, s2, s3, _]) = (self.intervals, self.steps);
        let along = if u1 < 0.0 { -1.0 } else { 1.0 };
        let across = if u3 < 0.0 || (u3 == 0.0 && u2 < 0.0) { -1.0 } else { 1.0 };
        let stencils = [
            Stencil::new(u1.abs() * s1, n1),
            Stencil::new((across * u2).mul_add(s2, s2), 2 * n2),
            Stencil::new(u3.abs() * s3, n3),
            self.slender(q),
        ];
        // A sum over mirror images is nil but for rounding where it turns its sign.
        let present = [u1 != 0.0, u2 != 0.0 || u3 != 0.0].map(|there| f64::from(u8::from(there)));
        Place { stencils, signs: [along, across], present }
    }

    #[inline(always)]
    fn values_by<F: Four>(&self, x: [f64; 4]) -> [f64; 3] {
        let place = self.place(x);
        let [a, b, c, d] = place.stencils.map(|s| weights(s.off));
        place.turned(last::<F>(&self.block::<F>(&place.stencils, a, b), c, d))
    }

    #[inline(always)]
    fn slopes_by<F: Four>(&self, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        let place = self.place(x);
        let (all, [along, across]) = (&place.stencils, place.signs);
        let ([a, b, c, d], [da, db, dc, dd]) = (all.map(|s| weights(s.off)), all.map(|s| slopes(s.off)));
        let (block, [s1, s2, s3, sq]) = (self.block::<F>(all, a, b), self.steps);
        let turned = [along, across, across];
        let change = [
            last::<F>(&self.block::<F>(all, da, b), c, d).map(|s| s * s1 * along),
            last::<F>(&self.block::<F>(all, a, db), c, d).map(|s| s * s2 * across),
            last::<F>(&block, dc, d).map(|s| s * s3 * across),
            last::<F>(&block, c, dd).map(|s| s * sq),
        ];
        let value = place.turned(last::<F>(&block, c, d));
        (value, core::array::from_fn(|k| core::array::from_fn(|m| turned[k] * change[m][k])))
    }

    /// The nine nodes of u3 and of the slenderness about a place, each summed over its nine of u1 and u2.
    #[inline(always)]
    fn block<F: Four>(&self, [a, b, c, d]: &[Stencil; 4], along: [f64; 3], across: [f64; 3]) -> Block {
        let [step1, step2, step4] = self.strides;
        let first = d.first * step4 + a.first * step1 + b.first * step2 + c.first * ROW;
        let nodes = &self.nodes[first..first + 2 * (step1 + step2) + 3 * ROW];
        let mut sums = [[0.0; WIDTH]; 9];
        for (i, along) in along.into_iter().enumerate() {
            for (j, across) in across.into_iter().enumerate() {
                let (start, weight) = (i * step1 + j * step2, along * across);
                let (nodes, _) = nodes[start..start + 3 * ROW].as_chunks();
                for (sum, node) in sums.iter_mut().zip(nodes) {
                    *sum = F::add(F::node(node), weight, *sum);
                }
            }
        }
        sums
    }
}

/// Sums of nine nodes, the slenderness fastest. Side by side: a single one would be a chain of additions, each waiting for
/// the one before.
type Block = [[f64; WIDTH]; 9];

/// The sum over u3 and the slenderness.
#[inline(always)]
fn last<F: Four>(block: &Block, [u, v, w]: [f64; 3], slender: [f64; 3]) -> [f64; 3] {
    let nil = [0.0; WIDTH];
    let mut sum = nil;
    for (q, slender) in slender.into_iter().enumerate() {
        sum = F::add(F::add(block[q], u, F::add(block[3 + q], v, F::add(block[6 + q], w, nil))), slender, sum);
    }
    [sum[0], sum[1], sum[2]]
}

/// Four numbers at a time. A fused operation rounds once whatever computes it, so all give the same bitwise.
trait Four {
    /// The numbers of a node.
    fn node(node: &[f32; WIDTH]) -> [f64; WIDTH];
    /// x weight + sum, fused.
    fn add(x: [f64; WIDTH], weight: f64, sum: [f64; WIDTH]) -> [f64; WIDTH];
}

/// On any processor.
struct Any;

impl Four for Any {
    #[inline(always)]
    fn node(node: &[f32; WIDTH]) -> [f64; WIDTH] {
        node.map(f64::from)
    }
    #[inline(always)]
    fn add(x: [f64; WIDTH], weight: f64, sum: [f64; WIDTH]) -> [f64; WIDTH] {
        core::array::from_fn(|n| weight.mul_add(x[n], sum[n]))
    }
}

/// In wide registers; the compiler finds them by itself only in part.
#[cfg(target_arch = "x86_64")]
struct Avx2;

#[cfg(target_arch = "x86_64")]
impl Avx2 {
    #[inline(always)]
    fn there() -> bool {
        std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
    }
}

#[cfg(target_arch = "x86_64")]
impl Four for Avx2 {
    #[inline(always)]
    fn node(node: &[f32; WIDTH]) -> [f64; WIDTH] {
        use core::arch::x86_64::{_mm_loadu_ps, _mm256_cvtps_pd, _mm256_storeu_pd};
        let mut four = [0.0; WIDTH];
        // SAFETY: four numbers are read and four written; called only where the features were found.
        unsafe { _mm256_storeu_pd(four.as_mut_ptr(), _mm256_cvtps_pd(_mm_loadu_ps(node.as_ptr()))) };
        four
    }
    #[inline(always)]
    fn add(x: [f64; WIDTH], weight: f64, sum: [f64; WIDTH]) -> [f64; WIDTH] {
        use core::arch::x86_64::{_mm256_fmadd_pd, _mm256_loadu_pd, _mm256_set1_pd, _mm256_storeu_pd};
        let mut four = [0.0; WIDTH];
        // SAFETY: as above.
        unsafe {
            let (x, sum) = (_mm256_loadu_pd(x.as_ptr()), _mm256_loadu_pd(sum.as_ptr()));
            _mm256_storeu_pd(four.as_mut_ptr(), _mm256_fmadd_pd(x, _mm256_set1_pd(weight), sum));
        }
        four
    }
}
