//! Tread, root and flange of a wheel: each carries load by its own penetration.
//! They meet where the contact of a level wheel jumps, so that a patch lies in one zone and two patches in two.

use super::geometry::{RigidContact, Strips, first_touch};
use super::{ContactError, PairGeometry, Profile};

/// The part of the wheel that touches; patches come in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    Tread,
    Root,
    Flange,
}

impl Zone {
    pub const ALL: [Self; 3] = [Self::Tread, Self::Root, Self::Flange];
}

/// Width of the strips of each zone, m.
const STRIP: [f64; 3] = [1e-4, 5e-5, 5e-5];
/// Angles between which the root starts and ends, degrees.
const ROOT_START: [f64; 2] = [4.0, 14.0];
const ROOT_END: [f64; 2] = [30.0, 62.0];
/// Least width of the root, and least jump of the contact that counts, m.
const LEAST_ROOT: f64 = 3e-3;
const LEAST_JUMP: f64 = 1e-3;

/// Where a centred wheelset may touch its wheels, m from the tape circle to the field side.
const CENTRED: [f64; 2] = [-0.027, 0.045];

/// Wheel strips of the three zones.
pub(super) struct WheelZones {
    pub strips: [Strips; 3],
    /// Places where root and flange, tread and root meet, m from the tape circle.
    pub borders: [f64; 2],
}

impl WheelZones {
    /// Splits the wheel where the contact jumps widest as a level wheel moves to the field side, once at either end of the
    /// root; where it does not jump, at the middle of the angles.
    ///
    /// # Errors
    /// A wheel without a flange, or with one less steep than 46 degrees; a gauge that cannot hold the wheelset.
    pub fn new(pair: &PairGeometry, rail: &Profile) -> Result<Self, ContactError> {
        let whole = Strips::of_wheel(&pair.wheel, 5e-5)?;
        holds(pair, rail, &whole)?;
        let scan: Vec<RigidContact> = (0..=240)
            .filter_map(|i| {
                let gaps = PairGeometry::gaps(rail, &whole, f64::from(i) * 5e-5, 0.0);
                first_touch(&whole, &gaps, pair.radius)
            })
            .collect();
        // The widest jump between two angles that lies on the flange side of `limit`, or the place of the middle angle.
        let border = |[least, most]: [f64; 2], limit: f64| {
            let angle = |p: &[RigidContact]| 0.5 * (p[0].angle + p[1].angle).to_degrees();
            let middle = |p: &[RigidContact]| 0.5 * (p[0].y_wheel + p[1].y_wheel);
            let jump = |p: &[RigidContact]| (p[0].y_wheel - p[1].y_wheel).abs();
            let widest = scan
                .windows(2)
                .filter(|p| angle(p) > least && angle(p) < most && jump(p) > LEAST_JUMP && middle(p) < limit)
                .max_by(|p, q| jump(p).total_cmp(&jump(q)));
            let steep = |j: &usize| whole.angle[*j] >= (0.5 * (least + most)).to_radians() && whole.y[*j] < limit;
            widest.map(middle).or_else(|| (0..whole.y.len()).rev().find(steep).map(|j| whole.y[j]))
        };
        let root = border(ROOT_START, 0.0);
        let Some((root, flange)) = root.and_then(|root| Some((root, border(ROOT_END, root - LEAST_ROOT)?))) else {
            let value = whole.angle.iter().fold(0.0, |m: f64, &a| m.max(a));
            let remedy = "give a wheel profile with its flange at negative y".into();
            let what = "largest angle of the wheel (rad)".into();
            return Err(ContactError::OutOfRange { what, value, least: 0.8, most: 1.6, remedy });
        };
        let limits = [[root, whole.y[whole.y.len() - 1]], [flange, root], [whole.y[0], flange]];
        Ok(Self { strips: [0, 1, 2].map(|z| Strips::new(&pair.wheel, limits[z], STRIP[z])), borders: [flange, root] })
    }
}

/// Refuses a gauge that cannot hold the wheelset: centred, one that fits runs on its treads, neither on its flanges nor
/// on its outer edges.
pub(super) fn holds(pair: &PairGeometry, rail: &Profile, wheel: &Strips) -> Result<(), ContactError> {
    let gaps = PairGeometry::gaps(rail, wheel, 0.0, 0.0);
    let centred = first_touch(wheel, &gaps, pair.radius).map_or(f64::INFINITY, |touch| touch.y_wheel);
    let [least, most] = CENTRED;
    if centred > least && centred < most {
        return Ok(());
    }
    let remedy = "the gauge cannot hold this wheelset; check gauge, flange-back distance and profiles".into();
    let what = "contact of the centred wheelset on its wheel (m)".into();
    Err(ContactError::OutOfRange { what, value: centred, least, most, remedy })
}
