//! Vectors and rotations in three dimensions over any `Scalar`.
//! Axes x forward, y right, z down, so a positive roll lowers the right side and a positive yaw turns to the right.

use crate::Scalar;
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector resolved in some frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vec3<S>(pub [S; 3]);

impl<S: Scalar> Vec3<S> {
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self([x, y, z])
    }
    #[inline(always)]
    pub fn constant(v: [f64; 3]) -> Self {
        Self(v.map(S::constant))
    }
    #[inline(always)]
    pub fn zero() -> Self {
        Self([S::zero(); 3])
    }
    #[inline(always)]
    pub fn x(self) -> S {
        self.0[0]
    }
    #[inline(always)]
    pub fn y(self) -> S {
        self.0[1]
    }
    #[inline(always)]
    pub fn z(self) -> S {
        self.0[2]
    }
    #[inline(always)]
    pub fn dot(self, o: Self) -> S {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, o.0);
        Self([b * f - c * e, c * d - a * f, a * e - b * d])
    }
    #[inline(always)]
    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }
    #[inline(always)]
    pub fn values(self) -> [f64; 3] {
        self.0.map(S::value)
    }
}
impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}
impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1], self.0[2] - o.0[2]])
    }
}
impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}
impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self(self.0.map(|x| x * s))
    }
}
impl<S: Scalar> AddAssign for Vec3<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<S: Scalar> SubAssign for Vec3<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

/// A rotation: `r.apply(v)` resolves in the outer frame what was resolved in the inner one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rotation<S>(pub [[S; 3]; 3]);

impl<S: Scalar> Rotation<S> {
    /// Rz(yaw) Rx(roll).
    #[inline(always)]
    pub fn yaw_roll(yaw: S, roll: S) -> Self {
        let ((sz, cz), (sx, cx)) = (yaw.sin_cos(), roll.sin_cos());
        Self([[cz, -(sz * cx), sz * sx], [sz, cz * cx, -(cz * sx)], [S::zero(), sx, cx]])
    }
    /// Rz(yaw) Rx(roll) Ry(pitch): pitch last, so that a spinning wheelset may leave it out.
    #[inline(always)]
    pub fn yaw_roll_pitch(yaw: S, roll: S, pitch: S) -> Self {
        Self::yaw_roll(yaw, roll).pitched(pitch.sin_cos())
    }
    /// This rotation followed by Ry, given by the sine and cosine of the pitch.
    #[inline(always)]
    pub fn pitched(&self, (sin, cos): (S, S)) -> Self {
        Self(self.0.map(|[x, y, z]| [x * cos - z * sin, y, x * sin + z * cos]))
    }
    #[inline(always)]
    pub fn apply(&self, v: Vec3<S>) -> Vec3<S> {
        let m = &self.0;
        Vec3([0, 1, 2].map(|i| m[i][0] * v.0[0] + m[i][1] * v.0[1] + m[i][2] * v.0[2]))
    }
    /// Resolves in the inner frame.
    #[inline(always)]
    pub fn back(&self, v: Vec3<S>) -> Vec3<S> {
        let m = &self.0;
        Vec3([0, 1, 2].map(|i| m[0][i] * v.0[0] + m[1][i] * v.0[1] + m[2][i] * v.0[2]))
    }
    #[inline(always)]
    pub fn then(&self, inner: &Self) -> Self {
        let (a, b) = (&self.0, &inner.0);
        Self([0, 1, 2].map(|i| [0, 1, 2].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_is_the_product_of_its_three_turns_and_orthogonal() {
        let (z, x, y) = (0.3, -0.2, 0.1);
        let r = Rotation::yaw_roll_pitch(z, x, y);
        let p = Rotation::yaw_roll_pitch(z, 0.0, 0.0)
            .then(&Rotation::yaw_roll_pitch(0.0, x, 0.0))
            .then(&Rotation::yaw_roll_pitch(0.0, 0.0, y));
        for i in 0..3 {
            for j in 0..3 {
                assert!((r.0[i][j] - p.0[i][j]).abs() < 1e-15);
            }
        }
        let v = Vec3::new(1.0, 2.0, 3.0);
        let w = r.back(r.apply(v));
        assert!((w - v).norm() < 1e-14);
    }

    #[test]
    fn positive_roll_lowers_the_right_side_and_positive_yaw_turns_right() {
        let right = Vec3::new(0.0, 1.0, 0.0);
        assert!(Rotation::yaw_roll_pitch(0.0, 0.1, 0.0).apply(right).z() > 0.0);
        let ahead = Vec3::new(1.0, 0.0, 0.0);
        assert!(Rotation::yaw_roll_pitch(0.1, 0.0, 0.0).apply(ahead).y() > 0.0);
    }
}
