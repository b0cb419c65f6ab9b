//! The laws of the blocks with their memory: what happens to one signal within one sample.
//! Nothing allocates in `step`; `reset` puts every memory where a constant input would leave it.

use super::filter::{Sections, StateSpace};
use super::lookup::{Lookup, Outside};

/// A number or the slot of the signal that carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    Number(f64),
    Slot(usize),
}

impl Operand {
    #[inline]
    fn value(self, signals: &[f64]) -> f64 {
        match self {
            Self::Number(x) => x,
            Self::Slot(i) => signals[i],
        }
    }
}

/// PI with limits; `integral` carries the unit of the output, so a scheduled gain never makes it jump.
#[derive(Clone, Debug)]
pub struct Pi {
    pub input: usize,
    pub proportional: Operand,
    pub rate: Operand,
    pub lower: Option<Operand>,
    pub upper: Option<Operand>,
    pub integral: f64,
    pub last_error: f64,
}

impl Pi {
    fn limit(&self, y: f64, signals: &[f64]) -> f64 {
        let y = self.lower.map_or(y, |l| y.max(l.value(signals)));
        self.upper.map_or(y, |u| y.min(u.value(signals)))
    }

    fn reset(&mut self, signals: &[f64]) -> f64 {
        (self.integral, self.last_error) = (0.0, signals[self.input]);
        self.limit(self.proportional.value(signals) * self.last_error, signals)
    }

    fn step(&mut self, signals: &[f64], ts: f64) -> f64 {
        let error = signals[self.input];
        let direct = self.proportional.value(signals) * error;
        let growth = self.rate.value(signals) * 0.5 * ts * (error + self.last_error);
        self.last_error = error;
        let wanted = direct + self.integral + growth;
        let given = self.limit(wanted, signals);
        // Held while it would push the output further past the limit, free to come back.
        if (wanted - given) * growth <= 0.0 {
            self.integral += growth;
        }
        given
    }
}

/// One compiled block; slots index the signals of the controller.
#[derive(Clone, Debug)]
pub enum Block {
    Sum { terms: Vec<(usize, Operand)>, bias: f64 },
    Product { factors: Vec<usize> },
    Quotient { numerator: usize, denominator: usize, floor: f64 },
    Filter { input: usize, filter: Sections },
    StateSpace { inputs: Vec<usize>, gathered: Vec<f64>, filter: StateSpace },
    Pi(Pi),
    Saturation { input: usize, lower: Operand, upper: Operand },
    RateLimit { input: usize, rising: f64, falling: f64, last: f64 },
    Delay { input: usize, ring: Vec<f64>, oldest: usize },
    Lookup { input: usize, table: Lookup },
}

impl Block {
    /// Goes to the steady state for constant inputs (an integral goes to zero) and returns the output there.
    pub fn reset(&mut self, signals: &[f64], ts: f64) -> Result<f64, Outside> {
        Ok(match self {
            Self::Filter { input, filter } => filter.reset(signals[*input]),
            Self::StateSpace { inputs, gathered, filter } => {
                gather(gathered, inputs, signals);
                filter.reset(gathered)
            }
            Self::Pi(pi) => pi.reset(signals),
            Self::RateLimit { input, last, .. } => {
                *last = signals[*input];
                *last
            }
            Self::Delay { input, ring, oldest } => {
                ring.fill(signals[*input]);
                *oldest = 0;
                signals[*input]
            }
            _ => return self.step(signals, ts),
        })
    }

    /// The output of this sample.
    pub fn step(&mut self, signals: &[f64], ts: f64) -> Result<f64, Outside> {
        Ok(match self {
            Self::Sum { terms, bias } => {
                terms.iter().fold(*bias, |sum, &(slot, gain)| sum + gain.value(signals) * signals[slot])
            }
            Self::Product { factors } => factors.iter().map(|&f| signals[f]).product(),
            Self::Quotient { numerator, denominator, floor } => {
                let d = signals[*denominator];
                signals[*numerator] / d.abs().max(*floor).copysign(d)
            }
            Self::Filter { input, filter } => filter.step(signals[*input]),
            Self::StateSpace { inputs, gathered, filter } => {
                gather(gathered, inputs, signals);
                filter.step(gathered)
            }
            Self::Pi(pi) => pi.step(signals, ts),
            Self::Saturation { input, lower, upper } => {
                signals[*input].max(lower.value(signals)).min(upper.value(signals))
            }
            Self::RateLimit { input, rising, falling, last } => {
                *last = signals[*input].max(*last - *falling * ts).min(*last + *rising * ts);
                *last
            }
            Self::Delay { input, ring, oldest } => {
                let y = core::mem::replace(&mut ring[*oldest], signals[*input]);
                *oldest = (*oldest + 1) % ring.len();
                y
            }
            Self::Lookup { input, table } => return table.value(signals[*input]),
        })
    }
}

fn gather(into: &mut [f64], slots: &[usize], signals: &[f64]) {
    for (x, &slot) in into.iter_mut().zip(slots) {
        *x = signals[slot];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TS: f64 = 1e-3;

    fn pi(lower: f64, upper: f64) -> Block {
        Block::Pi(Pi {
            input: 0,
            proportional: Operand::Number(2.0),
            rate: Operand::Number(10.0),
            lower: Some(Operand::Number(lower)),
            upper: Some(Operand::Number(upper)),
            integral: 0.0,
            last_error: 0.0,
        })
    }

    #[test]
    fn sum_product_and_quotient() {
        let mut sum = Block::Sum { terms: vec![(0, Operand::Number(2.0)), (1, Operand::Slot(2))], bias: 0.5 };
        assert_eq!(sum.step(&[1.0, 3.0, -1.0], TS), Ok(-0.5));
        assert_eq!(Block::Product { factors: vec![0, 1, 1] }.step(&[2.0, 3.0], TS), Ok(18.0));
        let mut quotient = Block::Quotient { numerator: 0, denominator: 1, floor: 0.5 };
        assert_eq!(quotient.step(&[3.0, -2.0], TS), Ok(-1.5));
        assert_eq!(quotient.step(&[3.0, -0.1], TS), Ok(-6.0));
        assert_eq!(quotient.step(&[3.0, 0.0], TS), Ok(6.0));
    }

    #[test]
    fn the_pi_integrates_exactly_and_starts_without_a_jolt() {
        let mut block = pi(-100.0, 100.0);
        assert_eq!(block.reset(&[0.5], TS), Ok(1.0));
        let mut y = 0.0;
        for _ in 0..1000 {
            y = block.step(&[0.5], TS).unwrap();
        }
        assert!((y - (1.0 + 10.0 * 0.5 * 1.0)).abs() < 1e-9, "{y}");
    }

    #[test]
    fn the_integral_does_not_wind_up() {
        let mut block = pi(-3.0, 3.0);
        block.reset(&[0.0], TS).unwrap();
        for _ in 0..5000 {
            assert!(block.step(&[1.0], TS).unwrap() <= 3.0);
        }
        // Leaves the limit within the time the direct part needs, not after unloading 50 units.
        let mut samples = 0;
        while block.step(&[-0.5], TS).unwrap() > 0.0 && samples < 1000 {
            samples += 1;
        }
        assert_eq!(samples, 0);
    }

    #[test]
    fn limits() {
        let mut s = Block::Saturation { input: 0, lower: Operand::Number(-1.0), upper: Operand::Slot(1) };
        assert_eq!(s.step(&[5.0, 2.0], TS), Ok(2.0));
        assert_eq!(s.step(&[-5.0, 2.0], TS), Ok(-1.0));
        let mut r = Block::RateLimit { input: 0, rising: 100.0, falling: 50.0, last: 0.0 };
        assert_eq!(r.reset(&[1.0], TS), Ok(1.0));
        assert!((r.step(&[9.0], TS).unwrap() - 1.1).abs() < 1e-12);
        assert!((r.step(&[0.0], TS).unwrap() - 1.05).abs() < 1e-12);
    }

    #[test]
    fn a_delay_of_n_samples_is_n_samples() {
        let mut d = Block::Delay { input: 0, ring: vec![0.0; 3], oldest: 1 };
        assert_eq!(d.reset(&[7.0], TS), Ok(7.0));
        let out: Vec<f64> = (0..6).map(|k| d.step(&[f64::from(k)], TS).unwrap()).collect();
        assert_eq!(out, [7.0, 7.0, 7.0, 0.0, 1.0, 2.0]);
    }
}
