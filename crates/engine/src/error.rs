//! What can go wrong in the engine: bad specs (errors) and ends of motion (faults, which are outcomes).

use crate::control::ControlError;
use klingel_physics::contact::creep::CreepError;
use klingel_physics::contact::{ContactError, OutsideTable};
use klingel_physics::elements::StopError;
use klingel_physics::track::{AdhesionError, AlignmentError};
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
    #[error("{}", no_equilibrium(*speed, *curve, *iterations, *residual, state))]
    Equilibrium { speed: f64, curve: Option<Curve>, iterations: usize, residual: f64, state: String },
    #[error("no linear model: {fault}")]
    Linear { fault: Fault },
    #[error("the run was cancelled at {time:.3} s")]
    Cancelled { time: f64 },
}

/// The curve that a vehicle should have run in steadily.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    /// \[1/m\], positive in a right-hand curve.
    pub curvature: f64,
    /// \[m\], positive where the left rail is higher.
    pub cant: f64,
    /// Unbalanced lateral acceleration \[m/s2\], positive towards the left.
    pub lateral: f64,
}

/// Where there is no steady state, how far the search came, and what to look at: in a curve first the running itself.
fn no_equilibrium(speed: f64, curve: Option<Curve>, iterations: usize, residual: f64, state: &str) -> String {
    let (place, remedy) = match curve {
        None => (String::new(), "stiffnesses, preloads, wheel loads and friction"),
        Some(Curve { curvature, cant, lateral }) => {
            let course = match 1.0 / curvature {
                radius if radius.is_infinite() => "on a straight".to_string(),
                radius => {
                    format!("in a {}-hand curve of {:.0} m", if radius > 0.0 { "right" } else { "left" }, radius.abs())
                }
            };
            let place = format!(" {course} with {:.0} mm of cant, {lateral:.2} m/s2 unbalanced", 1e3 * cant);
            (place, "speed, radius, cant and friction, then stiffnesses and preloads")
        }
    };
    let came = match residual {
        r if r.is_finite() => format!("after {iterations} iterations the largest residual is {r:.3e} in {state}"),
        _ => format!("{iterations} iterations found none that keeps the wheels on their rails"),
    };
    format!("no steady state at {speed:.2} m/s{place}: {came}; check {remedy}")
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

    #[test]
    fn no_steady_state_names_the_curve() {
        let curve = Curve { curvature: -1.0 / 300.0, cant: -0.1, lateral: -22.49 };
        let said = no_equilibrium(83.333, Some(curve), 300, f64::INFINITY, "body.y");
        assert!(said.starts_with("no steady state at 83.33 m/s in a left-hand curve of 300 m with -100 mm of cant"));
        assert!(said.contains("-22.49 m/s2 unbalanced: 300 iterations found none"));
        let straight = no_equilibrium(40.0, None, 7, 1.5e3, "body.y");
        assert!(
            straight.starts_with("no steady state at 40.00 m/s: after 7 iterations the largest residual is 1.500e3")
        );
        let canted = no_equilibrium(40.0, Some(Curve { curvature: 0.0, cant: 0.1, lateral: -0.65 }), 7, 1.0, "body.y");
        assert!(canted.contains("on a straight with 100 mm of cant"));
    }
}
