//! Polach's closed-form law with spin (Vehicle System Dynamics Supplement 33, 1999, 728-739): fast, no moment.
//! The bracket of the spin force tends to Kalker's C23 for pure spin; kA and kS are those of Wear 258 (2005) 992-1000.

use super::{Kalker, PolachReduction, RollingContact};
use crate::{Mask, Scalar};
use core::f64::consts::PI;

/// Creepages below this count as none, so that the direction of the slip stays defined.
const LEAST_CREEPAGE: f64 = 1e-12;
/// Friction limit of a patch without load, N: it keeps the quotients finite.
const LEAST_LIMIT: f64 = 1e-9;

/// The friction limit mu N.
pub(super) fn limit<S: Scalar>(c: &RollingContact<S>) -> S {
    (c.friction * c.normal_force).max(S::constant(LEAST_LIMIT))
}

/// Size of the lateral slip: spin moves that of the patch's front; it counts where it makes the slip larger.
fn lateral_slip<S: Scalar>(c: &RollingContact<S>) -> S {
    let with_spin = c.eta + c.phi * c.a;
    S::select(c.eta.abs().lt(with_spin.abs()), with_spin, c.eta).abs()
}

/// Gradient of the tangential stress: eps = G pi a b c s / (4 mu N), c the mean of C11 and C22 in the direction of s.
pub(super) fn gradient<S: Scalar>([c11, c22]: [S; 2], shear_modulus: f64, c: &RollingContact<S>) -> S {
    let lateral = lateral_slip(c).square() + LEAST_CREEPAGE * LEAST_CREEPAGE;
    let stiffness = ((c11 * c.xi).square() + c22.square() * lateral).sqrt();
    c.a * c.b * stiffness * (0.25 * PI * shear_modulus) / limit(c)
}

pub(super) fn polach<S: Scalar>(
    kalker: &Kalker,
    shear_modulus: f64,
    reduction: PolachReduction,
    c: &RollingContact<S>,
) -> [S; 3] {
    let [c11, c22, c23, _] = kalker.at(c.a / c.b);
    let (limit, lateral) = (limit(c), lateral_slip(c));
    let slip = (c.xi.square() + lateral.square() + LEAST_CREEPAGE * LEAST_CREEPAGE).sqrt();
    let epsilon = gradient([c11, c22], shear_modulus, c);
    let adhesion = epsilon * reduction.adhesion;
    let force = limit * (adhesion / (adhesion.square() + 1.0) + (epsilon * reduction.slip).atan()) * (2.0 / PI);

    let widening = (S::one() - (-(c.a / c.b)).exp()) * 6.3 + 1.0;
    let area = c.a * c.b;
    let e = c.b * area.sqrt() * c23 * lateral * (8.0 / 3.0 * shear_modulus) / (widening * limit);
    let e2 = e.square();
    let delta = (e2 - 1.0) / (e2 + 1.0);
    let d2 = delta.square();
    // sqrt((1 - delta^2)^3) with 1 - delta^2 = (2 e / (e^2 + 1))^2.
    let edge = e * 2.0 / (e2 + 1.0);
    let bracket = e * (d2 * 0.5 - d2 * delta / 3.0 - 1.0 / 6.0) + edge * edge.square() / 3.0;
    let spin = c.a * limit * widening * bracket * c.phi / slip * (9.0 / 16.0);

    let (fx, fy) = (-(force * c.xi / slip), -(force * c.eta / slip + spin));
    // The sum of both parts may exceed the friction limit a little: it is brought back to it.
    let size2 = fx.square() + fy.square();
    let over = limit.square().lt(size2);
    if over.none() {
        return [fx, fy, S::zero()];
    }
    let scale = S::select(over, limit / size2.sqrt(), S::one());
    [fx * scale, fy * scale, S::zero()]
}
