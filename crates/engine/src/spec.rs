//! The spec: one vehicle on one track with its controllers, in multibody words and plain SI.
//! The only thing that crosses from Python into the core; `compile` turns it into a `Model`.

use crate::control::ControlSpec;
use klingel_physics::contact::NormalContact;
use serde::{Deserialize, Serialize};

/// Everything a run needs. Points are in the design frame of the vehicle: x forward from its reference point,
/// y right, z down from the top of rail \[m\]; a body's frame there is parallel to the track frame.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    pub name: String,
    /// \[m/s2\]
    pub gravity: f64,
    /// Speed at the start, and of the speed hold \[m/s\].
    pub speed: f64,
    pub track: TrackSpec,
    pub bodies: Vec<BodySpec>,
    /// Friction of both rails along the track, in place of that of the wheels.
    #[serde(default)]
    pub adhesion: Option<AdhesionSpec>,
    #[serde(default)]
    pub contact_pairs: Vec<PairSpec>,
    #[serde(default)]
    pub wheels: Vec<WheelSpec>,
    #[serde(default)]
    pub creep: CreepSpec,
    #[serde(default)]
    pub bushings: Vec<BushingSpec>,
    #[serde(default)]
    pub maxwells: Vec<MaxwellSpec>,
    #[serde(default)]
    pub stops: Vec<StopSpec>,
    #[serde(default)]
    pub actuators: Vec<ActuatorSpec>,
    #[serde(default)]
    pub drives: Vec<DriveSpec>,
    #[serde(default)]
    pub induction_drives: Vec<InductionDriveSpec>,
    #[serde(default)]
    pub drag: Option<DragSpec>,
    #[serde(default)]
    pub hold: Option<HoldSpec>,
    #[serde(default)]
    pub control: Option<ControlSpec>,
    pub run: RunSpec,
}

/// Centre line at top of rail, piece by piece; linear ramps inside a piece (clothoids, cant ramps).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackSpec {
    #[serde(default)]
    pub segments: Vec<SegmentSpec>,
    /// Endless instead of the segments.
    #[serde(default)]
    pub uniform: Option<UniformSpec>,
    /// Arc length of the vehicle's reference point (x = 0) at the start \[m\].
    pub start: f64,
    /// Lateral distance over which cant is measured \[m\]: 1.5.
    pub cant_base: f64,
}

/// The same curvature and cant everywhere.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UniformSpec {
    /// \[1/m\], positive in a right-hand curve.
    pub curvature: f64,
    /// \[m\], positive where the left rail is higher.
    pub cant: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SegmentSpec {
    /// \[m\]
    pub length: f64,
    /// At the start and end \[1/m\], positive in a right-hand curve.
    pub curvature: [f64; 2],
    /// At the start and end \[m\], positive where the left rail is higher (right-hand curve).
    pub cant: [f64; 2],
    /// At the start and end \[-\], positive uphill: it tilts gravity, its vertical curvature is left out.
    #[serde(default)]
    pub grade: [f64; 2],
}

/// Friction of the rails over arc length: linear between the places, the first and last value held beyond.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdhesionSpec {
    /// Rising \[m\].
    pub s: Vec<f64>,
    /// One value a place.
    pub left: Vec<f64>,
    pub right: Vec<f64>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Dotted: `body`, `bogie1`, `bogie1.wheelset2`.
    pub name: String,
    /// \[kg\]
    pub mass: f64,
    /// Principal inertias about the centre of mass \[kg m2\], rotors included except for their own spin about y.
    pub inertia: [f64; 3],
    /// Centre of mass in the design frame \[m\].
    pub position: [f64; 3],
    /// False for the non-spinning frame of a solid wheelset: it has no pitch of its own.
    #[serde(default = "yes")]
    pub pitches: bool,
    /// Motions that a guide keeps as they are, of x, y, z, roll, pitch, yaw (roller rig): the place, and along x the
    /// speed. On straight level track only.
    #[serde(default)]
    pub guided: Vec<String>,
    /// Axisymmetric parts that spin about the body's y axis (wheels; the solid wheelset itself).
    #[serde(default)]
    pub rotors: Vec<RotorSpec>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotorSpec {
    /// Short: `left`, `right`, `spin`.
    pub name: String,
    /// About the spin axis \[kg m2\].
    pub inertia: f64,
}

/// A wheel profile on a rail profile.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairSpec {
    pub wheel: ProfileSpec,
    pub rail: ProfileSpec,
    /// Slope of the rail's axis, positive when it leans inwards \[-\].
    pub rail_inclination: f64,
    /// 14 mm below the top of rail \[m\].
    pub gauge: f64,
    /// Distance of the flange backs of the two wheels \[m\]; the tape circles lie 70 mm outside them.
    pub flange_back: f64,
    /// Nominal wheel radius \[m\].
    pub radius: f64,
    #[serde(default)]
    pub normal: NormalSpec,
}

/// How the normal contact is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NormalSpec {
    /// Hertz in every zone of the wheel.
    #[default]
    Hertz,
    /// Virtual penetration, not Hertzian.
    KikPiotrowski,
}

impl From<NormalSpec> for NormalContact {
    fn from(normal: NormalSpec) -> Self {
        match normal {
            NormalSpec::Hertz => Self::Hertz,
            NormalSpec::KikPiotrowski => Self::KikPiotrowski,
        }
    }
}

/// A named profile or its points \[m\].
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ProfileSpec {
    /// `s1002`, `60e1`, `uic60`.
    Named(String),
    /// A coned tread of this slope with the S1002 flange.
    Cone(f64),
    Points {
        y: Vec<f64>,
        z: Vec<f64>,
    },
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelSpec {
    /// Dotted: `bogie1.wheelset1.left`.
    pub name: String,
    pub body: String,
    /// The rotor of that body which this wheel turns with.
    pub rotor: String,
    pub side: Side,
    /// Index into `contact_pairs`.
    pub pair: usize,
    pub friction: f64,
    /// By how much this wheel is larger than the radius of its pair, with the same profile \[m\].
    #[serde(default)]
    pub radius_offset: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    Left,
    Right,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CreepSpec {
    /// `linear`, `shen_hedrick_elkins`, `polach`, `fastsim`, `table`.
    pub law: String,
    /// Elements along and across the ellipse, FASTSIM only.
    pub elements: [usize; 2],
    /// Contact damping over elastic force and approach speed (Hunt & Crossley) \[s/m\].
    pub contact_dissipation: f64,
    /// FASTSIM: its three flexibilities blend into one as sliding sets in.
    #[serde(default)]
    pub blended: bool,
    /// FASTSIM: k0, alpha and beta of the reduced initial slope.
    #[serde(default)]
    pub slope: Option<[f64; 3]>,
    /// Polach: kA and kS of the reduced stiffness.
    #[serde(default)]
    pub reduction: Option<[f64; 2]>,
    /// Every law: A and B \[s/m\] of the friction that falls with the slip velocity, mu ((1 - A) exp(-B w) + A).
    #[serde(default)]
    pub falling: Option<[f64; 2]>,
    /// Creepages need way to build up, so that wheels stick while they stand; two more states a wheel.
    #[serde(default)]
    pub stick: bool,
}

impl Default for CreepSpec {
    fn default() -> Self {
        Self {
            law: "table".into(),
            elements: [10, 10],
            contact_dissipation: 3.0,
            blended: false,
            slope: None,
            reduction: None,
            falling: None,
            stick: false,
        }
    }
}

/// Where two bodies are joined. The force is resolved in the frame of `a` and acts at the point of `b` on both,
/// which conserves momentum, angular momentum and energy exactly. Deflection: point of b minus point of a.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    pub a: String,
    pub b: String,
    /// Design frame \[m\].
    pub point: [f64; 3],
}

/// Spring and damper in three translations and three rotations.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BushingSpec {
    pub name: String,
    pub joint: JointSpec,
    /// \[N/m\]
    #[serde(default)]
    pub stiffness: [f64; 3],
    /// \[N s/m\]
    #[serde(default)]
    pub damping: [f64; 3],
    /// About x, y, z \[N m/rad\].
    #[serde(default)]
    pub rotational_stiffness: [f64; 3],
    /// \[N m s/rad\]
    #[serde(default)]
    pub rotational_damping: [f64; 3],
    /// Force on `b` in the design position \[N\].
    #[serde(default)]
    pub preload: [f64; 3],
}

/// Damper with a spring in series, along one axis of `a`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaxwellSpec {
    pub name: String,
    pub joint: JointSpec,
    pub axis: Axis,
    /// Of the spring \[N/m\].
    pub stiffness: f64,
    /// Of the damper below blow-off \[N s/m\].
    pub damping: f64,
    #[serde(default)]
    pub blow_off: Option<BlowOffSpec>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlowOffSpec {
    /// \[N\]
    pub force: f64,
    /// Beyond the blow-off force \[N s/m\].
    pub damping: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    pub fn index(self) -> usize {
        self as usize
    }
}

/// Bump stop along one axis of `a`: force over deflection, odd, continued with its last slope.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopSpec {
    pub name: String,
    pub joint: JointSpec,
    pub axis: Axis,
    /// From zero upwards \[m\].
    pub deflection: Vec<f64>,
    /// \[N\]
    pub force: Vec<f64>,
}

/// Force actuator along x of `a`; a positive force pushes `b` forward.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorSpec {
    /// Dotted: `bogie1.wheelset1.actuator_left`.
    pub name: String,
    pub joint: JointSpec,
    /// \[rad/s\]
    pub natural_frequency: f64,
    pub damping_ratio: f64,
    /// \[N\]
    pub force_max: f64,
    /// \[N/s\]
    pub rate_max: f64,
    /// Half stroke \[m\].
    pub stroke: f64,
    /// Of the end stops \[N/m\].
    pub stop_stiffness: f64,
}

/// Separately excited DC motor, gearbox and elastic transmission between a body (stator, gear case) and its rotor.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveSpec {
    /// The driven wheel: `bogie1.wheelset1.left`.
    pub name: String,
    pub body: String,
    pub rotor: String,
    /// Ra \[Ohm\]
    pub armature_resistance: f64,
    /// La \[H\]
    pub armature_inductance: f64,
    /// Ke \[V s/(rad A)\]
    pub emf_constant: f64,
    /// If \[A\]: constant in a run unless `field` lets it move.
    pub field_current: f64,
    #[serde(default)]
    pub field: Option<FieldSpec>,
    /// Armature voltage while no controller commands it \[V\].
    pub armature_voltage: f64,
    /// VaMax \[V\]; commands beyond it saturate, and the channel shows what is put out.
    pub armature_voltage_max: f64,
    /// N = wheel speed over motor speed \[-\].
    pub gear_ratio: f64,
    /// +1 where the motor turns with the wheel, -1 against it.
    pub gear_sense: f64,
    /// JM \[kg m2\]
    pub rotor_inertia: f64,
    /// CM \[N m s/rad\]
    pub rotor_damping: f64,
    /// KOUT \[N m/rad\]
    pub transmission_stiffness: f64,
    /// COUT \[N m s/rad\]
    pub transmission_damping: f64,
}

/// The field circuit of a DC motor: its current is a state, its voltage an input, Rf If while no controller commands it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldSpec {
    /// Rf \[Ohm\]
    pub resistance: f64,
    /// Lf \[H\]
    pub inductance: f64,
    /// VfMax \[V\]; commands beyond it saturate, and the channel shows what is put out.
    pub voltage_max: f64,
}

/// Induction motor with field-oriented control and inverter, gearbox and elastic transmission.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InductionDriveSpec {
    /// The driven wheel: `bogie1.wheelset1.left`.
    pub name: String,
    pub body: String,
    pub rotor: String,
    pub motor: InductionMotorSpec,
    pub control: FieldOrientedSpec,
    /// Air-gap torque as seen at the wheel while no controller commands it \[N m\].
    pub torque_command: f64,
    pub transmission: TransmissionSpec,
}

/// Equivalent circuit of one phase (star), rotor values seen from the stator.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InductionMotorSpec {
    /// Rs \[Ohm\]
    pub stator_resistance: f64,
    /// Rr \[Ohm\]
    pub rotor_resistance: f64,
    /// Lls \[H\]
    pub stator_leakage: f64,
    /// Llr \[H\]
    pub rotor_leakage: f64,
    /// Lm \[H\]
    pub magnetizing_inductance: f64,
    pub pole_pairs: f64,
}

/// Control and inverter of an induction drive; amplitudes are peak values of a phase.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldOrientedSpec {
    /// What the control takes the motor for; None: for what it is.
    #[serde(default)]
    pub model: Option<InductionMotorSpec>,
    /// \[1/s\]
    pub torque_bandwidth: f64,
    /// \[1/s\]
    pub flux_bandwidth: f64,
    /// \[V s\]
    pub flux_rated: f64,
    /// \[A\]
    pub current_max: f64,
    /// \[V\]
    pub voltage_max: f64,
    /// Share of the voltage that the flux may take at speed, 0 to 1.
    pub flux_share: f64,
}

/// Gearbox, rotor and elastic shaft, with the names that they have in a `DriveSpec`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransmissionSpec {
    /// N = wheel speed over motor speed \[-\].
    pub gear_ratio: f64,
    /// +1 where the motor turns with the wheel, -1 against it.
    pub gear_sense: f64,
    /// JM \[kg m2\]
    pub rotor_inertia: f64,
    /// CM \[N m s/rad\]
    pub rotor_damping: f64,
    /// KOUT \[N m/rad\]
    pub transmission_stiffness: f64,
    /// COUT \[N m s/rad\]
    pub transmission_damping: f64,
}

/// Running resistance A + B v + C v^2 of this vehicle, on the centre of mass of a body \[N, N s/m, N s2/m2\].
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DragSpec {
    pub body: String,
    pub coefficients: [f64; 3],
    /// Of the air along the track, positive against the vehicle: C v^2 becomes C (v + headwind)^2 \[m/s\].
    #[serde(default)]
    pub headwind: f64,
}

/// A slow ideal force along the track on the centre of mass of a body that holds `speed`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldSpec {
    pub body: String,
    /// \[N s/m\]
    pub proportional: f64,
    /// \[N/m\]
    pub integral: f64,
    /// Of the held speed from the start on \[m/s2\].
    #[serde(default)]
    pub acceleration: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSpec {
    /// \[s\]
    pub duration: f64,
    /// Integration step; the controllers' sample time is a multiple of it \[s\].
    pub step: f64,
    /// Below this speed steps are linearly implicit, as creep damping is too stiff for explicit ones; with stick they are
    /// at every speed \[m/s\].
    #[serde(default)]
    pub implicit_below: f64,
    /// Of the recorded channels, a multiple of the step \[s\].
    pub record_interval: f64,
    /// Start from the static equilibrium at `speed` (else from the design position).
    pub equilibrium: bool,
    /// Start from the steady state with the controllers settled as well: their integrals, and their commands put out.
    #[serde(default)]
    pub settled: bool,
    /// Extra velocity of a body at the start: lateral \[m/s\] and yaw rate \[rad/s\], for stability runs and tests.
    #[serde(default)]
    pub kicks: Vec<KickSpec>,
    /// Whether the energies are booked and become channels.
    #[serde(default)]
    pub energy: bool,
    /// What is added to inputs of the model in the course of the run.
    #[serde(default)]
    pub excitations: Vec<ExcitationSpec>,
}

/// Values that are added to an input, nothing after the last: each held for an interval, or one an interval apart and
/// joined by straight lines, as rails go on between them.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExcitationSpec {
    /// Dotted: `bogie1.wheelset1.left.rail_z`, `wind.y`.
    pub input: String,
    /// A multiple of the step \[s\].
    pub interval: f64,
    pub values: Vec<f64>,
    #[serde(default)]
    pub joined: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KickSpec {
    pub body: String,
    /// Added to (x, y, z) relative to the track \[m\].
    #[serde(default)]
    pub displacement: [f64; 3],
    /// Added to roll, pitch, yaw \[rad\].
    #[serde(default)]
    pub rotation: [f64; 3],
    /// Added to the velocity in the track frame \[m/s\].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Added to the angular velocity in the body frame \[rad/s\].
    #[serde(default)]
    pub angular_velocity: [f64; 3],
}

fn yes() -> bool {
    true
}
