//! Two undamped bodies on bushings, turning far: total energy, linear and angular momentum stay what they were.
//! Elastic energy of a bushing: k u^2/2 - preload u in translation, k (1 - cos theta) for equal rotational stiffnesses.

use crate::common::{Plant, Random, bodies, straight, track};
use klingel_physics::math::Vec3;
use serde_json::{Value, json};

/// Stiffnesses, preloads and rotational stiffness of the four bushings between the two bodies.
const STIFFNESS: [f64; 3] = [2e5, 1e5, 4e5];
const ROTATIONAL: f64 = 2e4;
const PRELOAD: [f64; 3] = [0.0, 100.0, -2000.0];

fn pair(gravity: f64, track: Value) -> Value {
    let mut case = bodies(
        gravity,
        track,
        json!([
            { "name": "lower", "mass": 900.0, "inertia": [300.0, 500.0, 700.0], "position": [0.0, 0.0, -0.5] },
            { "name": "upper", "mass": 1500.0, "inertia": [800.0, 1500.0, 1200.0], "position": [0.2, 0.0, -1.6] }
        ]),
    );
    let corners = [(0.8, 0.6), (0.8, -0.6), (-0.8, 0.6), (-0.8, -0.6)];
    case["bushings"] = corners
        .iter()
        .enumerate()
        .map(|(i, (x, y))| {
            json!({ "name": format!("spring{i}"), "joint": { "a": "lower", "b": "upper", "point": [x, y, -1.0] },
                    "stiffness": STIFFNESS, "preload": PRELOAD, "rotational_stiffness": [ROTATIONAL, ROTATIONAL, ROTATIONAL] })
        })
        .collect();
    case
}

/// Displaced by centimetres, turning against each other at radians per second.
fn disturbed(plant: &Plant) -> Vec<f64> {
    let mut x = plant.design_state();
    let mut random = Random(7);
    for body in &plant.model.bodies {
        for (i, size) in [0.0, 0.05, 0.05, 0.1, 0.1, 0.1, 0.5, 0.5, 0.5, 2.0, 2.0, 2.0].iter().enumerate() {
            x[body.state + i] += size * random.next();
        }
    }
    x
}

fn kinetic(plant: &Plant) -> f64 {
    let of = |(body, motion): (&klingel_engine::model::Body, &klingel_engine::motion::Motion<f64>)| {
        let turning: f64 = (0..3).map(|i| body.inertia[i] * motion.w_B.0[i].powi(2)).sum();
        0.5 * (body.mass * motion.v_T.dot(motion.v_T) + turning)
    };
    plant.model.bodies.iter().zip(&plant.work.motions).map(of).sum()
}

fn gravitational(plant: &Plant) -> f64 {
    let of = |(b, m): (&klingel_engine::model::Body, &klingel_engine::motion::Motion<f64>)| b.mass * m.p_W.z();
    -plant.model.gravity * plant.model.bodies.iter().zip(&plant.work.motions).map(of).sum::<f64>()
}

fn elastic(plant: &Plant) -> f64 {
    let (a, b) = (&plant.work.motions[0].R_WB.0, &plant.work.motions[1].R_WB.0);
    let trace: f64 = (0..3).map(|i| (0..3).map(|k| a[k][i] * b[k][i]).sum::<f64>()).sum();
    let stretched =
        |u: Vec3<f64>| -> f64 { (0..3).map(|i| 0.5 * STIFFNESS[i] * u.0[i].powi(2) - PRELOAD[i] * u.0[i]).sum() };
    let twisted = ROTATIONAL * 0.5 * (3.0 - trace);
    plant.work.joints.iter().map(|j| stretched(j.u) + twisted).sum()
}

/// Linear momentum, and angular momentum about the origin, both in the world.
fn momenta(plant: &Plant) -> [Vec3<f64>; 2] {
    let (mut linear, mut angular) = (Vec3::zero(), Vec3::zero());
    for (body, motion) in plant.model.bodies.iter().zip(&plant.work.motions) {
        let (p, w) = (motion.v_W * body.mass, motion.w_B);
        let spin = Vec3::new(body.inertia[0] * w.x(), body.inertia[1] * w.y(), body.inertia[2] * w.z());
        linear += p;
        angular += motion.p_W.cross(p) + motion.R_WB.apply(spin);
    }
    [linear, angular]
}

/// Largest drift of the total energy over 2 s, relative to the largest elastic energy, and the largest turn seen.
fn drift(gravity: f64, track: Value, step: f64) -> (f64, f64) {
    let mut plant = Plant::new(&pair(gravity, track));
    let mut x = disturbed(&plant);
    let (mut start, mut worst, mut largest, mut turn) = (f64::NAN, 0.0_f64, 0.0_f64, 0.0_f64);
    plant.advance(&mut x, step, (2.0 / step).round() as usize, |plant, x| {
        plant.rates(x);
        let spring = elastic(plant);
        let total = kinetic(plant) + gravitational(plant) + spring;
        if start.is_nan() {
            start = total;
        }
        worst = worst.max((total - start).abs());
        largest = largest.max(spring);
        turn = turn.max(x[5].abs());
    });
    (worst / largest, turn)
}

/// A clothoid with its cant ramp in one piece: curvature, cant and twist all at work, no kink on the way.
fn curving() -> Value {
    track(100.0, [0.002, 0.006], [0.02, 0.18])
}

#[test]
fn energy_is_kept_on_straight_and_curved_track() {
    for (gravity, track) in [(0.0, straight(100.0)), (9.81, straight(100.0)), (9.81, curving())] {
        let (coarse, turn) = drift(gravity, track.clone(), 5e-4);
        assert!(turn > 0.5, "the bodies turn far: {turn} rad");
        assert!(coarse < 1e-7, "relative drift {coarse:e}");
    }
}

/// The energy error of the fourth-order scheme falls at least with the fourth power of the step.
#[test]
fn the_drift_of_energy_falls_with_the_step_at_its_order() {
    for track in [straight(100.0), curving()] {
        let [coarse, fine] = [4e-3, 2e-3].map(|step| drift(9.81, track.clone(), step).0);
        let order = (coarse / fine).log2();
        assert!(order > 3.7, "observed order {order} ({coarse:e}, {fine:e})");
    }
}

#[test]
fn momentum_and_angular_momentum_are_kept_on_curved_track() {
    let mut plant = Plant::new(&pair(0.0, curving()));
    let mut x = disturbed(&plant);
    let mut start = None;
    plant.advance(&mut x, 5e-4, 4000, |plant, x| {
        plant.rates(x);
        let now = momenta(plant);
        let start = start.get_or_insert(now);
        for (now, start) in now.iter().zip(*start) {
            assert!((*now - start).norm() < 1e-7 * start.norm(), "{now:?} from {start:?}");
        }
    });
}
