//! What analytic profiles are made of: lines, circles and polynomials in millimetres, and their sampling.
//! Every curve gives (z, dz/dy) at y.

use super::{Profile, STEP};

/// One piece of an analytic profile in millimetres, valid from its `from` to the `from` of the next one.
pub(super) struct Piece {
    pub from: f64,
    /// (z, dz/dy) at y.
    pub curve: fn(f64) -> (f64, f64),
}

/// A circle about (yc, zc): `side` -1 gives its upper edge (small z), +1 its lower edge.
pub(super) fn circle(y: f64, yc: f64, zc: f64, radius: f64, side: f64) -> (f64, f64) {
    let root = (radius * radius - (y - yc).powi(2)).sqrt();
    (zc + side * root, -side * (y - yc) / root)
}

pub(super) fn line(y: f64, z0: f64, slope: f64) -> (f64, f64) {
    (z0 + slope * y, slope)
}

pub(super) fn polynomial(y: f64, coefficients: &[f64]) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(p, d), c| (p * y + c, d * y + p))
}

/// Samples an analytic curve (mm) evenly along its arc and gives it in metres.
pub(super) fn sample(range: [f64; 2], curve: impl Fn(f64) -> (f64, f64)) -> Profile {
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

pub(super) fn sample_pieces(range: [f64; 2], pieces: &[&[Piece]]) -> Profile {
    let pieces: Vec<&Piece> = pieces.iter().flat_map(|p| p.iter()).collect();
    sample(range, |y| {
        let k = pieces.partition_point(|p| p.from <= y).max(1) - 1;
        (pieces[k].curve)(y)
    })
}
