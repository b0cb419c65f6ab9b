#![allow(non_snake_case)] // monogram notation
//! Newton and Euler: loads to accelerations, with the exact inertia terms of the travelling track frame.

use crate::model::{Body, Model};
use crate::motion::Motion;
use crate::rates::Workspace;
use klingel_physics::Scalar;
use klingel_physics::math::Vec3;

/// m (v' + w_track x v) = F in T;  I w' + h' + w x (I w + h) = M in B, with the rotors' own momentum h along y.
/// A rotor turns forward about -y: J w_r' = its torque; the motor's rotor turns with `gear_sense` times that.
/// A guide takes the force or moment along what it keeps.
pub fn newton_euler<S: Scalar>(m: &Model, w: &mut Workspace<S>, x: &[S], dx: &mut [S]) {
    for (rotor, torque) in m.rotors.iter().zip(&w.rotor_torque) {
        dx[rotor.state] = *torque / rotor.inertia;
        w.rotor_momentum[rotor.body] += x[rotor.state] * rotor.inertia;
        w.rotor_reaction[rotor.body] += *torque;
    }
    for (drive, state) in m.drives.iter().zip(&w.drives) {
        let motor_speed = x[drive.state] * drive.gear_sense - w.motions[drive.body].w_B.y();
        w.motor_momentum[drive.body] += motor_speed * drive.law.rotor_inertia;
        w.motor_reaction[drive.body] += state.net_rotor_torque * drive.gear_sense;
    }
    for (i, body) in m.bodies.iter().enumerate() {
        let motion = &w.motions[i];
        let loads = &w.loads[i];
        let gravity_T = gravity(m.gravity * body.mass, motion);
        let contact_T = loads.force_T + motion.R_WT.back(loads.force_W);
        let force_T = contact_T + gravity_T;
        let acceleration = force_T * S::constant(1.0 / body.mass) - motion.w_track_T.cross(motion.v_T);
        let moment_B = motion.R_WB.back(loads.moment_W) + motion.R_TB.back(loads.moment_T);
        let turning = {
            let momentum = w.rotor_momentum[i] + w.motor_momentum[i];
            let reaction = w.rotor_reaction[i] + w.motor_reaction[i];
            angular_acceleration(body, motion, moment_B, momentum, reaction)
        };

        w.felt_T[i] = contact_T;
        let d = &mut dx[body.state..];
        if body.pitches {
            d[6..9].copy_from_slice(&acceleration.0);
            d[9..12].copy_from_slice(&turning.0);
        } else {
            d[5..8].copy_from_slice(&acceleration.0);
            (d[8], d[9]) = (turning.x(), turning.z());
        }
        for [coordinate, rate] in body.kept() {
            dx[rate] = S::zero();
            if coordinate != body.state {
                dx[coordinate] = S::zero();
            }
        }
    }
    for drive in &m.drives {
        let body = &m.bodies[drive.body];
        let pitch_acceleration = dx[body.state + 10];
        dx[drive.state] += pitch_acceleration * drive.gear_sense;
    }
}

/// Weight \[N\] in T: along the track on a grade, else at right angles to the plane of its centre line.
pub(crate) fn gravity<S: Scalar>(weight: f64, motion: &Motion<S>) -> Vec3<S> {
    let (along, across) = motion.track.gravity();
    motion.R_WT.back(Vec3::new(S::zero(), S::zero(), across * weight)) + Vec3::new(along * weight, S::zero(), S::zero())
}

/// Accelerations about the body axes; the y equation gives up what the rotors take (their reaction on the body).
fn angular_acceleration<S: Scalar>(
    body: &Body,
    motion: &Motion<S>,
    moment_B: Vec3<S>,
    rotor_momentum: S,
    rotor_reaction: S,
) -> Vec3<S> {
    let [ix, iy, iz] = body.inertia;
    let w = motion.w_B;
    let own = if body.pitches { w.y() * iy } else { S::zero() };
    let momentum = Vec3::new(w.x() * ix, own - rotor_momentum, w.z() * iz);
    let rest = moment_B - w.cross(momentum);
    let about_y = if body.pitches { (rest.y() + rotor_reaction) / iy } else { S::zero() };
    Vec3::new(rest.x() / ix, about_y, rest.z() / iz)
}
