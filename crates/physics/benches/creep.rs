//! Cost of the creep forces of one contact patch: in partial slip, in adhesion and with derivatives.
//! Run with `cargo bench -p klingel-physics --bench creep`; compare the table and FASTSIM with Polach of the same run.

use divan::{Bencher, black_box};
use klingel_physics::contact::creep::{CreepOptions, Kalker, SlopeReduction};
use klingel_physics::contact::{CreepForce, CreepLaw, Material, RollingContact};
use klingel_physics::{Dual, Scalar};

fn main() {
    divan::main();
}

const LAWS: [&str; 9] = [
    "linear",
    "shen_hedrick_elkins",
    "polach",
    "table",
    "fastsim 10 x 10",
    "fastsim 10 x 10, blended",
    "fastsim 16 x 16",
    "fastsim 16 x 16, blended",
    "fastsim 16 x 16, slope",
];

fn law(name: &str) -> CreepForce {
    let elements = if name.contains("10 x 10") { [10, 10] } else { [16, 16] };
    let law = name.split(' ').next().and_then(|name| CreepLaw::named(name, elements)).expect("a known law");
    let slope = SlopeReduction { initial: 0.54, limit: 0.02, decay: 0.64 };
    let options = CreepOptions {
        blended: name.ends_with("blended"),
        slope: name.ends_with("slope").then_some(slope),
        ..CreepOptions::default()
    };
    CreepForce::with_options(law, options, &Material::STEEL).expect("steel")
}

fn patch<S: Scalar>(slip: f64) -> RollingContact<S> {
    let c = S::constant;
    let (xi, eta, phi) = (c(slip), c(slip), c(200.0 * slip));
    RollingContact { a: c(6e-3), b: c(4e-3), normal_force: c(5e4), friction: c(0.3), xi, eta, phi }
}

#[divan::bench(args = LAWS)]
fn partial_slip(bencher: Bencher, name: &str) {
    let law = law(name);
    bencher.bench(|| law.force(&black_box(patch::<f64>(1e-3))));
}

#[divan::bench(args = LAWS)]
fn adhesion(bencher: Bencher, name: &str) {
    let law = law(name);
    bencher.bench(|| law.force(&black_box(patch::<f64>(1e-5))));
}

#[divan::bench(args = LAWS)]
fn partial_slip_dual(bencher: Bencher, name: &str) {
    let law = law(name);
    bencher.bench(|| law.force(&black_box(patch::<Dual<12>>(1e-3))));
}

/// Patches that follow each other like those of a vehicle's eight wheels: their places in a table lie apart.
#[divan::bench(args = ["polach", "table", "fastsim 10 x 10, blended"])]
fn eight_contacts(bencher: Bencher, name: &str) {
    let law = law(name);
    let patches: [RollingContact<f64>; 8] = core::array::from_fn(|i| {
        let (side, slip) = (if i % 2 == 0 { 1.0 } else { -1.0 }, 1e-4 * (1.0 + i as f64));
        let (xi, eta, phi) = (side * slip, -2.0 * slip, 0.1 * side + 50.0 * slip);
        RollingContact { a: 5e-3 + 2e-4 * i as f64, b: 3e-3, normal_force: 5e4, friction: 0.3, xi, eta, phi }
    });
    bencher.bench(|| black_box(&patches).map(|c| law.force(&c)));
}

#[divan::bench]
fn kalker(bencher: Bencher) {
    let kalker = Kalker::new(0.28);
    bencher.bench(|| kalker.at(black_box(1.5_f64)));
}
