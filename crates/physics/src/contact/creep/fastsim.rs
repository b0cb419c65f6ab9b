//! Kalker's simplified theory FASTSIM: three flexibilities, parabolic traction bound, one friction coefficient.
//! All strips advance side by side from their leading edges, so the compiler runs four of them at a time.

use super::{Kalker, RollingContact};
use crate::{Mask, Scalar};
use core::f64::consts::{FRAC_PI_2, PI};

/// Most strips and most elements a strip.
pub const MOST_ELEMENTS: usize = 40;

/// The division of the unit circle: `ny` strips of `nx` elements each.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    nx: usize,
    ny: usize,
    /// Middle of each strip and half its length; mirrored bitwise, filled up to a multiple of four strips.
    y: Vec<[f64; 4]>,
    half: Vec<[f64; 4]>,
    /// Exact over discrete volume of the traction bound, so that full slip gives mu N.
    bound: f64,
}

impl Grid {
    pub fn new(nx: usize, ny: usize) -> Self {
        let middle = |j: usize| (2.0 * j.min(ny - 1) as f64 + 1.0 - ny as f64) / ny as f64;
        let y: Vec<[f64; 4]> = (0..ny.div_ceil(4)).map(|g| [0, 1, 2, 3].map(|l| middle(4 * g + l))).collect();
        let half: Vec<[f64; 4]> = y.iter().map(|y| y.map(|y| (1.0 - y * y).sqrt())).collect();
        // Midpoint sum of (l^2 - x^2) over a strip: 4/3 l^3 (1 + 1/(2 nx^2)).
        let strip = 4.0 / 3.0 * (1.0 + 0.5 / (nx * nx) as f64);
        let volume: f64 = half.iter().flatten().take(ny).map(|l| strip * l.powi(3)).sum::<f64>() * 2.0 / ny as f64;
        Self { nx, ny, y, half, bound: FRAC_PI_2 / volume }
    }
}

/// Rigid slips over flexibilities times a, and the traction bound of the middle of the patch, Pa.
#[derive(Clone, Copy)]
pub(super) struct Slip<T> {
    xi: T,
    eta: T,
    phi_y: T,
    phi_x: T,
    bound: T,
}

/// Four strips side by side: steps of traction an element, bound, tractions, and sums of px, py and x py.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Four<T> {
    step_x: [T; 4],
    step_y: [T; 4],
    spin: [T; 4],
    bound: [T; 4],
    px: [T; 4],
    py: [T; 4],
    sum: [[T; 4]; 3],
}

impl<T: Scalar> Four<T> {
    #[inline(always)]
    fn new(nx: f64, y: &[f64; 4], half: &[f64; 4], slip: &Slip<T>) -> Self {
        let mut s = Self::default();
        for l in 0..4 {
            let dx = half[l] * 2.0 / nx;
            // A whole step to the middle of the first element, as Kalker has it, sums to (1 + 1/nx) of the linear theory.
            let step = half[l] * 2.0 / (nx + 1.0);
            s.step_x[l] = (slip.xi - slip.phi_y * y[l]) * step;
            s.step_y[l] = slip.eta * step;
            s.spin[l] = slip.phi_x * (half[l] * dx);
            s.bound[l] = slip.bound * (half[l] * half[l]);
        }
        s
    }

    /// Takes one more element, whose middle is at `x` (in half lengths of the strip).
    #[inline(always)]
    fn element(&mut self, x: f64) {
        let (mut size2, mut limit, mut slipping) = ([T::zero(); 4], [T::zero(); 4], false);
        for l in 0..4 {
            self.px[l] -= self.step_x[l];
            self.py[l] -= self.step_y[l] + self.spin[l] * x;
            size2[l] = self.px[l].square() + self.py[l].square();
            limit[l] = self.bound[l] * (1.0 - x * x);
        }
        for l in 0..4 {
            slipping |= !limit[l].square().lt(size2[l]).none();
        }
        if slipping {
            for l in 0..4 {
                let scale = T::select(limit[l].square().lt(size2[l]), limit[l] / size2[l].sqrt(), T::one());
                self.px[l] = self.px[l] * scale;
                self.py[l] = self.py[l] * scale;
            }
        }
        for l in 0..4 {
            self.sum[0][l] += self.px[l];
            self.sum[1][l] += self.py[l];
            self.sum[2][l] += self.py[l] * x;
        }
    }
}

/// Sums of px, py, x py and y px over the unit circle.
type Sums<T> = [T; 4];

/// Advances all strips, in at most `G` fours, from the leading to the trailing edge and sums them up.
#[inline(always)]
fn advance<T: Scalar, const G: usize>(grid: &Grid, slip: &Slip<T>) -> Sums<T> {
    let nx = grid.nx as f64;
    let mut fours = [Four::default(); G];
    let fours = &mut fours[..grid.y.len()];
    for (f, (y, half)) in fours.iter_mut().zip(grid.y.iter().zip(&grid.half)) {
        *f = Four::new(nx, y, half, slip);
    }
    for i in 0..grid.nx {
        let x = 1.0 - (2 * i + 1) as f64 / nx;
        for f in fours.iter_mut() {
            f.element(x);
        }
    }
    let strip = |j: usize| {
        let (f, l) = (&fours[j / 4], j % 4);
        let half = grid.half[j / 4][l];
        let dx = half * 2.0 / nx;
        [f.sum[0][l] * dx, f.sum[1][l] * dx, f.sum[2][l] * (half * dx)]
    };
    // In pairs from the edges inwards, so that a mirrored contact gives the mirrored force bitwise.
    let mut sums = [T::zero(); 4];
    for j in 0..grid.ny / 2 {
        let ([xj, yj, mj], [xk, yk, mk]) = (strip(j), strip(grid.ny - 1 - j));
        sums[0] += xj + xk;
        sums[1] += yj + yk;
        sums[2] += mj + mk;
        sums[3] += (xj - xk) * grid.y[j / 4][j % 4];
    }
    if grid.ny % 2 == 1 {
        let [x, y, m] = strip(grid.ny / 2);
        sums[0] += x;
        sums[1] += y;
        sums[2] += m;
    }
    sums
}

/// Grids of up to sixteen strips, the usual ones, need less room.
#[inline(always)]
fn advance_any<T: Scalar>(grid: &Grid, slip: &Slip<T>) -> Sums<T> {
    if grid.y.len() <= 4 { advance::<T, 4>(grid, slip) } else { advance::<T, { MOST_ELEMENTS / 4 }>(grid, slip) }
}

/// Numbers that FASTSIM runs on.
pub(super) trait Strip: Scalar {
    fn strips(grid: &Grid, slip: &Slip<Self>) -> Sums<Self>;
}

impl Strip for f64 {
    #[inline]
    fn strips(grid: &Grid, slip: &Slip<f64>) -> Sums<f64> {
        #[cfg(target_arch = "x86_64")]
        {
            /// The same operations for wider registers; without fused operations the result is the same bitwise.
            #[target_feature(enable = "avx2")]
            fn wide(grid: &Grid, slip: &Slip<f64>) -> Sums<f64> {
                advance_any(grid, slip)
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the feature was just found.
                return unsafe { wide(grid, slip) };
            }
        }
        advance_any(grid, slip)
    }
}

impl<const N: usize> Strip for crate::Dual<N> {
    fn strips(grid: &Grid, slip: &Slip<Self>) -> Sums<Self> {
        advance_any(grid, slip)
    }
}

pub(super) fn fastsim<S: Strip>(kalker: &Kalker, shear_modulus: f64, grid: &Grid, c: &RollingContact<S>) -> [S; 3] {
    let [c11, c22, c23, _] = kalker.at(c.a / c.b);
    // a / L with L1 = 8 a / (3 G C11), L2 = 8 a / (3 G C22), L3 = pi a sqrt(a/b) / (4 G C23).
    let spin = c23 * c.phi * (4.0 / PI * shear_modulus) / (c.a / c.b).sqrt();
    let slip = Slip {
        xi: c11 * c.xi * (0.375 * shear_modulus),
        eta: c22 * c.eta * (0.375 * shear_modulus),
        phi_y: spin * c.b,
        phi_x: spin * c.a,
        bound: c.friction * c.normal_force * (2.0 / PI * grid.bound) / (c.a * c.b),
    };
    let [fx, fy, along, across] = S::strips(grid, &slip);
    let element = c.a * c.b * (2.0 / grid.ny as f64);
    [fx * element, fy * element, (c.a * along - c.b * across) * element]
}
