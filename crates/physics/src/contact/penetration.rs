//! Virtual penetration after Kik and Piotrowski, with the pressure of each strip from its own curvatures and the approach
//! met on every strip (Boussinesq): exact for Hertz's contact at any ratio of axes, and for two humps that share a patch.

use super::geometry::Strips;
use super::hertz::ellipse;
use super::influence::{Influence, Influences};
use super::normal::{Load, PatchDetail, Start};
use core::f64::consts::{FRAC_PI_2, PI};

/// Strips across the interpenetration area; the patch takes half to nine tenths of them.
const STRIPS: usize = 28;
/// Half-width of the second difference that gives the curvature of a strip, over a b / sqrt(a^2 + b^2).
const REACH: f64 = 0.35;
/// Newton's steps at most, and the error of the approach, over the penetration, before the last of them.
const STEPS: usize = 20;
const TOLERANCE: f64 = 4e-3;

/// Strips of one interpenetration area.
struct Area {
    width: f64,
    /// Place of each strip among the given ones, in their widths.
    place: Vec<f64>,
    /// Penetration, m.
    depth: Vec<f64>,
    /// Pressure over half-length k, Pa/m.
    stiffness: Vec<f64>,
    /// Borders of the zone that cut the patch, m from the first strip, and how much of the patch lies beyond: 0 to 1.
    mirrors: [(f64, f64); 2],
}

/// A solved patch, from which the one of the next smaller penetration of the same strips starts.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    /// Largest penetration, m.
    depth: f64,
    /// Squared half-lengths at the places `first + j step`, among the given strips, in their widths.
    first: f64,
    step: f64,
    squares: Vec<f64>,
}

impl Solved {
    /// Edges of the patch: a smaller penetration has no strip beyond them.
    fn edges(&self) -> [f64; 2] {
        let first = self.squares.iter().position(|&s| s > 0.0).unwrap_or(0);
        let last = self.squares.iter().rposition(|&s| s > 0.0).unwrap_or(0);
        [first as f64 - 0.5, last as f64 + 0.5].map(|j| self.first + j * self.step)
    }
}

/// The load of `strips` whose normal `penetration` is given; `start` is the Hertz contact that fits best.
pub(super) fn solve(
    strips: &Strips,
    penetration: &[f64],
    (radius, pair_modulus): (f64, f64),
    start: &Start,
    before: &mut Option<Solved>,
) -> Option<Load> {
    let before_deeper = before.take().filter(|s| s.depth > start.depth);
    let limits = before_deeper.as_ref().map_or([f64::NEG_INFINITY, f64::INFINITY], Solved::edges);
    let area = Area::new(strips, penetration, (radius, pair_modulus), start, limits)?;
    // Squared half-lengths: those of the Hertz contact, or the known ones less what the difference in depth takes off.
    let gain = start.a * start.a / (start.epsilon * start.depth);
    let mut squares: Vec<f64> = if let Some(s) = &before_deeper {
        let less = gain * start.epsilon * (s.depth - start.depth);
        let known = |&x: &f64| (between(&s.squares, (x - s.first) / s.step) - less).max(0.0);
        area.place.iter().map(known).collect()
    } else {
        area.depth.iter().map(|d| gain * (d - (1.0 - start.epsilon) * start.depth).max(0.0)).collect()
    };
    let mut work = Work::new();
    for _ in 0..STEPS {
        if area.improve(&mut squares, start.depth, pair_modulus, &mut work) < TOLERANCE {
            break;
        }
    }
    let load = area.load(strips, &squares);
    *before = Some(Solved { depth: start.depth, first: area.place[0], step: area.width / strips.width, squares });
    load
}

/// `values` at the place `x`, in strips.
fn between(values: &[f64], x: f64) -> f64 {
    let k = (x.max(0.0) as usize).min(values.len() - 2);
    values[k] + (x - k as f64) * (values[k + 1] - values[k])
}

impl Area {
    fn new(
        strips: &Strips,
        penetration: &[f64],
        (radius, pair_modulus): (f64, f64),
        start: &Start,
        limits: [f64; 2],
    ) -> Option<Self> {
        let last = penetration.len() - 1;
        let (first, end) = (penetration.iter().position(|&p| p > 0.0)?, penetration.iter().rposition(|&p| p > 0.0)?);
        if last < 4 {
            return None;
        }
        // Where the penetration passes through zero, or the zone's border.
        let cross = |i: usize, o: usize| penetration[i] / (penetration[i] - penetration[o]);
        let low = if first == 0 { -0.5 } else { first as f64 - cross(first, first - 1) };
        let high = if end == last { last as f64 + 0.5 } else { end as f64 + cross(end, end + 1) };
        let (low, high) = (low.max(limits[0]), high.min(limits[1]));
        let count = STRIPS.min(((high - low).ceil() as usize).max(8));
        let step = (high - low) / count as f64;
        let place: Vec<f64> = (0..count).map(|j| low + (j as f64 + 0.5) * step).collect();
        let depth: Vec<f64> = place.iter().map(|&x| between(penetration, x)).collect();
        let reach = REACH * start.a * start.b / start.a.hypot(start.b) / strips.width;
        let reach = reach.clamp(1.0, 0.5 * last as f64);
        let stiffness = place.iter().map(|&x| {
            let about = x.clamp(reach, last as f64 - reach);
            let [before, here, after] = [about - reach, about, about + reach].map(|x| between(penetration, x));
            let across = (2.0 * here - before - after) / (2.0 * (reach * strips.width).powi(2));
            let along = 0.5 * between(&strips.cos, x) / (radius + between(&strips.z, x));
            pair_modulus * along * stiffening(along, across)
        });
        let stiffness = stiffness.collect();
        let edge = |x: f64| (x - low) * strips.width;
        let mirrors = [(edge(-0.5), start.cut[0]), (edge(last as f64 + 0.5), start.cut[1])];
        Some(Self { width: step * strips.width, place, depth, stiffness, mirrors })
    }

    /// One step of Newton's method towards equal approach on all loaded strips; the error before it, over `depth`.
    fn improve(&self, squares: &mut [f64], depth: f64, pair_modulus: f64, work: &mut Work) -> f64 {
        let n = squares.len();
        work.begin(n);
        for (i, &square) in squares.iter().enumerate().filter(|(_, y)| **y > 0.0) {
            self.column(i, square, pair_modulus, work);
            for (u, c) in work.approach.iter_mut().zip(&work.columns[i * n..]) {
                *u += square * c[0];
            }
        }
        for (j, &square) in squares.iter().enumerate() {
            let error = self.depth[j] - work.approach[j];
            if square <= 0.0 && error > 0.0 {
                self.column(j, 0.0, pair_modulus, work);
            }
            if square > 0.0 || error > 0.0 {
                work.active.push(j);
                work.right.push(error);
            }
        }
        let worst = work.right.iter().map(|e| e * e).sum::<f64>() / work.right.len().max(1) as f64;
        work.eliminate(n);
        for (&j, change) in work.active.iter().zip(&work.right) {
            squares[j] = (squares[j] + change).max(0.0);
        }
        worst.sqrt() / depth
    }

    /// What strip `i` does to all strips: the approach over its squared half-length, and the slope of the approach.
    fn column(&self, i: usize, square: f64, pair_modulus: f64, work: &mut Work) {
        let n = self.depth.len();
        // Of a strip without length the slope is infinite in the logarithm: it starts with a hundredth of its width.
        let inverse = 1.0 / square.max(1e-4 * self.width * self.width).sqrt().sqrt();
        let scale = self.stiffness[i] / (PI * pair_modulus);
        let root = self.width.sqrt() * inverse;
        // A strip's own edges lie half a width away on either side, the others whole widths farther.
        let mut near = Influence::default();
        work.apart.clear();
        for (m, edge) in work.edges.iter().enumerate().take(i.max(n - 1 - i) + 1) {
            let far = work.influences.at(edge * root);
            let sides = if m == 0 { 2.0 } else { 1.0 };
            let (f, p) = (sides * (far.integral - near.integral), sides * (far.product - near.product));
            work.apart.push([scale * f, scale * (f - 0.5 * p)]);
            near = far;
        }
        let column = &mut work.columns[i * n..(i + 1) * n];
        for (j, c) in column.iter_mut().enumerate() {
            *c = work.apart[i.abs_diff(j)];
        }
        for &(border, share) in self.mirrors.iter().filter(|m| m.1 > 0.0) {
            for (j, c) in column.iter_mut().enumerate() {
                let t = ((i + j + 1) as f64 * self.width - 2.0 * border).abs();
                let at = |t: f64| work.influences.at(t.max(0.0).sqrt() * inverse);
                let (far, near) = (at(t + 0.5 * self.width), at(t - 0.5 * self.width));
                let (f, p) = (far.integral - near.integral, far.product - near.product);
                c[0] += share * scale * f;
                c[1] += share * scale * (f - 0.5 * p);
            }
        }
    }

    fn load(&self, strips: &Strips, squares: &[f64]) -> Option<Load> {
        let (mut load, mut x2, mut side, mut down, mut y, mut z) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        let (mut place, mut place2, mut area, mut pressure) = (0.0, 0.0, 0.0, 0.0_f64);
        for (j, &square) in squares.iter().enumerate().filter(|(_, s)| **s > 0.0) {
            let (x, s) = (self.place[j], (j as f64 + 0.5) * self.width);
            let force = FRAC_PI_2 * self.stiffness[j] * square * self.width;
            load += force;
            x2 += force * square;
            side += force * between(&strips.sin, x);
            down += force * between(&strips.cos, x);
            y += force * between(&strips.y, x);
            z += force * between(&strips.z, x);
            place += force * s;
            place2 += force * s * s;
            area += 2.0 * square.sqrt() * self.width;
            pressure = pressure.max(self.stiffness[j] * square.sqrt());
        }
        if load <= 0.0 {
            return None;
        }
        let variance = place2 / load - (place / load).powi(2) + self.width * self.width / 12.0;
        Some(Load {
            force: side.hypot(down),
            angle: side.atan2(down),
            y: y / load,
            z: z / load,
            a: (1.25 * x2 / load).sqrt(),
            b: (5.0 * variance).sqrt(),
            detail: PatchDetail { area, pressure },
        })
    }
}

/// Pressure over half-length of a Hertz contact, over E* A: 1 for a line across the rolling direction, 4/pi for a circle.
///
/// Between two humps the curvature `across` is negative, where Hertz has no answer: the reciprocal goes on smoothly.
fn stiffening(along: f64, across: f64) -> f64 {
    let ratio = (across / along).abs().max(1e-6);
    let e = ellipse(1.0, ratio);
    let factor = 1.5 * e.load * ratio / (PI * e.ratio * e.ratio * e.epsilon);
    if across >= 0.0 { factor } else { 1.0 / factor }
}

/// Arrays of Newton's method.
struct Work {
    influences: Influences,
    /// Roots of the distances of a strip's edges, in widths.
    edges: [f64; STRIPS],
    /// Approach and slope for strips so many widths apart.
    apart: Vec<[f64; 2]>,
    /// Of strip i at strip j, at i n + j: approach over squared half-length, and slope of the approach over it.
    columns: Vec<[f64; 2]>,
    approach: Vec<f64>,
    active: Vec<usize>,
    right: Vec<f64>,
    matrix: Vec<f64>,
}

impl Work {
    fn new() -> Self {
        Self {
            influences: Influences::new(),
            edges: core::array::from_fn(|m| (m as f64 + 0.5).sqrt()),
            apart: vec![],
            columns: vec![],
            approach: vec![],
            active: vec![],
            right: vec![],
            matrix: vec![],
        }
    }

    fn begin(&mut self, n: usize) {
        self.approach.clear();
        self.approach.resize(n, 0.0);
        self.columns.resize(n * n, [0.0; 2]);
        self.active.clear();
        self.right.clear();
    }

    /// Solves the active rows and columns of the slopes for `right` in its place; the diagonal is the largest, so Gauss's
    /// elimination needs no pivots.
    fn eliminate(&mut self, n: usize) {
        let (m, x) = (self.active.len(), &mut self.right);
        self.matrix.clear();
        for &j in &self.active {
            self.matrix.extend(self.active.iter().map(|&i| self.columns[i * n + j][1]));
        }
        for k in 0..m {
            let (upper, lower) = self.matrix.split_at_mut((k + 1) * m);
            let pivot = &upper[k * m + k..];
            for (r, row) in lower.chunks_exact_mut(m).enumerate() {
                let factor = row[k] / pivot[0];
                for (c, p) in row[k + 1..].iter_mut().zip(&pivot[1..]) {
                    *c -= factor * p;
                }
                x[k + 1 + r] -= factor * x[k];
            }
        }
        for k in (0..m).rev() {
            let row = &self.matrix[k * m..(k + 1) * m];
            let known: f64 = (k + 1..m).map(|c| row[c] * x[c]).sum();
            x[k] = (x[k] - known) / row[k];
        }
    }
}
