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
    #[error(
        "no static equilibrium at {speed} m/s: after {iterations} iterations the largest residual is {residual:.3e} \
         in {state}; check stiffnesses, preloads and wheel loads"
    )]
    Equilibrium { speed: f64, iterations: usize, residual: f64, state: String },
    #[error("no linear model: {fault}")]
    Linear { fault: Fault },
    #[error("the run was cancelled at {time:.3} s")]
    Cancelled { time: f64 },
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
    #[error("unstable: state {state} is no longer finite")]
    Unstable { state: String },
    #[error("controller failed: {0}")]
    Control(String),
}
