//! Exact theory: steady rolling of a Hertzian ellipse on elastic half-spaces (Kalker's variational theory).
//! For reference data and tables, not for the simulation loop; the derivation is in docs/theory/exact.md.

mod contacts;
mod friction;
mod grid;
mod influence;
mod linear;
mod newton;
mod products;
#[cfg(test)]
mod tests;

use super::CreepError;
use super::error::out_of_range;
pub use contacts::{exact_force, exact_forces};
use grid::Grid;
use newton::{Found, TOLERANCE};
use rayon::prelude::*;

/// Least and most elements along and across, and semi-axes' ratios.
pub const ELEMENTS: [usize; 2] = [4, 80];
pub const RATIOS: [f64; 2] = [0.02, 50.0];

/// Fewest elements of a division that gives a start for a finer one.
const COARSEST: usize = 10;

/// Where the rigid slip of an element is taken, in elements ahead of its middle.
///
/// The displacement is differenced over one element, so its slip belongs half an element ahead, while the traction in
/// full sliding belongs to the middle. Neither end is right everywhere; the forces of spin converge best in between,
/// and at the value below they agree with CONTACT's at the same grid (docs/theory/exact.md has the figures).
const SLIP_POINT: f64 = 1.0 / 6.0;

/// One contact ellipse cut into elements, ready for any creepage.
///
/// ```
/// use klingel_physics::contact::creep::Exact;
/// let ellipse = Exact::new(1.5, 0.28, [16, 16]).unwrap();
/// let found = ellipse.solve([0.1, 0.0, 0.0]).unwrap();
/// assert!(found.force[0] < -0.3 && found.force[0] > -0.5 && found.force[1].abs() < 1e-6);
/// ```
#[derive(Clone, Debug)]
pub struct Exact {
    grid: Grid,
    /// Half as many elements either way, whose solution is a start.
    coarse: Option<Box<Exact>>,
}

/// Forces and what they were made of.
#[derive(Clone, Debug)]
pub struct ExactSolution {
    /// [Fx, Fy] over mu N and Mz over mu N sqrt(ab), on the wheel; x forward, y right, z down.
    pub force: [f64; 3],
    /// Elements that stick and that slip.
    pub sticking: usize,
    pub slipping: usize,
    /// Steps of Newton's method, and the part by which the laws of friction would still change the tractions.
    pub steps: usize,
    pub residual: f64,
    tractions: Vec<f64>,
}

impl Exact {
    /// The name beside those of `CreepLaw`, in Python.
    pub const NAME: &'static str = "exact";

    /// The ellipse with the semi-axes' ratio a/b (a in the rolling direction) in a box of `elements` along and across.
    ///
    /// # Errors
    /// A ratio outside `RATIOS`, Poisson's ratio outside 0 to 0.5, a number of elements outside `ELEMENTS`.
    pub fn new(ratio: f64, poisson: f64, elements: [usize; 2]) -> Result<Self, CreepError> {
        check("ratio of the semi-axes a/b", ratio, RATIOS, "slender patches are line contacts")?;
        Self::check(poisson, elements)?;
        Ok(Self::divided(ratio, poisson, elements))
    }

    /// Refuses what no ellipse could be made of.
    ///
    /// # Errors
    /// Poisson's ratio outside 0 to 0.5, a number of elements outside `ELEMENTS`.
    pub fn check(poisson: f64, elements: [usize; 2]) -> Result<(), CreepError> {
        check("Poisson's ratio", poisson, [0.0, 0.5], "steel has 0.28")?;
        let range = ELEMENTS.map(|n| n as f64);
        elements.iter().try_for_each(|&n| check("number of elements", n as f64, range, "40 x 40 is usual"))
    }

    fn divided(ratio: f64, poisson: f64, elements: [usize; 2]) -> Self {
        let half = elements.map(|n| n / 2);
        let coarse = half.iter().all(|&n| n >= COARSEST).then(|| Box::new(Self::divided(ratio, poisson, half)));
        Self { grid: Grid::new(ratio, poisson, elements), coarse }
    }

    /// Forces at the creepages [xi, eta, phi sqrt(ab)], each times G a b/(mu N).
    ///
    /// # Errors
    /// A creepage that is not finite; no convergence, which has not been seen.
    pub fn solve(&self, creepage: [f64; 3]) -> Result<ExactSolution, CreepError> {
        self.solve_from(creepage, None)
    }

    /// The same, from a solution of the same ellipse at a creepage nearby, which takes fewer steps.
    ///
    /// # Errors
    /// As `solve`.
    pub fn solve_from(&self, creepage: [f64; 3], start: Option<&ExactSolution>) -> Result<ExactSolution, CreepError> {
        for (what, c) in ["longitudinal creepage", "lateral creepage", "spin"].into_iter().zip(creepage) {
            check(what, c, [f64::MIN, f64::MAX], "creepages are finite numbers")?;
        }
        let n = self.grid.size();
        let start = start.map(|s| &s.tractions).filter(|t| t.len() == 2 * n);
        let found = self.tractions(creepage, start);
        if found.residual > TOLERANCE || found.residual.is_nan() {
            return Err(CreepError::NoConvergence { creepage, steps: found.steps, residual: found.residual });
        }
        Ok(ExactSolution {
            force: self.resultant(&found.tractions),
            sticking: self.grid.elements().count() - found.slipping,
            slipping: found.slipping,
            steps: found.steps,
            residual: found.residual,
            tractions: found.tractions,
        })
    }

    /// Derivatives of the force: row i, column j is the change of `found.force[i]` with `creepage[j]`.
    ///
    /// Exact but for the elements that go over from adhesion to slip, and those carry the same traction either way.
    ///
    /// ```
    /// use klingel_physics::contact::creep::Exact;
    /// let ellipse = Exact::new(1.0, 0.28, [12, 12]).unwrap();
    /// let slopes = ellipse.slopes([0.0; 3], &ellipse.solve([0.0; 3]).unwrap());
    /// assert!((slopes[0][0] + 4.2).abs() < 0.4); // -C11
    /// ```
    pub fn slopes(&self, creepage: [f64; 3], found: &ExactSolution) -> [[f64; 3]; 3] {
        let directions = [0, 1, 2].map(|j| self.rigid_slip(core::array::from_fn(|i| f64::from(i == j))));
        let rigid = self.rigid_slip(creepage);
        let changes = newton::changes(&self.grid, &rigid, found.tractions.clone(), &directions);
        let columns = changes.iter().map(|change| self.resultant(change)).collect::<Vec<_>>();
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]))
    }

    /// Forces of full sliding, the limit of large creepages of this direction.
    ///
    /// ```
    /// use klingel_physics::contact::creep::Exact;
    /// let [fx, fy, _] = Exact::new(1.0, 0.28, [12, 12]).unwrap().sliding([3.0, 4.0, 0.0]);
    /// assert!((fx + 0.6).abs() < 1e-12 && (fy + 0.8).abs() < 1e-12);
    /// ```
    pub fn sliding(&self, creepage: [f64; 3]) -> [f64; 3] {
        let (slip, n) = (self.rigid_slip(creepage), self.grid.size());
        let mut tractions = vec![0.0; 2 * n];
        for (_, _, k) in self.grid.elements() {
            let size = slip[k].hypot(slip[n + k]).max(f64::MIN_POSITIVE);
            let factor = -self.grid.bound[k] / size;
            (tractions[k], tractions[n + k]) = (factor * slip[k], factor * slip[n + k]);
        }
        self.resultant(&tractions)
    }

    /// Forces and moment of tractions.
    fn resultant(&self, tractions: &[f64]) -> [f64; 3] {
        let (n, area) = (self.grid.size(), self.grid.sides[0] * self.grid.sides[1]);
        let mut force = [0.0; 3];
        for (x, y, k) in self.grid.elements() {
            let p = [tractions[k] * area, tractions[n + k] * area];
            force[0] += p[0];
            force[1] += p[1];
            force[2] += x * p[1] - y * p[0];
        }
        force
    }

    /// Forces at many creepages, on all cores.
    ///
    /// # Errors
    /// As `solve`, for the first creepage that fails.
    pub fn forces(&self, creepages: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, CreepError> {
        creepages.par_iter().map(|&c| self.solve(c).map(|found| found.force)).collect()
    }

    /// From the given tractions, or else from those of the coarser division.
    fn tractions(&self, creepage: [f64; 3], start: Option<&Vec<f64>>) -> Found {
        let start = match (start, &self.coarse) {
            (Some(start), _) => start.clone(),
            (None, Some(coarse)) => self.grid.refined(&coarse.grid, &coarse.tractions(creepage, None).tractions),
            (None, None) => vec![0.0; 2 * self.grid.size()],
        };
        newton::solve(&self.grid, &self.rigid_slip(creepage), start)
    }

    /// Slip of every element while the wheel, if it were rigid, rolls by one element.
    fn rigid_slip(&self, [xi, eta, phi]: [f64; 3]) -> Vec<f64> {
        let (n, step) = (self.grid.size(), self.grid.sides[0]);
        let mut slip = vec![0.0; 2 * n];
        for (x, y, k) in self.grid.elements() {
            slip[k] = (xi - phi * y) * step;
            slip[n + k] = (eta + phi * (x + SLIP_POINT * step)) * step;
        }
        slip
    }
}

fn check(what: &str, value: f64, range: [f64; 2], remedy: &str) -> Result<(), CreepError> {
    if (range[0]..=range[1]).contains(&value) { Ok(()) } else { Err(out_of_range(what, value, range, remedy)) }
}
