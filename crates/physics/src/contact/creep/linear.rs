//! Kalker's linear theory: forces proportional to the creepages, no limit by friction.
//! For linear analysis and for checks; it is the limit of every other law at vanishing creepage.

use super::{Kalker, RollingContact};
use crate::Scalar;

/// Fx = -G a b C11 xi, Fy = -G a b (C22 eta + sqrt(ab) C23 phi), Mz = G a b (sqrt(ab) C23 eta - a b C33 phi).
pub(super) fn linear<S: Scalar>(kalker: &Kalker, shear_modulus: f64, c: &RollingContact<S>) -> [S; 3] {
    let [c11, c22, c23, c33] = kalker.at(c.a / c.b);
    let area = c.a * c.b;
    let (stiffness, arm) = (area * shear_modulus, area.sqrt());
    [
        -(stiffness * c11 * c.xi),
        -(stiffness * (c22 * c.eta + arm * c23 * c.phi)),
        stiffness * (arm * c23 * c.eta - area * c33 * c.phi),
    ]
}
