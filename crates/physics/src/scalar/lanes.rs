//! Four `f64` side by side (SIMD): four contacts, four strips of one contact, or four vehicles.

use super::{Mask, Scalar};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use wide::f64x4;

/// Four numbers that go through the same law at once.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes(pub f64x4);

/// Four truth values.
#[derive(Clone, Copy, Debug)]
pub struct LanesMask(f64x4);

impl Lanes {
    pub fn to_array(self) -> [f64; 4] {
        self.0.to_array()
    }
    /// The sum of the lanes.
    pub fn sum(self) -> f64 {
        self.0.reduce_add()
    }
}
impl From<[f64; 4]> for Lanes {
    fn from(x: [f64; 4]) -> Self {
        Self(f64x4::new(x))
    }
}
impl From<f64> for Lanes {
    fn from(x: f64) -> Self {
        Self(f64x4::splat(x))
    }
}

impl Mask for LanesMask {
    #[inline(always)]
    fn and(self, o: Self) -> Self {
        Self(self.0 & o.0)
    }
    #[inline(always)]
    fn or(self, o: Self) -> Self {
        Self(self.0 | o.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.all()
    }
    #[inline(always)]
    fn none(self) -> bool {
        self.0.none()
    }
}

macro_rules! binary {
    ($($op:ident :: $f:ident),*) => {$(
        impl $op for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $f(self, o: Self) -> Self { Self($op::$f(self.0, o.0)) }
        }
        impl $op<f64> for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $f(self, o: f64) -> Self { Self($op::$f(self.0, f64x4::splat(o))) }
        }
    )*};
}
binary!(Add::add, Sub::sub, Mul::mul, Div::div);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        self.0 += o.0;
    }
}
impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        self.0 -= o.0;
    }
}

impl Scalar for Lanes {
    type Mask = LanesMask;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self(f64x4::splat(x))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.to_array()[0]
    }
    fn lift(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        Self::from(self.to_array().map(|x| f(x).0))
    }
    fn lift_n<const M: usize, const K: usize>(
        args: [Self; M],
        f: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        Self::lift_n_lazy(args, |x| f(x).0, &f)
    }
    fn lift_n_lazy<const M: usize, const K: usize>(
        args: [Self; M],
        values: impl Fn([f64; M]) -> [f64; K],
        _: impl Fn([f64; M]) -> ([f64; K], [[f64; M]; K]),
    ) -> [Self; K] {
        let a = args.map(Self::to_array);
        let lanes: [[f64; K]; 4] = core::array::from_fn(|l| values(core::array::from_fn(|m| a[m][l])));
        core::array::from_fn(|k| Self::from(core::array::from_fn(|l| lanes[l][k])))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    fn sin_cos(self) -> (Self, Self) {
        let a = self.to_array();
        (Self::from(a.map(f64::sin)), Self::from(a.map(f64::cos)))
    }
    fn exp(self) -> Self {
        Self::from(self.to_array().map(f64::exp))
    }
    #[inline(always)]
    fn lt(self, o: Self) -> LanesMask {
        LanesMask(self.0.simd_lt(o.0))
    }
    #[inline(always)]
    fn le(self, o: Self) -> LanesMask {
        LanesMask(self.0.simd_le(o.0))
    }
    #[inline(always)]
    fn select(mask: LanesMask, a: Self, b: Self) -> Self {
        Self(mask.0.bitselect(a.0, b.0))
    }
}
