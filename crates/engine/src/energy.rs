//! The energy account of a run: what goes in, what is lost and what is stored, booked by the power of every law.
//! Powers are integrated as further states by the scheme that moves the vehicle, so that only its step limits the balance.
#![allow(non_snake_case)] // monogram notation

use crate::channels::Channel;
use crate::model::{Body, Course, FieldIn, Model};
use crate::newton_euler::gravity;
use crate::rates::Workspace;
use klingel_physics::math::Vec3;

/// What a power is booked on; see `docs/theory/energy.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Account {
    // into the vehicle
    Traction,
    Actuators,
    Hold,
    Wind,
    Rails,
    Gradient,
    Guides,
    // out of it
    Regeneration,
    CopperArmature,
    CopperField,
    CopperStator,
    CopperRotor,
    MotorFriction,
    Transmission,
    RunningResistance,
    ContactFriction,
    ContactDamping,
    Suspension,
    // stored, but told by its power alone
    ContactElastic,
}

use Account::{
    Actuators, ContactDamping, ContactElastic, ContactFriction, CopperArmature, CopperField, CopperRotor, CopperStator,
    Gradient, Guides, Hold, MotorFriction, Rails, Regeneration, RunningResistance, Suspension, Traction, Transmission,
    Wind,
};

/// Name and sign in the balance: in - out - growth of what is stored = residual.
const ACCOUNTS: [(Account, &str, f64); 19] = [
    (Traction, "traction", 1.0),
    (Actuators, "actuators", 1.0),
    (Hold, "hold", 1.0),
    (Wind, "wind", 1.0),
    (Rails, "rails", 1.0),
    (Gradient, "gradient", 1.0),
    (Guides, "guides", 1.0),
    (Regeneration, "regeneration", -1.0),
    (CopperArmature, "copper_armature", -1.0),
    (CopperField, "copper_field", -1.0),
    (CopperStator, "copper_stator", -1.0),
    (CopperRotor, "copper_rotor", -1.0),
    (MotorFriction, "motor_friction", -1.0),
    (Transmission, "transmission", -1.0),
    (RunningResistance, "running_resistance", -1.0),
    (ContactFriction, "contact_friction", -1.0),
    (ContactDamping, "contact_damping", -1.0),
    (Suspension, "suspension", -1.0),
    (ContactElastic, "contact_elastic", -1.0),
];

/// Functions of the state, told as growth since the start.
const STORED: [&str; 4] = ["kinetic", "potential", "elastic", "magnetic"];

/// The accounts of one run.
#[derive(Clone, Debug)]
pub struct Energy {
    /// Accounts that this model has any power for, as channels show them.
    shown: Vec<usize>,
    graded: bool,
    blown: bool,
    /// Bushings with a damper.
    damped: Vec<usize>,
    /// Bodies of which a guide keeps some motion.
    guided: Vec<usize>,
    /// Stored at the start \[J\].
    start: [f64; STORED.len()],
}

impl Energy {
    /// One state each, behind those of the model.
    pub const STATES: usize = ACCOUNTS.len();

    pub fn new(m: &Model) -> Self {
        let excited = |part: &str| m.run.excitations.iter().any(|e| e.input.contains(part));
        let graded = matches!(&m.track, Course::Laid(alignment) if alignment.climbs());
        let guided: Vec<usize> =
            (0..m.bodies.len()).filter(|&i| !m.bodies[i].pitches || m.bodies[i].guided != [false; 6]).collect();
        let damped = (0..m.bushings.len()).filter(|&i| m.bushings[i].1.damps()).collect();
        let (wheels, blown) = (!m.wheels.is_empty(), excited("wind."));
        let has = |account: Account| match account {
            Traction | Regeneration | MotorFriction | Transmission => !m.drives.is_empty(),
            CopperArmature => !m.dc_motors.is_empty(),
            CopperField => m.dc_motors.iter().any(|d| matches!(d.field, FieldIn::Moved { .. })),
            CopperStator | CopperRotor => !m.induction_motors.is_empty(),
            Actuators => !m.actuators.is_empty(),
            Hold => m.hold.is_some(),
            Wind => blown,
            Gradient => graded,
            Guides => !guided.is_empty(),
            RunningResistance => m.drag.is_some(),
            ContactFriction | ContactDamping | ContactElastic | Rails => wheels,
            Suspension => !m.joints.is_empty(),
        };
        let shown = (0..ACCOUNTS.len()).filter(|&i| has(ACCOUNTS[i].0)).collect();
        Self { shown, graded, blown, damped, guided, start: [0.0; STORED.len()] }
    }

    /// Channels, in the order that `fill` writes: the accounts, what is stored, and what does not close.
    pub fn list(&self) -> Vec<Channel> {
        let accounts = self.shown.iter().map(|&i| ACCOUNTS[i].1);
        let names = accounts.chain(STORED).chain(["residual"]);
        names.map(|name| (format!("energy.{name}"), "J")).collect()
    }

    /// Takes what is stored now as the start.
    pub fn begin(&mut self, m: &Model, x: &[f64], w: &Workspace<f64>) {
        self.start = stored(m, x, w);
    }

    /// Writes the channels; `w` must come from `rates` at `x`, `booked` are the states of the accounts.
    pub fn fill(&self, m: &Model, x: &[f64], w: &Workspace<f64>, booked: &[f64], row: &mut [f64]) {
        let mut residual: f64 = ACCOUNTS.iter().zip(booked).map(|((.., sign), energy)| sign * energy).sum();
        for (value, &i) in row.iter_mut().zip(&self.shown) {
            *value = booked[i];
        }
        let now = stored(m, x, w);
        let grown = &mut row[self.shown.len()..];
        for i in 0..STORED.len() {
            grown[i] = now[i] - self.start[i];
            residual -= grown[i];
        }
        grown[STORED.len()] = residual;
    }

    /// Power on every account \[W\]; `w` and `dx` must come from `rates` at `x` and `inputs`.
    pub fn powers(&self, m: &Model, x: &[f64], inputs: &[f64], w: &Workspace<f64>, dx: &[f64], power: &mut [f64]) {
        power.fill(0.0);
        let mut book = |account: Account, watts: f64| power[account as usize] += watts;
        drives(m, x, inputs, w, &mut book);
        self.elements(m, x, w, &mut book);
        for wheel in &w.wheels {
            book(ContactFriction, wheel.friction_power);
            book(ContactDamping, wheel.damping_power);
            book(ContactElastic, wheel.elastic_power);
            book(Rails, wheel.rail_power);
        }
        if let Some((body, law)) = &m.drag {
            let speed = w.motions[*body].v_T.x();
            book(RunningResistance, law.force(speed) * speed);
        }
        if let Some(hold) = &m.hold {
            book(Hold, w.hold_force * w.motions[hold.body].v_T.x());
        }
        if self.blown {
            let [y, z, roll] = core::array::from_fn(|i| inputs[m.places.wind + i]);
            let motion = &w.motions[m.reference()];
            let turning = motion.R_TB.apply(motion.w_B).x();
            book(Wind, y * motion.v_T.y() + z * motion.v_T.z() + roll * turning);
        }
        if self.graded {
            book(Gradient, gradient(m, w));
        }
        for &i in &self.guided {
            book(Guides, guide(m, i, w, dx));
        }
    }

    /// Dampers, and what the actuators do on their way.
    fn elements(&self, m: &Model, x: &[f64], w: &Workspace<f64>, book: &mut impl FnMut(Account, f64)) {
        for (joint, law) in self.damped.iter().map(|&i| &m.bushings[i]) {
            let joint = &w.joints[*joint];
            book(Suspension, law.dissipated(joint.rate, joint.spin));
        }
        for e in &m.maxwells {
            book(Suspension, e.law.dissipated(x[e.state]));
        }
        for e in &m.actuators {
            book(Actuators, x[e.state] * w.joints[e.joint].rate.x());
        }
    }
}

/// Electrical power and copper of the motors, friction of their rotors, damping of the shafts.
fn drives(m: &Model, x: &[f64], inputs: &[f64], w: &Workspace<f64>, book: &mut impl FnMut(Account, f64)) {
    let electrical = |watts: f64| (if watts > 0.0 { Traction } else { Regeneration }, watts.abs());
    for motor in &m.dc_motors {
        let current = x[motor.state];
        let mut taken = motor.armature_voltage(inputs) * current;
        book(CopperArmature, motor.law.dissipated(current));
        if let (FieldIn::Moved { law, state, .. }, Some(voltage)) = (&motor.field, motor.field_voltage(inputs)) {
            taken += voltage * x[*state];
            book(CopperField, law.dissipated(x[*state]));
        }
        let (account, watts) = electrical(taken);
        book(account, watts);
    }
    for (motor, excited) in m.induction_motors.iter().zip(&w.inverters) {
        let (state, _) = motor.read(x);
        let [stator, rotor] = motor.law.dissipated(&state);
        book(CopperStator, stator);
        book(CopperRotor, rotor);
        let (account, watts) = electrical(motor.law.input_power(&state, excited.voltage));
        book(account, watts);
    }
    for drive in &m.drives {
        let wheel_speed = x[m.rotors[drive.rotor].state] + w.motions[drive.body].w_B.y();
        let [bearings, shaft] = drive.law.dissipated(x[drive.state], wheel_speed);
        book(MotorFriction, bearings);
        book(Transmission, shaft);
    }
}

/// What gravity on a grade does beyond the fall of the centres of mass in the level frame \[W\].
fn gradient(m: &Model, w: &Workspace<f64>) -> f64 {
    let of = |(body, motion): (&Body, &crate::motion::Motion<f64>)| {
        let weight = m.gravity * body.mass;
        gravity(weight, motion).dot(motion.v_T) - weight * motion.v_W.z()
    };
    m.bodies.iter().zip(&w.motions).map(of).sum()
}

/// What a guide does on the motions it keeps \[W\]: the growth of kinetic energy that no load explains. The frame of a
/// solid wheelset is such: it takes no moment about its axle and follows the track there.
fn guide(m: &Model, i: usize, w: &Workspace<f64>, dx: &[f64]) -> f64 {
    let (body, motion, loads) = (&m.bodies[i], &w.motions[i], &w.loads[i]);
    let d = &dx[body.state..];
    let (acceleration, turning) = if body.pitches {
        (Vec3::new(d[6], d[7], d[8]), Vec3::new(d[9], d[10], d[11]))
    } else {
        (Vec3::new(d[5], d[6], d[7]), Vec3::new(d[8], 0.0, d[9]))
    };
    let momentum = Vec3(core::array::from_fn(|k| body.inertia[k] * motion.w_B.0[k]));
    let growth = motion.v_T.dot(acceleration) * body.mass + momentum.dot(turning);
    let force = w.felt_T[i] + gravity(m.gravity * body.mass, motion);
    let moment = motion.R_WB.back(loads.moment_W) + motion.R_TB.back(loads.moment_T);
    let reaction = w.rotor_reaction[i] + w.motor_reaction[i];
    growth - force.dot(motion.v_T) - moment.dot(motion.w_B) - reaction * motion.w_B.y()
}

/// Kinetic, potential, elastic and magnetic energy \[J\].
fn stored(m: &Model, x: &[f64], w: &Workspace<f64>) -> [f64; STORED.len()] {
    let (mut kinetic, mut potential, mut elastic, mut magnetic) = (0.0, 0.0, 0.0, 0.0);
    for (body, motion) in m.bodies.iter().zip(&w.motions) {
        // the frame of a solid wheelset turns about its axle without inertia
        let own = |k: usize| if k == 1 && !body.pitches { 0.0 } else { body.inertia[k] * motion.w_B.0[k].powi(2) };
        kinetic += 0.5 * (body.mass * motion.v_T.dot(motion.v_T) + own(0) + own(1) + own(2));
        potential -= m.gravity * body.mass * motion.p_W.z();
    }
    for rotor in &m.rotors {
        kinetic += 0.5 * rotor.inertia * x[rotor.state].powi(2);
    }
    for drive in &m.drives {
        let absolute = x[drive.state] * drive.gear_sense - w.motions[drive.body].w_B.y();
        kinetic += 0.5 * drive.law.rotor_inertia * absolute * absolute;
        elastic += drive.law.stored(x[drive.state + 1]);
    }
    for motor in &m.dc_motors {
        magnetic += motor.law.stored(x[motor.state]);
        if let FieldIn::Moved { law, state, .. } = &motor.field {
            magnetic += law.stored(x[*state]);
        }
    }
    magnetic += m.induction_motors.iter().map(|motor| motor.law.stored(&motor.read(x).0)).sum::<f64>();
    for (joint, law) in &m.bushings {
        let joint = &w.joints[*joint];
        elastic += law.stored(joint.u, joint.angle);
    }
    elastic += m.maxwells.iter().map(|e| e.law.stored(x[e.state])).sum::<f64>();
    elastic += m.stops.iter().map(|e| e.law.stored(w.joints[e.joint].u.0[e.axis])).sum::<f64>();
    elastic += m.actuators.iter().map(|e| e.law.stored(w.joints[e.joint].u.x())).sum::<f64>();
    [kinetic, potential, elastic, magnetic]
}
