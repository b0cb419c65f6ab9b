//! The compiled model: constant arrays, one `Vec` per element kind, every name resolved to an index.
//! Made by `compile`; read by `rates`; never changed by a run.

use crate::inputs::Places;
use crate::spec::RunSpec;
use klingel_physics::Scalar;
use klingel_physics::contact::creep::FallingFriction;
use klingel_physics::contact::{ContactTable, CreepForce};
use klingel_physics::drives::{
    Actuator, DcField, DcMotor, FieldOriented, FieldOrientedState, InductionMotor, InductionState, RunningResistance,
    Transmission,
};
use klingel_physics::elements::{Bushing, Maxwell, Stop};
use klingel_physics::track::{Adhesion, Alignment, TrackFrame, UniformTrack};
use std::ops::Range;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct Model {
    pub track: Course,
    pub cant_base: f64,
    /// \[m/s2\]
    pub gravity: f64,
    /// Initial and held speed \[m/s\].
    pub speed: f64,
    /// Arc length of the design frame's origin at the start \[m\].
    pub start: f64,
    pub bodies: Vec<Body>,
    pub rotors: Vec<Rotor>,
    pub joints: Vec<Joint>,
    /// Joints with their mirror partners, which are summed first: mirrored motions then agree to the last bit.
    pub joint_pairs: Vec<(usize, Option<usize>)>,
    pub bushings: Vec<(usize, Bushing)>,
    pub maxwells: Vec<MaxwellIn>,
    pub stops: Vec<StopIn>,
    pub actuators: Vec<ActuatorIn>,
    pub wheels: Vec<Wheel>,
    pub drives: Vec<Drive>,
    pub dc_motors: Vec<DcMotorIn>,
    pub induction_motors: Vec<InductionMotorIn>,
    pub drag: Option<(usize, RunningResistance)>,
    pub hold: Option<Hold>,
    /// Friction along the track, in place of that of the wheels.
    pub adhesion: Option<Adhesion>,
    pub creep: CreepForce,
    /// How friction falls with the slip velocity, if it does.
    pub falling_friction: Option<FallingFriction>,
    /// Speed v0 that keeps creepages finite at standstill \[m/s\].
    pub creep_floor: f64,
    /// Contact damping over elastic force and approach speed \[s/m\].
    pub contact_dissipation: f64,
    /// Decay rate of each state that the integrator takes exactly \[1/s\]; zero for most.
    pub poles: Vec<f64>,
    /// Dotted name of each state, for messages and linear models.
    pub state_names: Vec<String>,
    pub state_units: Vec<&'static str>,
    /// Inputs before any controller acts, in the order of `inputs::list`.
    pub inputs: Vec<f64>,
    pub places: Places,
    pub run: RunSpec,
}

/// Where the vehicle runs.
#[derive(Clone, Debug)]
pub enum Course {
    Laid(Alignment),
    Uniform(UniformTrack<f64>),
}

impl Course {
    /// The frame at `s`; on a uniform track seen from the place at `reference`, with the changes of curvature and cant.
    #[inline]
    pub fn at<S: Scalar>(&self, s: S, reference: S, [curvature, cant]: [S; 2]) -> TrackFrame<S> {
        match self {
            Self::Laid(alignment) => alignment.at(s),
            Self::Uniform(track) => UniformTrack {
                curvature: curvature + track.curvature,
                cant: cant + track.cant,
                cant_base: track.cant_base,
            }
            .at(s - reference),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    /// \[kg\]
    pub mass: f64,
    /// \[kg m2\]
    pub inertia: [f64; 3],
    /// Centre of mass in the design frame \[m\].
    pub position: [f64; 3],
    pub pitches: bool,
    /// Coordinates (x, y, z, roll, pitch, yaw) that a guide keeps as they are; that of x keeps its velocity.
    pub guided: [bool; 6],
    /// First of its states: s, y, z, roll, (pitch,) yaw, then the velocities vx, vy, vz in T and wx, (wy,) wz in B.
    pub state: usize,
}

/// A part that spins about the y axis of its body; its speed is positive when the vehicle rolls forward.
#[derive(Clone, Debug)]
pub struct Rotor {
    pub name: String,
    pub body: usize,
    /// \[kg m2\]
    pub inertia: f64,
    pub state: usize,
}

/// Two bodies and a point on each; the force acts at the point of `b`, resolved in the frame of `a`.
#[derive(Clone, Debug)]
pub struct Joint {
    pub a: usize,
    pub b: usize,
    /// In the body frames, from the centres of mass \[m\].
    pub point_a: [f64; 3],
    pub point_b: [f64; 3],
    /// Whether any element of it has a rotational law.
    pub turns: bool,
}

#[derive(Clone, Debug)]
pub struct MaxwellIn {
    pub name: String,
    pub joint: usize,
    pub axis: usize,
    pub law: Maxwell,
    pub state: usize,
}

#[derive(Clone, Debug)]
pub struct StopIn {
    pub name: String,
    pub joint: usize,
    pub axis: usize,
    pub law: Stop,
}

#[derive(Clone, Debug)]
pub struct ActuatorIn {
    pub name: String,
    pub joint: usize,
    pub law: Actuator,
    /// Force and its rate.
    pub state: usize,
    pub input: usize,
}

#[derive(Clone, Debug)]
pub struct Wheel {
    pub name: String,
    pub body: usize,
    pub rotor: usize,
    /// +1 right, -1 left.
    pub sign: f64,
    pub table: Arc<ContactTable>,
    pub friction: f64,
    /// Half distance of the tape circles \[m\].
    pub half_tape_distance: f64,
    /// Radius at the tape circle: the nominal one of its contact table and what this wheel is larger by \[m\].
    pub radius: f64,
    pub radius_offset: f64,
    /// Point on the axle line in the tape-circle plane, from the centre of mass, body frame \[m\].
    pub centre: [f64; 3],
    /// First of its transient creepages, along and across, where wheels stick.
    pub stick: Option<usize>,
}

/// A motor's rotor, gearbox and shaft on one wheel; the motor itself is in `dc_motors` or `induction_motors`.
#[derive(Clone, Debug)]
pub struct Drive {
    pub name: String,
    pub body: usize,
    pub rotor: usize,
    pub law: Transmission,
    /// +1 where the motor turns with the wheel, -1 against it.
    pub gear_sense: f64,
    /// Motor speed, shaft twist.
    pub state: usize,
}

#[derive(Clone, Debug)]
pub struct DcMotorIn {
    /// Which of `drives` it drives.
    pub drive: usize,
    pub law: DcMotor,
    /// \[V\]
    pub voltage_max: f64,
    pub field: FieldIn,
    /// Armature current.
    pub state: usize,
    pub input: usize,
}

/// The field current of a DC motor.
#[derive(Clone, Debug)]
pub enum FieldIn {
    /// Constant in a run \[A\].
    Held(f64),
    /// A state that follows the field voltage.
    Moved { law: DcField, voltage_max: f64, state: usize, input: usize },
}

#[derive(Clone, Debug)]
pub struct InductionMotorIn {
    /// Which of `drives` it drives.
    pub drive: usize,
    pub law: InductionMotor,
    pub control: FieldOriented,
    /// Currents d, q, rotor fluxes d, q, flux of the control's model, integrals d, q.
    pub state: usize,
    /// Air-gap torque as seen at the wheel.
    pub input: usize,
}

#[derive(Clone, Debug)]
pub struct Hold {
    pub body: usize,
    /// \[N s/m\]
    pub proportional: f64,
    /// \[N/m\]
    pub integral: f64,
    /// Of the held speed \[m/s2\].
    pub acceleration: f64,
    pub state: usize,
}

impl Body {
    /// Places of its velocities: vx, vy, vz in T and wx, (wy,) wz in B.
    pub fn velocities(&self) -> Range<usize> {
        if self.pitches { self.state + 6..self.state + 12 } else { self.state + 5..self.state + 10 }
    }
}

impl InductionMotorIn {
    /// Names and units of its states.
    pub const STATES: [(&str, &str); 7] = [
        ("current_d", "A"),
        ("current_q", "A"),
        ("rotor_flux_d", "V s"),
        ("rotor_flux_q", "V s"),
        ("flux_model", "V s"),
        ("integral_d", "V"),
        ("integral_q", "V"),
    ];

    /// The states of the motor and of its control.
    #[inline]
    pub fn read<S: Scalar>(&self, x: &[S]) -> (InductionState<S>, FieldOrientedState<S>) {
        let x = &x[self.state..];
        let motor = InductionState { current: [x[0], x[1]], flux: [x[2], x[3]] };
        (motor, FieldOrientedState { flux: x[4], integral: [x[5], x[6]] })
    }

    /// Writes states, or their rates, in the order of `STATES`.
    #[inline]
    pub fn write<S: Scalar>(&self, motor: &InductionState<S>, control: &FieldOrientedState<S>, x: &mut [S]) {
        let values = [motor.current, motor.flux, [control.flux, control.integral[0]]];
        x[self.state..self.state + 6].copy_from_slice(values.as_flattened());
        x[self.state + 6] = control.integral[1];
    }
}

impl DcMotorIn {
    /// What the chopper puts out \[V\]: the commanded voltage within +-VaMax.
    #[inline]
    pub fn armature_voltage<S: Scalar>(&self, inputs: &[S]) -> S {
        inputs[self.input].clamp(-self.voltage_max, self.voltage_max)
    }

    /// If \[A\]
    #[inline]
    pub fn field_current<S: Scalar>(&self, x: &[S]) -> S {
        match self.field {
            FieldIn::Held(current) => S::constant(current),
            FieldIn::Moved { state, .. } => x[state],
        }
    }

    /// What is put on the field winding \[V\], the commanded voltage within +-VfMax; None where the field is held.
    #[inline]
    pub fn field_voltage<S: Scalar>(&self, inputs: &[S]) -> Option<S> {
        match self.field {
            FieldIn::Held(_) => None,
            FieldIn::Moved { voltage_max, input, .. } => Some(inputs[input].clamp(-voltage_max, voltage_max)),
        }
    }
}

impl Body {
    /// The states of coordinate `c` (x, y, z, roll, pitch, yaw) and of its rate; none of the pitch of a frame without.
    pub fn coordinate(&self, c: usize) -> Option<[usize; 2]> {
        if self.pitches {
            return Some([self.state + c, self.state + 6 + c]);
        }
        let c = [0, 1, 2, 3, usize::MAX, 4][c];
        (c < 5).then(|| [self.state + c, self.state + 5 + c])
    }

    /// States of coordinates and of rates that a guide keeps.
    pub fn kept(&self) -> impl Iterator<Item = [usize; 2]> {
        (0..6).filter(|&c| self.guided[c]).filter_map(|c| self.coordinate(c))
    }
}

impl Model {
    pub fn state_count(&self) -> usize {
        self.state_names.len()
    }

    /// Speed of the reference body \[m/s\].
    pub fn reference_speed(&self, x: &[f64]) -> f64 {
        x[self.bodies[self.reference()].velocities().start]
    }

    /// Friction of a standing contact at the place of a wheel.
    #[inline]
    pub fn friction<S: Scalar>(&self, wheel: &Wheel, x: &[S]) -> S {
        match &self.adhesion {
            Some(adhesion) => adhesion.at(x[self.bodies[wheel.body].state], wheel.sign),
            None => S::constant(wheel.friction),
        }
    }

    /// The body whose arc length and speed count for the vehicle's: that of the speed hold, else the first.
    pub fn reference(&self) -> usize {
        self.hold.as_ref().map_or(0, |h| h.body)
    }
}
