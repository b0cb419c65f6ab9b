//! Small specs for the analytic cases: one wheelset, one body, on simple tracks.
#![allow(dead_code)] // every test file uses its own part

use klingel_engine::spec::Spec;
use klingel_engine::{Progress, TimeSeries, simulate};
use serde_json::{Value, json};

pub fn straight(length: f64) -> Value {
    json!({ "segments": [{ "length": length, "curvature": [0.0, 0.0], "cant": [0.0, 0.0] }],
            "start": 5.0, "cant_base": 1.5 })
}

/// A solid wheelset of the Manchester coach on coned wheels or S1002, without any suspension.
pub fn wheelset(wheel: Value, track: Value, speed: f64, duration: f64) -> Value {
    json!({
        "name": "wheelset", "gravity": 9.81, "speed": speed, "track": track,
        "bodies": [{ "name": "wheelset", "mass": 1813.0, "inertia": [1120.0, 0.0, 1120.0],
                     "position": [0.0, 0.0, -0.46], "pitches": false,
                     "rotors": [{ "name": "spin", "inertia": 112.0 }] }],
        "contact_pairs": [{ "wheel": wheel, "rail": { "named": "60e1" }, "rail_inclination": 0.025,
                            "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }],
        "wheels": [
            { "name": "wheelset.left", "body": "wheelset", "rotor": "spin", "side": "left", "pair": 0, "friction": 0.35 },
            { "name": "wheelset.right", "body": "wheelset", "rotor": "spin", "side": "right", "pair": 0, "friction": 0.35 }
        ],
        "creep": { "law": "fastsim", "elements": [16, 16], "contact_dissipation": 3.0 },
        "run": { "duration": duration, "step": 0.0005, "record_interval": 0.001, "equilibrium": true }
    })
}

pub fn spec(value: &Value) -> Spec {
    serde_json::from_value(value.clone()).expect("a readable spec")
}

pub fn run(value: &Value) -> TimeSeries {
    simulate(&spec(value), &Progress::default()).expect("a run")
}

/// One channel over time.
pub fn channel(series: &TimeSeries, name: &str) -> Vec<f64> {
    let i = series.channels.iter().position(|c| c.0 == name).unwrap_or_else(|| panic!("no channel {name}"));
    series.rows.chunks(series.channels.len()).map(|row| row[i]).collect()
}
