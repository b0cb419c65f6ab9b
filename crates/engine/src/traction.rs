#![allow(non_snake_case)] // monogram notation
//! Drives and the forces along the track: motors on their body, running resistance, the speed hold.

use crate::model::Model;
use crate::rates::Workspace;
use klingel_physics::math::Vec3;
use klingel_physics::{Scalar, drives};

/// What a drive does: torque on the wheel and net torque on the motor's rotor.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveState<S> {
    /// TOUT on the wheel \[N m\].
    pub shaft_torque: S,
    /// X = TM - CM wM - N TOUT = JM d(absolute motor speed)/dt \[N m\].
    pub net_rotor_torque: S,
}

/// Motors: shaft torque on the wheel's rotor; its reaction and that of the motor's rotor on the body (stator, gear case).
/// Motor and shaft speeds are relative to the body, which itself turns forward at -w_B.y.
pub fn motors<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    for (drive, state) in m.drives.iter().zip(&mut w.drives) {
        let i = drive.state;
        let wheel_speed = x[m.rotors[drive.rotor].state] + w.motions[drive.body].w_B.y();
        let motor = drives::DriveState { armature_current: x[i], motor_speed: x[i + 1], twist: x[i + 2] };
        let rates = drive.law.rates(&motor, drive.armature_voltage(inputs), wheel_speed);
        dx[i] = rates.armature_current;
        // still without the pitch acceleration of the body, which `newton_euler` adds
        dx[i + 1] = rates.motor_speed;
        dx[i + 2] = rates.twist;
        let shaft_torque = drive.law.shaft_torque(&motor, wheel_speed);
        *state = DriveState { shaft_torque, net_rotor_torque: drive.law.rotor_torque(&motor, shaft_torque) };
        w.rotor_torque[drive.rotor] += shaft_torque;
    }
}

/// Running resistance against the motion and the ideal force that holds the speed, both at a centre of mass along T.x.
pub fn along_track<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    if let Some((body, law)) = &m.drag {
        w.loads[*body].force_T.0[0] -= law.force(w.motions[*body].v_T.x());
    }
    if let Some(hold) = &m.hold {
        let error = inputs[m.places.speed] - w.motions[hold.body].v_T.x();
        w.hold_force = error * hold.proportional + x[hold.state];
        w.loads[hold.body].force_T.0[0] += w.hold_force;
        dx[hold.state] = error * hold.integral;
    }
}

/// Force and rolling moment of the wind at the centre of mass of the reference body, along its track frame.
pub fn wind<S: Scalar>(m: &Model, inputs: &[S], w: &mut Workspace<S>) {
    let [y, z, roll] = core::array::from_fn(|i| inputs[m.places.wind + i]);
    let loads = &mut w.loads[m.reference()];
    loads.force_T += Vec3::new(S::zero(), y, z);
    loads.moment_T += Vec3::new(roll, S::zero(), S::zero());
}
