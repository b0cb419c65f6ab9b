//! Polach's closed-form law with spin (Vehicle System Dynamics Supplement 33, 1999, 728-739): fast, no moment.
//! The bracket of the spin force tends to Kalker's C23 for pure spin.

use super::{Kalker, RollingContact};
use crate::{Mask, Scalar};
use core::f64::consts::PI;

/// Creepages below this count as none, so that the direction of the slip stays defined.
const LEAST_CREEPAGE: f64 = 1e-12;
/// Friction limit of a patch without load, N: it keeps the quotients finite.
const LEAST_LIMIT: f64 = 1e-9;

pub(super) fn polach<S: Scalar>(kalker: &Kalker, shear_modulus: f64, c: &RollingContact<S>) -> [S; 3] {
    let [c11, c22, c23, _] = kalker.at(c.a / c.b);
    let limit = (c.friction * c.normal_force).max(S::constant(LEAST_LIMIT));
    // Spin moves the lateral slip of the patch's front; it counts where it makes the slip larger.
    let with_spin = c.eta + c.phi * c.a;
    let lateral = S::select(c.eta.abs().lt(with_spin.abs()), with_spin, c.eta).abs();
    let least = LEAST_CREEPAGE * LEAST_CREEPAGE;
    let slip = (c.xi.square() + lateral.square() + least).sqrt();
    let stiffness = ((c11 * c.xi).square() + c22.square() * (lateral.square() + least)).sqrt();
    let epsilon = c.a * c.b * stiffness * (0.25 * PI * shear_modulus) / limit;
    let force = limit * (epsilon / (epsilon.square() + 1.0) + epsilon.atan()) * (2.0 / PI);

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
