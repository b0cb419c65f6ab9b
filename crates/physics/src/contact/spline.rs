//! Tensor products of uniform quadratic B-splines: C1, positive, three nodes an axis.
//! The node values are the coefficients, so a curve f is smoothed by f'' h^2 / 8 and never overshoots.

/// An evenly spaced axis with one node beyond either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub least: f64,
    pub most: f64,
    pub step: f64,
}

/// The three nodes about a place with their weights and the weights of the slope.
struct Stencil {
    first: usize,
    weight: [f64; 3],
    slope: [f64; 3],
}

impl Axis {
    pub fn new(least: f64, most: f64, intervals: usize) -> Self {
        Self { least, most, step: (most - least) / intervals as f64 }
    }
    pub fn len(&self) -> usize {
        ((self.most - self.least) / self.step).round() as usize + 3
    }
    pub fn node(&self, i: usize) -> f64 {
        self.least + (i as f64 - 1.0) * self.step
    }
    #[inline(always)]
    fn stencil(&self, x: f64) -> Stencil {
        let place = (x - self.least) / self.step;
        let nearest = (place + 0.5) as usize;
        let f = place - nearest as f64;
        let (l, r) = (0.5 - f, 0.5 + f);
        let k = 1.0 / self.step;
        Stencil {
            first: nearest,
            weight: [0.5 * l * l, 0.75 - f * f, 0.5 * r * r],
            slope: [-l * k, -2.0 * f * k, r * k],
        }
    }
}

/// K values over two axes, the last one fastest.
pub(super) fn plane<const K: usize>(nodes: &[[f64; K]], axes: &[Axis; 2], x: [f64; 2]) -> ([f64; K], [[f64; 2]; K]) {
    let (u, v) = (axes[0].stencil(x[0]), axes[1].stencil(x[1]));
    let (mut value, mut jacobian) = ([0.0; K], [[0.0; 2]; K]);
    for i in 0..3 {
        let row = (u.first + i) * axes[1].len() + v.first;
        for j in 0..3 {
            let w = [u.weight[i] * v.weight[j], u.slope[i] * v.weight[j], u.weight[i] * v.slope[j]];
            for k in 0..K {
                let c = nodes[row + j][k];
                value[k] += w[0] * c;
                jacobian[k][0] += w[1] * c;
                jacobian[k][1] += w[2] * c;
            }
        }
    }
    (value, jacobian)
}

/// K values over three axes, the last one fastest.
#[inline]
pub(super) fn space<const K: usize>(nodes: &[[f64; K]], axes: &[Axis; 3], x: [f64; 3]) -> [f64; K] {
    let [u, v, t] = [0, 1, 2].map(|i| axes[i].stencil(x[i]));
    let mut value = [0.0; K];
    for i in 0..3 {
        for j in 0..3 {
            let row = ((u.first + i) * axes[1].len() + v.first + j) * axes[2].len() + t.first;
            let w = u.weight[i] * v.weight[j];
            let line: &[[f64; K]; 3] = nodes[row..row + 3].try_into().expect("three nodes");
            for k in 0..K {
                let c = t.weight[0] * line[0][k] + t.weight[1] * line[1][k] + t.weight[2] * line[2][k];
                value[k] += w * c;
            }
        }
    }
    value
}

/// The values of `space`, bitwise, and their Jacobian.
pub(super) fn space_slopes<const K: usize>(
    nodes: &[[f64; K]],
    axes: &[Axis; 3],
    x: [f64; 3],
) -> ([f64; K], [[f64; 3]; K]) {
    let [u, v, t] = [0, 1, 2].map(|i| axes[i].stencil(x[i]));
    let (mut value, mut jacobian) = ([0.0; K], [[0.0; 3]; K]);
    for i in 0..3 {
        for j in 0..3 {
            let row = ((u.first + i) * axes[1].len() + v.first + j) * axes[2].len() + t.first;
            let w = [u.weight[i] * v.weight[j], u.slope[i] * v.weight[j], u.weight[i] * v.slope[j]];
            for k in 0..K {
                let line = [nodes[row][k], nodes[row + 1][k], nodes[row + 2][k]];
                let c = t.weight[0] * line[0] + t.weight[1] * line[1] + t.weight[2] * line[2];
                let dc = t.slope[0] * line[0] + t.slope[1] * line[1] + t.slope[2] * line[2];
                value[k] += w[0] * c;
                jacobian[k][0] += w[1] * c;
                jacobian[k][1] += w[2] * c;
                jacobian[k][2] += w[0] * dc;
            }
        }
    }
    (value, jacobian)
}
