//! The wheelset of rigid wheels on rigid rails: where it touches, rolling radii, equivalent conicity.
//! For plots, checks and starting values; the simulation reads the tables directly.

pub use super::geometry::RigidContact;
use super::geometry::{Strips, first_touch};
use super::level::{level, shifts};
use super::{ContactError, PairGeometry, Profile};

/// Spacing of the wheel points of the rigid view, m.
const SPACING: f64 = 2e-5;
/// Steps of shift at which the rolling radii are taken for the conicity, m.
const CONICITY_STEP: f64 = 5e-5;

/// A wheelset of rigid wheels on rigid rails, its roll following from both wheels touching.
///
/// ```
/// use klingel_physics::contact::{PairGeometry, Profile, RigidWheelset};
/// let pair = PairGeometry {
///     wheel: Profile::s1002(), rail: Profile::rail_60e1(),
///     rail_inclination: 0.025, gauge: 1.435, flange_back: 1.36, radius: 0.46,
/// };
/// let conicity = RigidWheelset::new(&pair).unwrap().equivalent_conicity(3e-3).unwrap();
/// assert!((conicity - 0.18).abs() < 0.01);
/// ```
#[derive(Clone, Debug)]
pub struct RigidWheelset {
    rail: Profile,
    strips: Strips,
    radius: f64,
    tape_circle: f64,
}

/// Both wheels of a wheelset in rigid contact, left wheel first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidState {
    /// Roll of the axle (rad), positive when the right side is low.
    pub roll: f64,
    /// Each wheel in its own mirrored frame (+ to the field side).
    pub wheels: [RigidContact; 2],
}

impl RigidWheelset {
    /// # Errors
    /// What [`PairGeometry::placed_rail`] refuses, and a wheel without a flange.
    pub fn new(pair: &PairGeometry) -> Result<Self, ContactError> {
        let strips = Strips::of_wheel(&pair.wheel, SPACING)?;
        Ok(Self { rail: pair.placed_rail()?, strips, radius: pair.radius, tape_circle: pair.tape_circle() })
    }

    /// The first contact of the right wheel at a `shift` of its tape circle (m) and a `roll` of the axle (rad).
    ///
    /// # Errors
    /// No rail below the wheel.
    pub fn wheel(&self, shift: f64, roll: f64) -> Result<RigidContact, ContactError> {
        let gaps = PairGeometry::gaps(&self.rail, &self.strips, shift, roll);
        first_touch(&self.strips, &gaps, self.radius).ok_or(ContactError::NoContact { shift, roll })
    }

    /// Both wheels of a wheelset moved by `y` to the right, m.
    ///
    /// # Errors
    /// No rail below a wheel.
    pub fn at(&self, y: f64) -> Result<RigidState, ContactError> {
        let touch = |roll: f64| {
            let [left, right] = shifts(y, roll, self.radius, self.tape_circle);
            Ok([self.wheel(left, -roll)?, self.wheel(right, roll)?])
        };
        let roll = level(self.tape_circle, |roll| touch(roll).map(|[l, r]| [l.gap, r.gap]))?;
        Ok(RigidState { roll, wheels: touch(roll)? })
    }

    /// Rolling radius of the right wheel less that of the left one (m) at a shift `y` to the right (m).
    ///
    /// # Errors
    /// No rail below a wheel.
    pub fn rolling_radius_difference(&self, y: f64) -> Result<f64, ContactError> {
        let [left, right] = self.at(y)?.wheels;
        Ok(right.radius - left.radius)
    }

    /// Equivalent conicity (slope) at an `amplitude` (m) of the free lateral motion, integrated as EN 15302 has it.
    ///
    /// The wheelset obeys y'' = -(difference of rolling radii) / (e r0), e the distance of the tape circles; the conicity is
    /// that of the cone with the same wavelength. Both wheels and both rails are alike, so the motion is symmetric.
    ///
    /// # Errors
    /// An amplitude that is not positive or above 15 mm; no rail below a wheel.
    pub fn equivalent_conicity(&self, amplitude: f64) -> Result<f64, ContactError> {
        if !(amplitude > 0.0 && amplitude <= 0.015) {
            let (what, remedy) = ("amplitude".into(), "give it in metres such as 0.003".into());
            return Err(ContactError::OutOfRange { what, value: amplitude, least: 0.0, most: 0.015, remedy });
        }
        let steps = (amplitude / CONICITY_STEP).ceil().max(20.0) as usize;
        let dy = amplitude / steps as f64;
        let difference = (0..=steps)
            .map(|i| self.rolling_radius_difference(i as f64 * dy))
            .collect::<Result<Vec<_>, ContactError>>()?;
        // Potential of the restoring slope, trapezoidal.
        let mut potential = vec![0.0];
        for pair in difference.windows(2) {
            potential.push(potential[potential.len() - 1] + 0.5 * dy * (pair[0] + pair[1]));
        }
        let height = |y: f64| {
            let place = (y / dy).min(steps as f64 - 1e-9);
            let (k, t) = (place as usize, place.fract());
            potential[k] + dy * t * (difference[k] + 0.5 * t * (difference[k + 1] - difference[k]))
        };
        // Quarter of a wavelength with y = amplitude sin(theta), in units of sqrt(e r0).
        let count = 400;
        let quarter: f64 = (0..count)
            .map(|i| {
                let theta = (f64::from(i) + 0.5) / f64::from(count) * core::f64::consts::FRAC_PI_2;
                let speed2 = 2.0 * (potential[steps] - height(amplitude * theta.sin()));
                amplitude * theta.cos() / speed2.sqrt()
            })
            .sum::<f64>()
            * core::f64::consts::FRAC_PI_2
            / f64::from(count);
        Ok(0.5 * (core::f64::consts::FRAC_PI_2 / quarter).powi(2))
    }
}
