//! What a creep law can be refused for.

/// Each message says what, which value and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CreepError {
    #[error("{what}: {value} is outside {least} to {most}; {remedy}")]
    OutOfRange { what: String, value: f64, least: f64, most: f64, remedy: String },
    #[error("{option} belongs to {owner}, the chosen law is {law}; leave it out or choose {owner}")]
    Misplaced { option: String, owner: String, law: String },
    #[error(
        "exact theory at the scaled creepages {creepage:?}: residual {residual} after {steps} steps; start from a \
         solution nearby or take fewer elements"
    )]
    NoConvergence { creepage: [f64; 3], steps: usize, residual: f64 },
    #[error("creep table: {problem}")]
    Table { problem: String },
}

pub(super) fn out_of_range(what: &str, value: f64, [least, most]: [f64; 2], remedy: &str) -> CreepError {
    CreepError::OutOfRange { what: what.into(), value, least, most, remedy: remedy.into() }
}
