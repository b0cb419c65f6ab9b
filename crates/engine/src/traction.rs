#![allow(non_snake_case)] // monogram notation
//! Drives and the forces along the track: motors on their body, running resistance, the speed hold.

use crate::model::{FieldIn, Model};
use crate::rates::Workspace;
use klingel_physics::Scalar;
use klingel_physics::drives::TransmissionState;
use klingel_physics::math::Vec3;

/// What a drive does: torques at the motor and at the wheel.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveState<S> {
    /// TM, of the motor on its rotor \[N m\].
    pub air_gap_torque: S,
    /// TOUT on the wheel \[N m\].
    pub shaft_torque: S,
    /// X = TM - CM wM - N TOUT = JM d(absolute motor speed)/dt \[N m\].
    pub net_rotor_torque: S,
}

/// DC motors: voltages to currents and air-gap torque, at the speed of the rotor against the stator.
pub fn dc_motors<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    for motor in &m.dc_motors {
        let (current, motor_speed) = (x[motor.state], x[m.drives[motor.drive].state]);
        let field_current = motor.field_current(x);
        let kt = motor.law.torque_constant(field_current);
        dx[motor.state] = motor.law.current_rate(current, kt, motor.armature_voltage(inputs), motor_speed);
        if let (FieldIn::Moved { law, state, .. }, Some(voltage)) = (&motor.field, motor.field_voltage(inputs)) {
            dx[*state] = law.current_rate(field_current, voltage);
        }
        w.drives[motor.drive].air_gap_torque = motor.law.torque(current, kt);
    }
}

/// Induction motors with their control and inverter: torque commands to currents, fluxes and air-gap torque.
pub fn induction_motors<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    for (motor, put_out) in m.induction_motors.iter().zip(&mut w.inverters) {
        let drive = &m.drives[motor.drive];
        let ((state, control), motor_speed) = (motor.read(x), x[drive.state]);
        let command = inputs[motor.input] * drive.law.gear_ratio;
        let (excited, control_rates) = motor.control.control(&control, state.current, command, motor_speed);
        let rates = motor.law.rates(&state, excited.voltage, excited.frame_speed, motor_speed);
        motor.write(&rates, &control_rates, dx);
        w.drives[motor.drive].air_gap_torque = motor.law.torque(&state);
        *put_out = excited;
    }
}

/// Rotors and shafts: shaft torque on the wheel's rotor; its reaction and that of the motor's rotor on the body (stator,
/// gear case). Motor and shaft speeds are relative to the body, which itself turns forward at -w_B.y.
pub fn transmissions<S: Scalar>(m: &Model, x: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    for (drive, at) in m.drives.iter().zip(&mut w.drives) {
        let i = drive.state;
        let wheel_speed = x[m.rotors[drive.rotor].state] + w.motions[drive.body].w_B.y();
        let state = TransmissionState { motor_speed: x[i], twist: x[i + 1] };
        let rates = drive.law.rates(&state, at.air_gap_torque, wheel_speed);
        // still without the pitch acceleration of the body, which `newton_euler` adds
        dx[i] = rates.motor_speed;
        dx[i + 1] = rates.twist;
        at.shaft_torque = drive.law.shaft_torque(&state, wheel_speed);
        at.net_rotor_torque = drive.law.rotor_torque(&state, at.air_gap_torque, at.shaft_torque);
        w.rotor_torque[drive.rotor] += at.shaft_torque;
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
