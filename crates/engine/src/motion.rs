#![allow(non_snake_case)] // monogram notation: R_TB, p_W, w_F
//! Kinematics of one body in its own track frame: position states to frames, velocity states to rates of position.
//! T: track frame at the body's arc length; F: yawed and rolled, not pitched; B: body; W: world.

use crate::model::Body;
use klingel_physics::Scalar;
use klingel_physics::math::{Rotation, Vec3};
use klingel_physics::track::TrackFrame;

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion<S> {
    pub track: TrackFrame<S>,
    /// s' \[m/s\]
    pub arc_rate: S,
    /// (0, y, z) in T \[m\].
    pub p_T: Vec3<S>,
    pub yaw: S,
    pub sin_roll: S,
    pub cos_roll: S,
    pub R_WT: Rotation<S>,
    pub R_TF: Rotation<S>,
    pub R_TB: Rotation<S>,
    pub R_WB: Rotation<S>,
    pub p_W: Vec3<S>,
    /// Absolute velocity of the centre of mass, resolved in T and in W \[m/s\].
    pub v_T: Vec3<S>,
    pub v_W: Vec3<S>,
    /// Absolute angular velocity of the body frame \[rad/s\].
    pub w_B: Vec3<S>,
    pub w_F: Vec3<S>,
    pub w_W: Vec3<S>,
    /// Angular velocity of the track frame that travels with the body, in T \[rad/s\].
    pub w_track_T: Vec3<S>,
}

/// The body's states by name, whichever layout it has.
#[derive(Clone, Copy, Debug)]
pub struct BodyStates<S> {
    pub s: S,
    pub y: S,
    pub z: S,
    pub roll: S,
    pub pitch: S,
    pub yaw: S,
    pub v: Vec3<S>,
    pub w: Vec3<S>,
}

/// Reads the states of a body; a frame that does not pitch has zero there, its w.y follows later.
#[inline(always)]
pub fn read<S: Scalar>(body: &Body, x: &[S]) -> BodyStates<S> {
    let q = &x[body.state..];
    if body.pitches {
        let v = Vec3::new(q[6], q[7], q[8]);
        BodyStates {
            s: q[0],
            y: q[1],
            z: q[2],
            roll: q[3],
            pitch: q[4],
            yaw: q[5],
            v,
            w: Vec3::new(q[9], q[10], q[11]),
        }
    } else {
        let v = Vec3::new(q[5], q[6], q[7]);
        let w = Vec3::new(q[8], S::zero(), q[9]);
        BodyStates { s: q[0], y: q[1], z: q[2], roll: q[3], pitch: S::zero(), yaw: q[4], v, w }
    }
}

/// Frames and velocities, and the rates of the position states written into `dx`.
///
/// With the turn of the track frame per metre O = (phi', rho sin phi, rho cos phi) and the absolute velocity v in T,
/// v = s' (e_x + O x p) + (0, y', z') gives s' = vx / (1 + Oy z - Oz y), y' = vy + s' Ox z, z' = vz - s' Ox y:
/// only first derivatives of the track enter, so the kink of a cant ramp does not touch v.
/// The relative angular velocity in F is (roll', pitch' + yaw' sin roll, yaw' cos roll).
pub fn motion<S: Scalar>(track: impl Fn(S) -> TrackFrame<S>, body: &Body, x: &[S], dx: &mut [S]) -> Motion<S> {
    let q = read(body, x);
    let frame = track(q.s);
    let turn = frame.turn();
    let arc_rate = q.v.x() / (turn.y() * q.z - turn.z() * q.y + 1.0);
    let w_track_T = turn * arc_rate;

    let R_WT = frame.rotation();
    let R_TF = Rotation::yaw_roll(q.yaw, q.roll);
    let (sin_roll, cos_roll) = (R_TF.0[2][1], R_TF.0[2][2]);
    let w_track_F = R_TF.back(w_track_T);

    let (R_TB, w_B, w_F, rotation_rates);
    if body.pitches {
        let (sin, cos) = q.pitch.sin_cos();
        R_TB = R_TF.pitched((sin, cos));
        w_B = q.w;
        w_F = Vec3::new(cos * w_B.x() + sin * w_B.z(), w_B.y(), cos * w_B.z() - sin * w_B.x());
        let relative = w_F - w_track_F;
        let yaw_rate = relative.z() / cos_roll;
        rotation_rates = [relative.x(), relative.y() - sin_roll * yaw_rate, yaw_rate];
    } else {
        R_TB = R_TF;
        let yaw_rate = (q.w.z() - w_track_F.z()) / cos_roll;
        w_B = Vec3::new(q.w.x(), w_track_F.y() + sin_roll * yaw_rate, q.w.z());
        w_F = w_B;
        rotation_rates = [w_B.x() - w_track_F.x(), S::zero(), yaw_rate];
    }

    let d = &mut dx[body.state..];
    d[0] = arc_rate;
    d[1] = q.v.y() + w_track_T.x() * q.z;
    d[2] = q.v.z() - w_track_T.x() * q.y;
    d[3] = rotation_rates[0];
    if body.pitches {
        d[4] = rotation_rates[1];
        d[5] = rotation_rates[2];
    } else {
        d[4] = rotation_rates[2];
    }

    let R_WB = R_WT.then(&R_TB);
    let p_T = Vec3::new(S::zero(), q.y, q.z);
    let p_W = Vec3::new(frame.x, frame.y, S::zero()) + R_WT.apply(p_T);
    Motion {
        track: frame,
        arc_rate,
        p_T,
        yaw: q.yaw,
        sin_roll,
        cos_roll,
        R_WT,
        R_TF,
        R_TB,
        R_WB,
        p_W,
        v_T: q.v,
        v_W: R_WT.apply(q.v),
        w_B,
        w_F,
        w_W: R_WB.apply(w_B),
        w_track_T,
    }
}
