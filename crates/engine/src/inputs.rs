//! The inputs of a model, in their order: what drives and actuators are commanded, the held speed, and disturbances.
//! Their nominal values belong to the model; a run adds commands and excitations, a linear model differentiates by them.

use crate::model::{DcMotorIn, FieldIn, Model};
use klingel_physics::Scalar;

/// Name and unit of one input.
pub type Input = (String, &'static str);

/// Of each wheel, how its rail lies off its place \[m\], how fast that changes as the wheel passes \[m/s\], and how far
/// it is rolled, with the sleepers, about its place \[rad\].
pub const RAIL: [(&str, &str); 5] =
    [("rail_y", "m"), ("rail_z", "m"), ("rail_y_rate", "m/s"), ("rail_z_rate", "m/s"), ("rail_roll", "rad")];

const TRACK: [(&str, &str); 2] = [("track.curvature", "1/m"), ("track.cant", "m")];
const WIND: [(&str, &str); 3] = [("wind.y", "N"), ("wind.z", "N"), ("wind.roll", "N m")];

/// Where each kind begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Places {
    pub rails: usize,
    /// Added to the curvature \[1/m\] and cant \[m\] of a uniform track.
    pub track: usize,
    /// Force \[N\] and rolling moment \[N m\] at the centre of mass of the reference body, in its track frame.
    pub wind: usize,
    /// \[m/s\], with a speed hold only.
    pub speed: usize,
    pub count: usize,
}

impl Places {
    /// Voltages and torques of the motors and forces of the actuators come first.
    pub fn new(commands: usize, wheels: usize, hold: bool) -> Self {
        let (rails, track) = (commands, commands + RAIL.len() * wheels);
        let wind = track + TRACK.len();
        let speed = wind + WIND.len();
        Self { rails, track, wind, speed, count: speed + usize::from(hold) }
    }
}

/// Every input of a model.
pub fn list(m: &Model) -> Vec<Input> {
    let own = |parts: &[(&str, &'static str)]| parts.iter().map(|(p, u)| ((*p).to_string(), *u)).collect::<Vec<_>>();
    let rails = |name: &str| RAIL.iter().map(|(part, unit)| (format!("{name}.{part}"), *unit)).collect::<Vec<_>>();
    let of_motor = |drive: usize, part: &str| format!("{}.{part}", m.drives[drive].name);
    let moved = |d: &&DcMotorIn| matches!(d.field, FieldIn::Moved { .. });
    let dc = m.dc_motors.iter();
    let mut inputs: Vec<Input> = dc.clone().map(|d| (of_motor(d.drive, "armature_voltage"), "V")).collect();
    inputs.extend(dc.filter(moved).map(|d| (of_motor(d.drive, "field_voltage"), "V")));
    inputs.extend(m.induction_motors.iter().map(|d| (of_motor(d.drive, "torque_command"), "N m")));
    inputs.extend(m.actuators.iter().map(|a| (format!("{}.force", a.name), "N")));
    inputs.extend(m.wheels.iter().flat_map(|w| rails(&w.name)));
    inputs.extend(own(&TRACK));
    inputs.extend(own(&WIND));
    if m.hold.is_some() {
        inputs.push(("hold.speed".into(), "m/s"));
    }
    inputs
}

/// Nominal values as constants of a scalar.
pub fn nominal<S: Scalar>(m: &Model) -> Vec<S> {
    m.inputs.iter().map(|&u| S::constant(u)).collect()
}
