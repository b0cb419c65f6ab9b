//! The solver's inner loop: slip of eight neighbouring elements by the tractions of one strip.
//! Written with vector instructions by hand, as the compiler makes a fifth of the speed of plain loops.

/// Elements whose slip is summed at once.
pub(super) const BLOCK: usize = 8;

/// Slip x by x, x by y, y by y and y by x of a block.
pub(super) type Sums = [[f64; BLOCK]; 4];

/// Tractions of a strip's elements, and the kernels xx, xy, yy with BLOCK - 1 values more, which move on by one value
/// to the left from element to element.
#[derive(Clone, Copy)]
pub(super) struct Strip<'a> {
    pub px: &'a [f64],
    pub py: &'a [f64],
    pub kernels: [&'a [f64]; 3],
}

impl<'a> Strip<'a> {
    /// (px, py, [xx, xy, yy]) of every element.
    #[inline(always)]
    fn elements(self) -> impl Iterator<Item = (f64, f64, [&'a [f64]; 3])> {
        let [xx, xy, yy] = self.kernels.map(|k| k.windows(BLOCK).rev());
        let kernels = xx.zip(xy).zip(yy).map(|((xx, xy), yy)| [xx, xy, yy]);
        self.px.iter().zip(self.py).zip(kernels).map(|((&px, &py), k)| (px, py, k))
    }
}

/// Adds up what all the strips do to the block.
pub(super) fn sums<'a>(strips: impl Iterator<Item = Strip<'a>>) -> Sums {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        // SAFETY: the features were just found.
        return unsafe { wide(strips) };
    }
    plain(strips)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn wide<'a>(strips: impl Iterator<Item = Strip<'a>>) -> Sums {
    use core::arch::x86_64::{_mm256_fmadd_pd, _mm256_loadu_pd, _mm256_set1_pd, _mm256_setzero_pd, _mm256_storeu_pd};
    let mut low = [_mm256_setzero_pd(); 4];
    let mut high = low;
    for strip in strips {
        for (px, py, kernels) in strip.elements() {
            let (px, py) = (_mm256_set1_pd(px), _mm256_set1_pd(py));
            // SAFETY: every window has BLOCK = 8 values.
            let four = |from: usize| kernels.map(|k| unsafe { _mm256_loadu_pd(k.as_ptr().add(from)) });
            for ([xx, xy, yy], sum) in [(four(0), &mut low), (four(4), &mut high)] {
                sum[0] = _mm256_fmadd_pd(xx, px, sum[0]);
                sum[1] = _mm256_fmadd_pd(xy, py, sum[1]);
                sum[2] = _mm256_fmadd_pd(yy, py, sum[2]);
                sum[3] = _mm256_fmadd_pd(xy, px, sum[3]);
            }
        }
    }
    let mut sums = [[0.0; BLOCK]; 4];
    for (sum, (low, high)) in sums.iter_mut().zip(low.into_iter().zip(high)) {
        // SAFETY: every sum has room for eight values.
        unsafe {
            _mm256_storeu_pd(sum.as_mut_ptr(), low);
            _mm256_storeu_pd(sum.as_mut_ptr().add(4), high);
        }
    }
    sums
}

fn plain<'a>(strips: impl Iterator<Item = Strip<'a>>) -> Sums {
    let mut sums = [[0.0; BLOCK]; 4];
    for strip in strips {
        for (px, py, [xx, xy, yy]) in strip.elements() {
            for l in 0..BLOCK {
                sums[0][l] += xx[l] * px;
                sums[1][l] += xy[l] * py;
                sums[2][l] += yy[l] * py;
                sums[3][l] += xy[l] * px;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_and_plain_sums_agree() {
        let values = |seed: usize, n: usize| (0..n).map(|i| ((i * 37 + seed) as f64).sin()).collect::<Vec<f64>>();
        let (px, py) = (values(1, 13), values(2, 13));
        let kernels = [3, 4, 5].map(|seed| values(seed, 13 + BLOCK - 1));
        let strip = Strip { px: &px, py: &py, kernels: kernels.each_ref().map(|k| &k[..]) };
        let strips = || [strip, Strip { px: &py, ..strip }].into_iter();
        // The first element goes with the last window.
        let mut direct = 0.0;
        for i in 0..13 {
            direct += kernels[0][12 - i + 2] * (px[i] + py[i]);
        }
        assert!((sums(strips())[0][2] - direct).abs() < 1e-13);
        for (wide, plain) in sums(strips()).as_flattened().iter().zip(plain(strips()).as_flattened()) {
            assert!((wide - plain).abs() < 1e-13, "{wide} {plain}");
        }
    }
}
