//! How a wheelset lies on two rails: shifts of its wheels, and the roll at which both rest.
//! Shared by the rigid and the loaded view; each wheel is seen in its own frame, + to the field side.

use super::ContactError;

/// Shifts of left and right wheel, each to its field side, of a wheelset at (y, roll).
pub(super) fn shifts(y: f64, roll: f64, radius: f64, half: f64) -> [f64; 2] {
    let (sin, cos) = roll.sin_cos();
    let inwards = half * (1.0 - cos);
    [-y - inwards + radius * sin, y - inwards - radius * sin]
}

/// The roll at which the heights \[left, right\] of the wheels differ as the axle's two ends do.
pub(super) fn level(half: f64, heights: impl Fn(f64) -> Result<[f64; 2], ContactError>) -> Result<f64, ContactError> {
    let mut roll = 0.0;
    for _ in 0..60 {
        let [left, right] = heights(roll)?;
        let next = (0.5 * (right - left) / half).clamp(-0.1, 0.1).asin();
        if (next - roll).abs() < 1e-12 {
            break;
        }
        // Contact on the flange makes the roll feed back on itself by up to -0.8: half steps damp that.
        roll += 0.6 * (next - roll);
    }
    Ok(roll)
}
