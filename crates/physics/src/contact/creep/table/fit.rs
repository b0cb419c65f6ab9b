//! Splines through forces at the nodes of the ball of creepages: which places to solve, and the coefficients.
//! Beyond the surface of the ball, which is full sliding, forces go on as their mirror images about it.

use super::coordinates::size;
use crate::contact::spline::weights;

/// Steps beyond the ball that nodes are needed for: one and a half for the spline, one for the ends of the fit.
const MARGIN: f64 = 2.5;
/// Rounds of the fit, each with the nodes beyond the ball from the one before: their change falls below 1e-9.
const ROUNDS: usize = 40;

/// Nodes in and about the ball |u| < 1; forces are solved at those inside, of the quarter u1 >= 0, u3 >= 0.
#[derive(Clone, Debug)]
pub(super) struct Ball {
    intervals: [usize; 3],
    inside: Vec<[i64; 3]>,
    beyond: Vec<[i64; 3]>,
}

/// Numbers at all nodes of the box about the ball, three each.
pub(super) type Field = Vec<[f64; 3]>;

impl Ball {
    pub fn new(intervals: [usize; 3]) -> Self {
        let mut ball = Self { intervals, inside: vec![], beyond: vec![] };
        let [r1, r2, r3] = ball.reach();
        for i in 0..=r1 {
            for j in -r2..=r2 {
                for k in 0..=r3 {
                    let node = [i, j, k];
                    if (k > 0 || j >= 0) && ball.needed(node) {
                        let inside = size(ball.place(node)) < 1.0 - 1e-9;
                        if inside { ball.inside.push(node) } else { ball.beyond.push(node) }
                    }
                }
            }
        }
        ball
    }

    /// How many forces are wanted.
    pub fn count(&self) -> usize {
        self.inside.len()
    }

    /// Where forces are wanted.
    pub fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        self.inside.iter().map(|&node| self.place(node))
    }

    /// The farthest node of each axis.
    fn reach(&self) -> [i64; 3] {
        self.intervals.map(|n| n as i64 + 2)
    }

    /// Whether a node is within the margin of the ball.
    fn needed(&self, node: [i64; 3]) -> bool {
        size([0, 1, 2].map(|a| (node[a].abs() as f64 - MARGIN).max(0.0) / self.intervals[a] as f64)) <= 1.0
    }

    fn place(&self, node: [i64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|a| node[a] as f64 / self.intervals[a] as f64)
    }

    fn lengths(&self) -> [usize; 3] {
        self.reach().map(|r| 2 * r as usize + 1)
    }

    fn index(&self, node: [i64; 3]) -> usize {
        let ([r1, r2, r3], [_, l2, l3]) = (self.reach(), self.lengths());
        ((node[0] + r1) as usize * l2 + (node[1] + r2) as usize) * l3 + (node[2] + r3) as usize
    }

    /// Coefficients of the spline that meets the forces at the places, in the whole box; zero where none are needed.
    ///
    /// `surface` gives the forces of full sliding in a direction. Beyond the surface, forces are twice those there less
    /// those as far below, which the spline itself tells from round to round.
    pub fn fit(&self, forces: &[[f64; 3]], surface: impl Fn([f64; 3]) -> [f64; 3]) -> Field {
        let mirrors: Vec<([f64; 3], [f64; 3])> = self
            .beyond
            .iter()
            .map(|&node| {
                let (place, t) = (self.place(node), size(self.place(node)));
                (surface(place), place.map(|u| u / t * (2.0 - t)))
            })
            .collect();
        let mut beyond: Vec<[f64; 3]> = mirrors.iter().map(|(at, _)| *at).collect();
        for _ in 0..ROUNDS {
            let field = self.through(forces, &beyond);
            for (node, (at, below)) in core::iter::zip(&mut beyond, &mirrors) {
                let value = self.value(&field, *below);
                *node = core::array::from_fn(|f| 2.0 * at[f] - value[f]);
            }
        }
        self.through(forces, &beyond)
    }

    /// Coefficients from the values at the nodes inside and beyond.
    fn through(&self, inside: &[[f64; 3]], beyond: &[[f64; 3]]) -> Field {
        let mut field = vec![[0.0; 3]; self.lengths().iter().product()];
        let values = inside.iter().chain(beyond);
        for (&[i, j, k], &[fx, fy, mz]) in self.inside.iter().chain(&self.beyond).zip(values) {
            // Fx turns with the sign of u1, Fy and Mz with that of (u2, u3).
            for sign in [1, -1] {
                let fx = sign as f64 * fx;
                field[self.index([sign * i, j, k])] = [fx, fy, mz];
                field[self.index([sign * i, -j, -k])] = [fx, -fy, -mz];
            }
        }
        self.settle(&mut field);
        for axis in 0..3 {
            self.sharpen(&mut field, axis);
        }
        field
    }

    /// Forces that are their own mirror images.
    fn settle(&self, field: &mut Field) {
        let [r1, r2, r3] = self.reach();
        for j in -r2..=r2 {
            for k in -r3..=r3 {
                field[self.index([0, j, k])][0] = 0.0;
            }
        }
        for i in -r1..=r1 {
            let middle = &mut field[self.index([i, 0, 0])];
            (middle[1], middle[2]) = (0.0, 0.0);
        }
    }

    /// Turns node values into coefficients along one axis, line by line over the needed nodes.
    fn sharpen(&self, field: &mut Field, axis: usize) {
        let reach = self.reach();
        let [second, third] = [(axis + 1) % 3, (axis + 2) % 3];
        for m in -reach[second]..=reach[second] {
            for n in -reach[third]..=reach[third] {
                let node = |i: i64| {
                    let mut node = [0; 3];
                    (node[axis], node[second], node[third]) = (i, m, n);
                    node
                };
                let line: Vec<usize> = (-reach[axis]..=reach[axis])
                    .filter(|&i| self.needed(node(i)))
                    .map(|i| self.index(node(i)))
                    .collect();
                let mut values: Vec<[f64; 3]> = line.iter().map(|&at| field[at]).collect();
                coefficients(&mut values);
                line.iter().zip(values).for_each(|(&at, value)| field[at] = value);
            }
        }
    }

    /// The spline at a place of the ball.
    pub fn value(&self, field: &Field, place: [f64; 3]) -> [f64; 3] {
        let near: [(i64, [f64; 3]); 3] = core::array::from_fn(|a| {
            let at = place[a] * self.intervals[a] as f64;
            (at.round() as i64, weights(at - at.round()))
        });
        let mut sum = [0.0; 3];
        for (i, u) in (-1..).zip(near[0].1) {
            for (j, v) in (-1..).zip(near[1].1) {
                for (k, w) in (-1..).zip(near[2].1) {
                    let node = field[self.index([near[0].0 + i, near[1].0 + j, near[2].0 + k])];
                    sum = core::array::from_fn(|f| sum[f] + u * v * w * node[f]);
                }
            }
        }
        sum
    }

    /// The stored quarter of the coefficients: u1 and u3 from 0, one step beyond the ball, mirror images made exact.
    pub fn quarter(&self, field: &Field) -> Field {
        let [n1, n2, n3] = self.intervals.map(|n| n as i64);
        let mut quarter = vec![];
        for i in 0..=n1 + 1 {
            for j in -n2 - 1..=n2 + 1 {
                for k in 0..=n3 + 1 {
                    let turned = k == 0 && j < 0;
                    let mut c = field[self.index(if turned { [i, -j, k] } else { [i, j, k] })];
                    if turned {
                        (c[1], c[2]) = (-c[1], -c[2]);
                    }
                    if i == 0 {
                        c[0] = 0.0;
                    }
                    if (j, k) == (0, 0) {
                        (c[1], c[2]) = (0.0, 0.0);
                    }
                    quarter.push(c);
                }
            }
        }
        quarter
    }
}

/// Coefficients along an open axis from the values at its nodes, three or more; one beyond either end, where the parabola
/// of the last three values goes on (its coefficients are its values less an eighth of the second difference).
pub(super) fn along(values: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let beyond = |[end, before, third]: [[f64; 3]; 3]| {
        core::array::from_fn(|k| {
            let bend = end[k] - 2.0 * before[k] + third[k];
            2.0 * end[k] - before[k] + bend - bend / 8.0
        })
    };
    let n = values.len();
    let mut all = vec![beyond([values[0], values[1], values[2]])];
    all.extend(values);
    all.push(beyond([values[n - 1], values[n - 2], values[n - 3]]));
    coefficients(&mut all);
    all
}

/// Solves c[i-1]/8 + 3 c[i]/4 + c[i+1]/8 = value; the first and the last coefficient are their values.
fn coefficients(values: &mut [[f64; 3]]) {
    let n = values.len();
    if n < 3 {
        return;
    }
    // Thomas: the upper diagonal after elimination.
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let pivot = 0.75 - 0.125 * upper[i - 1];
        upper[i] = 0.125 / pivot;
        values[i] = core::array::from_fn(|k| (values[i][k] - 0.125 * values[i - 1][k]) / pivot);
    }
    for i in (1..n - 1).rev() {
        values[i] = core::array::from_fn(|k| values[i][k] - upper[i] * values[i + 1][k]);
    }
}
