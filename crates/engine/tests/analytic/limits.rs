//! Elements with limits inside a moving body: bump stop, blow-off damper, actuator at the end of its stroke.
//! One body moves along y against a stand too heavy to move, without gravity.

use crate::common::{Plant, bodies, straight};
use serde_json::{Value, json};

const MASS: f64 = 1000.0;

fn against_a_stand() -> Value {
    bodies(
        0.0,
        straight(100.0),
        json!([
            { "name": "stand", "mass": 1e15, "inertia": [1e15, 1e15, 1e15], "position": [0.0, 0.0, -1.0] },
            { "name": "body", "mass": MASS, "inertia": [500.0, 500.0, 500.0], "position": [0.0, 0.0, -1.0] }
        ]),
    )
}

fn joint() -> Value {
    json!({ "a": "stand", "b": "body", "point": [0.0, 0.0, -1.0] })
}

/// m v^2/2 = area under the stop's curve, beyond its last point along the last slope; it comes back as fast as it went.
#[test]
fn a_bump_stop_takes_the_energy_and_gives_it_back() {
    let mut case = against_a_stand();
    case["stops"] = json!([{ "name": "stop", "joint": joint(), "axis": "y",
        "deflection": [0.0, 0.02, 0.03, 0.035], "force": [0.0, 0.0, 5e3, 1e4] }]);
    for hand in [1.0, -1.0] {
        let mut plant = Plant::new(&case);
        let mut x = plant.design_state();
        let (y, v) = (plant.state("body.y"), plant.state("body.vy"));
        x[v] = hand * 0.5;
        let mut furthest = 0.0_f64;
        plant.advance(&mut x, 5e-5, 4000, |_, x| furthest = furthest.max(hand * x[y]));
        // 25 J to 30 mm, 37.5 J to 35 mm, then 1e4 u + 1e6 u^2/2
        let left: f64 = 0.5 * MASS * 0.25 - 25.0 - 37.5;
        let beyond = (-1e4 + (1e8 + 2e6 * left).sqrt()) / 1e6;
        assert!((furthest - (0.035 + beyond)).abs() < 1e-6, "{furthest} for {}", 0.035 + beyond);
        // steps across the corners of the curve are of first order there
        assert!((x[v] + hand * 0.5).abs() < 1e-5, "{}", x[v]);
    }
}

/// The energy of mass and spring in series falls by exactly what the damper takes, F v(F), below and above blow-off.
#[test]
fn a_blow_off_damper_dissipates_what_it_takes() {
    let mut case = against_a_stand();
    case["maxwells"] = json!([{ "name": "damper", "joint": joint(), "axis": "y", "stiffness": 4e6, "damping": 1e5,
        "blow_off": { "force": 8e3, "damping": 1e4 } }]);
    let mut plant = Plant::new(&case);
    let mut x = plant.design_state();
    let (v, f) = (plant.state("body.vy"), plant.state("damper.force"));
    x[v] = 0.4;
    let law = plant.model.maxwells[0].law;
    let stored = |x: &[f64]| 0.5 * MASS * x[v] * x[v] + 0.5 * x[f] * x[f] / 4e6;
    let step = 2e-5;
    let (start, mut taken, mut last, mut power, mut peak) = (stored(&x), 0.0, f64::INFINITY, None, 0.0_f64);
    plant.advance(&mut x, step, 10_000, |_, x| {
        let now = x[f] * law.velocity(x[f]);
        taken += 0.5 * step * (now + power.unwrap_or(now));
        power = Some(now);
        peak = peak.max(x[f].abs());
        assert!(stored(x) <= last, "energy falls at every step");
        last = stored(x);
    });
    assert!(peak > 8e3, "the valve opened at {peak} N");
    assert!(last < 1e-3 * start);
    // the trapezoidal sum over steps of 20 us
    assert!(((start - last) / taken - 1.0).abs() < 1e-4, "{} J of {} J", taken, start - last);
}

/// Pushed by its full force against a soft spring and a damper, the actuator comes to rest on its stop:
/// force = spring (stroke + d) + stop d.
#[test]
fn an_actuator_rests_on_its_stop() {
    let mut case = against_a_stand();
    case["actuators"] = json!([{ "name": "actuator", "joint": joint(), "natural_frequency": 94.0, "damping_ratio": 0.7,
        "force_max": 2e4, "rate_max": 2e5, "stroke": 0.02, "stop_stiffness": 2e7 }]);
    case["bushings"] = json!([{ "name": "spring", "joint": joint(), "stiffness": [2e5, 1e5, 1e5],
        "damping": [3e4, 1e4, 1e4] }]);
    for command in [2e4, -2e4, 3e3] {
        let mut plant = Plant::new(&case);
        plant.model.inputs[0] = command;
        let mut x = plant.design_state();
        plant.advance(&mut x, 5e-4, 8000, |_, _| ());
        plant.rates(&x);
        let stroke = plant.work.joints[0].u.x();
        let free: f64 = command / 2e5;
        let expected =
            if free.abs() < 0.02 { free } else { (0.02 + (2e4 - 2e5 * 0.02) / (2e5 + 2e7)) * command.signum() };
        assert!((stroke - expected).abs() < 1e-7, "{stroke} for {expected}");
    }
}
