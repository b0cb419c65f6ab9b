//! Every law at once, over `f64` and over dual numbers; joints that push both bodies alike; the order of the scheme.
//! All on the vehicle of `bogie.rs`, at random states near its equilibrium.

use crate::bogie::{bogie, near};
use crate::common::{Plant, Random};
use klingel_engine::inputs::nominal;
use klingel_engine::rates;
use klingel_engine::rates::Workspace;
use klingel_physics::math::Vec3;
use klingel_physics::{Dual, Scalar};

#[test]
fn dual_rates_are_the_plain_rates_bit_by_bit() {
    for law in ["linear", "polach", "fastsim", "table"] {
        let mut plant = Plant::new(&bogie(law, 1.0));
        let middle = plant.equilibrium();
        let mut random = Random(3);
        for _ in 0..20 {
            let x = near(&plant, &middle, &mut random);
            let plain = plant.rates(&x);
            let dual: Vec<Dual<2>> = x.iter().map(|&v| Dual::constant(v)).collect();
            let mut dx = vec![Dual::default(); x.len()];
            let mut work = Workspace::new(&plant.model);
            rates(&plant.model, &dual, &nominal(&plant.model), &mut work, &mut dx).expect("wheels on their rails");
            for (i, (d, p)) in dx.iter().zip(&plain).enumerate() {
                assert_eq!(d.value.to_bits(), p.to_bits(), "{law}: {}", plant.model.state_names[i]);
            }
        }
    }
}

/// Central differences with a step to each state's scale; 1e-5 of the column's largest slope covers their own error.
#[test]
fn dual_slopes_are_difference_quotients() {
    for law in ["linear", "polach", "table"] {
        let mut plant = Plant::new(&bogie(law, 1.0));
        let middle = plant.equilibrium();
        let mut random = Random(11);
        let x = near(&plant, &middle, &mut random);
        let exact = plant.jacobian(&x);
        for j in 0..x.len() {
            let (body, state) = plant.model.state_names[j].rsplit_once('.').unwrap_or(("", ""));
            let h = match state {
                // the contact stiffens within micrometres
                "z" | "roll" if matches!(body, "front" | "rear") => 1e-8,
                // curvatures of the contact tables jump every 50 micrometres
                "y" if matches!(body, "front" | "rear") => 1e-7,
                "y" | "z" | "roll" | "pitch" | "yaw" => 1e-6,
                "force" | "force_rate" => 1e-2,
                _ => 1e-5,
            };
            let at = |d: f64, plant: &mut Plant| {
                let mut x = x.clone();
                x[j] += d;
                plant.rates(&x)
            };
            let (up, down) = (at(h, &mut plant), at(-h, &mut plant));
            let column = (0..x.len()).map(|i| exact[(i, j)].abs()).fold(0.0, f64::max);
            for i in 0..x.len() {
                let difference = (up[i] - down[i]) / (2.0 * h);
                let close = (difference - exact[(i, j)]).abs() <= 1e-5 * column + 1e-6;
                let names = &plant.model.state_names;
                assert!(close, "{law}: {}' over {}: {} for {difference}", names[i], names[j], exact[(i, j)]);
            }
        }
    }
}

/// Forces of all joints sum to nothing, and so do their moments about any point.
#[test]
fn joints_keep_momentum_and_angular_momentum() {
    let mut plant = Plant::new(&bogie("linear", 1.0));
    let middle = plant.equilibrium();
    let mut random = Random(5);
    for _ in 0..50 {
        let x = near(&plant, &middle, &mut random);
        plant.rates(&x);
        let about = Vec3::new(10.0 * random.next(), 10.0 * random.next(), random.next());
        let (mut force, mut moment, mut sizes) = (Vec3::zero(), Vec3::zero(), 0.0);
        for (motion, loads) in plant.work.motions.iter().zip(&plant.work.loads) {
            force += loads.force_W;
            moment += loads.moment_W + (motion.p_W - about).cross(loads.force_W);
            sizes += loads.force_W.norm();
        }
        assert!(sizes > 1e5);
        assert!(force.norm() < 1e-12 * sizes && moment.norm() < 1e-10 * sizes, "{force:?} {moment:?}");
    }
}

/// Fourth order as long as the motion is smooth: the linear creep law, small oscillations on the arc.
/// The tables are once continuously differentiable, so small errors may fall more slowly; 3.5 is asked for.
#[test]
fn the_vehicle_is_integrated_with_the_order_of_the_scheme() {
    let mut case = bogie("linear", 1.0);
    case["track"]["start"] = serde_json::json!(100.0);
    let mut plant = Plant::new(&case);
    let mut start = plant.equilibrium();
    let kicked = plant.state("front.vy");
    start[kicked] += 0.01;
    let mut end = |step: f64| {
        let mut x = start.clone();
        plant.advance(&mut x, step, (0.064 / step).round() as usize, |_, _| ());
        x
    };
    let exact = end(3.125e-5);
    let error = |x: Vec<f64>| {
        let of = |i: usize| (x[i] - exact[i]).abs() / (1e-6 + exact[i].abs());
        (0..x.len()).map(of).fold(0.0, f64::max)
    };
    let errors = [1e-3, 5e-4, 2.5e-4].map(|step| error(end(step)));
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    assert!(orders.iter().all(|o| *o > 3.5), "orders {orders:?} from {errors:?}");
}

/// The mirrored vehicle in the mirrored curve: lateral, roll and yaw change their sign, the rest stays.
/// Contact, wheels and drives agree bit by bit; bodies that sum several pairs of joints agree to rounding.
#[test]
fn the_mirrored_state_has_the_mirrored_rates() {
    let mut case = bogie("fastsim", 1.0);
    let mut mirrored_case = bogie("fastsim", -1.0);
    for c in [&mut case, &mut mirrored_case] {
        for drive in c["drives"].as_array_mut().expect("drives") {
            drive["gear_sense"] = serde_json::json!(1.0);
        }
    }
    let (mut right, mut left) = (Plant::new(&case), Plant::new(&mirrored_case));
    let middle = right.equilibrium();
    let mut random = Random(9);
    let names = right.model.state_names.clone();
    let place = |name: &str| names.iter().position(|n| n == name).expect("its mirror");
    let swap = |name: &str| -> String {
        if name.contains("left") { name.replace("left", "right") } else { name.replace("right", "left") }
    };
    let odd = |name: &str| matches!(name.rsplit('.').next(), Some("y" | "roll" | "yaw" | "vy" | "wx" | "wz"));
    let mirror = |x: &[f64]| -> Vec<f64> {
        let of = |name: &String| {
            let value = x[place(&swap(name))];
            if odd(name) { -value } else { value }
        };
        names.iter().map(of).collect()
    };
    for _ in 0..20 {
        let x = near(&right, &middle, &mut random);
        let expected = mirror(&right.rates(&x));
        let found = left.rates(&mirror(&x));
        for i in 0..x.len() {
            let exactly = names[i].starts_with("front") || names[i].ends_with("spin_speed");
            let tolerance = if exactly { 0.0 } else { 1e-13 * expected[i].abs().max(1.0) };
            let close = (found[i] - expected[i]).abs() <= tolerance;
            assert!(close, "{}: {} for {}", names[i], found[i], expected[i]);
        }
    }
}
