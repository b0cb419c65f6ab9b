//! From the written diagram to slots and blocks: every name found, every number checked, once before a run.
//! A spec that compiles can only fail later by a signal that is not finite or leaves a table.

use super::block::{Block, Operand, Pi};
use super::diagram::Diagram;
use super::error::ControlError;
use super::filter::{Sections, StateSpace};
use super::lookup::Lookup;
use super::spec::{BlockSpec, ControlSpec, Parameter, Section};
use std::collections::{HashMap, HashSet};

/// The names known so far and their slots.
struct Names(HashMap<String, usize>);

impl Names {
    fn add(&mut self, name: &str) -> Result<(), ControlError> {
        let slot = self.0.len();
        match self.0.insert(name.into(), slot) {
            None => Ok(()),
            Some(_) => Err(ControlError::Duplicate { name: name.into() }),
        }
    }

    fn slot(&self, place: &str, signal: &str) -> Result<usize, ControlError> {
        let unknown = || ControlError::UnknownSignal { place: place.into(), signal: signal.into() };
        self.0.get(signal).copied().ok_or_else(unknown)
    }

    fn slots(&self, place: &str, signals: &[String]) -> Result<Vec<usize>, ControlError> {
        signals.iter().map(|s| self.slot(place, s)).collect()
    }

    fn operand(&self, place: &str, parameter: &Parameter) -> Result<Operand, ControlError> {
        match parameter {
            Parameter::Number(x) => finite(place, "a parameter", *x).map(Operand::Number),
            Parameter::Signal(s) => self.slot(place, s).map(Operand::Slot),
        }
    }
}

pub(super) fn compile(spec: &ControlSpec) -> Result<Diagram, ControlError> {
    if !(spec.sample_time.is_finite() && spec.sample_time > 0.0) {
        return Err(ControlError::SampleTime { value: spec.sample_time });
    }
    let mut names = Names(HashMap::new());
    for name in &spec.measurements {
        names.add(name)?;
    }
    let mut blocks = Vec::with_capacity(spec.blocks.len());
    let mut taken = HashSet::new();
    for block in &spec.blocks {
        blocks.push((block.name().to_owned(), compile_block(block, &names)?));
        if !taken.insert(block.name()) {
            return Err(ControlError::Duplicate { name: block.name().clone() });
        }
        for signal in block.signals() {
            names.add(signal)?;
        }
    }
    let mut targets = HashMap::new();
    for c in &spec.commands {
        if targets.insert(&c.target, ()).is_some() {
            return Err(ControlError::Duplicate { name: c.target.clone() });
        }
    }
    let mut probed = HashSet::new();
    if let Some(twice) = spec.probes.iter().find(|p| !probed.insert(&p.channel)) {
        return Err(ControlError::Probe { name: twice.channel.clone(), taken: "is recorded twice" });
    }
    let slot_of = |place: &str, signal: &str| names.slot(place, signal);
    let commands = spec.commands.iter().map(|c| slot_of(&format!("command `{}`", c.target), &c.signal));
    let probes = spec.probes.iter().map(|p| slot_of(&format!("probe `{}`", p.channel), &p.signal));
    let (commands, probes) = (commands.collect::<Result<_, _>>()?, probes.collect::<Result<_, _>>()?);
    Ok(Diagram::new(spec, blocks, commands, probes))
}

fn compile_block(spec: &BlockSpec, names: &Names) -> Result<Block, ControlError> {
    let block = spec.name();
    let place = format!("block `{block}`");
    let slot = |signal: &str| names.slot(&place, signal);
    let operand = |p: &Parameter| names.operand(block, p);
    Ok(match spec {
        BlockSpec::Clock { .. } => Block::Clock,
        BlockSpec::Sum { terms, bias, .. } => {
            let terms = terms.iter().map(|t| Ok((slot(&t.signal)?, operand(&t.gain)?)));
            Block::Sum { terms: terms.collect::<Result<_, _>>()?, bias: finite(block, "bias", *bias)? }
        }
        BlockSpec::Product { factors, .. } => Block::Product { factors: names.slots(&place, factors)? },
        BlockSpec::Quotient { numerator, denominator, floor, .. } => Block::Quotient {
            numerator: slot(numerator)?,
            denominator: slot(denominator)?,
            floor: positive(block, "floor", *floor)?,
        },
        BlockSpec::Filter { input, sections, .. } => {
            for section in sections {
                check_section(block, section)?;
            }
            Block::Filter { input: slot(input)?, filter: Sections::new(sections.clone()) }
        }
        BlockSpec::StateSpace { inputs, outputs, a, b, c, d, .. } => {
            let sizes = [inputs.len(), some(block, outputs)?.len()];
            let filter = compile_state_space(block, sizes, [a, b, c, d])?;
            Block::StateSpace { inputs: names.slots(&place, inputs)?, filter }
        }
        BlockSpec::Pi { input, proportional, integral, lower, upper, .. } => {
            let [lower, upper] = [lower, upper].map(|limit| limit.as_ref().map(operand).transpose());
            let (lower, upper) = (lower?, upper?);
            in_order(block, lower.as_ref(), upper.as_ref())?;
            let (proportional, rate) = (operand(proportional)?, operand(integral)?);
            Block::Pi(Pi { input: slot(input)?, proportional, rate, lower, upper })
        }
        BlockSpec::Saturation { input, lower, upper, .. } => {
            let (lower, upper) = (operand(lower)?, operand(upper)?);
            in_order(block, Some(&lower), Some(&upper))?;
            Block::Saturation { input: slot(input)?, lower, upper }
        }
        BlockSpec::RateLimit { input, rising, falling, .. } => Block::RateLimit {
            input: slot(input)?,
            rising: positive(block, "rising", *rising)?,
            falling: positive(block, "falling", *falling)?,
        },
        BlockSpec::Delay { input, samples, .. } => {
            Block::Delay { input: slot(input)?, samples: counted(block, *samples)? }
        }
        BlockSpec::Lookup { input, x, y, interpolation, edge, .. } => {
            check_points(block, x, y)?;
            Block::Lookup { input: slot(input)?, table: Lookup::new(x.clone(), y.clone(), *interpolation, *edge) }
        }
        BlockSpec::Quantise { input, step, .. } => {
            Block::Quantise { input: slot(input)?, step: positive(block, "step", *step)? }
        }
        BlockSpec::Noise { std, seed, .. } => Block::Noise { std: not_negative(block, "std", *std)?, seed: *seed },
        BlockSpec::Hold { input, samples, .. } => {
            Block::Hold { input: slot(input)?, samples: counted(block, *samples)? }
        }
        BlockSpec::External { inputs, outputs, samples, .. } => Block::External {
            inputs: names.slots(&place, inputs)?,
            outputs: some(block, outputs)?.len(),
            samples: counted(block, *samples)?,
        },
    })
}

fn bad(block: &str, what: &'static str, value: impl ToString, remedy: &'static str) -> ControlError {
    ControlError::Value { block: block.into(), what, value: value.to_string(), remedy }
}

fn finite(block: &str, what: &'static str, x: f64) -> Result<f64, ControlError> {
    if x.is_finite() { Ok(x) } else { Err(bad(block, what, x, "give a finite number")) }
}

fn positive(block: &str, what: &'static str, x: f64) -> Result<f64, ControlError> {
    if x.is_finite() && x > 0.0 { Ok(x) } else { Err(bad(block, what, x, "give a finite number above zero")) }
}

fn not_negative(block: &str, what: &'static str, x: f64) -> Result<f64, ControlError> {
    if x.is_finite() && x >= 0.0 { Ok(x) } else { Err(bad(block, what, x, "give zero or a finite number above")) }
}

/// Two limits that are numbers; those that are signals may cross in a run.
fn in_order(block: &str, lower: Option<&Operand>, upper: Option<&Operand>) -> Result<(), ControlError> {
    match (lower, upper) {
        (Some(Operand::Number(lower)), Some(Operand::Number(upper))) if lower > upper => {
            Err(bad(block, "lower", format!("{lower}, above upper = {upper}"), "exchange the limits"))
        }
        _ => Ok(()),
    }
}

/// A quarter of an hour at 1 kHz: each sample of a delay is a number in memory.
const SAMPLES_MOST: usize = 1_000_000;

fn counted(block: &str, samples: usize) -> Result<usize, ControlError> {
    match samples {
        0 => Err(bad(block, "samples", 0, "give at least 1, or leave the block out")),
        1..=SAMPLES_MOST => Ok(samples),
        _ => Err(bad(block, "samples", samples, "give at most 1000000")),
    }
}

fn some<'a>(block: &str, outputs: &'a [String]) -> Result<&'a [String], ControlError> {
    if outputs.is_empty() { Err(bad(block, "the number of outputs", 0, "name at least one")) } else { Ok(outputs) }
}

const NO_POLE_AT_ONE: &str = "it has no steady state to start from; use a `pi` block for an integral";

fn check_section(block: &str, s: &Section) -> Result<(), ControlError> {
    for x in s.b.iter().chain(&s.a) {
        finite(block, "a coefficient", *x)?;
    }
    let at_one = 1.0 + s.a[0] + s.a[1];
    if at_one.abs() < 1e-12 { Err(bad(block, "1 + a1 + a2", at_one, NO_POLE_AT_ONE)) } else { Ok(()) }
}

fn compile_state_space(
    block: &str,
    [inputs, outputs]: [usize; 2],
    [a, b, c, d]: [&Vec<Vec<f64>>; 4],
) -> Result<StateSpace, ControlError> {
    let n = a.len();
    let shape = |m: &[Vec<f64>], rows, columns| m.len() == rows && m.iter().all(|r| r.len() == columns);
    if !(shape(a, n, n) && shape(b, n, inputs) && shape(c, outputs, n) && shape(d, outputs, inputs)) {
        let [a, b, c, d] = [a, b, c, d].map(|m| format!("{} x {}", m.len(), m.first().map_or(0, Vec::len)));
        let sizes = format!("{a}, {b}, {c}, {d} of {inputs} inputs and {outputs} outputs");
        return Err(bad(
            block,
            "the shape of a, b, c, d",
            sizes,
            "give a n x n, b n x inputs, c outputs x n, d outputs x inputs",
        ));
    }
    let matrices = [a, b, c, d].map(|m| m.concat());
    for x in matrices.iter().flatten() {
        finite(block, "a coefficient", *x)?;
    }
    let filter = StateSpace::new([n, inputs, outputs], matrices);
    if filter.settles() { Ok(filter) } else { Err(bad(block, "a pole", "1", NO_POLE_AT_ONE)) }
}

fn check_points(block: &str, x: &[f64], y: &[f64]) -> Result<(), ControlError> {
    if x.len() != y.len() || x.len() < 2 {
        let sizes = format!("{} and {}", x.len(), y.len());
        return Err(bad(block, "the number of x and y", sizes, "give as many x as y, two or more"));
    }
    for v in x.iter().chain(y) {
        finite(block, "a point", *v)?;
    }
    match x.windows(2).find(|w| w[1] <= w[0]) {
        Some(w) => Err(bad(block, "the x after a smaller or equal one", w[1], "give x in increasing order")),
        None => Ok(()),
    }
}
