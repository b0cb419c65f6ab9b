//! Motors on a wheelset that a guide keeps as on a roller rig: moved fields, induction motors, limits, what is guided.
//! The laws themselves are tested in `klingel_physics`.

use crate::common::{Plant, cone, run, straight, wheels};
use klingel_engine::{Spec, compile};
use serde_json::{Value, json};

/// An axle bridge on coned wheels at 30 m/s, everything guided but up and down, with a DC drive on each wheel.
fn rig(field: Value) -> Value {
    let drive = |side: &str| {
        json!({ "name": format!("axle.{side}"), "body": "axle", "rotor": side, "armature_resistance": 0.15,
            "armature_inductance": 3e-3, "emf_constant": 0.4646, "field_current": 6.0, "field": field,
            "armature_voltage": 560.0, "armature_voltage_max": 1000.0, "gear_ratio": 1.0 / 3.0, "gear_sense": -1.0,
            "rotor_inertia": 1.0, "rotor_damping": 0.02, "transmission_stiffness": 1e6, "transmission_damping": 300.0 })
    };
    json!({
        "name": "rig", "gravity": 9.81, "speed": 30.0, "track": straight(500.0),
        "bodies": [{ "name": "axle", "mass": 11000.0, "inertia": [1194.0, 60.0, 1194.0], "position": [0.0, 0.0, -0.46],
                     "guided": ["x", "y", "roll", "pitch", "yaw"],
                     "rotors": [{ "name": "left", "inertia": 45.0 }, { "name": "right", "inertia": 45.0 }] }],
        "contact_pairs": [{ "wheel": cone(0.05), "rail": { "named": "60e1" }, "rail_inclination": 0.025,
                            "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }],
        "wheels": wheels("axle", ["left", "right"]),
        "creep": { "law": "linear", "elements": [10, 10], "contact_dissipation": 3.0 },
        "drives": [drive("left"), drive("right")],
        "run": { "duration": 1.0, "step": 0.0005, "record_interval": 0.001, "equilibrium": true }
    })
}

/// The same with induction motors.
pub fn induction(command: f64) -> Value {
    let mut case = rig(Value::Null);
    case["drives"] = json!([]);
    case["induction_drives"] = ["left", "right"].iter().map(|side| induction_drive("axle", side, command)).collect();
    case
}

/// An induction drive of 160 kW on a rotor of a body.
pub fn induction_drive(body: &str, side: &str, command: f64) -> Value {
    json!({ "name": format!("{body}.{side}"), "body": body, "rotor": side,
        "motor": { "stator_resistance": 0.08167, "rotor_resistance": 0.08281, "stator_leakage": 1.655e-3,
                   "rotor_leakage": 1.511e-3, "magnetizing_inductance": 38.36e-3, "pole_pairs": 2.0 },
        "control": { "torque_bandwidth": 500.0, "flux_bandwidth": 10.0, "flux_rated": 1.943, "current_max": 250.0,
                     "voltage_max": 955.0, "flux_share": 0.85 },
        "torque_command": command,
        "transmission": { "gear_ratio": 1.0 / 3.0, "gear_sense": -1.0, "rotor_inertia": 1.0, "rotor_damping": 0.02,
                          "transmission_stiffness": 1e6, "transmission_damping": 300.0 } })
}

fn field(voltage_max: f64) -> Value {
    json!({ "resistance": 20.0, "inductance": 12.0, "voltage_max": voltage_max })
}

fn last(case: &Value, channel: &str) -> f64 {
    *crate::common::channel(&run(case), channel).last().expect("a row")
}

/// Adds a value to an input from the start on.
fn excited(mut case: Value, input: &str, value: f64) -> Value {
    case["run"]["excitations"] = json!([{ "input": input, "interval": 5.0, "values": [value] }]);
    case
}

#[test]
fn a_field_that_could_move_but_rests_changes_nothing() {
    let (held, moved) = (run(&rig(Value::Null)), run(&rig(field(300.0))));
    for name in ["axle.left.armature_current", "axle.right.shaft_torque", "axle.left.spin_speed", "axle.left.X"] {
        let (a, b) = (crate::common::channel(&held, name), crate::common::channel(&moved, name));
        let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9 * a[0].abs(), "{name}: {apart}");
    }
}

/// If rises by dVf/Rf (1 - exp(-t Rf/Lf)); the torque follows the weaker or stronger field.
#[test]
fn the_field_current_follows_its_voltage_within_the_limit() {
    let settled = 1.0 - (-20.0 / 12.0_f64).exp();
    for (added, put_out) in [(40.0, 160.0), (500.0, 300.0), (-500.0, -300.0)] {
        let case = excited(rig(field(300.0)), "axle.left.field_voltage", added);
        let expected = 6.0 + (put_out / 20.0 - 6.0) * settled;
        assert!((last(&case, "axle.left.field_current") - expected).abs() < 1e-9);
        assert_eq!(last(&case, "axle.left.field_voltage"), put_out);
        assert_eq!(last(&case, "axle.right.field_current"), 6.0);
    }
}

#[test]
fn only_what_is_free_moves_on_the_rig() {
    let case = excited(rig(Value::Null), "axle.left.armature_voltage", 80.0);
    let series = run(&case);
    for (name, kept) in [("y", 0.0), ("roll", 0.0), ("pitch", 0.0), ("yaw", 0.0), ("speed", 30.0)] {
        let values = crate::common::channel(&series, &format!("axle.{name}"));
        assert!(values.iter().all(|&v| v == kept), "{name}");
    }
    let change = |side: &str| {
        let spin = crate::common::channel(&series, &format!("axle.{side}.spin_speed"));
        spin[spin.len() - 1] - spin[0]
    };
    assert!(change("left") > 1e-3, "the excited wheel turns faster: {}", change("left"));
    assert!(change("right").abs() < 1e-5 * change("left"), "the other does not feel it: {}", change("right"));
}

#[test]
fn guides_are_refused_where_they_make_no_sense() {
    let refused = |case: Value, word: &str| {
        let spec: Spec = serde_json::from_value(case).expect("a readable spec");
        let message = compile(&spec).expect_err("a refusal").to_string();
        assert!(message.contains(word), "{message}");
    };
    let mut unknown = rig(Value::Null);
    unknown["bodies"][0]["guided"] = json!(["sideways"]);
    refused(unknown, "sideways");
    let mut curved = rig(Value::Null);
    curved["track"] = json!({ "start": 0.0, "cant_base": 1.5, "uniform": { "curvature": 0.001, "cant": 0.0 } });
    refused(curved, "straight level track");
}

/// A step of the torque command arrives at the air gap with one pole of 500 1/s, at the wheel side of the gear.
#[test]
fn an_induction_motor_gives_the_torque_it_is_told() {
    let mut case = excited(induction(100.0), "axle.left.torque_command", 300.0);
    case["run"]["duration"] = json!(0.01);
    let series = run(&case);
    let torque = crate::common::channel(&series, "axle.left.air_gap_torque");
    for (&t, &found) in series.time.iter().zip(&torque) {
        let exact = 100.0 + 300.0 * (1.0 - (-500.0 * t).exp());
        assert!((found - exact).abs() < 0.5, "{found} for {exact} at {t}");
    }
    assert!((crate::common::channel(&series, "axle.right.air_gap_torque")[10] - 100.0).abs() < 1e-6);
    let voltage = crate::common::channel(&series, "axle.left.stator_voltage");
    assert!(voltage.iter().all(|&v| v > 700.0 && v <= 955.1), "{voltage:?}");
    assert!((last(&case, "axle.left.rotor_flux") - 1.943).abs() < 0.01);
}

/// Twenty times what it can give: the limits hold and the wheel keeps turning.
#[test]
fn an_induction_motor_gives_no_more_than_it_has() {
    let case = excited(induction(100.0), "axle.left.torque_command", 1e5);
    let series = run(&case);
    let of = |name: &str| crate::common::channel(&series, &format!("axle.left.{name}"));
    let current = of("current_d").iter().zip(of("current_q")).map(|(d, q)| d.hypot(q)).fold(0.0, f64::max);
    assert!(current < 251.0 && current > 240.0, "{current}");
    assert!(of("stator_voltage").iter().all(|&v| v <= 955.1));
    let torque = *of("air_gap_torque").last().expect("a row");
    assert!(torque > 3500.0 && torque < 4200.0, "{torque}");
}

/// Steady states of the drives: everything rests, also where the control takes the motor for another.
#[test]
fn an_induction_drive_settles_whatever_its_control_believes() {
    let mut case = induction(250.0);
    let plant = Plant::new(&case);
    let matched = plant.equilibrium();
    assert!(matched[plant.state("axle.left.rotor_flux_q")].abs() < 1e-9);
    case["induction_drives"][0]["motor"]["rotor_resistance"] = json!(0.1);
    case["induction_drives"][0]["control"]["model"] = case["induction_drives"][1]["motor"].clone();
    let mut plant = Plant::new(&case);
    let x = plant.equilibrium();
    assert!(x[plant.state("axle.left.rotor_flux_q")].abs() > 1e-3);
    assert!(plant.rates(&x).iter().skip(12).all(|r| r.abs() < 1e-6));
}
