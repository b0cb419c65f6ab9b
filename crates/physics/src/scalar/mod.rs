//! The one number type that every law is written in: `f64`, `Dual<N>` (exact derivatives), `Lanes` (SIMD).
//! There is no ordering on it on purpose: laws choose with `select`, `min` and `max`, so they vectorise and differentiate.

mod dual;
mod lanes;
mod real;

pub use dual::Dual;
pub use lanes::Lanes;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The answer of a comparison: one truth value a lane.
pub trait Mask: Copy + Debug {
    /// True where both are.
    fn and(self, other: Self) -> Self;
    /// True where either is.
    fn or(self, other: Self) -> Self;
    /// True where this is false.
    fn not(self) -> Self;
    /// Whether every lane is true.
    fn all(self) -> bool;
    /// Whether no lane is true.
    fn none(self) -> bool;
}

/// A real number, possibly with derivatives or several lanes.
///
/// ```
/// use klingel_physics::{Dual, Scalar};
/// fn law<S: Scalar>(x: S) -> S { x.sqrt() * 3.0 }
/// let d = law(Dual::<1>::variable(4.0, 0));
/// assert_eq!((d.value, d.slope[0]), (6.0, 0.75));
/// ```
pub trait Scalar:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    type Mask: Mask;

    fn constant(x: f64) -> Self;
    /// The value of lane 0, for reports and for branches that save work in `f64`; never for the law itself.
    fn value(self) -> f64;

    /// A scalar function given in `f64` as (value, derivative): tables, roots, rare functions.
    fn lift(self, f: impl Fn(f64) -> (f64, f64)) -> Self;
    /// A function of M arguments with K values, given in `f64` as (values, K x M Jacobian).
    fn lift_n<const M: usize, const K: usize>(
        args: [Self; M],
        f: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K];

    /// As `lift_n`, with the values alone beside: what needs no slopes does not compute them. Both must agree bitwise.
    fn lift_n_lazy<const M: usize, const K: usize>(
        args: [Self; M],
        values: impl Fn([f64; M]) -> [f64; K],
        with_jacobian: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K];

    fn sqrt(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn exp(self) -> Self;

    fn lt(self, other: Self) -> Self::Mask;
    fn le(self, other: Self) -> Self::Mask;
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `a` where the mask is true, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn one() -> Self {
        Self::constant(1.0)
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn tan(self) -> Self {
        let (s, c) = self.sin_cos();
        s / c
    }
    fn atan(self) -> Self {
        self.lift(|x| (x.atan(), 1.0 / (1.0 + x * x)))
    }
    fn powf(self, p: f64) -> Self {
        self.lift(|x| (x.powf(p), p * x.powf(p - 1.0)))
    }
    fn square(self) -> Self {
        self * self
    }
    fn recip(self) -> Self {
        Self::one() / self
    }
    fn abs(self) -> Self {
        Self::select(self.lt(Self::zero()), -self, self)
    }
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    fn clamp(self, lo: f64, hi: f64) -> Self {
        self.max(Self::constant(lo)).min(Self::constant(hi))
    }
    /// The positive part.
    fn positive(self) -> Self {
        self.max(Self::zero())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation of the trait in one expression.
    fn all<S: Scalar>(x: S, y: S) -> S {
        let (s, c) = (x * 0.3).sin_cos();
        let p = (x.square() + y.abs() + 1.0).sqrt().powf(1.5);
        let [u, v] = S::lift_n([x, y], |[a, b]| ([a * b, a + 2.0 * b], [[b, a], [1.0, 2.0]]));
        s + c * p / (y.square() + 0.5) + (-x).exp() * u - v.atan() + x.min(y) + x.clamp(-1.0, 0.5) + (x - y).positive()
    }

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        for (x, y) in [(0.3, 0.7), (-1.2, 0.4), (2.0, -0.9)] {
            let d = all(Dual::<2>::variable(x, 0), Dual::<2>::variable(y, 1));
            assert_eq!(d.value, all(x, y));
            let h = 1e-6;
            let dx = (all(x + h, y) - all(x - h, y)) / (2.0 * h);
            let dy = (all(x, y + h) - all(x, y - h)) / (2.0 * h);
            assert!((d.slope[0] - dx).abs() < 1e-8 && (d.slope[1] - dy).abs() < 1e-8, "{d:?} {dx} {dy}");
        }
    }

    #[test]
    fn lanes_agree_with_f64() {
        let (x, y) = ([0.3, -1.2, 2.0, 0.0], [0.7, 0.4, -0.9, 0.1]);
        let l = all(Lanes::from(x), Lanes::from(y)).to_array();
        for i in 0..4 {
            assert!((l[i] - all(x[i], y[i])).abs() < 1e-13);
        }
    }
}
