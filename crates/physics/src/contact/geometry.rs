//! A wheel and a rail profile placed on the track, and the gap between them.
//! In the plane across the track the right wheel turns about the bottom of its tape circle: (y, z) = (u, w) + R(roll) (y_w, z_w).

use super::{ContactError, Profile};

/// Depth below the top of rail where the gauge is measured, m.
const GAUGE_DEPTH: f64 = 0.014;
/// Distance of the tape circle from the flange back, m.
const TAPE_CIRCLE: f64 = 0.070;

/// A wheel on a rail of a track, all lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct PairGeometry {
    pub wheel: Profile,
    /// The right rail, not inclined.
    pub rail: Profile,
    /// Slope by which the rails lean inwards, such as 1/40.
    pub rail_inclination: f64,
    /// Distance of the rails 14 mm below their top.
    pub gauge: f64,
    /// Distance of the flange backs of the two wheels.
    pub flange_back: f64,
    /// Radius of the tape circle r0.
    pub radius: f64,
}

impl PairGeometry {
    /// Half the distance of the tape circles, m: half the flange-back distance and 70 mm.
    pub fn tape_circle(&self) -> f64 {
        0.5 * self.flange_back + TAPE_CIRCLE
    }

    /// The right rail as it lies in the track: y from the tape circle of a centred wheelset, z down from the top of rail.
    ///
    /// # Errors
    /// An inclination, gauge, flange-back distance or radius that no railway has; a rail that does not reach 14 mm below its top.
    pub fn placed_rail(&self) -> Result<Profile, ContactError> {
        check("rail inclination", self.rail_inclination, [-0.1, 0.2], "give it as a slope such as 0.025 for 1:40")?;
        check("gauge", self.gauge, [0.5, 2.5], "give it in metres such as 1.435")?;
        check("radius", self.radius, [0.1, 1.5], "give the wheel radius in metres such as 0.46")?;
        let most = self.gauge - 0.03;
        check("flange-back distance", self.flange_back, [0.4, most], "the wheelset must fit into the gauge")?;
        let (sin, cos) = self.rail_inclination.atan().sin_cos();
        let mut rail = self
            .rail
            .map(|[y, z, slope]| [y * cos + z * sin, z * cos - y * sin, (slope * cos - sin) / (cos + slope * sin)]);
        // On an inclined rail an upright flank may overhang: only what can be seen from above is kept.
        let top = (0..rail.y.len()).min_by(|&i, &j| rail.z[i].total_cmp(&rail.z[j])).unwrap_or(0);
        let steep = |i: &usize| rail.slope[*i].abs() > 60.0 || (rail.slope[*i] > 0.0) != (*i >= top);
        let first = (0..top).rev().filter(|&i| i + 3 < top).find(steep).map_or(0, |i| i + 1);
        let last = (top..rail.y.len()).filter(|&i| i > top + 3).find(steep).unwrap_or(rail.y.len());
        let cut = |v: &[f64]| v[first..last].to_vec();
        rail = Profile { y: cut(&rail.y), z: cut(&rail.z), slope: cut(&rail.slope) };
        let top = top - first;
        let height = rail.z[top];
        let face = (1..=top).rev().find(|&i| rail.z[i - 1] - height >= GAUGE_DEPTH).ok_or_else(|| {
            let remedy = "give a rail profile that reaches 14 mm below its top on the gauge side (negative y)".into();
            let value = rail.z[0] - height;
            ContactError::OutOfRange { what: "depth of the rail".into(), value, least: GAUGE_DEPTH, most: 0.2, remedy }
        })?;
        let t = (GAUGE_DEPTH + height - rail.z[face]) / (rail.z[face - 1] - rail.z[face]);
        let gauge_point = rail.y[face] + t * (rail.y[face - 1] - rail.y[face]);
        let offset = 0.5 * self.gauge - self.tape_circle() - gauge_point;
        Ok(rail.map(|[y, z, slope]| [y + offset, z - height, slope]))
    }

    /// Place of the highest point of the placed rail, from the tape circle of a centred wheelset to the field side, m.
    ///
    /// # Errors
    /// What [`Self::placed_rail`] refuses.
    pub fn rail_top(&self) -> Result<f64, ContactError> {
        self.placed_rail().map(|rail| highest(&rail))
    }

    /// The gap of every wheel point of `strips` above the placed rail, at w = 0; infinite where there is no rail.
    pub(super) fn gaps(rail: &Profile, strips: &Strips, shift: f64, roll: f64) -> Vec<f64> {
        let (sin, cos) = roll.sin_cos();
        let (first, end) = (rail.y[0], rail.y[rail.y.len() - 1]);
        let mut k = 0;
        let gap = |(&y_w, &z_w): (&f64, &f64)| {
            let y = shift + y_w * cos - z_w * sin;
            if !(y > first && y < end) {
                return f64::INFINITY;
            }
            // The points come in the order of the rail's, so the interval is close to the last one.
            while rail.y[k + 1] < y {
                k += 1;
            }
            while rail.y[k] > y {
                k -= 1;
            }
            rail.within(k, y).0 - (y_w * sin + z_w * cos)
        };
        strips.y.iter().zip(&strips.z).map(gap).collect()
    }
}

/// Place of the highest point of a rail: where its slope changes sign, between the two samples about it.
pub(super) fn highest(rail: &Profile) -> f64 {
    let after = (1..rail.y.len()).find(|&i| rail.slope[i] >= 0.0 && rail.slope[i - 1] < 0.0);
    after.map_or(rail.y[0], |i| {
        let t = rail.slope[i - 1] / (rail.slope[i - 1] - rail.slope[i]);
        rail.y[i - 1] + t * (rail.y[i] - rail.y[i - 1])
    })
}

fn check(what: &str, value: f64, [least, most]: [f64; 2], remedy: &str) -> Result<(), ContactError> {
    if value >= least && value <= most {
        return Ok(());
    }
    Err(ContactError::OutOfRange { what: what.into(), value, least, most, remedy: remedy.into() })
}

/// Strips of a wheel profile between two places, evenly spaced along its arc.
#[derive(Clone, Debug, Default)]
pub(super) struct Strips {
    /// Width of a strip along the arc, m.
    pub width: f64,
    /// Middle of each strip: place and radius increment.
    pub y: Vec<f64>,
    pub z: Vec<f64>,
    /// Angle (rad, positive on the flange), its cosine and sine.
    pub angle: Vec<f64>,
    pub cos: Vec<f64>,
    pub sin: Vec<f64>,
}

impl Strips {
    /// The whole running surface of a wheel, from the tip of its flange to its field side.
    ///
    /// # Errors
    /// A profile without a flange 10 mm high at negative y, or that rises again on the field side.
    pub fn of_wheel(wheel: &Profile, width: f64) -> Result<Self, ContactError> {
        let tip = (0..wheel.y.len()).max_by(|&i, &j| wheel.z[i].total_cmp(&wheel.z[j])).unwrap_or(0);
        let end = wheel.y.len() - 1;
        let remedy = "give a wheel profile: y to the field side, flange at negative y with positive z";
        check("highest point of the wheel's flange: y", wheel.y[tip], [-0.1, -0.02], remedy)?;
        check("height of the wheel's flange", wheel.z[tip], [0.01, 0.06], remedy)?;
        check("height of the wheel's field side", wheel.z[end], [-0.05, 0.01], remedy)?;
        check("field side of the wheel: y", wheel.y[end], [0.01, 0.15], remedy)?;
        Ok(Self::new(wheel, [wheel.y[tip], wheel.y[end]], width))
    }

    /// About `width` wide strips of `wheel` from `y0` to `y1`, which must lie on the profile.
    pub fn new(wheel: &Profile, [y0, y1]: [f64; 2], width: f64) -> Self {
        let speed = |y: f64| wheel.at(y).map_or(1.0, |(_, s)| (1.0 + s * s).sqrt());
        // Arc length by the trapezoidal rule over fine steps, then inverted at the middles of the strips.
        let steps = ((y1 - y0) / 1e-5).ceil() as usize;
        let dy = (y1 - y0) / steps as f64;
        let mut arc = vec![0.0];
        for i in 0..steps {
            arc.push(arc[i] + dy * speed(y0 + (i as f64 + 0.5) * dy));
        }
        let count = (arc[steps] / width).round().max(1.0);
        let mut strips = Self { width: arc[steps] / count, ..Self::default() };
        for i in 0..count as usize {
            let s = (i as f64 + 0.5) * strips.width;
            let k = arc.partition_point(|&a| a <= s).clamp(1, steps) - 1;
            let y = y0 + dy * (k as f64 + (s - arc[k]) / (arc[k + 1] - arc[k]));
            let (z, slope) = wheel.at(y).unwrap_or_default();
            strips.y.push(y);
            strips.z.push(z);
            let cos = 1.0 / (1.0 + slope * slope).sqrt();
            strips.angle.push((-slope).atan());
            strips.cos.push(cos);
            strips.sin.push(-slope * cos);
        }
        strips
    }

    /// Strips `first` to `end`.
    pub fn part(&self, first: usize, end: usize) -> Self {
        let cut = |v: &[f64]| v[first..end].to_vec();
        Self {
            width: self.width,
            y: cut(&self.y),
            z: cut(&self.z),
            angle: cut(&self.angle),
            cos: cut(&self.cos),
            sin: cut(&self.sin),
        }
    }
}

/// A contact of rigid wheel and rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidContact {
    /// Height w at which the wheel touches, m.
    pub gap: f64,
    /// Place on the wheel from its tape circle, m.
    pub y_wheel: f64,
    /// Rolling radius, m.
    pub radius: f64,
    /// Angle of the contact plane on the wheel, rad, positive on the flange.
    pub angle: f64,
}

/// The first point of `strips` to touch, its place refined by a parabola.
pub(super) fn first_touch(strips: &Strips, gaps: &[f64], radius: f64) -> Option<RigidContact> {
    let i = (0..gaps.len()).min_by(|&i, &j| gaps[i].total_cmp(&gaps[j]))?;
    if !gaps[i].is_finite() {
        return None;
    }
    let (mut offset, mut gap) = (0.0, gaps[i]);
    if i > 0 && i + 1 < gaps.len() && gaps[i - 1].is_finite() && gaps[i + 1].is_finite() {
        let (slope, bend) = (0.5 * (gaps[i + 1] - gaps[i - 1]), gaps[i + 1] - 2.0 * gaps[i] + gaps[i - 1]);
        if bend > 0.0 {
            offset = -slope / bend;
            gap -= 0.5 * slope * slope / bend;
        }
    }
    let j = if offset < 0.0 { i.max(1) - 1 } else { (i + 1).min(gaps.len() - 1) };
    let between = |v: &[f64]| v[i] + offset.abs() * (v[j] - v[i]);
    Some(RigidContact {
        gap,
        y_wheel: between(&strips.y),
        radius: radius + between(&strips.z),
        angle: between(&strips.angle),
    })
}
