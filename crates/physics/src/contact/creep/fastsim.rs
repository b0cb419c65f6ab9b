//! Kalker's simplified theory FASTSIM: three flexibilities, parabolic traction bound, one friction coefficient.
//! Strips run along the rolling direction from the leading edge; four of them go side by side through the same law.

use super::{Kalker, RollingContact};
use crate::{Lanes, Mask, Scalar};
use core::f64::consts::{FRAC_PI_2, PI};

/// Most strips and most elements a strip.
pub const MOST_ELEMENTS: usize = 40;

/// The division of the unit circle: `ny` strips of `nx` elements each.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    nx: usize,
    ny: usize,
    /// Middle of each strip, and half its length; mirrored bitwise, padded with the last strip to a multiple of four.
    y: Vec<f64>,
    half: Vec<f64>,
    /// Exact over discrete volume of the traction bound, so that full slip gives mu N.
    bound: f64,
}

impl Grid {
    pub fn new(nx: usize, ny: usize) -> Self {
        let y: Vec<f64> =
            (0..ny.next_multiple_of(4)).map(|j| (2.0 * j.min(ny - 1) as f64 + 1.0 - ny as f64) / ny as f64).collect();
        let half: Vec<f64> = y.iter().map(|y| (1.0 - y * y).sqrt()).collect();
        // Midpoint sum of (l^2 - x^2) over a strip: 4/3 l^3 (1 + 1/(2 nx^2)).
        let strip = 4.0 / 3.0 * (1.0 + 0.5 / (nx * nx) as f64);
        let volume: f64 = half[..ny].iter().map(|l| strip * l.powi(3)).sum::<f64>() * 2.0 / ny as f64;
        Self { nx, ny, y, half, bound: FRAC_PI_2 / volume }
    }
}

/// What is the same for every strip: rigid slips over flexibilities times a (Pa), bound (Pa).
#[derive(Clone, Copy)]
struct Strip<T> {
    slip_x: T,
    slip_y: T,
    spin_x: T,
    spin_y: T,
    bound: T,
}

impl<T: Scalar> Strip<T> {
    /// Sums of px, py and x py over one strip in units of the patch, and y px to be taken off.
    #[inline(always)]
    fn run(&self, nx: usize, y: T, half: T) -> [T; 3] {
        let dx = half * (2.0 / nx as f64);
        let half2 = half.square();
        let rigid_x = (self.slip_x - self.spin_x * y) * dx;
        let (slip_y, spin_y) = (self.slip_y * dx, self.spin_y * dx);
        let (mut px, mut py) = (T::zero(), T::zero());
        let mut sum = [T::zero(); 3];
        // The first element's middle is half a step from the leading edge.
        px = px - rigid_x * 0.5;
        py = py - (slip_y + spin_y * (half - dx * 0.25)) * 0.5;
        for i in 0..nx {
            let x = half - dx * (i as f64 + 0.5);
            let bound = self.bound * (half2 - x.square());
            let size2 = px.square() + py.square();
            let slipping = bound.square().lt(size2);
            if !slipping.none() {
                let scale = T::select(slipping, bound / size2.sqrt(), T::one());
                px = px * scale;
                py = py * scale;
            }
            sum[0] += px;
            sum[1] += py;
            sum[2] += x * py;
            px = px - rigid_x;
            py = py - (slip_y + spin_y * (x - dx * 0.5));
        }
        [sum[0] * dx, sum[1] * dx, sum[2] * dx]
    }
}

/// Runs all strips; how is up to the number: four strips a time in f64, one a time with derivatives.
pub(super) trait RunStrips: Scalar {
    fn run_strips(strip: [Self; 5], grid: &Grid, out: &mut [[Self; 3]; MOST_ELEMENTS]);
}

fn strip_of<T>([slip_x, slip_y, spin_x, spin_y, bound]: [T; 5]) -> Strip<T> {
    Strip { slip_x, slip_y, spin_x, spin_y, bound }
}

impl RunStrips for f64 {
    #[inline]
    fn run_strips(strip: [f64; 5], grid: &Grid, out: &mut [[f64; 3]; MOST_ELEMENTS]) {
        let strip = strip_of(strip.map(Lanes::constant));
        for (first, (y, half)) in grid.y.chunks_exact(4).zip(grid.half.chunks_exact(4)).enumerate() {
            let four = |v: &[f64]| Lanes::from([v[0], v[1], v[2], v[3]]);
            let sums = strip.run(grid.nx, four(y), four(half)).map(Lanes::to_array);
            for (l, out) in out[4 * first..4 * first + 4].iter_mut().enumerate() {
                *out = [sums[0][l], sums[1][l], sums[2][l]];
            }
        }
    }
}

impl<const N: usize> RunStrips for crate::Dual<N> {
    fn run_strips(strip: [Self; 5], grid: &Grid, out: &mut [[Self; 3]; MOST_ELEMENTS]) {
        let strip = strip_of(strip);
        for (j, out) in out.iter_mut().enumerate().take(grid.ny) {
            *out = strip.run(grid.nx, Self::constant(grid.y[j]), Self::constant(grid.half[j]));
        }
    }
}

pub(super) fn fastsim<S: RunStrips>(kalker: &Kalker, shear_modulus: f64, grid: &Grid, c: &RollingContact<S>) -> [S; 3] {
    let [c11, c22, c23, _] = kalker.at(c.a / c.b);
    // a / L with L1 = 8 a / (3 G C11), L2 = 8 a / (3 G C22), L3 = pi a sqrt(a/b) / (4 G C23).
    let inverse = [c11 * (0.375 * shear_modulus), c22 * (0.375 * shear_modulus)];
    let spin = c23 * (4.0 / PI * shear_modulus) * c.phi / (c.a / c.b).sqrt();
    let peak = c.friction * c.normal_force * (2.0 / PI * grid.bound) / (c.a * c.b);
    let mut strips = [[S::zero(); 3]; MOST_ELEMENTS];
    S::run_strips([inverse[0] * c.xi, inverse[1] * c.eta, spin * c.b, spin * c.a, peak], grid, &mut strips);
    // Summed in pairs from the edges inwards, so that a mirrored contact gives the mirrored force bitwise.
    let (mut fx, mut fy, mut mz) = (S::zero(), S::zero(), S::zero());
    for j in 0..grid.ny.div_ceil(2) {
        let k = grid.ny - 1 - j;
        let ([xj, yj, mj], [xk, yk, mk]) = (strips[j], strips[k]);
        if j == k {
            (fx, fy, mz) = (fx + xj, fy + yj, mz + c.a * mj);
        } else {
            (fx, fy) = (fx + (xj + xk), fy + (yj + yk));
            mz += c.a * (mj + mk) + c.b * (xj - xk) * -grid.y[j];
        }
    }
    let element = c.a * c.b * (2.0 / grid.ny as f64);
    [fx * element, fy * element, mz * element]
}
