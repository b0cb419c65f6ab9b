//! Smooth tables of the elastic contact of a pair over shift, roll and penetration, one for each zone of the wheel.
//! Built once in f64; read through any `Scalar`, so that dual numbers get the exact slopes of what is simulated.

use super::normal::PatchDetail;
use super::spline::{Axis, plane, plane_slopes, space, space_plain, space_slopes};
use super::zones::Zone;
use crate::{Mask, Scalar};

/// The tables' reach: shift of the right wheel to the field side (m), roll (rad).
pub(super) const SHIFT: [f64; 2] = [-0.016, 0.016];
pub(super) const ROLL: [f64; 2] = [-0.012, 0.012];
/// Largest penetration of each zone along z, m; steep zones go deeper along z for the same load.
pub(super) const DEPTH: [f64; 3] = [4e-4, 8e-4, 1.4e-3];

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
    pub(super) plane: [Axis; 2],
    /// Of each zone at first touch: height w (m), then the squared tangent of the contact plane's angle in the track.
    pub(super) touch: Vec<f64>,
    /// Nominal radius of the wheel, m.
    pub(super) radius: f64,
    pub(super) space: [Axis; 3],
    /// Per zone: force / d^1.5, angle, y, radius, a / sqrt d, b / sqrt d over (shift, roll, sqrt(d / d_max)).
    pub(super) load: [Vec<f64>; 3],
    /// Per zone over the same nodes: area / d, largest pressure / sqrt d; apart, so that loads stay close in memory.
    pub(super) detail: [Vec<f64>; 3],
    /// Places on the wheel where the zones meet: root and flange, tread and root, m.
    pub borders: [f64; 2],
    /// Place of the highest point of the inclined rail, from the tape circle of a centred wheelset to the field side, m.
    pub rail_top: f64,
}

impl ContactTable {
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

    /// Area and largest pressure of the patch of a zone at a `penetration` (m, along z) that [`Self::patches`] gave.
    ///
    /// # Errors
    /// A place outside the table; nothing is extrapolated.
    pub fn detail(&self, zone: Zone, shift: f64, roll: f64, penetration: f64) -> Result<PatchDetail, OutsideTable> {
        let deepest = DEPTH[zone as usize];
        within("shift", shift, SHIFT)?;
        within("roll", roll, ROLL)?;
        within("penetration", penetration, [0.0, deepest])?;
        let root = penetration.sqrt();
        let x = [shift, roll, root / deepest.sqrt()];
        let [area, pressure] = space_plain(&self.detail[zone as usize], &self.space, x);
        Ok(PatchDetail { area: area * penetration, pressure: pressure * root })
    }

    #[inline]
    fn read<S: Scalar>(&self, zone: usize, x: [S; 3]) -> [S; 6] {
        let (nodes, axes) = (&self.load[zone], &self.space);
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
