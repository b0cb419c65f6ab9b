//! Smooth tables of the elastic contact of a pair over shift, roll and penetration, one for each zone of the wheel.
//! Built once in f64; read through any `Scalar`, so that dual numbers get the exact slopes of what is simulated.

use super::geometry::{RigidContact, Strips, first_touch};
use super::normal::zone_load;
use super::spline::{Axis, plane, plane_slopes, sharpen, space, space_slopes};
use super::zones::WheelZones;
use super::{ContactError, Material, PairGeometry};
use crate::{Mask, Scalar};
use rayon::prelude::*;

/// The tables' reach: shift of the right wheel to the field side (m), roll (rad).
const SHIFT: [f64; 2] = [-0.016, 0.016];
const ROLL: [f64; 2] = [-0.012, 0.012];
const SHIFT_INTERVALS: usize = 320;
const ROLL_INTERVALS: usize = 24;
const DEPTH_INTERVALS: usize = 14;
/// Largest penetration of each zone along z, m; steep zones go deeper along z for the same load.
const DEPTH: [f64; 3] = [4e-4, 8e-4, 1.4e-3];
/// A zone that finds no rail below it counts as this far away, m.
const FAR: f64 = 0.03;
/// A zone farther than this behind the first one to touch has no loads: before it is reached the others are deeper
/// than their tables; 0.1 mm of shift move it by less than 0.3 mm.
const REACH: f64 = 3e-3;
/// One contact patch of a wheel. All of it is for the right wheel; mirror it for the left one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Patch<S> {
    /// Whether wheel and rail touch in this zone; if not, everything but `penetration` is zero.
    pub active: bool,
    /// Penetration along z (m); negative: distance.
    pub penetration: S,
    /// Size of the elastic force, N. On the right wheel it acts as N (0, -sin angle, -cos angle) in track axes.
    pub normal_force: S,
    /// Angle of the contact plane in the track frame (rad), positive on the flange; `angle + roll` is the one on the wheel.
    pub angle: S,
    /// Place on the wheel from its tape circle, + to the field side, m.
    pub y_wheel: S,
    /// Rolling radius of the unstrained wheel at the load-weighted middle of the patch, m.
    pub radius: S,
    /// Semi-axes of the equivalent ellipse along and across the rolling direction, m.
    pub a: S,
    pub b: S,
}

/// A place outside the table: the vehicle has derailed, or an input is wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{what} {value} is outside {least} to {most} of the contact table; the wheel has left the rail or the load is not one of a railway"
)]
pub struct OutsideTable {
    pub what: &'static str,
    pub value: f64,
    pub least: f64,
    pub most: f64,
}

/// Tables of one wheel-rail pair.
#[derive(Clone, Debug)]
pub struct ContactTable {
    plane: [Axis; 2],
    /// Of each zone at first touch: height w (m), then the squared tangent of the contact plane's angle in the track.
    touch: Vec<f64>,
    /// Nominal radius of the wheel, m.
    radius: f64,
    space: [[Axis; 3]; 3],
    /// Per zone: force / d^1.5, angle, y, radius, a / sqrt d, b / sqrt d over (shift, roll, sqrt(d / d_max)).
    load: [Vec<f64>; 3],
    /// Places on the wheel where the zones meet: root and flange, tread and root, m.
    pub borders: [f64; 2],
}

impl ContactTable {
    /// Builds the tables in parallel.
    ///
    /// # Errors
    /// What [`PairGeometry::placed_rail`] refuses, a wheel without a flange, and profiles that never meet.
    pub fn build(pair: &PairGeometry, material: &Material) -> Result<Self, ContactError> {
        let rail = pair.placed_rail()?;
        let zones = WheelZones::new(pair, &rail)?;
        let axes = [Axis::new(SHIFT, SHIFT_INTERVALS), Axis::new(ROLL, ROLL_INTERVALS)];
        let depth = Axis::new([0.0, 1.0], DEPTH_INTERVALS);
        let nodes = axes[0].len * axes[1].len;
        let columns: Vec<[Column; 3]> = (0..nodes)
            .into_par_iter()
            .map(|i| {
                let (shift, roll) = (axes[0].node(i / axes[1].len), axes[1].node(i % axes[1].len));
                let gaps = zones.strips.each_ref().map(|strips| PairGeometry::gaps(&rail, strips, shift, roll));
                let touch = [0, 1, 2].map(|z| first_touch(&zones.strips[z], &gaps[z], pair.radius));
                let lowest = touch.iter().flatten().fold(FAR, |low, t| low.min(t.gap));
                [0, 1, 2].map(|z| {
                    let column = Column::new(touch[z], roll, depth.len);
                    if column.gap > lowest + REACH {
                        return column;
                    }
                    column.loaded(&zones.strips[z], &gaps[z], (pair.radius, material), (DEPTH[z], depth))
                })
            })
            .collect();
        if columns.iter().all(|c| c[0].gap >= FAR) {
            return Err(ContactError::NoContact { shift: SHIFT[0], roll: ROLL[0] });
        }
        let mut touch: Vec<f64> = columns
            .iter()
            .flat_map(|c| [0, 1, 2].map(|z| c[z].gap).into_iter().chain([0, 1, 2].map(|z| c[z].tan2)))
            .collect();
        // A micrometre of the gap is a percent of the load.
        for zone in 0..3 {
            sharpen(&mut touch, 6, zone, &axes);
        }
        Ok(Self {
            plane: axes,
            touch,
            radius: pair.radius,
            space: [[axes[0], axes[1], depth]; 3],
            load: [0, 1, 2].map(|z| columns.iter().flat_map(|c| c[z].rows.iter().flatten().copied()).collect()),
            borders: zones.borders,
        })
    }

    /// The patches of tread, root and flange of the right wheel.
    ///
    /// `shift`: lateral shift of the bottom of the tape circle to the field side (m); `w`: its height below the level at
    /// which a point of z = 0 would touch the top of rail (m, positive pressed in); `roll` of the axle to the track (rad).
    /// For the point (Y, Z) of the axle line in the plane of the tape circle, in track axes with the tape circles at
    /// +-`tape_circle`: shift = Y - tape_circle - r0 sin(roll), w = Z + r0 cos(roll). For the left wheel give
    /// -Y, -roll and -yaw, and mirror what comes out.
    ///
    /// `yaw` of the axle (rad, positive nose outwards on the right wheel): the wheel x'^2/(2 r) below its lowest line and
    /// turned by psi touches where x' = r tan(delta) psi, and there it is r tan^2(delta) psi^2 / 2 nearer to the rail.
    ///
    /// # Errors
    /// A place outside the table; nothing is extrapolated.
    #[inline]
    pub fn patches<S: Scalar>(&self, shift: S, w: S, roll: S, yaw: S) -> Result<[Patch<S>; 3], OutsideTable> {
        within("shift", shift, SHIFT)?;
        within("roll", roll, ROLL)?;
        let touch = S::lift_n_lazy(
            [shift, roll],
            |x| plane::<6>(&self.touch, &self.plane, x),
            |x| plane_slopes(&self.touch, &self.plane, x),
        );
        let nearer = yaw.square() * (0.5 * self.radius);
        let mut patches = [Patch::default(); 3];
        for zone in 0..3 {
            let d = w - touch[zone] + nearer * touch[zone + 3];
            patches[zone].penetration = d;
            if d.le(S::zero()).all() {
                continue;
            }
            within("penetration", d, [f64::NEG_INFINITY, DEPTH[zone]])?;
            let d = d.positive();
            let root = d.sqrt();
            let [n, angle, y, r, a, b] = self.read(zone, [shift, roll, root / DEPTH[zone].sqrt()]);
            patches[zone] = Patch {
                active: true,
                normal_force: n * d * root,
                angle: angle - roll,
                y_wheel: y,
                radius: r,
                a: a * root,
                b: b * root,
                ..patches[zone]
            };
        }
        Ok(patches)
    }

    #[inline]
    fn read<S: Scalar>(&self, zone: usize, x: [S; 3]) -> [S; 6] {
        let (nodes, axes) = (&self.load[zone], &self.space[zone]);
        S::lift_n_lazy(x, |x| space(nodes, axes, x), |x| space_slopes(nodes, axes, x))
    }
}

#[inline]
fn within<S: Scalar>(what: &'static str, x: S, [least, most]: [f64; 2]) -> Result<(), OutsideTable> {
    if S::constant(least).le(x).and(x.le(S::constant(most))).all() {
        return Ok(());
    }
    Err(OutsideTable { what, value: x.value(), least, most })
}

/// One zone at one (shift, roll).
struct Column {
    /// Height w at first touch, m.
    gap: f64,
    /// Squared tangent of the angle of the contact plane in the track at first touch.
    tan2: f64,
    /// What the table holds, over the depth axis.
    rows: Vec<[f64; 6]>,
}

impl Column {
    /// A zone that touches there, if at all, without loads.
    fn new(touch: Option<RigidContact>, roll: f64, len: usize) -> Self {
        let (gap, tan2) = touch.map_or((FAR, 0.0), |t| (t.gap.min(FAR), (t.angle - roll).tan().powi(2)));
        Self { gap, tan2, rows: vec![[0.0; 6]; len] }
    }

    fn loaded(
        mut self,
        strips: &Strips,
        gaps: &[f64],
        (radius, material): (f64, &Material),
        (deepest, axis): (f64, Axis),
    ) -> Self {
        // Only strips that can come into contact at the largest depth.
        let near = |g: &f64| *g < self.gap + deepest * 1.3;
        let first = gaps.iter().position(near).unwrap_or(0);
        let end = gaps.iter().rposition(near).map_or(first, |e| e + 1);
        let strips = strips.part(first, end);
        let mut epsilon = 0.5;
        let mut penetration = Vec::with_capacity(end - first);
        for (i, row) in self.rows.iter_mut().enumerate().rev().take_while(|(i, _)| *i > 1) {
            let d = axis.node(i).powi(2) * deepest;
            penetration.clear();
            penetration.extend(gaps[first..end].iter().zip(&strips.cos).map(|(g, cos)| (self.gap + d - g) * cos));
            if let Some(l) = zone_load(&strips, &penetration, radius, material.pair_modulus(), &mut epsilon) {
                *row = [l.force / d.powf(1.5), l.angle, l.y, radius + l.z, l.a / d.sqrt(), l.b / d.sqrt()];
            }
        }
        // Patches of a few strips tell nothing: the curve goes on to zero depth and beyond as a line.
        for i in [1, 0] {
            let (next, after) = (self.rows[i + 1], self.rows[i + 2]);
            // Force and semi-axes stay positive.
            self.rows[i] = core::array::from_fn(|k| {
                let line = 2.0 * next[k] - after[k];
                if matches!(k, 0 | 4 | 5) { line.max(0.5 * next[k]) } else { line }
            });
        }
        self
    }
}
