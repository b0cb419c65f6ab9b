//! The contact of a wheelset as people look at it: every patch with its place on wheel and rail, size, pressure and force.
//! Loaded from the tables, or of rigid wheels and rails; each wheel in its own frame, + to the field side.

use super::level::shifts;
use super::zones::Zone;
use super::{ContactError, ContactTable, LoadedState, PairGeometry, PatchDetail, RigidState};

/// One patch of one wheel. For the left wheel mirror it: `y_wheel`, `y_rail` and `angle` change sign in track axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Part of the wheel that touches; none in the rigid view, which has one point a wheel.
    pub zone: Option<Zone>,
    /// Load-weighted middle of the patch on the wheel's profile: from the tape circle to the field side, radius increment, m.
    pub y_wheel: f64,
    pub z_wheel: f64,
    /// The same point on the rail: from the highest point of the inclined rail, in track axes, to the field side and down,
    /// m. This is how CONTACT measures on a rail.
    pub y_rail: f64,
    pub z_rail: f64,
    /// Distance of the contact ahead of the axle, r tan(delta) psi, m.
    pub x: f64,
    /// Angle of the contact plane in the track (rad), positive on the flange.
    pub angle: f64,
    /// Rolling radius measured to the rail, that is less the vertical penetration, m.
    pub radius: f64,
    /// Semi-axes of the equivalent ellipse along and across the rolling direction, m; 0 in the rigid view.
    pub a: f64,
    pub b: f64,
    /// Area (m2) and largest pressure (Pa); 0 in the rigid view.
    pub area: f64,
    pub pressure: f64,
    /// Size of the normal force, N; 0 in the rigid view.
    pub normal_force: f64,
    /// Approach of wheel and rail along the normal of the contact plane, m; 0 in the rigid view.
    pub penetration: f64,
}

/// Contact of both wheels, left wheel first.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelsetContact {
    /// Roll of the axle (rad), positive when the right side is low.
    pub roll: f64,
    /// Patches of each wheel in the order tread, root, flange: those that touch.
    pub wheels: [Vec<ContactPoint>; 2],
}

impl ContactTable {
    /// The patches of a wheelset moved by `y` to the right (m) at a `yaw` (rad, positive to the right), each wheel pressed
    /// down by `wheel_load` (N, vertical, without friction). `pair` is the one the table was built for.
    ///
    /// ```
    /// use klingel_physics::contact::{ContactTable, Material, NormalContact, PairGeometry, Profile};
    /// let pair = PairGeometry {
    ///     wheel: Profile::s1002(), rail: Profile::rail_60e1(),
    ///     rail_inclination: 0.025, gauge: 1.435, flange_back: 1.36, radius: 0.46,
    /// };
    /// let table = ContactTable::build(&pair, &Material::STEEL, NormalContact::Hertz).unwrap();
    /// let [_, right] = table.contact(&pair, 3e-3, 0.0, 5e4).unwrap().wheels;
    /// assert!(right.len() == 1 && (right[0].y_wheel + 13.1e-3).abs() < 1e-3 && right[0].area > 5e-5);
    /// ```
    ///
    /// # Errors
    /// A load that is not positive or beyond the table's depth, a place outside the table.
    pub fn contact(
        &self,
        pair: &PairGeometry,
        y: f64,
        yaw: f64,
        wheel_load: f64,
    ) -> Result<WheelsetContact, ContactError> {
        let state = self.wheelset_at(pair, y, yaw, wheel_load)?;
        let wheel = |side: usize| self.points(pair, y, yaw, &state, side);
        Ok(WheelsetContact { roll: state.roll, wheels: [wheel(0)?, wheel(1)?] })
    }

    fn points(
        &self,
        pair: &PairGeometry,
        y: f64,
        yaw: f64,
        state: &LoadedState,
        side: usize,
    ) -> Result<Vec<ContactPoint>, ContactError> {
        let place = Place::new(pair, self.rail_top, y, state.roll, side);
        let touching = Zone::ALL.into_iter().zip(&state.wheels[side]).filter(|(_, p)| p.active);
        touching
            .map(|(zone, p)| {
                let PatchDetail { area, pressure } = self.detail(zone, place.shift, place.roll, p.penetration)?;
                let point = place.point(p.y_wheel, p.radius, p.angle, yaw, state.heights[side] - p.penetration);
                let radius = p.radius - p.penetration;
                let (normal_force, penetration) = (p.normal_force, p.penetration * p.angle.cos());
                Ok(ContactPoint {
                    zone: Some(zone),
                    radius,
                    a: p.a,
                    b: p.b,
                    area,
                    pressure,
                    normal_force,
                    penetration,
                    ..point
                })
            })
            .collect()
    }
}

impl RigidState {
    /// The two points of rigid wheels that touch at `y` (m, to the right) and `yaw` (rad); `rail_top` is
    /// [`PairGeometry::rail_top`] of the `pair` that the state belongs to.
    pub fn contact(&self, pair: &PairGeometry, rail_top: f64, y: f64, yaw: f64) -> WheelsetContact {
        let point = |side: usize| {
            let (touch, place) = (&self.wheels[side], Place::new(pair, rail_top, y, self.roll, side));
            place.point(touch.y_wheel, touch.radius, touch.angle - place.roll, yaw, touch.gap)
        };
        WheelsetContact { roll: self.roll, wheels: [vec![point(0)], vec![point(1)]] }
    }
}

/// Where a wheel is, in its own frame.
struct Place<'a> {
    pair: &'a PairGeometry,
    rail_top: f64,
    /// +1 for the right wheel, -1 for the left one, which sees the mirrored yaw.
    sign: f64,
    shift: f64,
    roll: f64,
}

impl<'a> Place<'a> {
    fn new(pair: &'a PairGeometry, rail_top: f64, y: f64, roll: f64, side: usize) -> Self {
        let sign = [-1.0, 1.0][side];
        let shift = shifts(y, roll, pair.radius, pair.tape_circle())[side];
        Self { pair, rail_top, sign, shift, roll: sign * roll }
    }

    /// The point (y_wheel, radius) of a wheel at the height `w`, which brings it to the rail, without sizes and force.
    fn point(&self, y_wheel: f64, radius: f64, angle: f64, yaw: f64, w: f64) -> ContactPoint {
        let (z_wheel, (sin, cos)) = (radius - self.pair.radius, self.roll.sin_cos());
        ContactPoint {
            zone: None,
            y_wheel,
            z_wheel,
            y_rail: self.shift + y_wheel * cos - z_wheel * sin - self.rail_top,
            z_rail: w + y_wheel * sin + z_wheel * cos,
            x: radius * angle.tan() * self.sign * yaw,
            angle,
            radius,
            a: 0.0,
            b: 0.0,
            area: 0.0,
            pressure: 0.0,
            normal_force: 0.0,
            penetration: 0.0,
        }
    }
}
