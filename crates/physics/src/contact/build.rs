//! Makes the tables of a pair: every zone at every shift, roll and depth, in parallel.
//! What the rows hold, and how they are read, is said in `table`.

use super::geometry::{Normal, RigidContact, Strips, first_touch, highest};
use super::normal::{Guess, Solver};
use super::spline::{Axis, sharpen};
use super::table::{DEPTH, ROLL, SHIFT};
use super::zones::WheelZones;
use super::{ContactError, ContactTable, Material, NormalContact, PairGeometry, Profile};
use rayon::prelude::*;

const SHIFT_INTERVALS: usize = 320;
const ROLL_INTERVALS: usize = 24;
const DEPTH_INTERVALS: usize = 12;
/// A zone that finds no rail below it counts as this far away, m.
const FAR: f64 = 0.03;
/// A zone that is this much farther away than the depth at which another one leaves its table has no loads: it is never
/// reached; 0.1 mm of shift move it by less than 0.3 mm.
const REACH: f64 = 8e-4;
/// Yaw for which the drift of the contact is computed (rad), and the largest one that is not a jump (m).
const YAW: f64 = 0.01;
const FARTHEST_DRIFT: f64 = 5e-4;

impl ContactTable {
    /// Builds the tables in parallel.
    ///
    /// # Errors
    /// What [`PairGeometry::placed_rail`] refuses, a wheel without a flange, and profiles that never meet.
    pub fn build(pair: &PairGeometry, material: &Material, normal: NormalContact) -> Result<Self, ContactError> {
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
                let deepest = touch.iter().zip(DEPTH).filter_map(|(t, d)| t.map(|t| t.gap + d)).fold(FAR, f64::min);
                [0, 1, 2].map(|z| {
                    let (strips, gaps) = (&zones.strips[z], &gaps[z]);
                    let mut column = Column::new(touch[z], roll, depth.len);
                    if column.gap > deepest + REACH {
                        return column;
                    }
                    column.drift =
                        touch[z].map_or([0.0; 3], |t| drift(&rail, strips, gaps, [shift, roll], pair.radius, &t));
                    let solver = Solver { normal, radius: pair.radius, pair_modulus: material.pair_modulus() };
                    let depths = Depths { most: DEPTH[z], reached: deepest + REACH - column.gap, axis: depth };
                    column.loaded(&rail, strips, gaps, [shift, roll], &solver, &depths)
                })
            })
            .collect();
        if columns.iter().all(|c| c[0].gap >= FAR) {
            return Err(ContactError::NoContact { shift: SHIFT[0], roll: ROLL[0] });
        }
        let gather = |values: &dyn Fn(&Column) -> Vec<f64>, zone: usize| -> Vec<f64> {
            columns.iter().flat_map(|c| values(&c[zone])).collect()
        };
        let mut touch: Vec<f64> = columns
            .iter()
            .flat_map(|c| [0, 1, 2].map(|z| c[z].gap).into_iter().chain([0, 1, 2].map(|z| c[z].tan2)))
            .collect();
        let mut drift = [0, 1, 2].map(|z| gather(&|c| c.drift.to_vec(), z));
        let space = [axes[0], axes[1], depth];
        let load = [0, 1, 2].map(|z| gather(&|c| c.rows.iter().flat_map(|r| r[..6].to_vec()).collect(), z));
        let detail = [0, 1, 2].map(|z| gather(&|c| c.rows.iter().flat_map(|r| r[6..].to_vec()).collect(), z));
        // A micrometre of the gap is a percent of the load. Loads are left smooth: sharpened, they bend so much at jumps that
        // Newton's method fails there.
        (0..6).for_each(|k| sharpen(&mut touch, 6, k, &axes));
        drift.par_iter_mut().for_each(|nodes| (0..3).for_each(|k| sharpen(nodes, 3, k, &axes)));
        let (radius, rail_top, borders) = (pair.radius, highest(&rail), zones.borders);
        Ok(Self { plane: axes, touch, drift, radius, space, load, detail, rail_top, borders })
    }
}

/// How far the first contact moves on the wheel by the square of the yaw: angle, place, radius.
///
/// A point of the wheel comes r tan^2(delta) psi^2 / 2 nearer to the rail, delta the angle of the rail beside it: the contact
/// moves to where the rail is steeper.
fn drift(
    rail: &Profile,
    strips: &Strips,
    gaps: &[f64],
    place: [f64; 2],
    radius: f64,
    level: &RigidContact,
) -> [f64; 3] {
    let near = |y: &f64| (y - level.y_wheel).abs() < 2.0 * FARTHEST_DRIFT;
    let first = strips.y.iter().position(near).unwrap_or(0);
    let end = strips.y.iter().rposition(near).map_or(first, |e| e + 1);
    let strips = strips.part(first, end);
    let normals = PairGeometry::normals(rail, &strips, place[0], place[1]);
    let nearer = |n: &Normal| 0.5 * radius * (YAW * n.slope).powi(2);
    let yawed: Vec<f64> = gaps[first..end].iter().zip(&normals).map(|(gap, n)| gap - nearer(n)).collect();
    // Downhill from the level contact; where it jumps to another place, it does so at a yaw that no slope tells.
    let mut i = (0..yawed.len()).min_by(|&i, &j| gaps[first + i].total_cmp(&gaps[first + j])).unwrap_or(0);
    while let Some(next) = [i.wrapping_sub(1), i + 1].into_iter().find(|&j| j < yawed.len() && yawed[j] < yawed[i]) {
        i = next;
    }
    let about = i.saturating_sub(1)..(i + 2).min(yawed.len());
    let touch = first_touch(&strips.part(about.start, about.end), &yawed[about], radius);
    let moved = touch.filter(|t| (t.y_wheel - level.y_wheel).abs() < FARTHEST_DRIFT);
    moved.map_or([0.0; 3], |t| {
        [t.angle - level.angle, t.y_wheel - level.y_wheel, t.radius - level.radius].map(|x| x / (YAW * YAW))
    })
}

/// One zone at one (shift, roll).
struct Column {
    /// Height w at first touch, m.
    gap: f64,
    /// Squared tangent of the angle of the contact plane in the track at first touch.
    tan2: f64,
    /// What the square of the yaw adds to angle (rad), place (m) and radius (m).
    drift: [f64; 3],
    /// What the table holds, over the depth axis.
    rows: Vec<[f64; 8]>,
}

/// Penetrations of a zone.
struct Depths {
    /// The largest of its table, and the largest that is reached before another zone leaves its own, m.
    most: f64,
    reached: f64,
    axis: Axis,
}

impl Column {
    /// A zone that touches there, if at all, without loads.
    fn new(touch: Option<RigidContact>, roll: f64, len: usize) -> Self {
        let (gap, tan2) = touch.map_or((FAR, 0.0), |t| (t.gap.min(FAR), (t.angle - roll).tan().powi(2)));
        Self { gap, tan2, drift: [0.0; 3], rows: vec![[0.0; 8]; len] }
    }

    fn loaded(
        mut self,
        rail: &Profile,
        strips: &Strips,
        gaps: &[f64],
        [shift, roll]: [f64; 2],
        solver: &Solver,
        depths: &Depths,
    ) -> Self {
        let at = |i: usize| depths.axis.node(i).powi(2) * depths.most;
        // Only strips that can come into contact at the largest depth.
        let near = |g: &f64| *g < self.gap + depths.most * 1.3;
        let first = gaps.iter().position(near).unwrap_or(0);
        let end = gaps.iter().rposition(near).map_or(first, |e| e + 1);
        let mut strips = strips.part(first, end);
        let normals = PairGeometry::normals(rail, &strips, shift, roll);
        let mut guess = Guess::default();
        let mut penetration = Vec::with_capacity(end - first);
        for (i, row) in self.rows.iter_mut().enumerate().rev().take_while(|(i, _)| *i > 1) {
            // If the next smaller depth is reached, this row still shapes the curve there.
            if i > 3 && at(i - 1) > depths.reached {
                continue;
            }
            let d = at(i);
            penetration.clear();
            let w = self.gap + d;
            penetration.extend(gaps[first..end].iter().zip(&normals).map(|(g, n)| n.penetration(w - g)));
            // What is farther apart than it can ever come has no strained surface.
            for (j, n) in normals.iter().enumerate().filter(|(j, _)| penetration[*j] > 0.0) {
                [strips.sin[j], strips.cos[j]] = n.strained(penetration[j]);
            }
            if let Some(l) = solver.load(&strips, &penetration, &mut guess) {
                let (root, detail) = (d.sqrt(), l.detail);
                let [a, b, pressure] = [l.a, l.b, detail.pressure].map(|x| x / root);
                *row = [l.force / (d * root), l.angle, l.y, solver.radius + l.z, a, b, detail.area / d, pressure];
            }
        }
        // Depths that are never reached only have to go on smoothly.
        for i in 3..self.rows.len() {
            if self.rows[i] == [0.0; 8] {
                self.rows[i] = self.rows[i - 1];
            }
        }
        // Patches of a few strips tell nothing: the curve goes on to zero depth and beyond as a line.
        for i in [1, 0] {
            let (next, after) = (self.rows[i + 1], self.rows[i + 2]);
            // Force and semi-axes stay positive.
            self.rows[i] = core::array::from_fn(|k| {
                let line = 2.0 * next[k] - after[k];
                if matches!(k, 0 | 4..) { line.max(0.5 * next[k]) } else { line }
            });
        }
        self
    }
}
