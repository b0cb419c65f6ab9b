//! Forward-mode dual numbers: a value and its exact slopes along N directions.

use super::Scalar;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// value + sum of slope\[i\] e_i with e_i e_j = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    pub value: f64,
    pub slope: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The independent variable of direction `i`.
    pub fn variable(value: f64, i: usize) -> Self {
        let mut slope = [0.0; N];
        slope[i] = 1.0;
        Self { value, slope }
    }
    #[inline(always)]
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: self.slope.map(|s| s * derivative) }
    }
    #[inline(always)]
    fn combine(self, other: Self, value: f64, da: f64, db: f64) -> Self {
        Self { value, slope: core::array::from_fn(|i| self.slope[i] * da + other.slope[i] * db) }
    }
}

impl<const N: usize> Default for Dual<N> {
    fn default() -> Self {
        Self { value: 0.0, slope: [0.0; N] }
    }
}
impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}
impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.combine(o, self.value + o.value, 1.0, 1.0)
    }
}
impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.combine(o, self.value - o.value, 1.0, -1.0)
    }
}
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.combine(o, self.value * o.value, o.value, self.value)
    }
}
impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let q = self.value / o.value;
        self.combine(o, q, 1.0 / o.value, -q / o.value)
    }
}
impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        Self { value: self.value + o, ..self }
    }
}
impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: f64) -> Self {
        Self { value: self.value - o, ..self }
    }
}
impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        self.chain(self.value * o, o)
    }
}
impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        self.chain(self.value / o, 1.0 / o)
    }
}
impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<const N: usize> Scalar for Dual<N> {
    type Mask = bool;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self { value: x, slope: [0.0; N] }
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn lift(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, derivative) = f(self.value);
        self.chain(value, derivative)
    }
    fn lift_n<const M: usize, const K: usize>(
        args: [Self; M],
        f: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        let (values, jacobian) = f(args.map(|a| a.value));
        core::array::from_fn(|k| Self {
            value: values[k],
            slope: core::array::from_fn(|i| (0..M).map(|m| jacobian[k][m] * args[m].slope[i]).sum()),
        })
    }
    #[inline(always)]
    fn lift_n_lazy<const M: usize, const K: usize>(
        args: [Self; M],
        _: impl Fn([f64; M]) -> [f64; K],
        with_jacobian: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        Self::lift_n(args, with_jacobian)
    }
    /// The slope at zero is set to zero: laws that take a root of a sum of squares are even there.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let r = self.value.sqrt();
        self.chain(r, if r > 0.0 { 0.5 / r } else { 0.0 })
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self.value <= other.value
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}
