//! The wheelset under load: roll, patches and rolling radii of both wheels, quasi-static.
//! For plots, checks and starting values; the simulation reads the tables directly.

use super::level::{level, shifts};
use super::{ContactError, ContactTable, PairGeometry, Patch};

/// Both wheels of a wheelset under load, left wheel first.
#[derive(Clone, Copy, Debug)]
pub struct LoadedState {
    /// Roll of the axle (rad), positive when the right side is low.
    pub roll: f64,
    /// Tread, root and flange patches of each wheel in its own mirrored frame.
    pub wheels: [[Patch<f64>; 3]; 2],
    /// Height w of each wheel, m: see [`ContactTable::patches`].
    pub heights: [f64; 2],
}

impl LoadedState {
    /// Load-weighted rolling radius of the right wheel less that of the left one, m.
    ///
    /// Radii are measured to the rail, that is less the penetration, which is how CONTACT gives them.
    pub fn rolling_radius_difference(&self) -> f64 {
        let [left, right] = self.wheels.map(|patches| {
            let force: f64 = patches.iter().map(|p| p.normal_force).sum();
            let rail = |p: &Patch<f64>| p.radius - p.penetration;
            patches.iter().filter(|p| p.active).map(|p| p.normal_force * rail(p)).sum::<f64>() / force
        });
        right - left
    }
}

impl ContactTable {
    /// Patches of a wheelset at a shift `y` to the right (m) and a `yaw` (rad), each wheel pressed down by `wheel_load` (N).
    ///
    /// `pair` is the one the table was built for. Friction is left out; the lateral forces are whatever the angles give.
    ///
    /// # Errors
    /// A load that is not positive or beyond the table's depth, a place outside the table.
    pub fn wheelset_at(
        &self,
        pair: &PairGeometry,
        y: f64,
        yaw: f64,
        wheel_load: f64,
    ) -> Result<LoadedState, ContactError> {
        let (radius, half) = (pair.radius, pair.tape_circle());
        // A mirrored wheel sees the mirrored yaw; it enters squared.
        let press = |shift: f64, roll: f64| self.pressed_by(wheel_load, shift, roll, yaw);
        let roll = level(half, |roll| {
            let [left, right] = shifts(y, roll, radius, half);
            Ok([press(left, -roll)?.0, press(right, roll)?.0])
        })?;
        let [left, right] = shifts(y, roll, radius, half);
        let ((left, p), (right, q)) = (press(left, -roll)?, press(right, roll)?);
        Ok(LoadedState { roll, wheels: [p, q], heights: [left, right] })
    }

    /// The height w at which the right wheel carries `load` (N, vertical), and its patches there.
    ///
    /// # Errors
    /// A load that is not positive or beyond the table's depth, a place outside the table.
    pub fn pressed_by(
        &self,
        load: f64,
        shift: f64,
        roll: f64,
        yaw: f64,
    ) -> Result<(f64, [Patch<f64>; 3]), ContactError> {
        let refuse = |what: &str, value: f64, [least, most]: [f64; 2], remedy: &str| ContactError::OutOfRange {
            what: what.into(),
            value,
            least,
            most,
            remedy: remedy.into(),
        };
        if !(load > 0.0 && load < 1e6) {
            return Err(refuse("wheel load", load, [0.0, 1e6], "give it in newtons"));
        }
        let patches = |w: f64| self.patches(shift, w, roll, yaw);
        let carried = |p: &[Patch<f64>; 3]| p.iter().map(|p| p.normal_force * p.angle.cos()).sum::<f64>();
        let apart = patches(-1.0).map_err(|e| refuse(e.what, e.value, [e.least, e.most], "stay on the rail"))?;
        // Bisection between first touch and the depth of the table.
        let touch = -1.0 - apart.iter().map(|p| p.penetration).fold(f64::MIN, f64::max);
        let (mut low, mut high) = (touch, touch + 2e-3);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match patches(middle) {
                Ok(p) if carried(&p) < load => low = middle,
                _ => high = middle,
            }
        }
        match patches(low) {
            Ok(p) if (carried(&p) / load - 1.0).abs() < 1e-6 => Ok((low, p)),
            _ => Err(refuse("wheel load", load, [0.0, 1e6], "the contact table is not deep enough for it here")),
        }
    }
}
