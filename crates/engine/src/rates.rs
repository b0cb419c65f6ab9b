#![allow(non_snake_case)] // monogram notation
//! The right-hand side of the model: states and held inputs to rates of the states. The page to read first.
//! It reads like the theory, allocates nothing, and is written once for `f64` and for dual numbers.

use crate::error::Fault;
use crate::model::Model;
use crate::motion::{Motion, motion};
use crate::newton_euler::newton_euler;
use crate::suspension::{self, JointState};
use crate::traction::{self, DriveState};
use crate::wheel_rail::{WheelState, wheels};
use klingel_physics::Scalar;
use klingel_physics::drives::Excited;
use klingel_physics::math::Vec3;

/// Forces and moments about the centre of mass: from joints resolved in W, from the track resolved in T.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loads<S> {
    pub force_W: Vec3<S>,
    pub moment_W: Vec3<S>,
    pub force_T: Vec3<S>,
    pub moment_T: Vec3<S>,
}

/// Everything `rates` computes on its way; channels are read from it.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub motions: Vec<Motion<S>>,
    pub loads: Vec<Loads<S>>,
    pub joints: Vec<JointState<S>>,
    pub wheels: Vec<WheelState<S>>,
    pub drives: Vec<DriveState<S>>,
    /// Voltage and frame of every induction motor.
    pub inverters: Vec<Excited<S>>,
    /// Torque on each rotor, forward positive \[N m\].
    pub rotor_torque: Vec<S>,
    /// Momentum of the rotors of each body \[kg m2/s\], and the torque they take \[N m\].
    pub rotor_momentum: Vec<S>,
    pub rotor_reaction: Vec<S>,
    /// The same of the motors, kept apart so that left and right are summed in pairs.
    pub motor_momentum: Vec<S>,
    pub motor_reaction: Vec<S>,
    /// Force on each body without gravity, in T \[N\]: what an accelerometer feels.
    pub felt_T: Vec<Vec3<S>>,
    pub hold_force: S,
    /// Creep forces get the slopes that linearly implicit steps want, `CreepForce::force_with_secants`.
    pub secants: bool,
}

impl<S: Scalar> Workspace<S> {
    pub fn new(m: &Model) -> Self {
        let bodies = m.bodies.len();
        Self {
            motions: vec![Motion::default(); bodies],
            loads: vec![Loads::default(); bodies],
            joints: vec![JointState::default(); m.joints.len()],
            wheels: vec![WheelState::default(); m.wheels.len()],
            drives: vec![DriveState::default(); m.drives.len()],
            inverters: vec![Excited::default(); m.induction_motors.len()],
            rotor_torque: vec![S::zero(); m.rotors.len()],
            rotor_momentum: vec![S::zero(); bodies],
            rotor_reaction: vec![S::zero(); bodies],
            motor_momentum: vec![S::zero(); bodies],
            motor_reaction: vec![S::zero(); bodies],
            felt_T: vec![Vec3::zero(); bodies],
            hold_force: S::zero(),
            secants: false,
        }
    }

    fn clear(&mut self) {
        self.loads.fill(Loads::default());
        self.rotor_torque.fill(S::zero());
        self.rotor_momentum.fill(S::zero());
        self.rotor_reaction.fill(S::zero());
        self.motor_momentum.fill(S::zero());
        self.motor_reaction.fill(S::zero());
    }
}

/// Rates `dx` of the states `x` under the held `inputs`, which `inputs::list` names.
pub fn rates<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) -> Result<(), Fault> {
    w.clear();
    let (reference, track) = (x[m.bodies[m.reference()].state], m.places.track);
    for (body, state) in m.bodies.iter().zip(&mut w.motions) {
        let frame = |s: S| m.track.at(s, reference, [inputs[track], inputs[track + 1]]);
        *state = motion(frame, body, x, dx);
    }
    wheels(m, x, inputs, w, dx)?;
    suspension::joints(m, w);
    suspension::elements(m, x, inputs, w, dx);
    suspension::apply(m, w);
    traction::dc_motors(m, x, inputs, w, dx);
    traction::induction_motors(m, x, inputs, w, dx);
    traction::transmissions(m, x, w, dx);
    traction::along_track(m, x, inputs, w, dx);
    traction::wind(m, inputs, w);
    newton_euler(m, w, x, dx);
    Ok(())
}
