//! What a run adds to the inputs beside its controllers: excitations over time and the ramp of the held speed.
//! Everything is held for a step, so that a linear model with held inputs sees the same.

use crate::error::EngineError;
use crate::inputs;
use crate::model::{Course, Model};

/// Values for one input, each held for some steps.
#[derive(Clone, Debug)]
struct Series {
    input: usize,
    every: usize,
    values: Vec<f64>,
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
            series.push(Series { input, every: steps.round() as usize, values: e.values.clone() });
        }
        let growth = m.hold.as_ref().map_or(0.0, |h| h.acceleration * m.run.step);
        let ramp = (growth != 0.0).then_some((m.places.speed, growth));
        Ok(Self { series, ramp })
    }

    /// Writes the inputs of step `k` from those that are held by controllers.
    pub fn apply(&self, k: usize, held: &[f64], inputs: &mut [f64]) {
        inputs.copy_from_slice(held);
        for s in &self.series {
            inputs[s.input] += s.values.get(k / s.every).copied().unwrap_or(0.0);
        }
        if let Some((speed, growth)) = self.ramp {
            inputs[speed] += k as f64 * growth;
        }
    }
}
