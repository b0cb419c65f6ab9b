//! Rail heads by their defining data: three tangent arcs and a flank, as the drawings of EN 13674-1 give them.
//! Lengths in millimetres; y from the rail's axis, z down from its top, the rail upright.

use super::Profile;
use super::curves::{circle, line, sample};

/// Slope of the flank of the head, dz/dy (1:20 to the upright).
const FLANK: f64 = 20.0;
/// Depth to which the flank is drawn.
const LAST: f64 = 39.0;

/// A head of three arcs, each tangent to the next, and a flank tangent to the last.
///
/// `widths` are those of the head, from side to side, where the first arc meets the second and the second the third:
/// the dimensions of the drawing. The width of the whole head follows and is a check on them.
struct Head {
    radii: [f64; 3],
    widths: [f64; 2],
}

/// An arc of a head: its centre, and the point where the next curve begins.
struct Arc {
    centre: [f64; 2],
    end: [f64; 2],
}

impl Head {
    /// Arcs of the half with y > 0, from the crown to the flank.
    fn arcs(&self) -> [Arc; 3] {
        let [r1, r2, r3] = self.radii;
        let on_arc = |y: f64, c: [f64; 2], r: f64| [y, circle(y, c[0], c[1], r, -1.0).0];
        // The centre of the next arc lies on the line from the common point to the centre of this one.
        let next = |end: [f64; 2], c: [f64; 2], ratio: f64| [0, 1].map(|i| end[i] + (c[i] - end[i]) * ratio);
        let c1 = [0.0, r1];
        let e1 = on_arc(0.5 * self.widths[0], c1, r1);
        let c2 = next(e1, c1, r2 / r1);
        let e2 = on_arc(0.5 * self.widths[1], c2, r2);
        let c3 = next(e2, c2, r3 / r2);
        let h = (1.0 + FLANK * FLANK).sqrt();
        let e3 = [c3[0] + r3 * FLANK / h, c3[1] - r3 / h];
        [(c1, e1), (c2, e2), (c3, e3)].map(|(centre, end)| Arc { centre, end })
    }

    fn sampled(&self) -> Profile {
        let arcs = self.arcs();
        let [y3, z3] = arcs[2].end;
        let half = |y: f64| match arcs.iter().position(|a| y <= a.end[0]) {
            Some(k) => circle(y, arcs[k].centre[0], arcs[k].centre[1], self.radii[k], -1.0),
            None => line(y - y3, z3, FLANK),
        };
        let end = y3 + (LAST - z3) / FLANK;
        sample([-end, end], |y| {
            let (z, slope) = half(y.abs());
            (z, slope * y.signum())
        })
    }
}

const HEAD_60E1: Head = Head { radii: [300.0, 80.0, 13.0], widths: [20.456, 52.053] };
const HEAD_54E1: Head = Head { radii: [300.0, 80.0, 13.0], widths: [20.024, 49.727] };
const HEAD_UIC60: Head = Head { radii: [300.0, 80.0, 13.0], widths: [21.0, 51.97604] };

impl Profile {
    /// Rail head 60E1 (EN 13674-1: arcs of 300, 80 and 13 mm, widths 20.456 and 52.053 mm), upright.
    ///
    /// Status: memory of the standard; self-consistent, as these arcs give the head's width of 72.000 mm at 14.300 mm.
    pub fn rail_60e1() -> Self {
        HEAD_60E1.sampled()
    }

    /// Rail head 54E1 (EN 13674-1: arcs of 300, 80 and 13 mm, widths 20.024 and 49.727 mm), upright.
    ///
    /// Status: memory of the standard; self-consistent, as these arcs give the head's width of 70.000 mm at 14.100 mm.
    pub fn rail_54e1() -> Self {
        HEAD_54E1.sampled()
    }

    /// The UIC60 head of common benchmark files, which differs from 60E1 by up to 0.041 mm; upright.
    ///
    /// Status: repo; arcs fitted to a public point file (residual below 2e-6 mm).
    pub fn rail_uic60() -> Self {
        HEAD_UIC60.sampled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_and_radii_give_the_width_of_the_head() {
        for (head, width, depth) in [(HEAD_60E1, 72.0, 14.3), (HEAD_54E1, 70.0, 14.1)] {
            let [y, z] = head.arcs()[2].end;
            assert!((2.0 * y - width).abs() < 5e-4 && (z - depth).abs() < 5e-4, "{y} {z}");
        }
    }

    #[test]
    fn arcs_meet_without_a_kink() {
        for rail in [Profile::rail_60e1(), Profile::rail_54e1(), Profile::rail_uic60()] {
            for i in 1..rail.y.len() {
                // The slope turns by at most the sharpest curvature, 1/13 mm.
                let turn = rail.slope[i].atan() - rail.slope[i - 1].atan();
                let step = (rail.y[i] - rail.y[i - 1]).hypot(rail.z[i] - rail.z[i - 1]);
                assert!((-1e-9..1.01 * step / 0.013).contains(&turn), "{} {turn}", rail.y[i]);
            }
        }
    }
}
