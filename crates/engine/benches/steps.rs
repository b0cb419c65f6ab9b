//! Cost of one step of the tests' short vehicle: explicit, linearly implicit, and with wheels that stick.
//! Run with `cargo bench -p klingel-engine --bench steps`; the ratio of the first two is what low speed costs.
#![allow(dead_code)] // of the tests' helpers

#[path = "../tests/analytic/bogie.rs"]
mod bogie;
#[path = "../tests/analytic/common.rs"]
mod common;

use common::Plant;
use divan::Bencher;
use klingel_engine::rates;
use klingel_engine::stepper::Stepper;
use serde_json::json;

fn main() {
    divan::main();
}

fn steps(bencher: Bencher, implicit_below: f64, stick: bool) {
    let mut case = bogie::bogie("table", 1.0);
    case["run"]["implicit_below"] = json!(implicit_below);
    case["creep"]["stick"] = json!(stick);
    let mut plant = Plant::new(&case);
    let start = plant.equilibrium();
    let mut stepper = Stepper::new(&plant.model, &plant.model.poles).expect("a stepper");
    stepper.choose(&plant.model, &start);
    let (mut x, mut first, mut inputs) = (start.clone(), vec![0.0; start.len()], plant.model.inputs.clone());
    bencher.bench_local(|| {
        x.copy_from_slice(&start);
        let Plant { model, work } = &mut plant;
        rates(model, &x, &inputs, work, &mut first).expect("on the rails");
        let rhs = |_, at: &[f64], inputs: &mut [f64], dx: &mut [f64]| rates(model, at, inputs, work, dx);
        stepper.advance(model, &mut x, &first, &mut inputs, rhs).expect("a step");
    });
}

#[divan::bench]
fn explicit(bencher: Bencher) {
    steps(bencher, 0.0, false);
}

#[divan::bench]
fn implicit(bencher: Bencher) {
    steps(bencher, 100.0, false);
}

#[divan::bench]
fn implicit_with_stick(bencher: Bencher) {
    steps(bencher, 100.0, true);
}
