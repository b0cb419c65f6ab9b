//! `f64` as a `Scalar`: every method is the plain machine operation.

use super::{Mask, Scalar};

impl Mask for bool {
    fn and(self, other: Self) -> Self {
        self && other
    }
    fn or(self, other: Self) -> Self {
        self || other
    }
    fn not(self) -> Self {
        !self
    }
    fn all(self) -> bool {
        self
    }
    fn none(self) -> bool {
        !self
    }
}

impl Scalar for f64 {
    type Mask = bool;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn lift(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        f(self).0
    }
    #[inline(always)]
    fn lift_n<const M: usize, const K: usize>(
        args: [Self; M],
        f: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        f(args).0
    }
    #[inline(always)]
    fn lift_n_lazy<const M: usize, const K: usize>(
        args: [Self; M],
        values: impl Fn([f64; M]) -> [f64; K],
        _: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        values(args)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}
