//! A short vehicle with every element, joint and drive that the engine knows, for tests over all of them at once:
//! a body, a frame, a solid wheelset in front and an axle bridge with two driven wheels behind.

use crate::common::{Plant, Random, bodies, wheels};
use serde_json::{Value, json};

/// Straight, clothoid with cant ramp, arc: the vehicle starts on the ramp, where every term of the track is alive.
fn ramp(hand: f64) -> Value {
    let (k, h) = (hand / 400.0, hand * 0.12);
    json!({ "start": 40.0, "cant_base": 1.5, "segments": [
        { "length": 20.0, "curvature": [0.0, 0.0], "cant": [0.0, 0.0] },
        { "length": 60.0, "curvature": [0.0, k], "cant": [0.0, h] },
        { "length": 200.0, "curvature": [k, k], "cant": [h, h] } ] })
}

fn joint(a: &str, b: &str, point: [f64; 3]) -> Value {
    json!({ "a": a, "b": b, "point": point })
}

/// The vehicle at 25 m/s; `law` is the creep law, `hand` +1 for a right-hand curve.
pub fn bogie(law: &str, hand: f64) -> Value {
    let mut case = bodies(
        9.81,
        ramp(hand),
        json!([
            { "name": "body", "mass": 16e3, "inertia": [2.8e4, 9e4, 9e4], "position": [0.0, 0.0, -1.8] },
            { "name": "frame", "mass": 2600.0, "inertia": [1700.0, 1500.0, 3100.0], "position": [0.0, 0.0, -0.6] },
            { "name": "front", "mass": 1813.0, "inertia": [1120.0, 0.0, 1120.0], "position": [1.28, 0.0, -0.46],
              "pitches": false, "rotors": [{ "name": "spin", "inertia": 112.0 }] },
            { "name": "rear", "mass": 2600.0, "inertia": [1400.0, 180.0, 1450.0], "position": [-1.28, 0.0, -0.46],
              "rotors": [{ "name": "left", "inertia": 56.0 }, { "name": "right", "inertia": 56.0 }] }
        ]),
    );
    case["speed"] = json!(25.0);
    case["contact_pairs"] = json!([{ "wheel": { "named": "s1002" }, "rail": { "named": "60e1" },
        "rail_inclination": 0.025, "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }]);
    let solid = wheels("front", ["spin", "spin"]);
    let free = wheels("rear", ["left", "right"]);
    case["wheels"] = [solid, free].iter().flat_map(|w| w.as_array().expect("wheels").clone()).collect();
    case["creep"] = json!({ "law": law, "elements": [8, 8], "contact_dissipation": 3.0 });
    let (mut bushings, mut maxwells, mut stops) = (Vec::new(), Vec::new(), Vec::new());
    let load = |masses: f64, share: f64| [0.0, 0.0, -masses * 9.81 * share];
    for (side, y) in [("left", -1.0), ("right", 1.0)] {
        for (axle, x) in [("front", 1.28), ("rear", -1.28)] {
            bushings
                .push(json!({ "name": format!("{axle}.primary_{side}"), "joint": joint(axle, "frame", [x, y, -0.46]),
                "stiffness": [2e6, 2e6, 6e5], "damping": [1e4, 1e4, 1e4], "preload": load(18_600.0, 0.25) }));
            maxwells.push(json!({ "name": format!("{axle}.primary_damper_{side}"), "axis": "z", "stiffness": 1e6,
                "joint": joint(axle, "frame", [x, y, -0.46]), "damping": 4e3 }));
        }
        bushings.push(json!({ "name": format!("secondary_{side}"), "joint": joint("frame", "body", [0.0, y, -1.0]),
            "stiffness": [1.6e5, 1.6e5, 4.3e5], "damping": [2e4, 2e4, 2e4], "rotational_stiffness": [1e4, 3e6, 1e5],
            "rotational_damping": [0.0, 1e5, 1e3], "preload": load(16e3, 0.5) }));
        maxwells
            .push(json!({ "name": format!("yaw_damper_{side}"), "joint": joint("frame", "body", [0.0, 1.3 * y, -0.7]),
            "axis": "x", "stiffness": 8e6, "damping": 2e5, "blow_off": { "force": 300.0, "damping": 1e4 } }));
        stops.push(json!({ "name": format!("lateral_stop_{side}"), "joint": joint("frame", "body", [0.0, y, -0.9]),
            "axis": "y", "deflection": [0.0, 0.002, 0.01], "force": [0.0, 500.0, 2e4] }));
    }
    bushings.push(json!({ "name": "torque_link", "joint": joint("rear", "frame", [-0.6, 0.0, -0.46]),
        "stiffness": [0.0, 0.0, 5e6], "damping": [0.0, 0.0, 5e3] }));
    (case["bushings"], case["maxwells"], case["stops"]) = (json!(bushings), json!(maxwells), json!(stops));
    case["actuators"] = ["left", "right"]
        .iter()
        .zip([-1.0, 1.0])
        .map(|(side, y)| {
            json!({ "name": format!("rear.actuator_{side}"), "joint": joint("rear", "frame", [-1.28, y, -0.46]),
                "natural_frequency": 94.0, "damping_ratio": 0.7, "force_max": 2e4, "rate_max": 2e5, "stroke": 0.0005,
                "stop_stiffness": 2e7 })
        })
        .collect();
    case["drives"] = [("left", 1.0), ("right", -1.0)]
        .iter()
        .map(|(side, sense)| {
            json!({ "name": format!("rear.{side}"), "body": "rear", "rotor": side, "armature_resistance": 0.15,
                "armature_inductance": 3e-3, "emf_constant": 0.4646, "field_current": 6.0, "armature_voltage": 500.0,
                "armature_voltage_max": 1500.0, "gear_ratio": 1.0 / 3.0, "gear_sense": sense, "rotor_inertia": 1.5,
                "rotor_damping": 0.02, "transmission_stiffness": 2e5, "transmission_damping": 300.0 })
        })
        .collect();
    case["drag"] = json!({ "body": "body", "coefficients": [500.0, 20.0, 2.0] });
    case["hold"] = json!({ "body": "body", "proportional": 2e4, "integral": 2e3 });
    case
}

/// A state near the equilibrium: wheels within the table, everything else by millimetres, milliradians and decimetres
/// a second, forces by kilonewtons.
pub fn near(plant: &Plant, x: &[f64], random: &mut Random) -> Vec<f64> {
    let mut x = x.to_vec();
    for (value, name) in x.iter_mut().zip(&plant.model.state_names) {
        let (body, state) = name.rsplit_once('.').unwrap_or(("", name));
        let railed = matches!(body, "front" | "rear");
        let size = match state {
            "y" if railed => 2e-3,
            "z" if railed => 1e-5,
            "roll" if railed => 2e-5,
            "yaw" if railed => 2e-3,
            "y" | "z" | "roll" | "pitch" | "yaw" => 5e-3,
            "vx" | "vy" | "vz" | "wx" | "wy" | "wz" => 0.02,
            "spin_speed" => 0.1,
            "force" => 500.0,
            _ => 0.0,
        };
        *value += size * random.next();
    }
    x
}

#[test]
fn the_vehicle_stands_on_its_wheels() {
    let mut plant = Plant::new(&bogie("linear", 1.0));
    let x = plant.equilibrium();
    plant.rates(&x);
    let carried: f64 = plant.work.wheels.iter().map(|w| -w.force_T.z()).sum();
    let weight = 9.81 * plant.model.bodies.iter().map(|b| b.mass).sum::<f64>();
    // on the ramp the weight is tilted and the curve presses: within some percent
    assert!((carried / weight - 1.0).abs() < 0.05, "{carried} N of {weight} N");
}
