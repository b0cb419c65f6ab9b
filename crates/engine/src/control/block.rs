//! The laws of the blocks: what happens to one signal within one sample, for numbers and for dual numbers.
//! Their memory is the caller's; `reset` puts it where a constant input would leave it. Nothing allocates.

use super::filter::{Sections, StateSpace};
use super::lookup::{Lookup, Outside};
use super::noise;
use klingel_physics::Scalar;

/// A number or the slot of the signal that carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    Number(f64),
    Slot(usize),
}

impl Operand {
    #[inline]
    fn value<S: Scalar>(self, signals: &[S]) -> S {
        match self {
            Self::Number(x) => S::constant(x),
            Self::Slot(i) => signals[i],
        }
    }
}

/// PI with limits; its integral carries the unit of the output, so a scheduled gain never makes it jump.
/// Memory: the integral, the error of the sample before.
#[derive(Clone, Debug)]
pub struct Pi {
    pub input: usize,
    pub proportional: Operand,
    pub rate: Operand,
    pub lower: Option<Operand>,
    pub upper: Option<Operand>,
}

impl Pi {
    fn limit<S: Scalar>(&self, y: S, signals: &[S]) -> S {
        let y = self.lower.map_or(y, |l| y.max(l.value(signals)));
        self.upper.map_or(y, |u| y.min(u.value(signals)))
    }

    /// The output with this integral while the error stays, within its limits if they are to count.
    fn settled<S: Scalar>(&self, memory: &mut [S], signals: &[S], integral: S, limited: bool) -> S {
        (memory[0], memory[1]) = (integral, signals[self.input]);
        let wanted = self.proportional.value(signals) * memory[1] + integral;
        if limited { self.limit(wanted, signals) } else { wanted }
    }

    /// What is nil in a steady state: the error, or at a limit that the error pushes against what the output is beyond it.
    /// Written as the projection of output + error, it has no jump between the two.
    pub fn unsettled<S: Scalar>(&self, integral: S, signals: &[S], limited: bool) -> S {
        let error = signals[self.input];
        if !limited {
            return error;
        }
        let wanted = self.proportional.value(signals) * error + integral;
        let pushed = wanted + S::select(self.rate.value(signals).lt(S::zero()), -error, error);
        self.limit(pushed, signals) - wanted
    }

    fn step<S: Scalar>(&self, memory: &mut [S], signals: &[S], ts: f64) -> S {
        let error = signals[self.input];
        let direct = self.proportional.value(signals) * error;
        let growth = self.rate.value(signals) * (error + memory[1]) * (0.5 * ts);
        memory[1] = error;
        let wanted = direct + memory[0] + growth;
        let given = self.limit(wanted, signals);
        // Held while it would push the output further past the limit, free to come back.
        let free = ((wanted - given) * growth).le(S::zero());
        // Nor does it stay beyond a limit that moves in.
        memory[0] = self.limit(S::select(free, memory[0] + growth, memory[0]), signals);
        given
    }
}

/// When a sample is taken, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Its number since the start of the run.
    pub sample: i64,
    /// Time since the sample before \[s\].
    pub interval: f64,
    /// Whether blocks that steady states and linear models cannot have (rounding, noise, sampling) show what a linear
    /// law has in their place.
    pub linear: bool,
}

impl Instant {
    /// The start of a run, of a controller that has always been there.
    pub const STEADY: Self = Self { sample: 0, interval: 0.0, linear: true };

    /// Since the start of the run \[s\].
    pub fn time(self) -> f64 {
        self.sample as f64 * self.interval
    }
}

/// One compiled block; slots index the signals of the controller.
#[derive(Clone, Debug)]
pub enum Block {
    Clock,
    Sum { terms: Vec<(usize, Operand)>, bias: f64 },
    Product { factors: Vec<usize> },
    Quotient { numerator: usize, denominator: usize, floor: f64 },
    Filter { input: usize, filter: Sections },
    StateSpace { inputs: Vec<usize>, filter: StateSpace },
    Pi(Pi),
    Saturation { input: usize, lower: Operand, upper: Operand },
    RateLimit { input: usize, rising: f64, falling: f64 },
    Delay { input: usize, samples: usize },
    Lookup { input: usize, table: Lookup },
    Quantise { input: usize, step: f64 },
    Noise { std: f64, seed: u64 },
    Hold { input: usize, samples: usize },
    External { inputs: Vec<usize>, outputs: usize, samples: usize },
}

impl Block {
    /// Signals it writes.
    pub fn signals(&self) -> usize {
        match self {
            Self::StateSpace { filter, .. } => filter.outputs(),
            Self::External { outputs, .. } => *outputs,
            _ => 1,
        }
    }

    /// Numbers it remembers from sample to sample.
    pub fn states(&self) -> usize {
        match self {
            Self::Filter { filter, .. } => filter.states(),
            Self::StateSpace { filter, .. } => filter.states(),
            Self::Pi(_) => 2,
            Self::RateLimit { .. } => 1,
            Self::Delay { samples, .. } => *samples,
            // of the linear law the inputs before, of the other one the input held
            Self::Hold { samples, .. } => *samples - 1,
            Self::External { outputs, .. } => *outputs,
            _ => 0,
        }
    }

    /// Numbers that a step writes over.
    pub fn scratch(&self) -> usize {
        match self {
            Self::StateSpace { inputs, filter } => inputs.len() + filter.states(),
            Self::External { inputs, .. } => inputs.len(),
            _ => 0,
        }
    }

    /// Goes to the steady state for constant inputs, a PI with the integral given, within limits or without; `out` is
    /// what it puts out there. `signals` are those of the blocks before.
    pub fn reset<S: Scalar>(
        &self,
        memory: &mut [S],
        scratch: &mut [S],
        (signals, out): (&[S], &mut [S]),
        integral: S,
        limited: bool,
    ) -> Result<(), Outside> {
        out[0] = match self {
            Self::Filter { input, filter } => filter.reset(memory, signals[*input]),
            Self::StateSpace { inputs, filter } => {
                gather(scratch, inputs, signals);
                filter.reset(memory, &scratch[..inputs.len()], out);
                return Ok(());
            }
            Self::Pi(pi) => pi.settled(memory, signals, integral, limited),
            Self::RateLimit { input, .. } | Self::Delay { input, .. } | Self::Hold { input, .. } => {
                memory.fill(signals[*input]);
                signals[*input]
            }
            _ => return self.step(memory, scratch, (signals, out), Instant::STEADY),
        };
        Ok(())
    }

    /// The outputs of this sample. `signals` are those of the blocks before.
    pub fn step<S: Scalar>(
        &self,
        memory: &mut [S],
        scratch: &mut [S],
        (signals, out): (&[S], &mut [S]),
        now: Instant,
    ) -> Result<(), Outside> {
        let Instant { sample, interval: ts, linear } = now;
        out[0] = match self {
            Self::Clock => S::constant(now.time()),
            Self::Sum { terms, bias } => {
                terms.iter().fold(S::constant(*bias), |sum, &(slot, gain)| sum + gain.value(signals) * signals[slot])
            }
            Self::Product { factors } => factors.iter().fold(S::one(), |product, &f| product * signals[f]),
            Self::Quotient { numerator, denominator, floor } => {
                let d = signals[*denominator];
                let size = d.abs().max(S::constant(*floor));
                signals[*numerator] / S::select(d.lt(S::zero()), -size, size)
            }
            Self::Filter { input, filter } => filter.step(memory, signals[*input]),
            Self::StateSpace { inputs, filter } => {
                gather(scratch, inputs, signals);
                let (given, next) = scratch.split_at_mut(inputs.len());
                filter.step(memory, given, &mut next[..filter.states()], out);
                return Ok(());
            }
            Self::Pi(pi) => pi.step(memory, signals, ts),
            Self::Saturation { input, lower, upper } => {
                signals[*input].max(lower.value(signals)).min(upper.value(signals))
            }
            Self::RateLimit { input, rising, falling } => {
                memory[0] = signals[*input].max(memory[0] - falling * ts).min(memory[0] + rising * ts);
                memory[0]
            }
            Self::Delay { input, .. } => {
                let y = memory[0];
                memory.rotate_left(1);
                memory[memory.len() - 1] = signals[*input];
                y
            }
            Self::Lookup { input, table } => table.value(signals[*input])?,
            Self::Quantise { input, .. } if linear => signals[*input],
            Self::Quantise { input, step } => signals[*input].lift(|x| (step * (x / step).round(), 0.0)),
            Self::Noise { .. } if linear => S::zero(),
            Self::Noise { std, seed } => S::constant(std * noise::normal(*seed, sample)),
            Self::Hold { input, samples: 1 } => signals[*input],
            Self::Hold { input, samples } if linear => mean(memory, signals[*input], *samples),
            Self::Hold { input, samples } => {
                if sample.rem_euclid(*samples as i64) == 0 {
                    memory[0] = signals[*input];
                }
                memory[0]
            }
            // whoever runs it has written what its controller gave into the memory
            Self::External { .. } => {
                out.copy_from_slice(memory);
                return Ok(());
            }
        };
        Ok(())
    }

    /// What an external controller is asked at this sample; none of a block of the core and in between its samples.
    pub fn asks<'a, S: Scalar>(&self, scratch: &'a mut [S], signals: &[S], now: Instant) -> Option<&'a [S]> {
        match self {
            Self::External { inputs, samples, .. } if now.sample.rem_euclid(*samples as i64) == 0 => {
                gather(scratch, inputs, signals);
                Some(&scratch[..inputs.len()])
            }
            _ => None,
        }
    }

    /// Where a limit or corner is near: how far off, as a part of the law's range; none for a smooth law or one far off.
    pub fn kink(&self, signals: &[f64]) -> Option<f64> {
        let between = |x: f64, lower: f64, upper: f64| {
            let range = (upper - lower).abs().max(f64::MIN_POSITIVE);
            (x - lower).abs().min((upper - x).abs()) / range
        };
        match self {
            Self::Quotient { denominator, floor, .. } => Some((signals[*denominator].abs() - floor).abs() / floor),
            Self::Saturation { input, lower, upper } => {
                Some(between(signals[*input], lower.value(signals), upper.value(signals)))
            }
            Self::Lookup { input, table } => table.kink(signals[*input]),
            _ => None,
        }
    }
}

/// The mean of this input and those before, the oldest first, which is what a hold is apart from when it samples: the
/// response of every phase of it, averaged.
fn mean<S: Scalar>(before: &mut [S], input: S, count: usize) -> S {
    let sum = before.iter().fold(input, |sum, &x| sum + x);
    before.rotate_left(1);
    before[count - 2] = input;
    sum * (1.0 / count as f64)
}

fn gather<S: Scalar>(into: &mut [S], slots: &[usize], signals: &[S]) {
    for (x, &slot) in into.iter_mut().zip(slots) {
        *x = signals[slot];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TS: f64 = 1e-3;

    /// A block with its memory, as a controller keeps it.
    struct Kept {
        block: Block,
        memory: Vec<f64>,
        now: Instant,
    }

    impl Kept {
        fn new(block: Block) -> Self {
            let memory = vec![0.0; block.states()];
            Self { block, memory, now: Instant { sample: 0, interval: TS, linear: false } }
        }
        fn linear(mut self) -> Self {
            self.now.linear = true;
            self
        }
        fn reset(&mut self, signals: &[f64]) -> f64 {
            let mut out = [f64::NAN];
            self.now.sample = 0;
            self.block.reset(&mut self.memory, &mut [], (signals, &mut out), 0.0, true).unwrap();
            out[0]
        }
        fn step(&mut self, signals: &[f64]) -> f64 {
            let mut out = [f64::NAN];
            self.now.sample += 1;
            self.block.step(&mut self.memory, &mut [], (signals, &mut out), self.now).unwrap();
            out[0]
        }
    }

    fn pi(lower: f64, upper: f64) -> Kept {
        Kept::new(Block::Pi(Pi {
            input: 0,
            proportional: Operand::Number(2.0),
            rate: Operand::Number(10.0),
            lower: Some(Operand::Number(lower)),
            upper: Some(Operand::Number(upper)),
        }))
    }

    #[test]
    fn sum_product_and_quotient() {
        let mut sum =
            Kept::new(Block::Sum { terms: vec![(0, Operand::Number(2.0)), (1, Operand::Slot(2))], bias: 0.5 });
        assert_eq!(sum.step(&[1.0, 3.0, -1.0]), -0.5);
        assert_eq!(Kept::new(Block::Product { factors: vec![0, 1, 1] }).step(&[2.0, 3.0]), 18.0);
        let mut quotient = Kept::new(Block::Quotient { numerator: 0, denominator: 1, floor: 0.5 });
        assert_eq!(quotient.step(&[3.0, -2.0]), -1.5);
        assert_eq!(quotient.step(&[3.0, -0.1]), -6.0);
        assert_eq!(quotient.step(&[3.0, 0.0]), 6.0);
    }

    #[test]
    fn the_pi_integrates_exactly_and_starts_without_a_jolt() {
        let mut block = pi(-100.0, 100.0);
        assert_eq!(block.reset(&[0.5]), 1.0);
        let mut y = 0.0;
        for _ in 0..1000 {
            y = block.step(&[0.5]);
        }
        assert!((y - (1.0 + 10.0 * 0.5 * 1.0)).abs() < 1e-9, "{y}");
    }

    #[test]
    fn the_integral_does_not_wind_up() {
        let mut block = pi(-3.0, 3.0);
        block.reset(&[0.0]);
        for _ in 0..5000 {
            assert!(block.step(&[1.0]) <= 3.0);
        }
        // Leaves the limit within the time the direct part needs, not after unloading 50 units.
        let mut samples = 0;
        while block.step(&[-0.5]) > 0.0 && samples < 1000 {
            samples += 1;
        }
        assert_eq!(samples, 0);
    }

    #[test]
    fn a_limit_that_moves_in_takes_the_integral_with_it() {
        let mut block = Kept::new(Block::Pi(Pi {
            input: 0,
            proportional: Operand::Number(0.0),
            rate: Operand::Number(10.0),
            lower: Some(Operand::Number(0.0)),
            upper: Some(Operand::Slot(1)),
        }));
        block.reset(&[0.0, 3.0]);
        for _ in 0..500 {
            block.step(&[1.0, 3.0]);
        }
        assert_eq!(block.step(&[1.0, 3.0]), 3.0);
        assert_eq!(block.step(&[1.0, 0.5]), 0.5);
        assert!(block.step(&[0.0, 3.0]) < 0.52);
    }

    #[test]
    fn a_settled_pi_has_no_error_or_stands_at_its_limit() {
        let Block::Pi(pi) = pi(-3.0, 3.0).block else { unreachable!() };
        assert_eq!(pi.unsettled(1.5, &[0.0], true), 0.0);
        assert_eq!(pi.unsettled(1.0, &[0.25], true), 0.25);
        assert_eq!(pi.unsettled(1.0, &[1.0], true), 0.0);
        assert_eq!(pi.unsettled(2.0, &[1.0], true), -1.0);
        assert_eq!(pi.unsettled(4.0, &[-0.25], true), -0.5);
        assert_eq!(pi.unsettled(9.0, &[0.25], false), 0.25);
    }

    #[test]
    fn limits() {
        let mut s = Kept::new(Block::Saturation { input: 0, lower: Operand::Number(-1.0), upper: Operand::Slot(1) });
        assert_eq!(s.step(&[5.0, 2.0]), 2.0);
        assert_eq!(s.step(&[-5.0, 2.0]), -1.0);
        let mut r = Kept::new(Block::RateLimit { input: 0, rising: 100.0, falling: 50.0 });
        assert_eq!(r.reset(&[1.0]), 1.0);
        assert!((r.step(&[9.0]) - 1.1).abs() < 1e-12);
        assert!((r.step(&[0.0]) - 1.05).abs() < 1e-12);
    }

    #[test]
    fn a_delay_of_n_samples_is_n_samples() {
        let mut d = Kept::new(Block::Delay { input: 0, samples: 3 });
        assert_eq!(d.reset(&[7.0]), 7.0);
        let out: Vec<f64> = (0..6).map(|k| d.step(&[f64::from(k)])).collect();
        assert_eq!(out, [7.0, 7.0, 7.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn the_nearest_multiple_of_a_step() {
        let block = Block::Quantise { input: 0, step: 0.25 };
        let mut q = Kept::new(block.clone());
        assert_eq!([0.1, 0.13, -0.13, 7.4, 0.125, -0.125].map(|x| q.step(&[x])), [0.0, 0.25, -0.25, 7.5, 0.25, -0.25]);
        assert_eq!(q.reset(&[0.1]), 0.1);
        assert_eq!(Kept::new(block).linear().step(&[0.1]), 0.1);
    }

    #[test]
    fn noise_of_a_standard_deviation_that_no_linear_model_has() {
        let block = Block::Noise { std: 0.5, seed: 11 };
        let mut n = Kept::new(block.clone());
        assert_eq!(n.reset(&[]), 0.0);
        assert_eq!(n.step(&[]), 0.5 * noise::normal(11, 1));
        assert_eq!(n.step(&[]), 0.5 * noise::normal(11, 2));
        assert_eq!(Kept::new(block).linear().step(&[]), 0.0);
    }

    #[test]
    fn a_hold_takes_every_third_sample() {
        let block = Block::Hold { input: 0, samples: 3 };
        let mut h = Kept::new(block.clone());
        assert_eq!(h.reset(&[7.0]), 7.0);
        let held: Vec<f64> = (1..8).map(|k| h.step(&[f64::from(k)])).collect();
        assert_eq!(held, [7.0, 7.0, 3.0, 3.0, 3.0, 6.0, 6.0]);
        h.now.sample = -1;
        assert_eq!(h.step(&[9.0]), 9.0);
        let mut mean = Kept::new(block).linear();
        mean.reset(&[0.0]);
        assert_eq!([3.0, 3.0, 3.0, 0.0, 6.0, 0.0].map(|x| mean.step(&[x])), [1.0, 2.0, 3.0, 2.0, 3.0, 2.0]);
        assert_eq!(Kept::new(Block::Hold { input: 0, samples: 1 }).step(&[4.0]), 4.0);
    }
}
