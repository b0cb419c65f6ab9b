//! What can go wrong in the engine: bad specs (errors) and ends of motion (faults, which are outcomes).

use crate::control::ControlError;
use klingel_physics::contact::creep::CreepError;
use klingel_physics::contact::{ContactError, OutsideTable};
use klingel_physics::elements::StopError;
use klingel_physics::track::{AdhesionError, AlignmentError};
use std::fmt;
use thiserror::Error;

/// A spec that cannot become a model, or a model that has no start.
#[derive(Debug, Error)]
pub enum EngineError {
    #[error("the spec is not readable: {0}")]
    Json(#[from] serde_json::Error),
    #[error("{place}: {value} is not allowed; {remedy}")]
    Value { place: String, value: String, remedy: String },
    #[error("{place}: there is no {what} called `{name}`; known: {known}")]
    Unknown { place: String, what: &'static str, name: String, known: String },
    #[error("control {does} `{name}`, but {}", unwired(what, *count, nearest))]
    Unwired { does: &'static str, what: &'static str, name: String, count: usize, nearest: String },
    #[error(transparent)]
    Track(#[from] AlignmentError),
    #[error(transparent)]
    Adhesion(#[from] AdhesionError),
    #[error("stop `{name}`: {source}")]
    Stop { name: String, source: StopError },
    #[error("wheel-rail pair {index}: {source}")]
    Contact { index: usize, source: ContactError },
    #[error("creep law: {0}")]
    Creep(#[from] CreepError),
    #[error("controller: {0}")]
    Control(#[from] ControlError),
    #[error("no steady state at {course}: {}", search(*iterations, *residual, state, course.curve.is_some()))]
    Equilibrium { course: Running, iterations: usize, residual: f64, state: String },
    #[error("no linear model: {fault}")]
    Linear { fault: Fault },
    #[error("the run was cancelled at {time:.3} s")]
    Cancelled { time: f64 },
}

/// How a vehicle should have run steadily.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    /// \[m/s\].
    pub speed: f64,
    /// The least of any wheel, none without wheels.
    pub friction: Option<f64>,
    /// None on straight level track.
    pub curve: Option<Curve>,
}

/// A curve, or cant without one.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    /// \[1/m\], positive in a right-hand curve.
    pub curvature: f64,
    /// \[m\], positive where the left rail is higher.
    pub cant: f64,
    /// Unbalanced lateral acceleration \[m/s2\], positive towards the left.
    pub lateral: f64,
}

impl fmt::Display for Running {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.2} m/s", self.speed)?;
        if let Some(friction) = self.friction {
            write!(f, ", friction {friction}")?;
        }
        let Some(Curve { curvature, cant, lateral }) = self.curve else { return Ok(()) };
        match curvature {
            0.0 => write!(f, ", on a straight")?,
            right if right > 0.0 => write!(f, ", in a right-hand curve of {:.0} m", 1.0 / right)?,
            left => write!(f, ", in a left-hand curve of {:.0} m", -1.0 / left)?,
        }
        write!(f, " with {:.0} mm of cant, {lateral:.2} m/s2 unbalanced", 1e3 * cant)
    }
}

/// What there is in place of a channel or input that is not.
fn unwired(what: &str, count: usize, nearest: &str) -> String {
    match count {
        0 => format!("the model has no {what}s"),
        _ => format!("there is no such {what}; the nearest of {count} is `{nearest}`"),
    }
}

/// How far the search for a steady state came, and what to look at: in a curve first the running itself.
fn search(iterations: usize, residual: f64, state: &str, curved: bool) -> String {
    let came = if residual.is_finite() {
        format!("the largest residual is {residual:.3e} in {state}")
    } else {
        "none was found that keeps the wheels on their rails".to_string()
    };
    let remedy = if curved {
        "speed, radius, cant and friction, then stiffnesses and preloads"
    } else {
        "stiffnesses, preloads, wheel loads and friction"
    };
    format!("{came} (iterations: {iterations}); check {remedy}")
}

impl Fault {
    /// What it means that a wheel is outside its contact table.
    pub(crate) fn outside_table(wheel: &str, outside: OutsideTable) -> Self {
        let OutsideTable { what, value, least, most } = outside;
        let wheel = wheel.to_string();
        if !value.is_finite() {
            Self::Unstable { state: format!("{wheel} ({what})") }
        } else if what == "penetration" {
            Self::Overloaded { wheel, value, most }
        } else {
            Self::Derailed { wheel, what, value, least, most }
        }
    }
}

/// Why a motion ended before its time. Values, not exceptions: a batch goes on.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Fault {
    #[error("derailed: {wheel} has left its rail ({what} {value:.4}, the contact reaches from {least} to {most})")]
    Derailed { wheel: String, what: &'static str, value: f64, least: f64, most: f64 },
    #[error(
        "overloaded: {wheel} is pressed {value:.2e} m into its rail, the contact reaches to {most} m; check loads and step"
    )]
    Overloaded { wheel: String, value: f64, most: f64 },
    #[error("end of track: {body} has reached {length:.1} m, where the track ends; lengthen it or end the run sooner")]
    EndOfTrack { body: String, length: f64 },
    #[error("unstable: state {state} is no longer finite")]
    Unstable { state: String },
    #[error("controller failed: {0}")]
    Control(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(curve: Option<Curve>, residual: f64) -> String {
        let course = Running { speed: 83.333, friction: Some(0.01), curve };
        EngineError::Equilibrium { course, iterations: 7, residual, state: "body.y".into() }.to_string()
    }

    #[test]
    fn no_steady_state_names_speed_friction_and_curve() {
        let curve = Curve { curvature: -1.0 / 300.0, cant: -0.1, lateral: -22.49 };
        let place = "no steady state at 83.33 m/s, friction 0.01, in a left-hand curve of 300 m with -100 mm of cant";
        assert!(said(Some(curve), f64::INFINITY).starts_with(place));
        assert!(said(Some(curve), f64::INFINITY).contains("-22.49 m/s2 unbalanced: none was found that keeps"));
        let straight = "no steady state at 83.33 m/s, friction 0.01: the largest residual is 1.500e3 in body.y";
        assert!(said(None, 1.5e3).starts_with(straight));
        assert!(said(Some(Curve { curvature: 0.0, ..curve }), 1.0).contains("on a straight with -100 mm of cant"));
    }
}
