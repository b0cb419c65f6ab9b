//! How a controller is wired to the plant: which channels it measures and which inputs it drives.
//! Shared by runs, steady states and linear models.

use crate::channels::Channel;
use crate::control::{ControlSpec, Diagram};
use crate::error::EngineError;
use crate::model::Model;
use crate::{channels, inputs};

/// A block diagram and its wires.
#[derive(Clone, Debug)]
pub struct Wiring {
    pub diagram: Diagram,
    /// Channels, in the order of `Diagram::measurement_names`.
    pub measured: Vec<usize>,
    /// Inputs, in the order of `Diagram::command_targets`.
    pub driven: Vec<usize>,
}

impl Wiring {
    /// The controller of a spec, with its wires.
    ///
    /// # Errors
    /// A diagram that is refused; a channel or input that the model does not have.
    pub fn new(m: &Model, spec: &ControlSpec) -> Result<Self, EngineError> {
        Self::of(m, Diagram::compile(spec)?)
    }

    /// The wires of a compiled diagram.
    ///
    /// # Errors
    /// A channel or input that the model does not have.
    pub fn of(m: &Model, diagram: Diagram) -> Result<Self, EngineError> {
        let channels: Vec<Channel> = channels::list(m);
        let mut commanded = inputs::list(m);
        commanded.truncate(m.places.rails);
        let places = |names: &[String], known: &[Channel], what: &'static str| {
            names.iter().map(|name| find(known, what, name)).collect::<Result<Vec<_>, _>>()
        };
        let measured = places(&diagram.measurement_names, &channels, "channel")?;
        let driven = places(&diagram.command_targets, &commanded, "input")?;
        Ok(Self { diagram, measured, driven })
    }
}

fn find(known: &[Channel], what: &'static str, name: &str) -> Result<usize, EngineError> {
    known.iter().position(|(n, _)| n == name).ok_or_else(|| EngineError::Unknown {
        place: "control".into(),
        what,
        name: name.into(),
        known: format!("{} of them, such as {}", known.len(), known.first().map_or("none", |k| k.0.as_str())),
    })
}
