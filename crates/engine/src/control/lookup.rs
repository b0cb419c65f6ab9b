//! A function of one variable given by points: linear, or cubic with a continuous slope and no overshoot.
//! Outside the points it reports, or holds the end value where that was asked for.

use super::spec::{Edge, Interpolation};
use klingel_physics::Scalar;

/// The argument that lies outside the points, and the points' range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// Points with slopes at both ends of every interval, so that one Hermite formula serves both interpolations.
#[derive(Clone, Debug, PartialEq)]
pub struct Lookup {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Slopes at the points for the cubic; empty for the linear one.
    slope: Vec<f64>,
    edge: Edge,
}

impl Lookup {
    /// `x` strictly increasing, both of one length, at least two points (the compiler checks).
    pub fn new(x: Vec<f64>, y: Vec<f64>, interpolation: Interpolation, edge: Edge) -> Self {
        let slope = match interpolation {
            Interpolation::Linear => Vec::new(),
            Interpolation::C1 => monotone_slopes(&x, &y),
        };
        Self { x, y, slope, edge }
    }

    /// y(x); outside the points an error, or the end value with `edge = "hold"`.
    pub fn value<S: Scalar>(&self, x: S) -> Result<S, Outside> {
        let (low, high) = (self.x[0], self.x[self.x.len() - 1]);
        let at = x.value();
        let inside = low <= at && at <= high;
        if !inside && self.edge == Edge::Error {
            return Err(Outside { value: at, low, high });
        }
        Ok(x.lift(|x| self.with_slope(x)))
    }

    /// y and y' at x, held beyond the ends.
    fn with_slope(&self, x: f64) -> (f64, f64) {
        let last = self.x.len() - 1;
        if x < self.x[0] {
            return (self.y[0], 0.0);
        }
        if x > self.x[last] {
            return (self.y[last], 0.0);
        }
        let i = self.x.partition_point(|&p| p <= x).clamp(1, last) - 1;
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        let d = self.y[i + 1] - self.y[i];
        if self.slope.is_empty() {
            return (self.y[i] + t * d, d / h);
        }
        let (m0, m1) = (h * self.slope[i], h * self.slope[i + 1]);
        let (square, cube) = (3.0 * d - 2.0 * m0 - m1, m0 + m1 - 2.0 * d);
        (self.y[i] + t * (m0 + t * (square + t * cube)), (m0 + t * (2.0 * square + 3.0 * t * cube)) / h)
    }

    /// How far x lies from a point where the slope jumps, over the distance of the points; none for a smooth function.
    pub fn kink(&self, x: f64) -> Option<f64> {
        let i = self.x.partition_point(|&p| p < x).clamp(1, self.x.len() - 1);
        let (near, width) = if x - self.x[i - 1] < self.x[i] - x { (i - 1, i) } else { (i, i) };
        let h = self.x[width] - self.x[width - 1];
        let slope = |i: usize| (self.y[i] - self.y[i - 1]) / (self.x[i] - self.x[i - 1]);
        let before = if near > 0 { slope(near) } else { 0.0 };
        let after = if near + 1 < self.x.len() { slope(near + 1) } else { 0.0 };
        let inner = near > 0 && near + 1 < self.x.len();
        let jumps = if inner { self.slope.is_empty() && bends(before, after) } else { before != after };
        jumps.then(|| (x - self.x[near]).abs() / h)
    }
}

/// Whether two slopes differ enough for a corner to matter: by a tenth of the larger one.
fn bends(before: f64, after: f64) -> bool {
    (after - before).abs() > 0.1 * before.abs().max(after.abs())
}

/// Slopes after Fritsch and Carlson (SIAM J. Numer. Anal. 17, 1980): a weighted harmonic mean of the two secants,
/// zero where they change sign, so that the curve stays between its points.
fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let secant: Vec<f64> = y.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    let mut slope = vec![secant[0]; n];
    slope[n - 1] = secant[n - 2];
    for i in 1..n - 1 {
        let (a, b) = (secant[i - 1], secant[i]);
        let (wa, wb) = (h[i - 1] + 2.0 * h[i], 2.0 * h[i - 1] + h[i]);
        slope[i] = if a * b > 0.0 { (wa + wb) / (wa / b + wb / a) } else { 0.0 };
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(interpolation: Interpolation, edge: Edge) -> Lookup {
        Lookup::new(vec![0.0, 1.0, 3.0, 4.0], vec![0.0, 1.0, 2.0, 2.0], interpolation, edge)
    }

    #[test]
    fn linear_passes_its_points_and_their_middles() {
        let t = table(Interpolation::Linear, Edge::Error);
        for (x, y) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (2.0, 1.5), (4.0, 2.0)] {
            assert_eq!(t.value(x), Ok(y));
        }
    }

    #[test]
    fn the_cubic_has_a_continuous_slope_and_stays_between_its_points() {
        let t = table(Interpolation::C1, Edge::Error);
        let f = |x: f64| t.value(x).unwrap();
        for x in [1.0, 3.0] {
            let h = 1e-6;
            assert!(((f(x + h) - f(x)) - (f(x) - f(x - h))).abs() < 1e-10);
        }
        assert!((0..=400).map(|i| f(i as f64 / 100.0)).is_sorted());
        assert!(f(3.7) <= 2.0);
    }

    #[test]
    fn slopes_are_difference_quotients() {
        use klingel_physics::Dual;
        for interpolation in [Interpolation::Linear, Interpolation::C1] {
            let t = table(interpolation, Edge::Hold);
            for x in [-0.5, 0.3, 1.7, 3.4, 4.5] {
                let h = 1e-6;
                let slope = t.value(Dual::<1>::variable(x, 0)).unwrap().slope[0];
                let difference = (t.value(x + h).unwrap() - t.value(x - h).unwrap()) / (2.0 * h);
                assert!((slope - difference).abs() < 1e-8, "{slope} {difference}");
            }
        }
    }

    #[test]
    fn a_corner_is_seen_where_the_slope_jumps() {
        let t = table(Interpolation::Linear, Edge::Hold);
        assert!(t.kink(1.02).unwrap() < 0.02);
        assert_eq!(table(Interpolation::C1, Edge::Hold).kink(1.02), None);
        assert!(table(Interpolation::C1, Edge::Hold).kink(0.01).unwrap() < 0.02);
    }

    #[test]
    fn outside_it_reports_or_holds() {
        let outside = Outside { value: 4.1, low: 0.0, high: 4.0 };
        assert_eq!(table(Interpolation::Linear, Edge::Error).value(4.1), Err(outside));
        assert_eq!(table(Interpolation::C1, Edge::Hold).value(-1.0), Ok(0.0));
        assert_eq!(table(Interpolation::C1, Edge::Hold).value(9.0), Ok(2.0));
    }
}
