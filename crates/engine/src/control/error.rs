//! What can go wrong in a block diagram: while it is compiled, and while it runs.
//! Every message names the block, the value and the remedy.

use thiserror::Error;

/// An error of a controller.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ControlError {
    #[error("control.sample_time is {value} s; give a finite time above zero, e.g. 0.001")]
    SampleTime { value: f64 },
    #[error("control signal `{name}` is defined twice; give every measurement and block its own name")]
    Duplicate { name: String },
    #[error(
        "control {place} reads `{signal}`, which is neither a measurement nor a block before it; \
         add it to `measurements` or move its block forward"
    )]
    UnknownSignal { place: String, signal: String },
    #[error("control probe `{name}` {taken}; give it another name")]
    Probe { name: String, taken: &'static str },
    #[error("control block `{block}`: {what} is {value}; {remedy}")]
    Value { block: String, what: &'static str, value: String, remedy: &'static str },
    #[error("control expects {expected} measurements and was given {given}; pass one value a name, in order")]
    Measurements { expected: usize, given: usize },
    #[error("control measurement `{name}` is {value}; the plant state is no longer finite")]
    Measurement { name: String, value: f64 },
    #[error("control block `{block}` gives {value}; check its gains and inputs")]
    NotFinite { block: String, value: f64 },
    #[error(
        "control block `{block}`: input {value} lies outside its table {low} .. {high}; \
         extend the table or set edge = \"hold\""
    )]
    OutsideTable { block: String, value: f64, low: f64, high: f64 },
    #[error(
        "`{name}` is a controller outside the core and none was given; \
         pass it with the spec: simulate_spec(spec, externals={{...}}), or run the scenario it belongs to"
    )]
    ExternalMissing { name: String },
    #[error(
        "`{name}` was given as a controller outside the core, but no block is called so; give the name of its block"
    )]
    ExternalUnknown { name: String },
    #[error(
        "`{name}` is a controller outside the core, of which there is no steady state and no linear model; \
         give it as blocks or as a discrete StateSpace"
    )]
    ExternalNotLinear { name: String },
    #[error(
        "control has {states} states, with delays one a sample, of which a linear model would be too large; \
         shorten delays until it has {most} at most"
    )]
    Large { states: usize, most: usize },
    #[error("`{name}` {text}")]
    External { name: String, text: String },
    #[error(
        "`{name}` gives {given} commands, {wanted} are declared ({expected}); return one number each, in this order"
    )]
    ExternalSize { name: String, given: usize, wanted: usize, expected: String },
    #[error("`{name}` gives {value} for `{output}`; check what it divides by and what it measures")]
    ExternalValue { name: String, output: String, value: f64 },
}
