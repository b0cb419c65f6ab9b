//! The wheelset of rigid wheels on rigid rails: where it touches, rolling radii, equivalent conicity.
//! For plots, checks and starting values; the simulation reads the tables directly.

mod conicity;

pub use super::geometry::RigidContact;
use super::geometry::{Strips, first_touch};
use super::level::shifts;
use super::{ContactError, PairGeometry, Profile};

/// Spacing of the wheel points of the rigid view, m.
const SPACING: f64 = 2e-5;

/// A wheel that touches higher on its flange than this share of its height runs on the flange's tip.
const CLIMBED: f64 = 0.95;

/// A wheelset of rigid wheels on rigid rails, its roll following from both wheels touching.
///
/// ```
/// use klingel_physics::contact::{PairGeometry, Profile, RigidWheelset};
/// let pair = PairGeometry {
///     wheel: Profile::s1002(), rail: Profile::rail_60e1(),
///     rail_inclination: 0.025, gauge: 1.435, flange_back: 1.36, radius: 0.46,
/// };
/// let wheelset = RigidWheelset::new(&pair).unwrap();
/// assert!((wheelset.equivalent_conicity(3e-3).unwrap() - 0.17).abs() < 0.01);
/// // With a left wheel 1 mm smaller it runs to the left, where the left wheel is larger.
/// let smaller = PairGeometry { radius: 0.459, ..pair.clone() };
/// let uneven = RigidWheelset::of_wheels(&smaller, &pair).unwrap();
/// assert!(uneven.rolling_radius_difference(0.0).unwrap() > 0.9e-3);
/// ```
#[derive(Clone, Debug)]
pub struct RigidWheelset {
    /// Left side first, each in its own mirrored frame.
    sides: [Side; 2],
    tape_circle: f64,
}

/// A wheel above its rail, seen as the right one.
#[derive(Clone, Debug)]
struct Side {
    rail: Profile,
    strips: Strips,
    radius: f64,
}

/// Both wheels of a wheelset in rigid contact, left wheel first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidState {
    /// Roll of the axle (rad), positive when the right side is low.
    pub roll: f64,
    /// Each wheel in its own mirrored frame (+ to the field side).
    pub wheels: [RigidContact; 2],
}

impl RigidState {
    /// Rolling radius of the right wheel less that of the left one, m.
    pub fn rolling_radius_difference(&self) -> f64 {
        self.wheels[1].radius - self.wheels[0].radius
    }
}

impl Side {
    fn new(pair: &PairGeometry) -> Result<Self, ContactError> {
        let strips = Strips::of_wheel(&pair.wheel, SPACING)?;
        Ok(Self { rail: pair.placed_rail()?, strips, radius: pair.radius })
    }

    /// The first contact at a `shift` of the tape circle to the field side and a `roll` that lowers that side.
    fn touch(&self, shift: f64, roll: f64) -> Result<RigidContact, ContactError> {
        let gaps = PairGeometry::gaps(&self.rail, &self.strips, shift, roll);
        let touch = first_touch(&self.strips, &gaps, self.radius).ok_or(ContactError::NoContact { shift, roll })?;
        // The strips begin at the tip of the flange.
        let (on_wheel, most) = (touch.radius - self.radius, CLIMBED * self.strips.z[0]);
        if on_wheel > most {
            let what = "radius increment at the contact (m)".into();
            let remedy = "the flange runs on top of the rail; give a smaller displacement".into();
            return Err(ContactError::OutOfRange { what, value: on_wheel, least: -0.01, most, remedy });
        }
        Ok(touch)
    }
}

impl RigidWheelset {
    /// A wheelset with two wheels of `pair` on two rails of it.
    ///
    /// # Errors
    /// What [`PairGeometry::placed_rail`] refuses, and a wheel without a flange.
    pub fn new(pair: &PairGeometry) -> Result<Self, ContactError> {
        let side = Side::new(pair)?;
        Ok(Self { sides: [side.clone(), side], tape_circle: pair.tape_circle() })
    }

    /// A wheelset whose wheels, rails or radii differ; both sides are given as right ones.
    ///
    /// # Errors
    /// As for [`new`](Self::new); different gauges or flange-back distances, which the two sides share.
    pub fn of_wheels(left: &PairGeometry, right: &PairGeometry) -> Result<Self, ContactError> {
        for (what, left, right) in
            [("gauge", left.gauge, right.gauge), ("flange-back distance", left.flange_back, right.flange_back)]
        {
            if left != right {
                let (what, remedy) = (format!("{what} of the left side"), "give both sides the same".into());
                return Err(ContactError::OutOfRange { what, value: left, least: right, most: right, remedy });
            }
        }
        Ok(Self { sides: [Side::new(left)?, Side::new(right)?], tape_circle: right.tape_circle() })
    }

    /// The first contact of the right wheel at a `shift` of its tape circle (m) and a `roll` of the axle (rad).
    ///
    /// # Errors
    /// No rail below the wheel.
    pub fn wheel(&self, shift: f64, roll: f64) -> Result<RigidContact, ContactError> {
        self.sides[1].touch(shift, roll)
    }

    /// Both wheels of a wheelset whose axle is moved by `y` to the right, m.
    ///
    /// # Errors
    /// No rail below a wheel.
    pub fn at(&self, y: f64) -> Result<RigidState, ContactError> {
        self.state(|side, roll| shifts(y, roll, self.sides[side].radius, self.tape_circle)[side])
    }

    /// Both wheels of a wheelset whose tape circles are moved by `y` to the right at their lowest points, m: where it rolls,
    /// the axle has then moved by r0 sin(roll) more.
    ///
    /// # Errors
    /// No rail below a wheel.
    pub fn at_rail_level(&self, y: f64) -> Result<RigidState, ContactError> {
        self.state(|side, roll| shifts(y, roll, 0.0, self.tape_circle)[side])
    }

    /// Both wheels at rest on their rails, their shifts following from the roll.
    fn state(&self, shift: impl Fn(usize, f64) -> f64) -> Result<RigidState, ContactError> {
        let [left, right] = &self.sides;
        let touch = |roll: f64| -> Result<[RigidContact; 2], ContactError> {
            Ok([left.touch(shift(0, roll), -roll)?, right.touch(shift(1, roll), roll)?])
        };
        let roll = self.resting_roll(|roll: f64| {
            let [l, r] = touch(roll)?;
            Ok(r.gap - l.gap + (left.radius - right.radius) * roll.cos())
        })?;
        Ok(RigidState { roll, wheels: touch(roll)? })
    }

    /// The roll at which the two ends of the axle differ in height by `rise` (m, right end lower), which depends on the roll.
    ///
    /// Secants; contact on the flange makes the roll feed back on itself by up to -0.8, so the slope is between -1.9 and -0.9.
    fn resting_roll(&self, rise: impl Fn(f64) -> Result<f64, ContactError>) -> Result<f64, ContactError> {
        let miss = |roll: f64| -> Result<f64, ContactError> {
            Ok((0.5 * rise(roll)? / self.tape_circle).clamp(-0.1, 0.1).asin() - roll)
        };
        let (mut before, mut missed) = (0.0, miss(0.0)?);
        let mut roll = 0.6 * missed;
        for _ in 0..60 {
            let here = miss(roll)?;
            if here.abs() < 1e-13 {
                break;
            }
            let slope = ((here - missed) / (roll - before)).clamp(-1.9, -0.9);
            (before, missed) = (roll, here);
            roll -= here / slope;
        }
        Ok(roll)
    }

    /// Rolling radius of the right wheel less that of the left one (m) at a shift `y` of the axle to the right (m).
    ///
    /// # Errors
    /// No rail below a wheel.
    pub fn rolling_radius_difference(&self, y: f64) -> Result<f64, ContactError> {
        Ok(self.at(y)?.rolling_radius_difference())
    }
}
