//! Kalker's simplified theory FASTSIM (Vehicle System Dynamics 11, 1982, 1-13) under a parabolic traction bound.
//! All strips advance side by side from their leading edges, so the compiler runs four of them at a time.

use super::{RollingContact, flexibility::Stiffness};
use crate::{Mask, Scalar};
use core::f64::consts::{FRAC_PI_2, PI};

/// Most strips and most elements a strip.
pub const MOST_ELEMENTS: usize = 40;

/// The division of the unit circle: `ny` strips of `nx` elements each.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    nx: usize,
    /// For each element of a strip its middle x (in half lengths of the strip) and 1 - x^2.
    x: Vec<[f64; 2]>,
    fours: Vec<FourStrips>,
    /// Width of a strip.
    width: f64,
    /// Exact over discrete volume of the traction bound, so that full slip gives mu N.
    bound: f64,
}

/// Four strips, in two pairs that mirror each other: middle, half length, and weights of a strip's sums.
///
/// As mirrored strips are neighbours, a mirrored contact sums up to the mirrored force bitwise. The middle strip of an odd
/// number pairs with itself at half weight; strips that fill up the last four have none.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct FourStrips {
    y: [f64; 4],
    half: [f64; 4],
    weight: [f64; 4],
}

impl Grid {
    pub fn new(nx: usize, ny: usize) -> Self {
        let middle = |j: usize| (2.0 * j as f64 + 1.0 - ny as f64) / ny as f64;
        let pairs = ny.div_ceil(2);
        let strip = |i: usize| {
            let (j, mirrored) = ((i / 2).min(pairs - 1), i % 2 == 1);
            let y = if mirrored { middle(ny - 1 - j) } else { middle(j) };
            let share = if i / 2 >= pairs {
                0.0
            } else if 2 * j + 1 == ny {
                0.5
            } else {
                1.0
            };
            (y, (1.0 - y * y).sqrt(), share)
        };
        let fours: Vec<FourStrips> = (0..pairs.div_ceil(2))
            .map(|g| {
                let four = [0, 1, 2, 3].map(|l| strip(4 * g + l));
                let (y, half) = (four.map(|s| s.0), four.map(|s| s.1));
                FourStrips { y, half, weight: four.map(|(_, half, share)| share * half * 2.0 / nx as f64) }
            })
            .collect();
        let x = |i: usize| 1.0 - (2 * i + 1) as f64 / nx as f64;
        // Midpoint sum of (l^2 - x^2) over a strip: 4/3 l^3 (1 + 1/(2 nx^2)).
        let strips = (0..ny).map(|j| (1.0 - middle(j).powi(2)).powf(1.5));
        let volume = strips.sum::<f64>() * (4.0 / 3.0) * (1.0 + 0.5 / (nx * nx) as f64) * 2.0 / ny as f64;
        let x = (0..nx).map(|i| [x(i), 1.0 - x(i) * x(i)]).collect();
        Self { nx, x, fours, width: 2.0 / ny as f64, bound: FRAC_PI_2 / volume }
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
    fn new(nx: f64, strips: &FourStrips, slip: &Slip<T>) -> Self {
        let mut s = Self::default();
        for l in 0..4 {
            let half = strips.half[l];
            // A whole step to the middle of the first element, as Kalker has it, sums to (1 + 1/nx) of the linear theory.
            let step = half * (2.0 / (nx + 1.0));
            s.step_x[l] = (slip.xi - slip.phi_y * strips.y[l]) * step;
            s.step_y[l] = slip.eta * step;
            s.spin[l] = slip.phi_x * (half * half * (2.0 / nx));
            s.bound[l] = slip.bound * (half * half);
        }
        s
    }

    /// Takes one more element, whose middle is at `x` (in half lengths of the strip); `depth` is 1 - x^2.
    #[inline(always)]
    fn element(&mut self, [x, depth]: [f64; 2]) {
        let (mut size2, mut limit, mut slipping) = ([T::zero(); 4], [T::zero(); 4], false);
        for l in 0..4 {
            self.px[l] -= self.step_x[l];
            self.py[l] -= self.step_y[l] + self.spin[l] * x;
            size2[l] = self.px[l].square() + self.py[l].square();
            limit[l] = self.bound[l] * depth;
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

    /// Adds the weighted sums of px, py, x py and y px to those of other strips.
    #[inline(always)]
    fn add_to(&self, strips: &FourStrips, [px, py, x_py, y_px]: &mut [[T; 4]; 4]) {
        for l in 0..4 {
            let (weight, half) = (strips.weight[l], strips.half[l]);
            let along = self.sum[0][l] * weight;
            px[l] += along;
            py[l] += self.sum[1][l] * weight;
            x_py[l] += self.sum[2][l] * (weight * half);
            y_px[l] += along * strips.y[l];
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
    let fours = &mut fours[..grid.fours.len()];
    for (four, strips) in fours.iter_mut().zip(&grid.fours) {
        *four = Four::new(nx, strips, slip);
    }
    for &x in &grid.x {
        for four in fours.iter_mut() {
            four.element(x);
        }
    }
    let mut sums = [[T::zero(); 4]; 4];
    for (four, strips) in fours.iter().zip(&grid.fours) {
        four.add_to(strips, &mut sums);
    }
    sums.map(|[a, b, c, d]| (a + b) + (c + d))
}

/// Grids of up to sixteen strips, the usual ones, need less room.
#[inline(always)]
fn advance_any<T: Scalar>(grid: &Grid, slip: &Slip<T>) -> Sums<T> {
    match grid.fours.len() {
        ..=3 => advance::<T, 3>(grid, slip),
        4 => advance::<T, 4>(grid, slip),
        _ => advance::<T, { MOST_ELEMENTS / 4 }>(grid, slip),
    }
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

/// Rolling forces of one patch from its stiffness a/L and the traction bound of its middle, Pa.
pub(super) fn fastsim<S: Strip>(grid: &Grid, stiffness: &Stiffness<S>, bound: S, c: &RollingContact<S>) -> [S; 3] {
    let spin = stiffness.phi * c.phi;
    let slip = Slip {
        xi: stiffness.xi * c.xi,
        eta: stiffness.eta * c.eta,
        phi_y: spin * c.b,
        phi_x: spin * c.a,
        bound: bound * grid.bound,
    };
    let [fx, fy, along, across] = S::strips(grid, &slip);
    let element = c.a * c.b * grid.width;
    [fx * element, fy * element, (c.a * along - c.b * across) * element]
}

/// The parabolic bound of the middle, Pa: mu 2 N / (pi a b).
pub(super) fn bound<S: Scalar>(c: &RollingContact<S>) -> S {
    c.friction * c.normal_force * (2.0 / PI) / (c.a * c.b)
}
