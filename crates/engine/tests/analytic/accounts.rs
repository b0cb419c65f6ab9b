//! The energy account closes: in - out - growth of what is stored, on wheelsets and bodies, and better with the order of
//! the steps.

use crate::common::{bodies, channel, cone, run, straight, track, wheelset};
use serde_json::{Value, json};

/// Last value of `energy.<name>` \[J\].
fn booked(case: &Value, names: &[&str]) -> Vec<f64> {
    let mut case = case.clone();
    case["run"]["energy"] = json!(true);
    let series = run(&case);
    assert!(series.fault.is_none(), "{:?}", series.fault);
    names.iter().map(|name| *channel(&series, &format!("energy.{name}")).last().expect("a row")).collect()
}

/// A wheelset on soft springs under a body, kicked sideways on a curve with a cant ramp.
fn hunting(step: f64) -> Value {
    let mut case = wheelset(cone(0.05), 0.025, track(80.0, [0.0, 2e-3], [0.0, 0.05]), 20.0, 1.0);
    case["bodies"].as_array_mut().expect("bodies").push(json!(
        { "name": "frame", "mass": 2000.0, "inertia": [900.0, 1500.0, 1800.0], "position": [0.0, 0.0, -0.9] }));
    let joint = |y: f64| json!({ "a": "frame", "b": "wheelset", "point": [0.0, y, -0.46] });
    let spring = |(name, y): (&str, f64)| {
        json!({ "name": name, "joint": joint(y), "stiffness": [8e6, 4e6, 1e6], "damping": [1e3, 2e3, 1e4],
                "rotational_stiffness": [0.0, 2e5, 0.0], "rotational_damping": [0.0, 1e4, 0.0],
                "preload": [0.0, 0.0, 9810.0] })
    };
    let damper = |(name, y): (&str, f64)| {
        json!({ "name": name, "joint": joint(y), "axis": "y", "stiffness": 2e6, "damping": 1e4,
                "blow_off": { "force": 100.0, "damping": 2e3 } })
    };
    let sides = [("left", -1.0), ("right", 1.0)];
    case["bushings"] = sides.map(spring).to_vec().into();
    case["maxwells"] = sides.map(damper).to_vec().into();
    case["stops"] = json!([{ "name": "stop", "joint": joint(0.0), "axis": "y", "deflection": [0.0, 5e-4, 1e-2],
                             "force": [0.0, 0.0, 1e4] }]);
    case["creep"]["law"] = json!("polach");
    case["run"]["step"] = json!(step);
    case["run"]["record_interval"] = json!(1e-3);
    case["run"]["kicks"] = json!([{ "body": "wheelset", "velocity": [0.0, 0.1, 0.0] }]);
    case
}

#[test]
fn a_hunting_wheelset_closes_better_with_every_step() {
    let names = ["residual", "contact_friction", "suspension", "contact_damping", "rails"];
    let [coarse, fine] = [1e-3, 5e-4].map(|step| booked(&hunting(step), &names));
    let [friction, suspension, damping] = [coarse[1], coarse[2], coarse[3]];
    assert!(friction > 10.0 && suspension > 1.0 && damping > 0.0 && coarse[4] != 0.0, "{coarse:?}");
    assert!(coarse[0].abs() < 1e-3 * friction, "{coarse:?}");
    assert!(fine[0].abs() < 0.2 * coarse[0].abs(), "order two at least: {coarse:?} {fine:?}");
}

/// Rails that heave under the wheelset work on it, and the balance still closes.
#[test]
fn rails_that_move_give_their_work() {
    let mut case = hunting(5e-4);
    case["run"]["kicks"] = json!([]);
    let (wave, rate): (Vec<f64>, Vec<f64>) = (0..1000)
        .map(|k| 2.0 * std::f64::consts::PI * 4.0 * f64::from(k) * 1e-3)
        .map(|turn| (1e-3 * (1.0 - turn.cos()), 1e-3 * 8.0 * std::f64::consts::PI * turn.sin()))
        .unzip();
    let rail = |(side, part, values): (&str, &str, &Vec<f64>)| json!({ "input": format!("wheelset.{side}.{part}"), "interval": 1e-3, "values": values, "joined": true });
    case["run"]["excitations"] = [("left", "rail_z", &wave), ("left", "rail_z_rate", &rate)].map(rail).to_vec().into();
    let [residual, rails, suspension] = booked(&case, &["residual", "rails", "suspension"])[..] else { unreachable!() };
    assert!(rails > 5.0 && suspension > 5.0, "{rails} {suspension}");
    assert!(residual.abs() < 2e-3 * rails, "{residual} of {rails}");
}

/// Up a grade the weight takes m g sin(grade) a metre.
#[test]
fn a_grade_takes_the_weight_along_it() {
    let mut uphill = straight(60.0);
    uphill["segments"][0]["grade"] = json!([0.02, 0.02]);
    let case = wheelset(json!({ "cone": 0.025 }), 0.025, uphill, 15.0, 1.0);
    let names = ["residual", "gradient", "kinetic"];
    let [residual, gradient, kinetic] = booked(&case, &names)[..] else { unreachable!() };
    let way = 15.0 - 0.5 * 9.81 * 0.02 * 0.77;
    assert!((gradient / (-1813.0 * 9.81 * 0.02 * way) - 1.0).abs() < 1e-3, "{gradient}");
    assert!((kinetic / gradient - 1.0).abs() < 0.02, "{kinetic} {gradient}");
    assert!(residual.abs() < 1e-5 * gradient.abs(), "{residual}");
}

/// Wind on a body and what it takes from the wind: all of it becomes motion.
#[test]
fn wind_becomes_motion_and_drag_stops_it() {
    let mut case = bodies(
        0.0,
        straight(100.0),
        json!([{ "name": "block", "mass": 1000.0, "inertia": [200.0, 300.0, 400.0], "position": [0.0, 0.0, -1.0] }]),
    );
    case["drag"] = json!({ "body": "block", "coefficients": [50.0, 4.0, 2.0], "headwind": 5.0 });
    case["run"]["excitations"] = json!([{ "input": "wind.y", "interval": 0.5, "values": [300.0, -100.0] },
                                        { "input": "wind.roll", "interval": 0.5, "values": [20.0, 20.0] }]);
    let names = ["residual", "wind", "running_resistance", "kinetic"];
    let [residual, wind, drag, kinetic] = booked(&case, &names)[..] else { unreachable!() };
    // y: 0.15 m/s, then back to 0.1 m/s; roll: 0.1 rad/s
    assert!((wind - (0.5 * 1000.0 * 0.01 + 0.5 * 200.0 * 0.01)).abs() < 1e-6, "{wind}");
    assert!(drag > 5000.0 && (kinetic + drag - wind).abs() < 1e-6, "{drag} {kinetic}");
    assert!(residual.abs() < 1e-6, "{residual}");
}

/// A rig that keeps the speed of a body gives what its drag takes.
#[test]
fn a_guide_gives_what_drag_takes() {
    let mut case = wheelset(json!({ "cone": 0.025 }), 0.025, straight(60.0), 15.0, 1.0);
    case["bodies"][0]["guided"] = json!(["x"]);
    case["drag"] = json!({ "body": "wheelset", "coefficients": [0.0, 100.0, 0.0] });
    let [residual, guides, drag] = booked(&case, &["residual", "guides", "running_resistance"])[..] else {
        unreachable!()
    };
    assert!((drag - 100.0 * 15.0 * 15.0).abs() < 1e-6 && (guides / drag - 1.0).abs() < 1e-3, "{guides} {drag}");
    assert!(residual.abs() < 1e-5 * drag, "{residual}");
}
