//! What a run records: dotted channels with units, read from the states and from the workspace of `rates`.
//! Forces Q and Y act on the rail (down, right), X on the wheel (forward); all in the local track frame.
#![allow(non_snake_case)] // monogram notation

use crate::model::{Body, FieldIn, Model};
use crate::motion::{self, Motion};
use crate::rates::{Loads, Workspace};
use crate::wheel_rail::WheelState;
use klingel_physics::Scalar;
use klingel_physics::math::Vec3;

/// Name and unit of one channel.
pub type Channel = (String, &'static str);

const BODY: [(&str, &str); 14] = [
    ("s", "m"),
    ("y", "m"),
    ("z", "m"),
    ("roll", "rad"),
    ("pitch", "rad"),
    ("yaw", "rad"),
    ("speed", "m/s"),
    ("lateral_acceleration", "m/s2"),
    ("vertical_acceleration", "m/s2"),
    ("roll_rate", "rad/s"),
    ("yaw_rate", "rad/s"),
    ("curvature", "1/m"),
    ("cant", "m"),
    ("yaw_moment", "N m"),
];

const WHEEL: [(&str, &str); 15] = [
    ("Q", "N"),
    ("Y", "N"),
    ("X", "N"),
    ("tgamma", "N"),
    ("spin_work", "N"),
    ("contact_angle", "rad"),
    ("steep_force", "N"),
    ("slender_force", "N"),
    ("tread_force", "N"),
    ("root_force", "N"),
    ("flange_force", "N"),
    ("spin_speed", "rad/s"),
    ("friction", "-"),
    ("creep_x", "-"),
    ("creep_y", "-"),
];

const ARMATURE: [(&str, &str); 2] = [("armature_current", "A"), ("armature_voltage", "V")];

const FIELD: [(&str, &str); 2] = [("field_current", "A"), ("field_voltage", "V")];

const INDUCTION: [(&str, &str); 6] = [
    ("torque_command", "N m"),
    ("air_gap_torque", "N m"),
    ("current_d", "A"),
    ("current_q", "A"),
    ("rotor_flux", "V s"),
    ("stator_voltage", "V"),
];

const SHAFT: [(&str, &str); 2] = [("motor_speed", "rad/s"), ("shaft_torque", "N m")];

const ACTUATOR: [(&str, &str); 3] = [("force", "N"), ("command", "N"), ("stroke", "m")];

/// Every channel of the model, in the order that `fill` writes.
pub fn list(m: &Model) -> Vec<Channel> {
    let of = |name: &str, parts: &[(&str, &'static str)]| -> Vec<Channel> {
        parts.iter().map(|(part, unit)| (format!("{name}.{part}"), *unit)).collect()
    };
    let mut channels = Vec::new();
    channels.extend(m.bodies.iter().flat_map(|b| of(&b.name, &BODY)));
    channels.extend(m.wheels.iter().flat_map(|w| of(&w.name, &WHEEL)));
    for motor in &m.dc_motors {
        let name = &m.drives[motor.drive].name;
        channels.extend(of(name, &ARMATURE));
        if matches!(motor.field, FieldIn::Moved { .. }) {
            channels.extend(of(name, &FIELD));
        }
        channels.extend(of(name, &SHAFT));
    }
    for motor in &m.induction_motors {
        let name = &m.drives[motor.drive].name;
        channels.extend(of(name, &INDUCTION));
        channels.extend(of(name, &SHAFT));
    }
    channels.extend(m.actuators.iter().flat_map(|a| of(&a.name, &ACTUATOR)));
    if m.hold.is_some() {
        channels.push(("hold.force".into(), "N"));
    }
    channels
}

/// Writes the channels at one time; `w` must come from `rates` at the same `x` and `inputs`.
pub fn fill<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &Workspace<S>, row: &mut [S]) {
    let mut at = 0;
    let mut put = |values: &[S]| {
        row[at..at + values.len()].copy_from_slice(values);
        at += values.len();
    };
    for (i, body) in m.bodies.iter().enumerate() {
        put(&body_row(m, body, &w.motions[i], &w.loads[i], w.felt_T[i], x));
    }
    for (wheel, state) in m.wheels.iter().zip(&w.wheels) {
        put(&wheel_row(state, x[m.rotors[wheel.rotor].state]));
    }
    for motor in &m.dc_motors {
        put(&[x[motor.state], motor.armature_voltage(inputs)]);
        if let Some(voltage) = motor.field_voltage(inputs) {
            put(&[motor.field_current(x), voltage]);
        }
        put(&[x[m.drives[motor.drive].state], w.drives[motor.drive].shaft_torque]);
    }
    for (motor, put_out) in m.induction_motors.iter().zip(&w.inverters) {
        let (drive, state) = (&m.drives[motor.drive], &w.drives[motor.drive]);
        let at_wheel = state.air_gap_torque / drive.law.gear_ratio;
        let (inside, _) = motor.read(x);
        put(&[inputs[motor.input], at_wheel]);
        put(&inside.current);
        put(&[amplitude(inside.flux), amplitude(put_out.voltage)]);
        put(&[x[drive.state], state.shaft_torque]);
    }
    for actuator in &m.actuators {
        put(&[x[actuator.state], inputs[actuator.input], w.joints[actuator.joint].u.x()]);
    }
    if m.hold.is_some() {
        put(&[w.hold_force]);
    }
}

/// Length of a pair; its slope is nil at zero.
fn amplitude<S: Scalar>([d, q]: [S; 2]) -> S {
    let square = d.square() + q.square();
    S::select(S::zero().lt(square), square, S::one()).sqrt() * S::select(S::zero().lt(square), S::one(), S::zero())
}

fn body_row<S: Scalar>(
    m: &Model,
    body: &Body,
    motion: &Motion<S>,
    loads: &Loads<S>,
    felt_T: Vec3<S>,
    x: &[S],
) -> [S; BODY.len()] {
    let q = motion::read(body, x);
    let felt_B = motion.R_TB.back(felt_T) * S::constant(1.0 / body.mass);
    let moment_B = motion.R_WB.back(loads.moment_W);
    [
        q.s,
        q.y,
        q.z - body.position[2],
        q.roll,
        q.pitch,
        q.yaw,
        q.v.x(),
        felt_B.y(),
        felt_B.z() + m.gravity,
        motion.w_B.x(),
        motion.w_B.z(),
        motion.track.curvature,
        motion.track.cant_angle.sin() * m.cant_base,
        moment_B.z(),
    ]
}

fn wheel_row<S: Scalar>(state: &WheelState<S>, spin_speed: S) -> [S; WHEEL.len()] {
    let [x, y, z] = state.force_T.0;
    let [tread, root, flange] = state.normal;
    let (angle, steep, slender) = (state.contact_angle, state.steep_force, state.slender_force);
    let (friction, creep_x, creep_y) = (state.friction, state.creep_x, state.creep_y);
    [
        -z,
        -y,
        x,
        state.t_gamma,
        state.spin_work,
        angle,
        steep,
        slender,
        tread,
        root,
        flange,
        spin_speed,
        friction,
        creep_x,
        creep_y,
    ]
}
