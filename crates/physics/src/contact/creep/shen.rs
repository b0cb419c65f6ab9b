//! Shen, Hedrick & Elkins (Vehicle System Dynamics 12 (1983) 79-83): the linear force, its size bounded by friction.
//! The cubic is that of Vermeulen & Johnson; small spin only, and no moment.

use super::{Kalker, RollingContact, linear, polach::limit};
use crate::{Mask, Scalar};

/// Least size of the linear force, N: it keeps the direction defined.
const LEAST_FORCE: f64 = 1e-12;

/// (Fx, Fy) = (Fx', Fy') f(u), u = F' / (mu N), f = 1 - u/3 + u^2/27 up to u = 3 and 1/u beyond; F' of the linear law.
pub(super) fn shen_hedrick_elkins<S: Scalar>(kalker: &Kalker, shear_modulus: f64, c: &RollingContact<S>) -> [S; 3] {
    let [fx, fy, _] = linear::linear(kalker, shear_modulus, c);
    let size = (fx.square() + fy.square() + LEAST_FORCE * LEAST_FORCE).sqrt();
    let u = size / limit(c);
    let sliding = u.gt(S::constant(3.0));
    let mut factor = u * (u / 27.0 - 1.0 / 3.0) + 1.0;
    if !sliding.none() {
        factor = S::select(sliding, u.recip(), factor);
    }
    [fx * factor, fy * factor, S::zero()]
}
