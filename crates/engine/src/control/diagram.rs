//! A compiled block diagram: one array of signals, filled from the front in the order of the blocks.
//! It never changes; what it remembers is a `Memory` of numbers, or of dual numbers for steady states and linear models.

use super::block::{Block, Instant, Pi};
use super::compile;
use super::error::ControlError;
use super::lookup::Outside;
use super::spec::ControlSpec;
use klingel_physics::Scalar;

#[derive(Clone, Debug)]
pub struct Diagram {
    pub sample_time: f64,
    pub measurement_names: Vec<String>,
    pub command_targets: Vec<String>,
    /// Channel and unit of every probe.
    pub probe_channels: Vec<(String, String)>,
    blocks: Vec<Placed>,
    command_slots: Vec<usize>,
    probe_slots: Vec<usize>,
}

/// A block with its name and where its memory and its signals begin.
#[derive(Clone, Debug)]
struct Placed {
    name: String,
    block: Block,
    memory: usize,
    signal: usize,
}

/// What a diagram remembers from sample to sample, and its signals: measurements first, then those of the blocks.
#[derive(Clone, Debug)]
pub struct Memory<S> {
    pub states: Vec<S>,
    /// Whether limits of integrals count in `settle`; on the way to a steady state they may stand in it.
    pub limited: bool,
    /// Whether a `step` shows the linear law of blocks that round, sample or make noise, as linear models need it.
    pub linear: bool,
    /// Taken since the start of the run.
    samples: i64,
    signals: Vec<S>,
    scratch: Vec<S>,
}

/// A signal near a corner of its block: how far off, as a part of the law's range.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockKink {
    pub block: String,
    pub distance: f64,
}

impl Diagram {
    /// Checks and compiles a diagram.
    ///
    /// # Errors
    /// Names that are unknown or taken twice, numbers out of their range, filters with a pole at z = 1.
    pub fn compile(spec: &ControlSpec) -> Result<Self, ControlError> {
        compile::compile(spec)
    }

    pub(super) fn new(
        spec: &ControlSpec,
        blocks: Vec<(String, Block)>,
        command_slots: Vec<usize>,
        probe_slots: Vec<usize>,
    ) -> Self {
        let (mut memory, mut signal) = (0, spec.measurements.len());
        let place = |(name, block): (String, Block)| {
            let placed = Placed { name, memory, signal, block };
            memory += placed.block.states();
            signal += placed.block.signals();
            placed
        };
        Self {
            sample_time: spec.sample_time,
            measurement_names: spec.measurements.clone(),
            command_targets: spec.commands.iter().map(|c| c.target.clone()).collect(),
            probe_channels: spec.probes.iter().map(|p| (p.channel.clone(), p.unit.clone())).collect(),
            blocks: blocks.into_iter().map(place).collect(),
            command_slots,
            probe_slots,
        }
    }

    pub fn memory<S: Scalar>(&self) -> Memory<S> {
        let states = self.blocks.iter().map(|b| b.block.states()).sum();
        let scratch = self.blocks.iter().map(|b| b.block.scratch()).max().unwrap_or(0);
        let written: usize = self.blocks.iter().map(|b| b.block.signals()).sum();
        Memory {
            states: vec![S::zero(); states],
            limited: true,
            linear: false,
            samples: 0,
            signals: vec![S::zero(); self.measurement_names.len() + written],
            scratch: vec![S::zero(); scratch],
        }
    }

    /// Name of each number of the memory: that of its block and a count.
    pub fn state_names(&self) -> Vec<String> {
        let of = |b: &Placed| (0..b.block.states()).map(|i| format!("{}.{i}", b.name)).collect::<Vec<_>>();
        self.blocks.iter().flat_map(of).collect()
    }

    /// The PI blocks, whose integrals a steady state has to find.
    pub fn integrators(&self) -> usize {
        self.pis().count()
    }

    fn pis(&self) -> impl Iterator<Item = &Pi> {
        self.blocks.iter().filter_map(|b| if let Block::Pi(pi) = &b.block { Some(pi) } else { None })
    }

    /// Whether it has steady states and linear models.
    ///
    /// # Errors
    /// A controller outside the core, which has none.
    pub fn is_linear(&self) -> Result<(), ControlError> {
        match self.blocks.iter().find(|b| matches!(b.block, Block::External { .. })) {
            Some(external) => Err(not_linear(&external.name)),
            None => Ok(()),
        }
    }

    /// Goes to the state that constant measurements would lead to, each PI with its given integral.
    ///
    /// # Errors
    /// As `step`.
    pub fn settle<S: Scalar>(
        &self,
        memory: &mut Memory<S>,
        measurements: &[S],
        integrals: &[S],
    ) -> Result<(), ControlError> {
        self.settle_with(memory, measurements, integrals, |name, _, _, _| Err(not_linear(name)))
    }

    /// As `settle`; `outside(name, time, inputs, outputs)` calls the external controllers.
    pub(super) fn settle_with<S: Scalar>(
        &self,
        memory: &mut Memory<S>,
        measurements: &[S],
        integrals: &[S],
        outside: impl FnMut(&str, f64, &[S], &mut [S]) -> Result<(), ControlError>,
    ) -> Result<(), ControlError> {
        memory.samples = 0;
        let (mut integrals, limited) = (integrals.iter(), memory.limited);
        self.sweep(memory, measurements, Instant::STEADY, outside, |block, states, scratch, signals| {
            let integral = if matches!(block, Block::Pi(_)) { integrals.next().copied() } else { None };
            block.reset(states, scratch, signals, integral.unwrap_or_default(), limited)
        })
    }

    /// One sample.
    ///
    /// # Errors
    /// A wrong number of measurements, a value that is not finite, an input outside its table; a controller outside the
    /// core.
    pub fn step<S: Scalar>(&self, memory: &mut Memory<S>, measurements: &[S]) -> Result<(), ControlError> {
        self.step_with(memory, measurements, |name, _, _, _| Err(not_linear(name)))
    }

    /// As `step`; `outside(name, time, inputs, outputs)` calls the external controllers.
    pub(super) fn step_with<S: Scalar>(
        &self,
        memory: &mut Memory<S>,
        measurements: &[S],
        outside: impl FnMut(&str, f64, &[S], &mut [S]) -> Result<(), ControlError>,
    ) -> Result<(), ControlError> {
        memory.samples += 1;
        let now = Instant { sample: memory.samples, interval: self.sample_time, linear: memory.linear };
        self.sweep(memory, measurements, now, outside, |block, states, scratch, signals| {
            block.step(states, scratch, signals, now)
        })
    }

    /// The next `step` is that of the start.
    pub fn before_start<S>(memory: &mut Memory<S>) {
        memory.samples = -1;
    }

    fn sweep<S: Scalar>(
        &self,
        memory: &mut Memory<S>,
        measurements: &[S],
        now: Instant,
        mut outside: impl FnMut(&str, f64, &[S], &mut [S]) -> Result<(), ControlError>,
        mut law: impl FnMut(&Block, &mut [S], &mut [S], (&[S], &mut [S])) -> Result<(), Outside>,
    ) -> Result<(), ControlError> {
        let offset = self.measurement_names.len();
        if measurements.len() != offset {
            return Err(ControlError::Measurements { expected: offset, given: measurements.len() });
        }
        if let Some(i) = measurements.iter().position(|m| !m.value().is_finite()) {
            let (name, value) = (self.measurement_names[i].clone(), measurements[i].value());
            return Err(ControlError::Measurement { name, value });
        }
        let Memory { states, signals, scratch, .. } = memory;
        signals[..offset].copy_from_slice(measurements);
        for Placed { name, block, memory, signal } in &self.blocks {
            let own = &mut states[*memory..*memory + block.states()];
            let (before, after) = signals.split_at_mut(*signal);
            let out = &mut after[..block.signals()];
            if let Some(inputs) = block.asks(scratch, before, now) {
                outside(name, now.time(), inputs, own)?;
            }
            law(block, own, scratch, (before, out)).map_err(|Outside { value, low, high }| {
                ControlError::OutsideTable { block: name.clone(), value, low, high }
            })?;
            if let Some(value) = out.iter().map(|y| y.value()).find(|y| !y.is_finite()) {
                return Err(ControlError::NotFinite { block: name.clone(), value });
            }
        }
        Ok(())
    }

    /// What the last pass commands, in the order of `command_targets`.
    pub fn commands<S: Scalar>(&self, memory: &Memory<S>) -> impl Iterator<Item = S> {
        self.command_slots.iter().map(|&slot| memory.signals[slot])
    }

    /// The probed signals of the last pass, in the order of `probe_channels`.
    pub fn probes<S: Scalar>(&self, memory: &Memory<S>) -> impl Iterator<Item = S> {
        self.probe_slots.iter().map(|&slot| memory.signals[slot])
    }

    /// What each PI lacks to a steady state after `settle` with these integrals; nil in one.
    pub fn unsettled<S: Scalar>(&self, memory: &Memory<S>, integrals: &[S]) -> impl Iterator<Item = S> {
        self.pis().zip(integrals).map(|(pi, &integral)| pi.unsettled(integral, &memory.signals, memory.limited))
    }

    /// Blocks whose signal is within `near` of a limit or corner, as a part of their range.
    pub fn kinks(&self, memory: &Memory<f64>, near: f64) -> Vec<BlockKink> {
        let kink = |b: &Placed| {
            let distance = b.block.kink(&memory.signals).filter(|d| *d < near)?;
            Some(BlockKink { block: b.name.clone(), distance })
        };
        self.blocks.iter().filter_map(kink).collect()
    }
}

fn not_linear(name: &str) -> ControlError {
    ControlError::ExternalNotLinear { name: name.into() }
}
