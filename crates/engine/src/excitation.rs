//! What a run adds to the inputs beside its controllers: excitations over time and the ramp of the held speed.
//! What is held is held for a step, so that a linear model with held inputs sees the same.

use crate::error::EngineError;
use crate::inputs;
use crate::model::{Course, Model};

/// Values for one input, some steps apart, each held or joined to the next by a straight line.
#[derive(Clone, Debug)]
struct Series {
    input: usize,
    every: usize,
    values: Vec<f64>,
    joined: bool,
}

impl Series {
    /// The value `share` of a step after step `k`.
    fn at(&self, k: usize, share: f64) -> f64 {
        let value = |i: usize| self.values.get(i).copied().unwrap_or(0.0);
        let (i, past) = (k / self.every, k % self.every);
        if !self.joined {
            return value(i);
        }
        value(i) + (value(i + 1) - value(i)) * (past as f64 + share) / self.every as f64
    }
}

/// Excitations of a run, by the number of the step.
#[derive(Clone, Debug)]
pub struct Excitation {
    series: Vec<Series>,
    /// Place of the held speed and its growth a step, if it grows.
    ramp: Option<(usize, f64)>,
}

impl Excitation {
    /// Finds the inputs of a model.
    ///
    /// # Errors
    /// An input that the model does not have, an interval that is no multiple of the step, values that are not finite.
    pub fn new(m: &Model) -> Result<Self, EngineError> {
        let known = inputs::list(m);
        let mut series = Vec::new();
        for (i, e) in m.run.excitations.iter().enumerate() {
            let place = format!("run.excitations[{i}]");
            let uniform = matches!(m.track, Course::Uniform(_)) || !e.input.starts_with("track.");
            let input = known.iter().position(|(name, _)| *name == e.input && uniform).ok_or_else(|| {
                let names = known.iter().map(|k| k.0.as_str()).filter(|n| uniform || !n.starts_with("track."));
                EngineError::Unknown {
                    place: place.clone(),
                    what: "input",
                    name: e.input.clone(),
                    known: names.collect::<Vec<_>>().join(", "),
                }
            })?;
            let steps = e.interval / m.run.step;
            let wrong = |value: String, remedy: &str| EngineError::Value { place, value, remedy: remedy.into() };
            if !(steps > 0.5 && (steps - steps.round()).abs() < 1e-6) {
                return Err(wrong(e.interval.to_string(), "make its interval a multiple of the step"));
            }
            if let Some(bad) = e.values.iter().find(|v| !v.is_finite()) {
                return Err(wrong(bad.to_string(), "give finite values"));
            }
            series.push(Series { input, every: steps.round() as usize, values: e.values.clone(), joined: e.joined });
        }
        let growth = m.hold.as_ref().map_or(0.0, |h| h.acceleration * m.run.step);
        let ramp = (growth != 0.0).then_some((m.places.speed, growth));
        Ok(Self { series, ramp })
    }

    /// Whether anything moves inside a step.
    pub fn moves(&self) -> bool {
        self.series.iter().any(|s| s.joined)
    }

    /// Writes the inputs `share` of a step after step `k` from those that are held by controllers.
    pub fn apply(&self, k: usize, share: f64, held: &[f64], inputs: &mut [f64]) {
        inputs.copy_from_slice(held);
        for s in &self.series {
            inputs[s.input] += s.at(k, share);
        }
        if let Some((speed, growth)) = self.ramp {
            inputs[speed] += k as f64 * growth;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Series;

    #[test]
    fn values_are_held_or_joined_and_nothing_follows() {
        let held = Series { input: 0, every: 2, values: vec![1.0, 3.0], joined: false };
        let joined = Series { joined: true, ..held.clone() };
        let of =
            |s: &Series| [(0, 0.0), (0, 0.5), (1, 0.0), (2, 0.0), (3, 0.5), (4, 0.0)].map(|(k, share)| s.at(k, share));
        assert_eq!(of(&held), [1.0, 1.0, 1.0, 3.0, 3.0, 0.0]);
        assert_eq!(of(&joined), [1.0, 1.5, 2.0, 3.0, 0.75, 0.0]);
    }
}
