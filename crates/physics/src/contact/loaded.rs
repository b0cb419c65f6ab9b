//! The wheelset under load: roll, patches and rolling radii of both wheels, quasi-static.
//! For plots, checks and starting values; the simulation reads the tables directly.

use super::level::{level, yawed_shifts};
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
    /// Radii are those of the load-weighted points of the rail, as in [`ContactTable::contact`].
    pub fn rolling_radius_difference(&self) -> f64 {
        let [left, right] = [0, 1].map(|side| {
            let roll = [-self.roll, self.roll][side];
            let patches = self.wheels[side].iter().filter(|p| p.active);
            let (moment, force) = patches.fold((0.0, 0.0), |(moment, force), p| {
                let normal = p.penetration * p.angle.cos();
                let radius = p.radius - normal * (p.angle + roll).cos();
                (moment + p.normal_force * radius, force + p.normal_force)
            });
            moment / force
        });
        right - left
    }
}

/// Loads of a wheel that the views take, N.
const LOAD: [f64; 2] = [1.0, 1e6];

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
            let [left, right] = yawed_shifts(y, roll, yaw, radius, half);
            Ok([press(left, -roll)?.0, press(right, roll)?.0])
        })?;
        let [left, right] = yawed_shifts(y, roll, yaw, radius, half);
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
        if !(LOAD[0]..=LOAD[1]).contains(&load) {
            return Err(refuse("wheel load", load, LOAD, "give the force of one wheel in newtons"));
        }
        let patches = |w: f64| self.patches(shift, w, roll, yaw);
        let carried = |p: &[Patch<f64>; 3]| p.iter().map(|p| p.normal_force * p.angle.cos()).sum::<f64>();
        let apart = patches(-1.0).map_err(|e| refuse(e.what, e.value, [e.least, e.most], "stay on the rail"))?;
        // Bisection from first touch until both ends lie in the table, then the Illinois variant of false position.
        let touch = -1.0 - apart.iter().map(|p| p.penetration).fold(f64::MIN, f64::max);
        let (mut low, mut high) = ((touch, -1.0), (touch + 2e-3, f64::INFINITY));
        for _ in 0..100 {
            let middle = if high.1.is_finite() && low.1 > -1.0 {
                low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1)
            } else {
                0.5 * (low.0 + high.0)
            };
            let (miss, found) = patches(middle).map_or((f64::INFINITY, None), |p| (carried(&p) / load - 1.0, Some(p)));
            if let Some(p) = found.filter(|_| miss.abs() < 1e-11) {
                return Ok((middle, p));
            }
            // The end that stays counts half, or else it would stay for ever.
            if miss < 0.0 {
                (low, high.1) = ((middle, miss), 0.5 * high.1);
            } else {
                (high, low.1) = ((middle, miss), if low.1 > -1.0 { 0.5 * low.1 } else { low.1 });
            }
        }
        // What the deepest place of the table carries.
        let most = patches(low.0).map_or(0.0, |p| carried(&p));
        Err(refuse("wheel load", load, [LOAD[0], most], "here the contact table carries no more; give a smaller load"))
    }
}
