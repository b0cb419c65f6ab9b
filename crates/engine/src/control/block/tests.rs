//! Every block against what it should do by hand, sample by sample; a block is kept with its memory as in a controller.

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
    let mut sum = Kept::new(Block::Sum { terms: vec![(0, Operand::Number(2.0)), (1, Operand::Slot(2))], bias: 0.5 });
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
