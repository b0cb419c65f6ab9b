//! Bodies with rotors: free nutation, precession under gravity's torque, drives inside a free body.
//! A rotor that rolls forward at w turns about -y of its body; its momentum is -J w e_y.

use crate::common::{Plant, bodies, straight, track};
use klingel_physics::math::Vec3;
use serde_json::{Value, json};

const ROTOR: f64 = 112.0;
const SPIN: f64 = 120.0;

fn top(gravity: f64, track: Value) -> Value {
    bodies(
        gravity,
        track,
        json!([{ "name": "top", "mass": 1000.0, "inertia": [800.0, 300.0, 800.0], "position": [0.0, 0.0, -0.5],
                 "rotors": [{ "name": "spin", "inertia": ROTOR }] }]),
    )
}

/// With A = Ix = Iz and the momentum -h along y: wx' = n wz, wz' = -n wx, n = ((Iy - A) wy - h)/A.
/// The track bends and twists below; the motion in space does not care.
#[test]
fn a_free_top_nutates_at_its_rate() {
    let mut plant = Plant::new(&top(0.0, track(100.0, [0.002, 0.006], [0.02, 0.18])));
    let mut x = plant.design_state();
    let [wx, wy, wz] = ["top.wx", "top.wy", "top.wz"].map(|name| plant.state(name));
    let spin = plant.state("top.spin.spin_speed");
    (x[wx], x[wy], x[wz], x[spin]) = (0.4, 0.3, 0.0, SPIN);
    let n = ((300.0 - 800.0) * 0.3 - ROTOR * SPIN) / 800.0;
    let momentum = |plant: &Plant, x: &[f64]| {
        let body = &plant.work.motions[0];
        body.R_WB.apply(Vec3::new(800.0 * x[wx], 300.0 * x[wy] - ROTOR * x[spin], 800.0 * x[wz]))
    };
    let (mut time, mut start) = (0.0, None);
    plant.advance(&mut x, 5e-4, 2000, |plant, x| {
        plant.rates(x);
        let now = momentum(plant, x);
        let start = *start.get_or_insert(now);
        assert!((now - start).norm() < 1e-8 * start.norm(), "angular momentum in space");
        // 1e-7: phase error of the fourth-order scheme over 1 s at 17 rad/s
        assert!((x[wx] - 0.4 * (n * time).cos()).abs() < 1e-7, "{time}");
        assert!((x[wz] + 0.4 * (n * time).sin()).abs() < 1e-7, "{time}");
        assert!((x[wy] - 0.3).abs() < 1e-14 && x[spin] == SPIN);
        time += 5e-4;
    });
}

/// A weight W at the arm l to the right of a level axle: yaw rate W l/h, to the right, level for ever.
/// The weight is the preload of a joint to a body so heavy that it does not move.
#[test]
fn a_level_top_precesses_under_its_weight() {
    let (weight, arm) = (2000.0, 0.7);
    for side in [1.0, -1.0] {
        let mut case = top(0.0, straight(100.0));
        let stand =
            json!({ "name": "stand", "mass": 1e15, "inertia": [1e15, 1e15, 1e15], "position": [0.0, 0.0, -0.5] });
        case["bodies"].as_array_mut().expect("bodies").push(stand);
        case["bushings"] = json!([{ "name": "weight", "preload": [0.0, 0.0, weight],
            "joint": { "a": "stand", "b": "top", "point": [0.0, side * arm, -0.5] } }]);
        let mut plant = Plant::new(&case);
        let mut x = plant.design_state();
        let precession = side * weight * arm / (ROTOR * SPIN);
        let (roll, yaw) = (plant.state("top.roll"), plant.state("top.yaw"));
        let (wz, spin) = (plant.state("top.wz"), plant.state("top.spin.spin_speed"));
        (x[wz], x[spin]) = (precession, SPIN);
        let mut time = 0.0;
        plant.advance(&mut x, 5e-4, 4000, |_, x| {
            assert!((x[yaw] - precession * time).abs() < 1e-9, "{} rad at {time} s", x[yaw]);
            assert!(x[roll].abs() < 1e-9);
            time += 5e-4;
        });
        assert!(x[yaw].abs() > 0.2);
    }
}

/// Left to nutate from rest the same top precesses at W l/h on average, once the fast nutation is averaged out.
#[test]
fn released_from_rest_the_top_precesses_on_average() {
    let (weight, arm) = (2000.0, 0.7);
    let mut case = top(0.0, straight(100.0));
    let stand = json!({ "name": "stand", "mass": 1e15, "inertia": [1e15, 1e15, 1e15], "position": [0.0, 0.0, -0.5] });
    case["bodies"].as_array_mut().expect("bodies").push(stand);
    case["bushings"] = json!([{ "name": "weight", "preload": [0.0, 0.0, weight],
        "joint": { "a": "stand", "b": "top", "point": [0.0, arm, -0.5] } }]);
    let mut plant = Plant::new(&case);
    let mut x = plant.design_state();
    x[plant.state("top.spin.spin_speed")] = SPIN;
    let (roll, yaw) = (plant.state("top.roll"), plant.state("top.yaw"));
    let nutation = ROTOR * SPIN / 800.0;
    let precession = weight * arm / (ROTOR * SPIN);
    let (mut time, mut lowest) = (0.0, 0.0_f64);
    plant.advance(&mut x, 5e-4, 4000, |_, x| {
        // linear theory: a cycloid; its roll is W l A/h^2 (1 - cos), up to 12 mrad, whose square it neglects
        let expected = precession * (time - (nutation * time).sin() / nutation);
        assert!((x[yaw] - expected).abs() < 2e-4 * expected + 1e-5, "{} for {expected}", x[yaw]);
        lowest = lowest.max(x[roll]);
        time += 5e-4;
    });
    let expected = 2.0 * weight * arm * 800.0 / (ROTOR * SPIN).powi(2);
    assert!((lowest / expected - 1.0).abs() < 1e-3, "{lowest} for {expected}");
}

/// A motor inside a free body only exchanges momentum about y: body + wheel + motor rotor keep their sum,
/// with the motor turning with the wheel or against it.
#[test]
fn a_drive_keeps_the_momentum_about_its_axle() {
    for sense in [1.0, -1.0] {
        let mut case = top(0.0, straight(100.0));
        case["drives"] = json!([{
            "name": "drive", "body": "top", "rotor": "spin", "armature_resistance": 0.15, "armature_inductance": 3e-3,
            "emf_constant": 0.4646, "field_current": 6.0, "armature_voltage": 900.0, "armature_voltage_max": 1500.0,
            "gear_ratio": 1.0 / 3.0, "gear_sense": sense, "rotor_inertia": 1.5, "rotor_damping": 0.02,
            "transmission_stiffness": 2e5, "transmission_damping": 300.0 }]);
        let mut plant = Plant::new(&case);
        let mut x = plant.design_state();
        let (wy, spin) = (plant.state("top.wy"), plant.state("top.spin.spin_speed"));
        let motor = plant.model.drives[0].state;
        // at rest: the wheel and the motor wind up from nothing
        (x[spin], x[motor]) = (0.0, 0.0);
        let momentum = |x: &[f64]| 300.0 * x[wy] - ROTOR * x[spin] - 1.5 * (sense * x[motor] - x[wy]);
        plant.advance(&mut x, 2e-4, 10_000, |_, x| assert!(momentum(x).abs() < 1e-8, "{}", momentum(x)));
        assert!(x[spin] > 5.0, "the wheel has spun up: {}", x[spin]);
        // the body turns back; the motor's share adds to the wheel's or takes from it
        let back = (ROTOR * x[spin] + sense * 1.5 * x[motor]) / (300.0 + 1.5);
        assert!((x[wy] / back - 1.0).abs() < 1e-9, "{} for {back}", x[wy]);
    }
}

/// Pitch acceleration and rotor torque of a driven wheel on a body, from the two equations by hand.
#[test]
fn the_first_instant_of_a_drive_is_right() {
    for sense in [1.0, -1.0] {
        let mut case = top(0.0, straight(100.0));
        case["drives"] = json!([{
            "name": "drive", "body": "top", "rotor": "spin", "armature_resistance": 0.15, "armature_inductance": 3e-3,
            "emf_constant": 0.4646, "field_current": 6.0, "armature_voltage": 0.0, "armature_voltage_max": 1500.0,
            "gear_ratio": 0.25, "gear_sense": sense, "rotor_inertia": 1.5, "rotor_damping": 0.0,
            "transmission_stiffness": 2e5, "transmission_damping": 0.0 }]);
        let mut plant = Plant::new(&case);
        let mut x = plant.design_state();
        let (motor, armature) = (plant.model.drives[0].state, plant.model.dc_motors[0].state);
        let spin = plant.state("top.spin.spin_speed");
        let (current, twist) = (50.0, 1e-3);
        (x[armature], x[motor], x[motor + 1], x[spin]) = (current, 4.0 * SPIN, twist, SPIN);
        let dx = plant.rates(&x);
        let (shaft, air_gap) = (2e5 * twist, 0.4646 * 6.0 * current);
        let net = air_gap - 0.25 * shaft;
        // what turns forward pushes its carrier backward, which is a positive torque about y
        let pitching = (shaft + sense * net) / 300.0;
        assert!((dx[plant.state("top.wy")] - pitching).abs() < 1e-12);
        assert!((dx[spin] - shaft / ROTOR).abs() < 1e-12);
        assert!((dx[motor] - (net / 1.5 + sense * pitching)).abs() < 1e-11);
    }
}

/// A commanded voltage beyond VaMax acts as VaMax, either way: La Ia' = Va at standstill.
#[test]
fn the_armature_voltage_stays_within_its_limit() {
    for (commanded, put_out) in [(900.0, 900.0), (2500.0, 1500.0), (-2500.0, -1500.0)] {
        let mut case = top(0.0, straight(100.0));
        case["drives"] = json!([{
            "name": "drive", "body": "top", "rotor": "spin", "armature_resistance": 0.15, "armature_inductance": 3e-3,
            "emf_constant": 0.4646, "field_current": 6.0, "armature_voltage": commanded, "armature_voltage_max": 1500.0,
            "gear_ratio": 0.25, "gear_sense": -1.0, "rotor_inertia": 1.5, "rotor_damping": 0.0,
            "transmission_stiffness": 2e5, "transmission_damping": 0.0 }]);
        let mut plant = Plant::new(&case);
        let x = plant.design_state();
        assert_eq!(x[plant.model.drives[0].state], 0.0);
        let armature = plant.model.dc_motors[0].state;
        assert_eq!(plant.rates(&x)[armature], put_out / 3e-3);
    }
}
