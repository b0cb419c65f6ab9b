//! Profiles of wheels and rails as densely sampled curves z(y) with slopes, from formulas or from given points.
//! Wheel: y from the tape circle, + to the field side, z = radius increment. Rail: y from its axis, z down from the top.

use super::ContactError;

/// Spacing of the samples along the curve, m.
pub(super) const STEP: f64 = 5e-5;

/// A profile z(y), metres, y rising; the canonical rail is the right one, its gauge side at negative y.
///
/// ```
/// use klingel_physics::contact::Profile;
/// let wheel = Profile::s1002();
/// let (z, slope) = wheel.at(0.0).unwrap();
/// assert!(z.abs() < 1e-12 && (slope + 0.033585).abs() < 1e-6);
/// assert!(wheel.at(0.08).is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub y: Vec<f64>,
    pub z: Vec<f64>,
    /// dz/dy.
    pub slope: Vec<f64>,
}

/// One piece of an analytic profile in millimetres, valid from its `from` to the `from` of the next one.
struct Piece {
    from: f64,
    /// (z, dz/dy) at y.
    curve: fn(f64) -> (f64, f64),
}

/// A circle about (yc, zc): `side` -1 gives its upper edge (small z), +1 its lower edge.
fn circle(y: f64, yc: f64, zc: f64, radius: f64, side: f64) -> (f64, f64) {
    let root = (radius * radius - (y - yc).powi(2)).sqrt();
    (zc + side * root, -side * (y - yc) / root)
}

fn line(y: f64, z0: f64, slope: f64) -> (f64, f64) {
    (z0 + slope * y, slope)
}

fn polynomial(y: f64, coefficients: &[f64]) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(p, d), c| (p * y + c, d * y + p))
}

/// Flange back H, flange tip G and F, flank E of S1002 and of the cones that borrow its flange.
const S1002_FLANGE: [Piece; 4] = [
    Piece { from: -70.0, curve: |y| circle(y, -49.5, 9.519259302, 20.5, 1.0) },
    Piece { from: -62.764705882, curve: |y| circle(y, -55.0, 16.0, 12.0, 1.0) },
    Piece { from: -49.662510381, curve: |y| circle(y, -58.558326413, 8.834924130, 20.0, 1.0) },
    Piece { from: -39.764473993, curve: |y| line(y, -93.576667419, -2.747477419) },
];
const S1002_TREAD: [Piece; 4] = [
    Piece { from: -38.426669071, curve: |y| circle(y, -26.210665, 16.446, 13.0, -1.0) },
    Piece {
        from: -35.0,
        curve: |y| {
            let c = [
                -4.320221063e3,
                -1.038384026e3,
                -1.065501873e2,
                -6.051367875,
                -2.054332446e-1,
                -4.169739389e-3,
                -4.687195829e-5,
                -2.252755540e-7,
            ];
            polynomial(y, &c)
        },
    },
    Piece {
        from: -26.0,
        curve: |y| {
            let c = [
                0.0,
                -3.358537058e-2,
                1.565681624e-3,
                -2.810427944e-5,
                5.844240864e-8,
                -1.562379023e-8,
                5.309217349e-15,
                -5.957839843e-12,
                2.646656573e-13,
            ];
            polynomial(y, &c)
        },
    },
    Piece { from: 32.15796, curve: |y| line(y, 1.364323640, -0.066666667) },
];
/// The flange back becomes vertical at -70 mm, where a function z(y) has no slope: the last 0.01 mm are left out.
const WHEEL_RANGE: [f64; 2] = [-69.99, 60.0];

/// Samples an analytic curve (mm) evenly along its arc and gives it in metres.
fn sample(range: [f64; 2], curve: impl Fn(f64) -> (f64, f64)) -> Profile {
    let mut profile = Profile { y: vec![], z: vec![], slope: vec![] };
    let mut push = |y: f64| {
        let (z, slope) = curve(y);
        profile.y.push(y * 1e-3);
        profile.z.push(z * 1e-3);
        profile.slope.push(slope);
    };
    let mut y = range[0];
    while y < range[1] {
        push(y);
        let trial = STEP * 1e3 / (1.0 + curve(y).1.powi(2)).sqrt();
        y += STEP * 1e3 / (1.0 + curve((y + 0.5 * trial).min(range[1])).1.powi(2)).sqrt();
    }
    push(range[1]);
    profile
}

fn sample_pieces(range: [f64; 2], pieces: &[&[Piece]]) -> Profile {
    let pieces: Vec<&Piece> = pieces.iter().flat_map(|p| p.iter()).collect();
    sample(range, |y| {
        let k = pieces.partition_point(|p| p.from <= y).max(1) - 1;
        (pieces[k].curve)(y)
    })
}

/// Head of three tangent arcs of radii 300, 80 and 13 mm and a flank of 1:20, given by its centres and tangent points.
fn rail_head(centres: [[f64; 2]; 3], tangents: [[f64; 2]; 3]) -> Profile {
    let last = 40.0 - 1.0;
    let half = |y: f64| match tangents.iter().position(|t| y <= t[0]) {
        Some(k) => circle(y, centres[k][0], centres[k][1], [300.0, 80.0, 13.0][k], -1.0),
        None => line(y - tangents[2][0], tangents[2][1], 20.0),
    };
    let end = tangents[2][0] + (last - tangents[2][1]) / 20.0;
    sample([-end, end], |y| {
        let (z, slope) = half(y.abs());
        (z, slope * y.signum())
    })
}

impl Profile {
    /// Wheel S1002 (EN 13715, flange height 28 mm, thickness 32.5 mm), -69.99 to 60 mm.
    ///
    /// Coefficients from memory of the standard, checked to 2e-6 mm against a public point file.
    pub fn s1002() -> Self {
        sample_pieces(WHEEL_RANGE, &[&S1002_FLANGE, &S1002_TREAD])
    }

    /// A coned tread z = -`slope` y with the flange of S1002 and a root arc of 13 mm tangent to both.
    ///
    /// Our own construction, for checks against the conicity of a cone.
    ///
    /// # Errors
    /// A slope outside 0 to 0.5.
    pub fn cone(slope: f64) -> Result<Self, ContactError> {
        if !(0.0..=0.5).contains(&slope) {
            let remedy = "give the cone's slope, such as 0.05".into();
            let what = "cone slope".into();
            return Err(ContactError::OutOfRange { what, value: slope, least: 0.0, most: 0.5, remedy });
        }
        let (flank, radius) = (2.747477419_f64, 13.0);
        let (h, g) = ((1.0 + slope * slope).sqrt(), (1.0 + flank * flank).sqrt());
        // Centre of the arc: at distance `radius` on the flange side of both lines.
        let yc = (93.576667419 + radius * (h - g)) / (slope - flank);
        let zc = -slope * yc + radius * h;
        let (on_tread, on_flank) = (yc - radius * slope / h, yc - radius * flank / g);
        Ok(sample(WHEEL_RANGE, |y| {
            if y >= on_tread {
                line(y, 0.0, -slope)
            } else if y >= on_flank {
                circle(y, yc, zc, radius, -1.0)
            } else {
                let k = S1002_FLANGE.partition_point(|p| p.from <= y).max(1) - 1;
                (S1002_FLANGE[k].curve)(y)
            }
        }))
    }

    /// Rail head 60E1 (EN 13674-1: arcs of 300, 80 and 13 mm, widths 20.456 and 52.053 mm), not inclined.
    ///
    /// From memory of the standard; self-consistent: the arcs meet the head width of 72 mm.
    pub fn rail_60e1() -> Self {
        rail_head(
            [[0.0, 300.0], [7.50053, 80.12790], [23.01603, 14.94915]],
            [[10.228, 0.17440], [26.0265, 2.30252], [35.99981, 14.29996]],
        )
    }

    /// The UIC60 head of common benchmark files, which differs from 60E1 by up to 0.041 mm.
    ///
    /// Arcs fitted to a public point file (residual below 2e-6 mm).
    pub fn rail_uic60() -> Self {
        rail_head(
            [[0.0, 300.0], [7.7, 80.13480], [23.01622, 14.90893]],
            [[10.5, 0.18381], [25.98802, 2.25316], [36.0, 14.25974]],
        )
    }

    /// (z, dz/dy) at `y`, cubic between the samples; none outside the profile.
    pub fn at(&self, y: f64) -> Option<(f64, f64)> {
        let n = self.y.len();
        if !(y >= self.y[0] && y <= self.y[n - 1]) {
            return None;
        }
        let k = self.y.partition_point(|&p| p <= y).clamp(1, n - 1) - 1;
        Some(self.within(k, y))
    }

    /// (z, dz/dy) at `y` in interval `k`.
    pub(super) fn within(&self, k: usize, y: f64) -> (f64, f64) {
        let (h, dz) = (self.y[k + 1] - self.y[k], self.z[k + 1] - self.z[k]);
        let (t, chord) = ((y - self.y[k]) / h, dz / h);
        let (m0, m1) = (self.slope[k] - chord, self.slope[k + 1] - chord);
        let z = self.z[k] + t * dz + h * t * (1.0 - t) * (m0 * (1.0 - t) - m1 * t);
        (z, chord + m0 * (1.0 - t) * (1.0 - 3.0 * t) + m1 * t * (3.0 * t - 2.0))
    }

    /// The same curve with other samples: each (y, z) is mapped to a new one, y still rising.
    pub(super) fn map(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let points: Vec<_> = (0..self.y.len()).map(|i| f([self.y[i], self.z[i], self.slope[i]])).collect();
        let column = |c: usize| points.iter().map(|p| p[c]).collect();
        Self { y: column(0), z: column(1), slope: column(2) }
    }
}
