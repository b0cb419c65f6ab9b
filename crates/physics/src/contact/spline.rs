//! Tensor products of uniform quadratic B-splines: C1, positive, three nodes an axis.
//! Node values taken as coefficients smooth a curve f by f'' h^2 / 8 and never overshoot; sharpened ones follow parabolas.

/// An evenly spaced axis with one node beyond either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub least: f64,
    pub step: f64,
    /// Number of nodes.
    pub len: usize,
}

/// Weights of the three nodes about a place `off` steps behind the middle one.
#[inline(always)]
pub(super) fn weights(off: f64) -> [f64; 3] {
    let (l, r) = (0.5 - off, 0.5 + off);
    [0.5 * l * l, 0.75 - off * off, 0.5 * r * r]
}

/// Slopes of the weights over the place counted in steps.
#[inline(always)]
pub(super) fn slopes(off: f64) -> [f64; 3] {
    [off - 0.5, -2.0 * off, off + 0.5]
}

/// The three nodes about a place with their weights and the weights of the slope.
struct Stencil {
    first: usize,
    weight: [f64; 3],
    slope: [f64; 3],
}

impl Axis {
    pub fn new([least, most]: [f64; 2], intervals: usize) -> Self {
        Self { least, step: (most - least) / intervals as f64, len: intervals + 3 }
    }
    pub fn node(&self, i: usize) -> f64 {
        self.least + (i as f64 - 1.0) * self.step
    }
    #[inline(always)]
    fn stencil(&self, x: f64) -> Stencil {
        let place = (x - self.least) / self.step;
        let nearest = (place + 0.5) as usize;
        let off = place - nearest as f64;
        let steps = 1.0 / self.step;
        Stencil { first: nearest, weight: weights(off), slope: slopes(off).map(|slope| slope * steps) }
    }
}

/// The coefficients whose spline follows the node values of column `k` to third order: a parabola exactly.
///
/// Each axis in turn takes off an eighth of the second difference, which is what the spline smooths away. At a jump or a
/// kink, where neighbouring second differences have other signs or less than half the size, it would overshoot: there
/// no more than twice the smallest of them is taken.
pub(super) fn sharpen(nodes: &mut [f64], columns: usize, k: usize, axes: &[Axis]) {
    let mut stride = columns;
    for axis in axes.iter().rev() {
        for start in (k..nodes.len()).step_by(columns).filter(|start| (start / stride).is_multiple_of(axis.len)) {
            let at = |i: usize| start + i * stride;
            let values: Vec<f64> = (0..axis.len).map(|i| nodes[at(i)]).collect();
            let bends: Vec<f64> = values.windows(3).map(|v| v[0] - 2.0 * v[1] + v[2]).collect();
            for (i, &bend) in bends.iter().enumerate() {
                let sides = [bends[i.max(1) - 1], bends[(i + 1).min(bends.len() - 1)]];
                let most = sides.iter().map(|side| 2.0 * (side * bend.signum()).max(0.0)).fold(f64::INFINITY, f64::min);
                nodes[at(i + 1)] -= 0.125 * bend.clamp(-most, most);
            }
        }
        stride *= axis.len;
    }
}

/// Sums three by three rows of `W` numbers that start at `rows`, each times its weight.
#[inline(always)]
fn rows<const W: usize>(
    nodes: &[f64],
    first: usize,
    stride: usize,
    step: usize,
    u: &[f64; 3],
    v: &[f64; 3],
) -> [f64; W] {
    let mut sum = [0.0; W];
    for (i, u) in u.iter().enumerate() {
        for (j, v) in v.iter().enumerate() {
            let start = first + i * stride + j * step;
            let w = u * v;
            for (s, c) in sum.iter_mut().zip(&nodes[start..start + W]) {
                *s += w * c;
            }
        }
    }
    sum
}

/// K values over two axes, the last one fastest.
#[inline]
pub(super) fn plane<const K: usize>(nodes: &[f64], axes: &[Axis; 2], x: [f64; 2]) -> [f64; K] {
    let (u, v) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]));
    let stride = axes[1].len * K;
    rows(nodes, u.first * stride + v.first * K, stride, K, &u.weight, &v.weight)
}

/// The values of `plane`, bitwise, and their Jacobian.
pub(super) fn plane_slopes<const K: usize>(nodes: &[f64], axes: &[Axis; 2], x: [f64; 2]) -> ([f64; K], [[f64; 2]; K]) {
    let (u, v) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]));
    let stride = axes[1].len * K;
    let sum = |u_weight, v_weight| rows(nodes, u.first * stride + v.first * K, stride, K, u_weight, v_weight);
    let (value, du, dv): ([f64; K], [f64; K], [f64; K]) =
        (sum(&u.weight, &v.weight), sum(&u.slope, &v.weight), sum(&u.weight, &v.slope));
    (value, core::array::from_fn(|k| [du[k], dv[k]]))
}

/// K values over three axes, the last one fastest.
pub(super) fn space_plain<const K: usize>(nodes: &[f64], axes: &[Axis; 3], x: [f64; 3]) -> [f64; K] {
    let (u, v, t) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]), axes[2].stencil(x[2]));
    let (step, stride) = (axes[2].len * K, axes[1].len * axes[2].len * K);
    let mut sum = [0.0; K];
    for (i, w) in t.weight.iter().enumerate() {
        let first = u.first * stride + v.first * step + (t.first + i) * K;
        let row: [f64; K] = rows(nodes, first, stride, step, &u.weight, &v.weight);
        sum.iter_mut().zip(row).for_each(|(s, r)| *s += w * r);
    }
    sum
}

/// Six values over three axes, the last one fastest.
#[inline]
pub(super) fn space(nodes: &[f64], axes: &[Axis; 3], x: [f64; 3]) -> [f64; 6] {
    #[cfg(target_arch = "x86_64")]
    {
        /// The same operations for wider registers; without fused operations the result is the same bitwise.
        #[target_feature(enable = "avx2")]
        fn wide(nodes: &[f64], axes: &[Axis; 3], x: [f64; 3]) -> [f64; 6] {
            space_any(nodes, axes, x)
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the feature was just found.
            return unsafe { wide(nodes, axes, x) };
        }
    }
    space_any(nodes, axes, x)
}

#[inline(always)]
fn space_any(nodes: &[f64], axes: &[Axis; 3], x: [f64; 3]) -> [f64; 6] {
    let (u, v, t) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]), axes[2].stencil(x[2]));
    let (step, stride) = (axes[2].len * 6, axes[1].len * axes[2].len * 6);
    let line = rows(nodes, u.first * stride + v.first * step + t.first * 6, stride, step, &u.weight, &v.weight);
    along(&line, &t.weight)
}

/// The values of `space`, bitwise, and their Jacobian.
pub(super) fn space_slopes(nodes: &[f64], axes: &[Axis; 3], x: [f64; 3]) -> ([f64; 6], [[f64; 3]; 6]) {
    let (u, v, t) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]), axes[2].stencil(x[2]));
    let (step, stride) = (axes[2].len * 6, axes[1].len * axes[2].len * 6);
    let first = u.first * stride + v.first * step + t.first * 6;
    let sum = |u_weight, v_weight| rows(nodes, first, stride, step, u_weight, v_weight);
    let line = sum(&u.weight, &v.weight);
    let (value, dt) = (along(&line, &t.weight), along(&line, &t.slope));
    let (du, dv) = (along(&sum(&u.slope, &v.weight), &t.weight), along(&sum(&u.weight, &v.slope), &t.weight));
    (value, core::array::from_fn(|k| [du[k], dv[k], dt[k]]))
}

#[inline(always)]
fn along(line: &[f64; 18], w: &[f64; 3]) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for (k, s) in sum.iter_mut().enumerate() {
        *s = w[0] * line[k] + w[1] * line[6 + k] + w[2] * line[12 + k];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sharpened_nodes_follow_a_parabola() {
        let axes = [Axis::new([0.0, 2.0], 8), Axis::new([-1.0, 1.0], 6)];
        let f = |x: f64, y: f64| 1.0 + x * x - 3.0 * x * y + 2.0 * y * y;
        let mut nodes: Vec<f64> = (0..axes[0].len * axes[1].len)
            .map(|i| f(axes[0].node(i / axes[1].len), axes[1].node(i % axes[1].len)))
            .collect();
        sharpen(&mut nodes, 1, 0, &axes);
        for (x, y) in [(0.3, 0.1), (1.1, -0.45), (1.62, 0.5)] {
            assert!((plane::<1>(&nodes, &axes, [x, y])[0] - f(x, y)).abs() < 1e-12);
        }
    }

    #[test]
    fn planes_are_exact_and_slopes_are_those_of_the_values() {
        let axes = [Axis::new([0.0, 2.0], 4), Axis::new([-1.0, 1.0], 5), Axis::new([0.0, 1.0], 3)];
        let mut nodes = vec![];
        for i in 0..axes[0].len {
            for j in 0..axes[1].len {
                for k in 0..axes[2].len {
                    let (x, y, z) = (axes[0].node(i), axes[1].node(j), axes[2].node(k));
                    nodes.extend([1.0 + x - 2.0 * y + 3.0 * z, x * y, y * z, x * x, (x + y).sin(), z.exp()]);
                }
            }
        }
        let (h, at) = (1e-6, [0.37, -0.21, 0.66]);
        let (value, slopes) = space_slopes(&nodes, &axes, at);
        assert_eq!(value, space(&nodes, &axes, at));
        assert!((value[0] - (1.0 + at[0] - 2.0 * at[1] + 3.0 * at[2])).abs() < 1e-12);
        // x^2 is smoothed by f'' h^2 / 8.
        assert!((value[3] - at[0] * at[0] - 0.25 * 0.25).abs() < 1e-12);
        for m in 0..3 {
            let (mut up, mut down) = (at, at);
            (up[m], down[m]) = (at[m] + h, at[m] - h);
            let (up, down) = (space(&nodes, &axes, up), space(&nodes, &axes, down));
            for k in 0..6 {
                assert!((slopes[k][m] - (up[k] - down[k]) / (2.0 * h)).abs() < 1e-8);
            }
        }
    }
}
