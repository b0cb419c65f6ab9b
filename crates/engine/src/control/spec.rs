//! The block diagram as it is written down (JSON): signals by name, blocks in execution order.
//! Discrete coefficients are made by whoever writes the spec; this crate never discretises.

use serde::{Deserialize, Serialize};

/// A sampled controller. Every name is unique; a block reads measurements and signals of blocks before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlSpec {
    /// Time between two samples, s.
    pub sample_time: f64,
    /// Dotted channels the engine reads at every sample, SI units.
    pub measurements: Vec<String>,
    pub blocks: Vec<BlockSpec>,
    pub commands: Vec<Command>,
    #[serde(default)]
    pub probes: Vec<Probe>,
}

/// A signal that drives an input of the plant (voltage V, force N) until the next sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    pub target: String,
    pub signal: String,
}

/// A signal that is recorded with the results under a channel name and unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    pub channel: String,
    pub unit: String,
    pub signal: String,
}

/// A number, or the name of a signal that carries it (a scheduled gain, a moving limit).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Parameter {
    Number(f64),
    Signal(String),
}

impl Parameter {
    fn one() -> Self {
        Self::Number(1.0)
    }
}

/// One summand: gain times signal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    pub signal: String,
    #[serde(default = "Parameter::one")]
    pub gain: Parameter,
}

/// One second-order section (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    pub b: [f64; 3],
    pub a: [f64; 2],
}

/// How a lookup runs between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    #[default]
    Linear,
    /// Piecewise cubic with a continuous slope that never overshoots the points (Fritsch and Carlson 1980).
    C1,
}

/// What a lookup does outside its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// The run ends with a reported outcome.
    #[default]
    Error,
    /// The end value holds.
    Hold,
}

/// One block; it writes the one signal that carries its name, or those named in `outputs`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum BlockSpec {
    /// Time since the start of the run \[s\].
    Clock { name: String },
    /// bias + sum of gain * signal.
    Sum {
        name: String,
        terms: Vec<Term>,
        #[serde(default)]
        bias: f64,
    },
    /// The product of its factors.
    Product { name: String, factors: Vec<String> },
    /// numerator / denominator, the magnitude of the denominator held at `floor` (> 0) or above with its sign kept.
    Quotient { name: String, numerator: String, denominator: String, floor: f64 },
    /// A linear filter as a chain of second-order sections; no pole at z = 1 (use `pi`).
    Filter { name: String, input: String, sections: Vec<Section> },
    /// A linear filter x\[k+1\] = A x\[k\] + B u\[k\], y\[k\] = C x\[k\] + D u\[k\] of several inputs and outputs; matrices
    /// by rows; no pole at z = 1 (use `pi`).
    StateSpace {
        name: String,
        inputs: Vec<String>,
        outputs: Vec<String>,
        a: Vec<Vec<f64>>,
        b: Vec<Vec<f64>>,
        c: Vec<Vec<f64>>,
        d: Vec<Vec<f64>>,
    },
    /// proportional * e + integral of (integral * e) by the trapezoidal rule. While the output would pass a limit the
    /// integral stops growing towards it (anti-windup). The integral starts at zero.
    Pi {
        name: String,
        input: String,
        proportional: Parameter,
        /// 1/s times the unit of the proportional gain.
        integral: Parameter,
        #[serde(default)]
        lower: Option<Parameter>,
        #[serde(default)]
        upper: Option<Parameter>,
    },
    /// The input held between `lower` and `upper`.
    Saturation { name: String, input: String, lower: Parameter, upper: Parameter },
    /// The output follows the input no faster than `falling` and `rising` (both > 0, units per second).
    RateLimit { name: String, input: String, rising: f64, falling: f64 },
    /// The input `samples` samples ago.
    Delay { name: String, input: String, samples: usize },
    /// y(x) between given points, x increasing.
    Lookup {
        name: String,
        input: String,
        x: Vec<f64>,
        y: Vec<f64>,
        #[serde(default)]
        interpolation: Interpolation,
        #[serde(default)]
        edge: Edge,
    },
    /// The multiple of `step` (> 0) nearest to the input; in linear models and steady states the input itself.
    Quantise { name: String, input: String, step: f64 },
    /// White Gaussian noise of standard deviation `std` (>= 0), one draw a sample from `seed` and the sample's number
    /// alone; in linear models and steady states nil.
    Noise { name: String, std: f64, seed: u64 },
    /// Every `samples`-th input (>= 1), that of the start included, held in between; in linear models the mean over the
    /// last `samples` inputs, which is what does not depend on when they are taken.
    Hold { name: String, input: String, samples: usize },
    /// A controller outside the core (`control::External`), called at every `samples`-th sample (>= 1), that of the start
    /// included; its outputs are held in between.
    External { name: String, inputs: Vec<String>, outputs: Vec<String>, samples: usize },
}

impl BlockSpec {
    /// The signals that it writes.
    pub fn signals(&self) -> &[String] {
        match self {
            Self::StateSpace { outputs, .. } | Self::External { outputs, .. } => outputs,
            _ => core::slice::from_ref(self.name()),
        }
    }

    /// The name of the block, and of its signal if it has no outputs with names of their own.
    pub fn name(&self) -> &String {
        match self {
            Self::Clock { name }
            | Self::Sum { name, .. }
            | Self::Product { name, .. }
            | Self::Quotient { name, .. }
            | Self::Filter { name, .. }
            | Self::StateSpace { name, .. }
            | Self::Pi { name, .. }
            | Self::Saturation { name, .. }
            | Self::RateLimit { name, .. }
            | Self::Delay { name, .. }
            | Self::Lookup { name, .. }
            | Self::Quantise { name, .. }
            | Self::Noise { name, .. }
            | Self::Hold { name, .. }
            | Self::External { name, .. } => name,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_keys_are_refused_and_a_spec_survives_json() {
        let block = r#"{"kind": "delay", "name": "d", "input": "x", "samples": 2}"#;
        let parsed: BlockSpec = serde_json::from_str(block).unwrap();
        assert_eq!(serde_json::from_str::<BlockSpec>(&serde_json::to_string(&parsed).unwrap()).unwrap(), parsed);
        let wrong = r#"{"kind": "delay", "name": "d", "input": "x", "samples": 2, "time": 0.1}"#;
        assert!(serde_json::from_str::<BlockSpec>(wrong).unwrap_err().to_string().contains("time"));
    }

    #[test]
    fn a_parameter_is_a_number_or_a_signal() {
        let term: Term = serde_json::from_str(r#"{"signal": "x", "gain": "k"}"#).unwrap();
        assert_eq!(term.gain, Parameter::Signal("k".into()));
        let term: Term = serde_json::from_str(r#"{"signal": "x"}"#).unwrap();
        assert_eq!(term.gain, Parameter::Number(1.0));
    }
}
