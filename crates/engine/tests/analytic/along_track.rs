//! What a place along the track brings: grade, friction of each rail; and the wind against the vehicle.

use crate::common::{Plant, bodies, channel, run, straight, wheelset};
use serde_json::{Value, json};

const GRADE: f64 = 0.02;
/// Along the track, of a weight of one, on that grade.
const DOWN: f64 = GRADE / 1.000_199_980_003_999; // the root of 1 + 0.02^2

fn uphill(length: f64) -> Value {
    let mut track = straight(length);
    track["segments"][0]["grade"] = json!([GRADE, GRADE]);
    track
}

fn block(track: Value) -> Value {
    bodies(
        9.81,
        track,
        json!([{ "name": "block", "mass": 1000.0, "inertia": [200.0, 300.0, 400.0], "position": [0.0, 0.0, -1.0] }]),
    )
}

#[test]
fn a_body_on_a_grade_is_pulled_back_by_its_weight() {
    let mut plant = Plant::new(&block(uphill(100.0)));
    let x = plant.design_state();
    let rates = plant.rates(&x);
    assert!((rates[6] + 9.81 * DOWN).abs() < 1e-12, "{}", rates[6]);
    assert!((rates[6].hypot(rates[8]) - 9.81).abs() < 1e-12);
}

/// A rolling wheelset loses g sin(grade) m / (m + J/r^2) a second.
#[test]
fn a_wheelset_rolls_up_a_grade_and_slows_down() {
    let mut case = wheelset(json!({ "cone": 0.025 }), 0.025, uphill(60.0), 15.0, 1.0);
    case["run"]["equilibrium"] = json!(false);
    let speed = channel(&run(&case), "wheelset.speed");
    let (last, mass, spin) = (speed[speed.len() - 1], 1813.0, 112.0 / 0.46 / 0.46);
    let expected = -9.81 * DOWN * mass / (mass + spin);
    assert!(((last - 15.0) / expected - 1.0).abs() < 0.01, "{} {expected}", last - 15.0);
}

#[test]
fn friction_follows_the_place_of_each_wheel() {
    let mut case = wheelset(json!({ "named": "s1002" }), 0.025, straight(60.0), 20.0, 1.0);
    case["adhesion"] = json!({ "s": [10.0, 15.0], "left": [0.4, 0.1], "right": [0.3, 0.3] });
    let series = run(&case);
    let at = channel(&series, "wheelset.s");
    let [left, right] = ["left", "right"].map(|side| channel(&series, &format!("wheelset.{side}.friction")));
    for i in 0..at.len() {
        let line = 0.4 - 0.3 * ((at[i] - 10.0) / 5.0).clamp(0.0, 1.0);
        assert!((left[i] - line).abs() < 1e-12 && right[i] == 0.3);
    }
    assert!(left[0] == 0.4 && left[left.len() - 1] == 0.1);
}

/// A wheel that turns too slowly brakes: its creepage is positive, and what it does on the rail is not more than friction.
#[test]
fn less_friction_brakes_less() {
    let braked = |friction: f64| {
        let mut case = wheelset(json!({ "cone": 0.025 }), 0.025, straight(60.0), 20.0, 1.0);
        case["adhesion"] = json!({ "s": [0.0], "left": [friction], "right": [friction] });
        let mut plant = Plant::new(&case);
        let mut x = plant.equilibrium();
        let spin = plant.state("wheelset.spin.spin_speed");
        x[spin] *= 0.98;
        plant.rates(&x);
        let wheel = plant.work.wheels[0];
        assert!((wheel.creep_x - 0.02).abs() < 1e-3, "{}", wheel.creep_x);
        -wheel.force_T.x() / -wheel.force_T.z()
    };
    for friction in [0.05, 0.3] {
        let used = braked(friction) / friction;
        assert!(used > 0.95 && used < 1.0 + 1e-3, "{used}");
    }
}

#[test]
fn a_headwind_adds_to_the_speed_through_the_air() {
    let slowing = |headwind: f64| {
        let mut case = block(straight(100.0));
        case["drag"] = json!({ "body": "block", "coefficients": [50.0, 4.0, 2.0], "headwind": headwind });
        let mut plant = Plant::new(&case);
        let x = plant.design_state();
        -1000.0 * plant.rates(&x)[6]
    };
    assert!((slowing(0.0) - (50.0 + 40.0 + 200.0)).abs() < 1e-4);
    assert!((slowing(5.0) - slowing(0.0) - 2.0 * (15.0 * 15.0 - 100.0)).abs() < 1e-9);
    assert!((slowing(-20.0) - slowing(0.0) + 2.0 * (100.0 + 100.0)).abs() < 1e-9, "the wind pushes");
}
