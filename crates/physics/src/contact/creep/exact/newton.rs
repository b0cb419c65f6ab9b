//! Newton's method for the tractions of all elements; every step is one linear system, solved by GMRES.
//! The friction law of an element is smooth but for one kink, so steps are exact once adhesion and slip are sorted.

use super::friction::{Traction, traction};
use super::grid::Grid;
use super::linear::{Lu, axpy, gmres, norm};

/// Iterations that Newton's method may take, and products that one of its steps may take.
const MOST_STEPS: usize = 60;
const MOST_PRODUCTS: usize = 200;
/// Each linear system is solved to this part of its right-hand side: less costs steps, more costs products.
const INNER_TOLERANCE: f64 = 0.03;
/// The tractions are done when the laws of friction would change them by this part.
pub(super) const TOLERANCE: f64 = 1e-7;

/// Tractions (a field), how many elements slip, and what it took.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub tractions: Vec<f64>,
    pub slipping: usize,
    pub steps: usize,
    pub residual: f64,
}

/// Tractions p, the slip they cause, and how far p is from what the law of friction gives for the slip.
struct State {
    p: Vec<f64>,
    slip: Vec<f64>,
    law: Vec<Traction>,
    residual: Vec<f64>,
}

impl State {
    fn of(grid: &Grid, rigid: &[f64], p: Vec<f64>) -> Self {
        let mut slip = vec![0.0; p.len()];
        grid.slip(&p, &mut slip);
        Self::new(grid, rigid, p, slip)
    }

    fn new(grid: &Grid, rigid: &[f64], p: Vec<f64>, slip: Vec<f64>) -> Self {
        let (n, own) = (grid.size(), grid.along_strip(0));
        let nothing = Traction { value: [0.0; 2], slope: [0.0; 3], slips: false };
        let (mut law, mut residual) = (vec![nothing; n], vec![0.0; 2 * n]);
        for (_, _, k) in grid.elements() {
            let others = [0, 1].map(|c| rigid[c * n + k] + slip[c * n + k] - own[c] * p[c * n + k]);
            law[k] = traction(others, own, grid.bound[k]);
            residual[k] = p[k] - law[k].value[0];
            residual[n + k] = p[n + k] - law[k].value[1];
        }
        Self { p, slip, law, residual }
    }

    /// The relative change that the law of friction asks for; from no traction at all, any change is a whole one.
    fn error(&self) -> f64 {
        let (size, change) = (norm(&self.p), norm(&self.residual));
        if change == 0.0 {
            0.0
        } else if size == 0.0 {
            1.0
        } else {
            change / size
        }
    }

    /// Derivative of the residual along `v`, whose slip is `slip`; the latter is overwritten with the result.
    fn derivative(&self, grid: &Grid, v: &[f64], slip: &mut [f64]) {
        let (n, own) = (grid.size(), grid.along_strip(0));
        for (_, _, k) in grid.elements() {
            let s = [slip[k] - own[0] * v[k], slip[n + k] - own[1] * v[n + k]];
            let [xx, xy, yy] = self.law[k].slope;
            slip[k] = v[k] - (xx * s[0] + xy * s[1]);
            slip[n + k] = v[n + k] - (xy * s[0] + yy * s[1]);
        }
    }

    /// What changes the residual by `b`, to a part of b.
    fn inverse(&self, grid: &Grid, strips: &[Lu], b: &[f64], tolerance: f64) -> Vec<f64> {
        let product = |v: &[f64]| {
            let mut out = vec![0.0; v.len()];
            grid.slip(v, &mut out);
            self.derivative(grid, v, &mut out);
            out
        };
        gmres(b, product, |v| solve_strips(grid, strips, v), tolerance, MOST_PRODUCTS)
    }

    /// The derivative within every strip, ready to be solved: what one strip does to the others is left to GMRES.
    fn strips(&self, grid: &Grid) -> Vec<Lu> {
        let strip = |iy: usize| {
            let m = grid.span[iy].len();
            let mut matrix = vec![0.0; 4 * m * m];
            for i in 0..m {
                let [xx, xy, yy] = self.law[grid.place(grid.span[iy].start + i, iy)].slope;
                let (row_x, row_y) = matrix[4 * m * i..][..4 * m].split_at_mut(2 * m);
                for j in (0..m).filter(|&j| j != i) {
                    let s = grid.along_strip(i as isize - j as isize);
                    (row_x[2 * j], row_x[2 * j + 1]) = (-xx * s[0], -xy * s[1]);
                    (row_y[2 * j], row_y[2 * j + 1]) = (-xy * s[0], -yy * s[1]);
                }
                (row_x[2 * i], row_y[2 * i + 1]) = (1.0, 1.0);
            }
            Lu::new(2 * m, matrix)
        };
        (0..grid.ny).map(strip).collect()
    }
}

/// Solves every strip for itself.
fn solve_strips(grid: &Grid, strips: &[Lu], v: &[f64]) -> Vec<f64> {
    let n = grid.size();
    let mut out = vec![0.0; 2 * n];
    for (iy, lu) in strips.iter().enumerate() {
        let places = || grid.span[iy].clone().map(|ix| grid.place(ix, iy));
        let mut x: Vec<f64> = places().flat_map(|k| [v[k], v[n + k]]).collect();
        lu.solve(&mut x);
        for (k, pair) in places().zip(x.chunks_exact(2)) {
            (out[k], out[n + k]) = (pair[0], pair[1]);
        }
    }
    out
}

/// The tractions for the slip `rigid` (a field) that a rigid wheel would have over one element of rolling.
pub(super) fn solve(grid: &Grid, rigid: &[f64], start: Vec<f64>) -> Found {
    let mut state = State::of(grid, rigid, start);
    let mut steps = 0;
    while state.error() > TOLERANCE && steps < MOST_STEPS {
        steps += 1;
        let step = state.inverse(grid, &state.strips(grid), &state.residual, INNER_TOLERANCE);
        let mut slip = vec![0.0; step.len()];
        grid.slip(&step, &mut slip);
        state = shortened(grid, rigid, &state, &step, &slip);
    }
    let slipping = state.law.iter().filter(|t| t.slips).count();
    Found { slipping, steps, residual: state.error(), tractions: state.p }
}

/// How the tractions `p` that belong to the slip `rigid` change with it, in each of some directions (fields).
pub(super) fn changes(grid: &Grid, rigid: &[f64], p: Vec<f64>, directions: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let state = State::of(grid, rigid, p);
    let (n, strips) = (grid.size(), state.strips(grid));
    let change = |d: &Vec<f64>| {
        let mut by_law = vec![0.0; 2 * n];
        for (_, _, k) in grid.elements() {
            let [xx, xy, yy] = state.law[k].slope;
            by_law[k] = xx * d[k] + xy * d[n + k];
            by_law[n + k] = xy * d[k] + yy * d[n + k];
        }
        state.inverse(grid, &strips, &by_law, TOLERANCE)
    };
    directions.iter().map(change).collect()
}

/// The state after the step, after half of it, ..., whichever first brings a fair gain, or the best of them.
fn shortened(grid: &Grid, rigid: &[f64], from: &State, step: &[f64], slip: &[f64]) -> State {
    let before = norm(&from.residual);
    let mut best: Option<State> = None;
    for part in [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125] {
        let (mut p, mut s) = (from.p.clone(), from.slip.clone());
        axpy(&mut p, -part, step);
        axpy(&mut s, -part, slip);
        let next = State::new(grid, rigid, p, s);
        let size = norm(&next.residual);
        if best.as_ref().is_none_or(|b| size < norm(&b.residual)) {
            best = Some(next);
        }
        if size < before * (1.0 - 0.3 * part) {
            break;
        }
    }
    best.expect("the full step is always looked at")
}
