//! Wheels by their defining data: S1002 of EN 13715, and cones with its flange.
//! Lengths in millimetres, as in the standard; y from the tape circle, + to the field side, z the radius increment.

use super::curves::{Piece, circle, line, polynomial, sample, sample_pieces};
use super::{super::ContactError, Profile};

/// Flange back H, flange tip G and F, flank E of S1002 and of the cones that borrow its flange.
const S1002_FLANGE: [Piece; 4] = [
    Piece { from: -70.0, curve: |y| circle(y, -49.5, 9.519259302, 20.5, 1.0) },
    Piece { from: -62.764705882, curve: |y| circle(y, -55.0, 16.0, 12.0, 1.0) },
    Piece { from: -49.662510381, curve: |y| circle(y, -58.558326413, 8.834924130, 20.0, 1.0) },
    Piece { from: -39.764473993, curve: |y| line(y, -93.576667419, -2.747477419) },
];
const S1002_TREAD: [Piece; 4] = [
    Piece { from: -38.426669071, curve: |y| circle(y, -26.210665, 16.446, 13.0, -1.0) },
    Piece {
        from: -35.0,
        curve: |y| {
            let c = [
                -4.320221063e3,
                -1.038384026e3,
                -1.065501873e2,
                -6.051367875,
                -2.054332446e-1,
                -4.169739389e-3,
                -4.687195829e-5,
                -2.252755540e-7,
            ];
            polynomial(y, &c)
        },
    },
    Piece {
        from: -26.0,
        curve: |y| {
            let c = [
                0.0,
                -3.358537058e-2,
                1.565681624e-3,
                -2.810427944e-5,
                5.844240864e-8,
                -1.562379023e-8,
                5.309217349e-15,
                -5.957839843e-12,
                2.646656573e-13,
            ];
            polynomial(y, &c)
        },
    },
    Piece { from: 32.15796, curve: |y| line(y, 1.364323640, -0.066666667) },
];
/// The flange back becomes vertical at -70 mm, where a function z(y) has no slope: the last 0.01 mm are left out.
const WHEEL_RANGE: [f64; 2] = [-69.99, 60.0];

impl Profile {
    /// Wheel S1002 (EN 13715, flange height 28 mm, thickness 32.5 mm), -69.99 to 60 mm.
    ///
    /// Coefficients from memory of the standard, checked to 2e-6 mm against a public point file.
    pub fn s1002() -> Self {
        sample_pieces(WHEEL_RANGE, &[&S1002_FLANGE, &S1002_TREAD])
    }

    /// A coned tread z = -`slope` y with the flange of S1002 and a root arc of 13 mm tangent to both.
    ///
    /// Our own construction, for checks against the conicity of a cone.
    ///
    /// # Errors
    /// A slope outside 0 to 0.5.
    pub fn cone(slope: f64) -> Result<Self, ContactError> {
        if !(0.0..=0.5).contains(&slope) {
            let remedy = "give the cone's slope, such as 0.05".into();
            let what = "cone slope".into();
            return Err(ContactError::OutOfRange { what, value: slope, least: 0.0, most: 0.5, remedy });
        }
        let (flank, radius) = (2.747477419_f64, 13.0);
        let (h, g) = ((1.0 + slope * slope).sqrt(), (1.0 + flank * flank).sqrt());
        // Centre of the arc: at distance `radius` on the flange side of both lines.
        let yc = (93.576667419 + radius * (h - g)) / (slope - flank);
        let zc = -slope * yc + radius * h;
        let (on_tread, on_flank) = (yc - radius * slope / h, yc - radius * flank / g);
        Ok(sample(WHEEL_RANGE, |y| {
            if y >= on_tread {
                line(y, 0.0, -slope)
            } else if y >= on_flank {
                circle(y, yc, zc, radius, -1.0)
            } else {
                let k = S1002_FLANGE.partition_point(|p| p.from <= y).max(1) - 1;
                (S1002_FLANGE[k].curve)(y)
            }
        }))
    }
}
