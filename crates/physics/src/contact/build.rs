//! Makes the tables of a pair: every zone at every shift, roll and depth, in parallel.
//! What the rows hold, and how they are read, is said in `table`.

use super::geometry::{RigidContact, Strips, first_touch, highest};
use super::normal::{Guess, Solver};
use super::spline::{Axis, sharpen};
use super::table::{DEPTH, ROLL, SHIFT};
use super::zones::WheelZones;
use super::{ContactError, ContactTable, Material, NormalContact, PairGeometry};
use rayon::prelude::*;

const SHIFT_INTERVALS: usize = 320;
const ROLL_INTERVALS: usize = 24;
const DEPTH_INTERVALS: usize = 14;
/// A zone that finds no rail below it counts as this far away, m.
const FAR: f64 = 0.03;
/// A zone that is this much farther away than the depth at which another one leaves its table has no loads: it is never
/// reached; 0.1 mm of shift move it by less than 0.3 mm.
const REACH: f64 = 8e-4;

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
                    let column = Column::new(touch[z], roll, depth.len);
                    if column.gap > deepest + REACH {
                        return column;
                    }
                    let solver = Solver { normal, radius: pair.radius, pair_modulus: material.pair_modulus() };
                    column.loaded(&zones.strips[z], &gaps[z], &solver, (DEPTH[z], depth))
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
            space: [axes[0], axes[1], depth],
            load: [0, 1, 2]
                .map(|z| columns.iter().flat_map(|c| c[z].rows.iter().flat_map(|r| r[..6].iter().copied())).collect()),
            detail: [0, 1, 2]
                .map(|z| columns.iter().flat_map(|c| c[z].rows.iter().flat_map(|r| r[6..].iter().copied())).collect()),
            rail_top: highest(&rail),
            borders: zones.borders,
        })
    }
}

/// One zone at one (shift, roll).
struct Column {
    /// Height w at first touch, m.
    gap: f64,
    /// Squared tangent of the angle of the contact plane in the track at first touch.
    tan2: f64,
    /// What the table holds, over the depth axis.
    rows: Vec<[f64; 8]>,
}

impl Column {
    /// A zone that touches there, if at all, without loads.
    fn new(touch: Option<RigidContact>, roll: f64, len: usize) -> Self {
        let (gap, tan2) = touch.map_or((FAR, 0.0), |t| (t.gap.min(FAR), (t.angle - roll).tan().powi(2)));
        Self { gap, tan2, rows: vec![[0.0; 8]; len] }
    }

    fn loaded(mut self, strips: &Strips, gaps: &[f64], solver: &Solver, (deepest, axis): (f64, Axis)) -> Self {
        // Only strips that can come into contact at the largest depth.
        let near = |g: &f64| *g < self.gap + deepest * 1.3;
        let first = gaps.iter().position(near).unwrap_or(0);
        let end = gaps.iter().rposition(near).map_or(first, |e| e + 1);
        let strips = strips.part(first, end);
        let mut guess = Guess::default();
        let mut penetration = Vec::with_capacity(end - first);
        for (i, row) in self.rows.iter_mut().enumerate().rev().take_while(|(i, _)| *i > 1) {
            let d = axis.node(i).powi(2) * deepest;
            penetration.clear();
            penetration.extend(gaps[first..end].iter().zip(&strips.cos).map(|(g, cos)| (self.gap + d - g) * cos));
            if let Some(l) = solver.load(&strips, &penetration, &mut guess) {
                let (root, detail) = (d.sqrt(), l.detail);
                let [a, b, pressure] = [l.a, l.b, detail.pressure].map(|x| x / root);
                *row = [l.force / (d * root), l.angle, l.y, solver.radius + l.z, a, b, detail.area / d, pressure];
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
