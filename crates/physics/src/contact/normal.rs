//! The elastic normal contact of one zone of the wheel as a sum over strips (semi-Hertzian, after Kik-Piotrowski and Ayasse-Chollet).
//! Exact for constant curvature; a patch that is cut by a zone border is never counted twice, so loads move over smoothly.

use super::geometry::Strips;
use super::hertz::{Ellipse, ellipse};
use super::penetration::{self, Solved};

/// What the penetration of a zone gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Load {
    /// Size of the resultant, N.
    pub force: f64,
    /// Its angle in the wheel's frame, rad, positive on the flange.
    pub angle: f64,
    /// Load-weighted place on the wheel and radius increment, m.
    pub y: f64,
    pub z: f64,
    /// Semi-axes of the equivalent ellipse along and across the rolling direction, m.
    pub a: f64,
    pub b: f64,
    /// What views show: see [`PatchDetail`].
    pub detail: PatchDetail,
}

/// Size of a patch and its largest pressure: shown by views, not needed by forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchDetail {
    /// Area, m2.
    pub area: f64,
    /// Largest pressure, Pa.
    pub pressure: f64,
}

/// How the elastic normal contact of a patch is computed; both share the zones, the tables and the way they are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalContact {
    /// The Hertz contact of the curvatures that fit the gap of each zone best.
    #[default]
    Hertz,
    /// Virtual penetration after Kik and Piotrowski with elliptic shape correction: patches of any outline.
    KikPiotrowski,
}

/// Load-weighted sums of one pass over the strips.
#[derive(Default)]
struct Sums {
    load: f64,
    place: f64,
    place2: f64,
    curvature: f64,
}

/// The Hertz contact that fits the penetrations of a zone best.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// Largest penetration, m.
    pub depth: f64,
    /// Virtual penetration factor.
    pub epsilon: f64,
    /// Semi-axes, m.
    pub a: f64,
    pub b: f64,
    /// Share of the patch's height that the zone's borders cut, 0 to 1, at its first and at its last strip.
    pub cut: [f64; 2],
}

/// Where an iteration starts: the result at a slightly larger penetration, if there is one.
#[derive(Clone, Debug)]
pub(super) struct Guess {
    pub epsilon: f64,
    pub solved: Option<Solved>,
}

impl Default for Guess {
    fn default() -> Self {
        Self { epsilon: 0.5, solved: None }
    }
}

/// What turns penetrations into loads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solver {
    pub normal: NormalContact,
    /// Nominal radius of the wheel, m.
    pub radius: f64,
    /// Plane-strain modulus of the pair, Pa.
    pub pair_modulus: f64,
}

impl Solver {
    /// The load of `strips` whose `penetration` (normal, m; negative where apart) is given.
    ///
    /// Strip j carries K x_l^2 with x_l^2 = h_j a^2 / (eps d), h_j = penetration - (1 - eps) d; a, eps and K are those of the
    /// Hertz contact with curvature A = mean of cos(angle) / (2 r) along and B = eps d / b^2 across the rolling direction,
    /// b^2 = 5 times the variance of h: eps is found by iteration from the `guess`, which is left for the next one.
    pub fn load(&self, strips: &Strips, penetrations: &[f64], guess: &mut Guess) -> Option<Load> {
        let depth = penetrations.iter().fold(f64::MIN, |m, &p| m.max(p));
        if depth <= 0.0 {
            return None;
        }
        let first = penetrations.iter().position(|&p| p > 0.0)?;
        let end = penetrations.iter().rposition(|&p| p > 0.0)? + 1;
        let mut state = None;
        let mut cut = [0.0; 2];
        for _ in 0..60 {
            let base = (1.0 - guess.epsilon) * depth;
            let loaded = |j: usize| (penetrations[j] - base).max(0.0);
            let mut s = Sums::default();
            for j in first..end {
                let h = loaded(j);
                let place = (j - first) as f64 * strips.width;
                s.load += h;
                s.place += h * place;
                s.place2 += h * place * place;
                s.curvature += h * strips.cos[j] / (self.radius + strips.z[j]);
            }
            // Of a patch that the zone's border cuts only one side is seen: its spread is taken about the border.
            let (mean, last) = (s.place / s.load, (penetrations.len() - 1 - first) as f64 * strips.width);
            let (low, high) = (loaded(0) / (depth - base), loaded(penetrations.len() - 1) / (depth - base));
            cut = [low, high];
            let middle = mean - low * (mean + first as f64 * strips.width) + high * (last - mean);
            // One strip has the variance of its own width.
            let spread = s.place2 / s.load - 2.0 * middle * mean + middle * middle + strips.width * strips.width / 12.0;
            let b = (5.0 * spread).sqrt();
            let along = 0.5 * s.curvature / s.load;
            let across = guess.epsilon * depth / (b * b);
            let e = ellipse(along, across);
            state = Some((e, across));
            let change = e.epsilon - guess.epsilon;
            guess.epsilon = e.epsilon;
            if change.abs() < 1e-7 {
                break;
            }
        }
        let (e, across) = state?;
        if self.normal == NormalContact::KikPiotrowski {
            let b = (e.epsilon * depth / across).sqrt();
            let start = Start { depth, epsilon: e.epsilon, a: e.ratio * b, b, cut };
            return penetration::solve(
                strips,
                penetrations,
                (self.radius, self.pair_modulus),
                &start,
                &mut guess.solved,
            );
        }
        let mut load = resultant(strips, &penetrations[first..end], first, depth, (e, across), self.pair_modulus);
        let area = core::f64::consts::PI * load.a * load.b;
        load.detail = PatchDetail { area, pressure: 1.5 * load.force / area };
        Some(load)
    }
}

/// Sums the strip forces of a solved zone.
fn resultant(
    strips: &Strips,
    penetration: &[f64],
    first: usize,
    depth: f64,
    (e, across): (Ellipse, f64),
    pair_modulus: f64,
) -> Load {
    let b_hertz = (e.epsilon * depth / across).sqrt();
    let a_hertz = e.ratio * b_hertz;
    let stiffness = 0.75 * e.load * pair_modulus * depth / (a_hertz * a_hertz);
    let base = (1.0 - e.epsilon) * depth;
    let (mut load, mut x4, mut side, mut down, mut y, mut z, mut place, mut place2) =
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (i, p) in penetration.iter().enumerate() {
        let (j, h) = (first + i, (p - base).max(0.0));
        let x2 = h * a_hertz * a_hertz / (e.epsilon * depth);
        let force = stiffness * x2 * strips.width;
        let s = i as f64 * strips.width;
        load += force;
        x4 += force * x2;
        side += force * strips.sin[j];
        down += force * strips.cos[j];
        y += force * strips.y[j];
        z += force * strips.z[j];
        place += force * s;
        place2 += force * s * s;
    }
    let variance = place2 / load - (place / load).powi(2) + strips.width * strips.width / 12.0;
    Load {
        force: side.hypot(down),
        angle: side.atan2(down),
        y: y / load,
        z: z / load,
        a: (1.25 * x4 / load).sqrt(),
        b: (5.0 * variance).sqrt(),
        detail: PatchDetail::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::hertz::ellipse;

    /// A level wheel of radius `radius` with the gap B s^2 over a flat rail.
    fn flat(count: usize, width: f64) -> Strips {
        let y: Vec<f64> = (0..count).map(|i| (i as f64 - 0.5 * (count - 1) as f64) * width).collect();
        let (zero, one) = (vec![0.0; count], vec![1.0; count]);
        Strips { width, y, z: zero.clone(), angle: zero.clone(), cos: one, sin: zero }
    }

    const RADIUS: f64 = 0.46;
    const MODULUS: f64 = 1.139e11;
    const HERTZ: Solver = Solver { normal: NormalContact::Hertz, radius: RADIUS, pair_modulus: MODULUS };

    /// Both methods, with the relative error each may have of Hertz.
    const METHODS: [(Solver, f64); 2] =
        [(HERTZ, 1e-3), (Solver { normal: NormalContact::KikPiotrowski, ..HERTZ }, 1.5e-2)];

    #[test]
    fn constant_curvature_gives_hertz_at_any_ratio_of_axes() {
        for (solver, tolerance) in METHODS {
            for (b, depth) in [(0.05, 4e-5), (0.3, 4e-5), (1.6, 7e-5), (6.0, 6e-5), (40.0, 1e-4), (300.0, 1e-4)] {
                let strips = flat(4001, 2e-5);
                let penetration: Vec<f64> = strips.y.iter().map(|y| depth - b * y * y).collect();
                let mut guess = Guess { epsilon: 0.3, ..Guess::default() };
                let load = solver.load(&strips, &penetration, &mut guess).unwrap();
                let hertz = ellipse(0.5 / RADIUS, b);
                let b_hertz = (hertz.epsilon * depth / b).sqrt();
                let a_hertz = hertz.ratio * b_hertz;
                let force = hertz.load * MODULUS * depth * b_hertz;
                let area = core::f64::consts::PI * a_hertz * b_hertz;
                for (name, x, y) in [
                    ("epsilon", guess.epsilon, hertz.epsilon),
                    ("b", load.b, b_hertz),
                    ("a", load.a, a_hertz),
                    ("force", load.force, force),
                    ("area", load.detail.area, area),
                    ("pressure", load.detail.pressure, 1.5 * force / area),
                ] {
                    assert!((x / y - 1.0).abs() < tolerance, "{:?} B {b} {name}: {x} {y}", solver.normal);
                }
                assert!(load.y.abs() < 1e-8 && load.angle.abs() < 1e-12);
            }
        }
    }

    #[test]
    fn load_moves_smoothly_over_a_border_and_is_never_counted_twice() {
        let (b, depth, whole) = (2.0, 7e-5, flat(801, 5e-5));
        for (solver, _) in METHODS {
            let force = |first: usize, end: usize| {
                let part = whole.part(first, end);
                let gap: Vec<f64> = part.y.iter().map(|y| b * y * y).collect();
                let lowest = gap.iter().fold(f64::MAX, |m, &g| m.min(g));
                let penetration: Vec<f64> = gap.iter().map(|g| depth - g).collect();
                let force = solver.load(&part, &penetration, &mut Guess::default()).map_or(0.0, |l| l.force);
                (force, lowest)
            };
            let all = force(0, 801).0;
            let mut before = all;
            for border in (272..=528).step_by(4) {
                let sum = force(0, border).0 + force(border, 801).0;
                assert!(sum < 1.2 * all && sum > 0.998 * all, "border {border}: {} of the load", sum / all);
                assert!((sum - before).abs() < 0.05 * all, "border {border} jumps");
                before = sum;
            }
        }
    }
}
