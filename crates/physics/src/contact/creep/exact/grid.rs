//! The elements of one ellipse, their friction bounds, and the slip that their tractions cause.
//! Lengths over sqrt(ab), tractions over mu N/(ab), creepages times G a b/(mu N): nothing else is left of the units.

use super::influence::Influence;
use super::products::{BLOCK, Strip, sums};
use core::f64::consts::FRAC_PI_4;
use core::ops::Range;

/// Elements in strips along the rolling direction (x); a field has `size` values along x, then `size` across.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    nx: usize,
    pub ny: usize,
    /// Sides of an element.
    pub sides: [f64; 2],
    middle: [Vec<f64>; 2],
    /// The elements of each strip whose middles lie within the ellipse.
    pub span: Vec<Range<usize>>,
    /// Greatest traction of every element; 0 outside the ellipse.
    pub bound: Vec<f64>,
    /// Slip along x by x, along one axis by the other, and across by across, for every distance of two strips. At
    /// `nx - 1 + observed - loaded`, so that one loaded element's share in a block of neighbours lies side by side.
    kernel: Vec<[Vec<f64>; 3]>,
}

impl Grid {
    /// The ellipse with the ratio a/b of its semi-axes and a b = 1 in a box of nx x ny elements.
    ///
    /// The elements' sides are stretched by a few tenths of a percent so that together they have the ellipse's area;
    /// otherwise its ragged edge would not let coarse and fine grids be extrapolated.
    pub fn new(ratio: f64, poisson: f64, [nx, ny]: [usize; 2]) -> Self {
        let unit = |i: usize, n: usize| (2 * i + 1) as f64 / n as f64 - 1.0;
        let depth = |ix: usize, iy: usize| 1.0 - unit(ix, nx).powi(2) - unit(iy, ny).powi(2);
        let span: Vec<_> = (0..ny)
            .map(|iy| {
                let count = (0..nx).filter(|&ix| depth(ix, iy) > 0.0).count();
                (nx - count) / 2..(nx + count) / 2
            })
            .collect();
        let count: usize = span.iter().map(|s| s.len()).sum();
        let stretch = (FRAC_PI_4 * (nx * ny) as f64 / count as f64).sqrt();
        let half = [stretch * ratio.sqrt(), stretch / ratio.sqrt()];
        let sides = [2.0 * half[0] / nx as f64, 2.0 * half[1] / ny as f64];
        let middle = [(nx, half[0]), (ny, half[1])].map(|(n, h)| (0..n).map(|i| h * unit(i, n)).collect());

        let mut bound = vec![0.0; ny * nx];
        for (iy, s) in span.iter().enumerate() {
            s.clone().for_each(|ix| bound[iy * nx + ix] = depth(ix, iy).sqrt());
        }
        // Hertz's half ellipsoid, scaled so that the elements carry mu N exactly.
        let volume = bound.iter().sum::<f64>() * sides[0] * sides[1];
        bound.iter_mut().for_each(|g| *g /= volume);

        let kernel = (0..ny).map(|dy| kernel_row(nx, dy, sides, poisson)).collect();
        Self { nx, ny, sides, middle, span, bound, kernel }
    }

    /// Values of one component of a field.
    pub fn size(&self) -> usize {
        self.bound.len()
    }

    /// (x, y, place in a field) of all elements, strip by strip.
    pub fn elements(&self) -> impl Iterator<Item = (f64, f64, usize)> {
        let places = |iy: usize| self.span[iy].clone().map(move |ix| (ix, iy));
        (0..self.ny).flat_map(places).map(|(ix, iy)| (self.middle[0][ix], self.middle[1][iy], self.place(ix, iy)))
    }

    pub fn place(&self, ix: usize, iy: usize) -> usize {
        iy * self.nx + ix
    }

    /// The tractions `p` of a coarser division of the same ellipse, in the same parts of the friction bound.
    pub fn refined(&self, coarse: &Self, p: &[f64]) -> Vec<f64> {
        let mut fine = vec![0.0; 2 * self.size()];
        for iy in 0..self.ny {
            for ix in self.span[iy].clone() {
                let (k, c) = (self.place(ix, iy), coarse.place(ix * coarse.nx / self.nx, iy * coarse.ny / self.ny));
                if coarse.bound[c] > 0.0 {
                    let scale = self.bound[k] / coarse.bound[c];
                    (fine[k], fine[self.size() + k]) = (scale * p[c], scale * p[coarse.size() + c]);
                }
            }
        }
        fine
    }

    /// Slip along and across that an element's traction causes `ahead` elements in front of it.
    /// Within a strip neither direction causes the other.
    pub fn along_strip(&self, ahead: isize) -> [f64; 2] {
        let k = (self.nx - 1).wrapping_add_signed(ahead);
        [self.kernel[0][0][k], self.kernel[0][2][k]]
    }

    /// Slip of every element over the time in which a wheel rolls by one element, from the tractions `p`.
    pub fn slip(&self, p: &[f64], out: &mut [f64]) {
        let (px, py) = p.split_at(self.size());
        let (out_x, out_y) = out.split_at_mut(self.size());
        for (iy, span) in self.span.iter().enumerate() {
            for first in span.clone().step_by(BLOCK) {
                let strips = |range: Range<usize>| sums(range.map(|jy| self.strip(first, iy, jy, px, py)));
                let (above, below) = (strips(0..iy), strips(iy..self.ny));
                let at = self.place(first, iy);
                for l in 0..BLOCK.min(span.end - first) {
                    // The influence of one direction on the other is odd in y.
                    out_x[at + l] = (above[0][l] + below[0][l]) + (above[1][l] - below[1][l]);
                    out_y[at + l] = (above[2][l] + below[2][l]) + (above[3][l] - below[3][l]);
                }
            }
        }
    }

    /// The tractions of strip jy and their kernels for the block that begins at (first, iy).
    #[inline(always)]
    fn strip<'a>(&'a self, first: usize, iy: usize, jy: usize, px: &'a [f64], py: &'a [f64]) -> Strip<'a> {
        let span = &self.span[jy];
        let loaded = self.place(span.start, jy)..self.place(span.end, jy);
        let from = self.nx + first - span.end;
        let kernel = &self.kernel[iy.abs_diff(jy)];
        let kernels = kernel.each_ref().map(|k| &k[from..from + span.len() + BLOCK - 1]);
        Strip { px: &px[loaded.clone()], py: &py[loaded], kernels }
    }
}

/// Differences of the influence over one element of rolling: a particle comes from the element ahead of it.
fn kernel_row(nx: usize, dy: usize, sides: [f64; 2], poisson: f64) -> [Vec<f64>; 3] {
    let at = |dx: f64| Influence::of_rectangle(dx * sides[0], dy as f64 * sides[1], sides, poisson);
    let step = |k: usize| {
        let ahead = k as f64 - (nx - 1) as f64;
        let (now, before) = (at(ahead), at(ahead + 1.0));
        [now.xx - before.xx, now.xy - before.xy, now.yy - before.yy]
    };
    let steps: Vec<_> = (0..2 * nx - 1).map(step).chain([[0.0; 3]; BLOCK - 1]).collect();
    [0, 1, 2].map(|c| steps.iter().map(|s| s[c]).collect())
}
