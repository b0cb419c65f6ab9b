//! How a controller is wired to the plant: which channels it measures, which inputs it drives, what it records.
//! Shared by runs, steady states and linear models.

use crate::channels::Channel;
use crate::control::{ControlError, ControlSpec, Diagram};
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
    /// A diagram that is refused; as `of`.
    pub fn new(m: &Model, spec: &ControlSpec) -> Result<Self, EngineError> {
        Self::of(m, Diagram::compile(spec)?)
    }

    /// The wires of a compiled diagram.
    ///
    /// # Errors
    /// A channel or input that the model does not have; a probe that would replace a channel of the results.
    pub fn of(m: &Model, diagram: Diagram) -> Result<Self, EngineError> {
        let channels: Vec<Channel> = channels::list(m);
        let mut commanded = inputs::list(m);
        commanded.truncate(m.places.rails);
        let places = |names: &[String], known: &[Channel], does: &'static str, what: &'static str| {
            names.iter().map(|name| find(known, does, what, name)).collect::<Result<Vec<_>, _>>()
        };
        let measured = places(&diagram.measurement_names, &channels, "measures", "channel")?;
        let driven = places(&diagram.command_targets, &commanded, "drives", "input")?;
        for (name, _) in &diagram.probe_channels {
            if let Some(taken) = taken(&channels, name) {
                return Err(ControlError::Probe { name: name.clone(), taken }.into());
            }
        }
        Ok(Self { diagram, measured, driven })
    }
}

/// Why a probe cannot have a name: results have one column a name.
fn taken(channels: &[Channel], name: &str) -> Option<&'static str> {
    if name == "time" || name.starts_with("energy.") {
        Some("has a name that results keep for time and energies")
    } else {
        channels.iter().any(|(n, _)| n == name).then_some("would replace the channel of the same name")
    }
}

fn find(known: &[Channel], does: &'static str, what: &'static str, name: &str) -> Result<usize, EngineError> {
    known.iter().position(|(n, _)| n == name).ok_or_else(|| EngineError::Unwired {
        does,
        what,
        name: name.into(),
        count: known.len(),
        nearest: known.iter().map(|k| &k.0).min_by_key(|k| edits(name, k)).cloned().unwrap_or_default(),
    })
}

/// How many letters to insert, leave out or change to make one name of another (Levenshtein's distance).
fn edits(from: &str, to: &str) -> usize {
    let mut row: Vec<usize> = (0..=to.chars().count()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut before = row[0];
        row[0] = i + 1;
        for (j, b) in to.chars().enumerate() {
            let changed = before + usize::from(a != b);
            before = row[j + 1];
            row[j + 1] = changed.min(row[j].min(before) + 1);
        }
    }
    row[row.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_told() {
        assert_eq!([edits("", "ab"), edits("ab", "ab"), edits("kitten", "sitting"), edits("ab", "b")], [2, 0, 3, 1]);
        let known = ["body.yaw", "bogie1.yaw", "bogie1.yaw_rate"].map(|name| (name.to_string(), "1"));
        let said = find(&known, "measures", "channel", "bogie1.yaw_rat").unwrap_err().to_string();
        let told = "there is no such channel; the nearest of 3 is `bogie1.yaw_rate`";
        assert_eq!(said, format!("control measures `bogie1.yaw_rat`, but {told}"));
        let none = find(&[], "drives", "input", "x").unwrap_err().to_string();
        assert_eq!(none, "control drives `x`, but the model has no inputs");
    }

    #[test]
    fn a_probe_replaces_no_channel() {
        let known = [("body.yaw".to_string(), "rad")];
        for (name, word) in [("body.yaw", Some("replace")), ("energy.drag", Some("energies")), ("body.my", None)] {
            assert_eq!(taken(&known, name).map(|why| why.contains(word.unwrap())), word.map(|_| true));
        }
    }
}
