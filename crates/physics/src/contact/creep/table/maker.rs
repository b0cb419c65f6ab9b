//! Makes the table: creepages to solve, part by part, and the spline through their forces.
//! Two levels: few elements at every node, and what more elements change at every second node of the ball.

use super::CreepError;
use super::coordinates::{self, RIM, creepage, ratio, unlimited};
use super::file::{self, Quarter, hex};
use super::fit::{Ball, along};
use super::lookup::bounded;
use crate::contact::creep::{Exact, Kalker};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

/// Sources that shape the forces at the nodes.
const SOLVER: [&str; 9] = [
    include_str!("../exact/friction.rs"),
    include_str!("../exact/grid.rs"),
    include_str!("../exact/influence.rs"),
    include_str!("../exact/linear.rs"),
    include_str!("../exact/mod.rs"),
    include_str!("../exact/newton.rs"),
    include_str!("../exact/products.rs"),
    include_str!("../kalker.rs"),
    include_str!("coordinates.rs"),
];

/// Creepages that one part solves, with few elements and for the correction: some seconds either way.
const SHARE: [usize; 2] = [1024, 128];

/// Intervals of one axis, and elements; the solver's own limit is below it.
const MOST_INTERVALS: usize = 100;

/// How fine a table is and of what it is made.
#[derive(Clone, Debug)]
pub struct Maker {
    poisson: f64,
    elements: [[usize; 2]; 2],
    intervals: [usize; 4],
    balls: [Ball; 2],
    kalker: Kalker,
}

/// One of the pieces of work.
struct Part {
    q: usize,
    level: usize,
    places: core::ops::Range<usize>,
}

impl Maker {
    /// Intervals of the table in the package: of u1, u2 and u3 from 0 to 1, and of the slenderness.
    pub const INTERVALS: [usize; 4] = [12, 16, 40, 22];

    /// `elements` along and across the patch, even; a quarter as many are solved at every node.
    /// `intervals` of u1, u2, u3 (even) and of the slenderness.
    ///
    /// ```
    /// use klingel_physics::contact::creep::Maker;
    /// let maker = Maker::new(0.28, [40, 40], Maker::INTERVALS).unwrap();
    /// assert!(maker.parts() > 100);
    /// ```
    ///
    /// # Errors
    /// Poisson's ratio outside 0 to 0.5; elements that are odd or out of the solver's range; odd, no or over 100 intervals.
    pub fn new(poisson: f64, elements: [usize; 2], intervals: [usize; 4]) -> Result<Self, CreepError> {
        let coarse = elements.map(|n| n / 2);
        Exact::check(poisson, elements)?;
        Exact::check(poisson, coarse)?;
        let even = |what: &str, n: usize| {
            let ok = (2..=MOST_INTERVALS).contains(&n) && n.is_multiple_of(2);
            let best = 2 * (n / 2).clamp(2, MOST_INTERVALS / 2);
            let problem = format!("{n} {what} are not an even number up to {MOST_INTERVALS}; take {best}");
            if ok { Ok(()) } else { Err(CreepError::Table { problem }) }
        };
        elements.iter().try_for_each(|&n| even("elements", n))?;
        intervals.iter().try_for_each(|&n| even("intervals", n))?;
        let [n1, n2, n3, _] = intervals;
        let balls = [Ball::new([n1, n2, n3]), Ball::new([n1 / 2, n2 / 2, n3 / 2])];
        Ok(Self { poisson, elements: [coarse, elements], intervals, balls, kalker: Kalker::new(poisson) })
    }

    /// Stands for everything that shapes the numbers: parts of an equal key belong together.
    pub fn key(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(format!("{} {:?} {:?} {SHARE:?}", self.poisson, self.elements, self.intervals));
        for u in self.balls.iter().flat_map(Ball::places).flatten() {
            hash.update(u.to_le_bytes());
        }
        hash.update(Self::solver());
        hex(&hash.finalize())
    }

    /// SHA-256 over the sources of the solver, which the provenance of a table names.
    pub fn solver() -> String {
        let mut hash = Sha256::new();
        SOLVER.iter().for_each(|source| hash.update(source));
        hex(&hash.finalize())
    }

    /// How many pieces the work has.
    pub fn parts(&self) -> usize {
        let shares = |level: usize| self.balls[level].count().div_ceil(SHARE[level]);
        (self.intervals[3] + 1) * (shares(0) + shares(1))
    }

    fn part(&self, index: usize) -> Part {
        let shares = [0, 1].map(|level: usize| self.balls[level].count().div_ceil(SHARE[level]));
        let (q, rest) = (index / (shares[0] + shares[1]), index % (shares[0] + shares[1]));
        let (level, share) = if rest < shares[0] { (0, rest) } else { (1, rest - shares[0]) };
        let end = self.balls[level].count();
        Part { q, level, places: share * SHARE[level]..((share + 1) * SHARE[level]).min(end) }
    }

    /// How many forces part `index` gives.
    pub fn part_len(&self, index: usize) -> usize {
        self.part(index).places.len()
    }

    /// What part `index` solves, for people.
    pub fn describe(&self, index: usize) -> String {
        let part = self.part(index);
        let [nx, ny] = self.elements[part.level];
        format!("a/b = {:.3}, {nx} x {ny} elements", ratio(self.slenderness(part.q)))
    }

    /// Slenderness of node `q`, the middle one and both ends exactly.
    fn slenderness(&self, q: usize) -> f64 {
        let half = self.intervals[3] as f64 / 2.0;
        RIM * ((q as f64 - half) / half)
    }

    /// The forces of part `index`, on all cores, in the solver's units; of the correction, what it adds to them.
    ///
    /// # Errors
    /// A creepage without convergence, which has not been seen.
    pub fn solve(&self, index: usize) -> Result<Vec<[f64; 3]>, CreepError> {
        let Part { q, level, places } = self.part(index);
        let (ratio, scale) = (ratio(self.slenderness(q)), self.scale(q));
        let [coarse, fine] = self.elements;
        let coarse = Exact::new(ratio, self.poisson, coarse)?;
        let fine = if level == 1 { Some(Exact::new(ratio, self.poisson, fine)?) } else { None };
        let force = |&place: &[f64; 3]| {
            let creepage = over(creepage(place), scale);
            let base = coarse.solve(creepage)?.force;
            let Some(fine) = &fine else { return Ok(base) };
            let better = fine.solve(creepage)?.force;
            Ok([0, 1, 2].map(|i| better[i] - base[i]))
        };
        let wanted: Vec<[f64; 3]> = self.balls[level].places().skip(places.start).take(places.len()).collect();
        wanted.par_iter().map(force).collect()
    }

    fn scale(&self, q: usize) -> [f64; 3] {
        coordinates::scales(&self.kalker, ratio(self.slenderness(q)))
    }

    /// The file of the table from the forces of all parts, in their order.
    ///
    /// # Errors
    /// Parts that are missing or of another length.
    pub fn finish(&self, parts: &[Vec<[f64; 3]>]) -> Result<Vec<u8>, CreepError> {
        let fits = parts.len() == self.parts() && parts.iter().enumerate().all(|(i, p)| p.len() == self.part_len(i));
        if !fits {
            return Err(CreepError::Table { problem: "parts are missing or of another table; solve them anew".into() });
        }
        let count = self.intervals[3] + 1;
        let quarters: Vec<Vec<[f64; 3]>> = (0..count)
            .into_par_iter()
            .map(|q| {
                let of = |level: usize| -> Vec<[f64; 3]> {
                    let belongs = |&i: &usize| self.part(i).q == q && self.part(i).level == level;
                    (0..parts.len()).filter(belongs).flat_map(|i| parts[i].iter().copied()).collect()
                };
                self.quarter(q, &of(0), &of(1))
            })
            .collect::<Result<_, _>>()?;
        let nodes =
            (0..quarters[0].len()).flat_map(|node| along(&quarters.iter().map(|f| f[node]).collect::<Vec<_>>()));
        let factors = |q| bounded(self.scale(q), ratio(self.slenderness(q)));
        let scale = along(&(0..count).map(factors).collect::<Vec<_>>());
        let quarter = Quarter { intervals: self.intervals, scale, nodes: nodes.collect() };
        Ok(file::write(&quarter, self.poisson, self.elements, &Self::solver()))
    }

    /// Coefficients over the ball at one slenderness.
    fn quarter(&self, q: usize, base: &[[f64; 3]], correction: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, CreepError> {
        let (ratio, scale) = (ratio(self.slenderness(q)), self.scale(q));
        let coarse = Exact::new(ratio, self.poisson, self.elements[0])?;
        let fine = Exact::new(ratio, self.poisson, self.elements[1])?;
        let sliding = |ellipse: &Exact, place: [f64; 3]| ellipse.sliding(over(place, scale));
        let [ball, second] = &self.balls;
        let correction = second.fit(correction, |place| {
            let (better, base) = (sliding(&fine, place), sliding(&coarse, place));
            core::array::from_fn(|i| better[i] - base[i])
        });
        // The solver's moment is over mu N sqrt(ab), the table's over mu N (a + b)/2.
        let lever = 2.0 / (ratio.sqrt() + 1.0 / ratio.sqrt());
        let stored = |[fx, fy, mz]: [f64; 3]| {
            let over = fx.hypot(fy).max(1.0);
            let [fx, fy] = unlimited([fx / over, fy / over]);
            [fx, fy, mz * lever]
        };
        let forces: Vec<[f64; 3]> = core::iter::zip(ball.places(), base)
            .map(|(place, base)| {
                let more = second.value(&correction, place);
                stored(core::array::from_fn(|i| base[i] + more[i]))
            })
            .collect();
        Ok(ball.quarter(&ball.fit(&forces, |place| stored(sliding(&fine, place)))))
    }
}

/// Creepages without their scale.
fn over(v: [f64; 3], scale: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| v[i] / scale[i])
}
