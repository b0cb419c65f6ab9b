//! Coordinates of the creep table: the ball of creepages, the slenderness of the ellipse, the limiter.
//! Derived in docs/theory/creep_table.md.

use super::super::kalker::Kalker;
use crate::{Mask, Scalar};

/// Largest slenderness |q| of the table, a/b = 36.
pub(super) const RIM: f64 = 5.0 / 7.0;
/// Half the width of the limiter's bend, part of mu N.
pub(super) const BEND: f64 = 0.01;
/// What rounding could add to a force at the limit.
const ROUNDING: f64 = 1e-15;

/// q = (sqrt a - sqrt b)/(sqrt a + sqrt b), from -1 to 1; multiplied by the denominator it needs one root.
pub(super) fn slenderness<S: Scalar>(a: S, b: S) -> S {
    (a - b) / (a + b + (a * b).sqrt() * 2.0)
}

/// a/b of a slenderness.
pub(super) fn ratio(q: f64) -> f64 {
    ((1.0 + q) / (1.0 - q)).powi(2)
}

pub(super) fn inside<S: Scalar>(q: S) -> S::Mask {
    let rim = S::constant(RIM);
    q.le(rim).and((-q).le(rim))
}

/// Factors of the normalised creepages: v = (S1 xi*, S2 eta*, S3 phi*).
///
/// The slopes of the linear theory for both creepages; for spin a smooth largest of C23 and of what makes a rotation
/// about the edge of the ellipse as large as a creepage.
pub(super) fn scales<S: Scalar>(kalker: &Kalker, ratio: S) -> [S; 3] {
    let [c11, c22, c23, _] = kalker.at(ratio);
    let root = ratio.sqrt();
    let fourth = |x: S| x.square().square();
    let spin = fourth(c23) + fourth(c11 / root * 0.5) + fourth(c22 * root * 0.5);
    [c11, c22, spin.sqrt().sqrt()]
}

/// u/v of the ball's place u = v (12 + 5 m)/(24 + 18 m + 5 m^2) for m = |v|, given m^2.
///
/// Along a creepage without spin u is v/2 (1 - m/3) for small m, as the force is, and 1 - |u| is 1.2/m for large ones.
/// Numerator and denominator are multiplied by 24 - 18 m + 5 m^2: the latter then needs no root, and neither waits.
pub(super) fn contraction<S: Scalar>(square: S) -> S {
    let share = (square * (square * 25.0 - 84.0) + 576.0).recip();
    let size = square.sqrt();
    (size * 5.0 + 12.0) * ((square * 5.0 + 24.0) - size * 18.0) * share
}

/// The creepage v of a place in the ball.
pub(super) fn creepage(u: [f64; 3]) -> [f64; 3] {
    let t = size(u);
    // 5 (1 - t) m^2 + (12 - 18 t) m = 24 t.
    let (square, linear) = (5.0 * (1.0 - t), 12.0 - 18.0 * t);
    let root = (linear * linear + 96.0 * t * square).sqrt();
    let m_over_t = if linear > 0.0 { 48.0 / (linear + root) } else { (root - linear) / (2.0 * square * t) };
    u.map(|u| u * m_over_t)
}

pub(super) fn size(u: [f64; 3]) -> f64 {
    u.iter().map(|u| u * u).sum::<f64>().sqrt()
}

/// Brings a force over mu N below 1: nothing up to 1 - e, a parabola up to 1 + e, 1 beyond; its slope has no jump.
pub(super) fn limited<S: Scalar>([fx, fy]: [S; 2]) -> [S; 2] {
    let size2 = fx.square() + fy.square();
    let over = S::constant((1.0 - BEND) * (1.0 - BEND)).lt(size2);
    if over.none() {
        return [fx, fy];
    }
    let size = S::select(over, size2, S::one()).sqrt();
    let left = (S::constant(1.0 + BEND) - size).positive();
    let scale = (S::constant(1.0 - ROUNDING) - left.square() / (4.0 * BEND)) / size;
    [S::select(over, fx * scale, fx), S::select(over, fy * scale, fy)]
}

/// The force that `limited` turns into this one.
pub(super) fn unlimited([fx, fy]: [f64; 2]) -> [f64; 2] {
    let size = fx.hypot(fy);
    if size <= 1.0 - BEND {
        return [fx, fy];
    }
    let scale = (1.0 + BEND - 2.0 * (BEND * (1.0 - size).max(0.0)).sqrt()) / size;
    [fx * scale, fy * scale]
}
