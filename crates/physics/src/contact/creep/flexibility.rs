//! The flexibilities of the simplified theory: three of them, a reduced slope, and their blend into one.
//! Everything here is a/L, the stiffness of the patch against rigid slip, Pa.

use super::{Kalker, RollingContact, SlopeReduction, polach};
use crate::Scalar;
use core::f64::consts::PI;

/// a/L for longitudinal creepage, lateral creepage and spin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness<S> {
    pub xi: S,
    pub eta: S,
    pub phi: S,
}

impl<S: Scalar> Stiffness<S> {
    /// L1 = 8 a / (3 G C11), L2 = 8 a / (3 G C22), L3 = pi a sqrt(a/b) / (4 G C23): the linear theory at small creepage.
    pub fn three([c11, c22, c23]: [S; 3], shear_modulus: f64, c: &RollingContact<S>) -> Self {
        let phi = c23 * (4.0 / PI * shear_modulus) / (c.a / c.b).sqrt();
        Self { xi: c11 * (0.375 * shear_modulus), eta: c22 * (0.375 * shear_modulus), phi }
    }

    /// All three times `factor`.
    pub fn times(self, factor: S) -> Self {
        Self { xi: self.xi * factor, eta: self.eta * factor, phi: self.phi * factor }
    }

    /// L_i moves to the one mean flexibility L by the share of sliding: (1 - sigma) L_i + sigma L.
    ///
    /// Where a point slides, the traction opposes the slip itself, whichever part of it is creepage or spin: there only one
    /// flexibility gives the right direction. L is the mean weighted with the mean square slips of the patch,
    ///
    /// ```text
    /// L = (L1 xi^2 + L2 eta^2 + L3 s^2) / (xi^2 + eta^2 + s^2),     s^2 = phi^2 (a^2 + b^2) / 4
    /// sigma = u^2 / (4 + u^2),     u^2 = ((a xi/L1)^2 + (a eta/L2)^2 + (a s/L3)^2) / g0^2
    /// ```
    ///
    /// g0 is the traction bound of the middle. Under pure creepage u/2 is the share of the middle strip that slides, so the
    /// blend is half way when the whole of it does. One creepage alone keeps its own flexibility.
    pub fn blended(self, c: &RollingContact<S>, bound: S) -> Self {
        let spin2 = c.phi.square() * (c.a.square() + c.b.square()) * 0.25;
        let (xi2, eta2) = (c.xi.square(), c.eta.square());
        let traction2 = self.xi.square() * xi2 + self.eta.square() * eta2 + self.phi.square() * spin2;
        let sigma = traction2 / (traction2 + bound.square() * 4.0 + LEAST_TRACTION2);
        let mean = (xi2 / self.xi + eta2 / self.eta + spin2 / self.phi) / (xi2 + eta2 + spin2 + LEAST_SLIP2);
        let blend = |own: S| own / (own * mean * sigma + (S::one() - sigma));
        Self { xi: blend(self.xi), eta: blend(self.eta), phi: blend(self.phi) }
    }
}

/// They keep the quotients finite at rest (square of a creepage) and without load (square of a traction, Pa^2).
const LEAST_SLIP2: f64 = 1e-40;
const LEAST_TRACTION2: f64 = 1e-20;

/// The stiffness of a patch with its options; `bound` is the traction bound of its middle, Pa.
pub(super) fn stiffness<S: Scalar>(
    kalker: &Kalker,
    shear_modulus: f64,
    slope: Option<SlopeReduction>,
    blended: bool,
    c: &RollingContact<S>,
    bound: S,
) -> Stiffness<S> {
    let [c11, c22, c23, _] = kalker.at(c.a / c.b);
    let mut stiffness = Stiffness::three([c11, c22, c23], shear_modulus, c);
    if let Some(SlopeReduction { initial, limit, decay }) = slope {
        let epsilon = polach::gradient([c11, c22], shear_modulus, c) * initial;
        let factor = ((epsilon * decay + 1.0).recip() * (1.0 - limit) + limit) * initial;
        stiffness = stiffness.times(factor);
    }
    if blended { stiffness.blended(c, bound) } else { stiffness }
}
