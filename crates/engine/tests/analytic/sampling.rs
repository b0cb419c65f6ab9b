//! Sampled controllers between steps: when commands reach the plant, whatever the step.
//! A controller on a body without wheels commands an actuator by the place along the track.

use crate::common::{bodies, channel, run, straight};
use serde_json::json;

/// What is measured at one sample is commanded from the next one on, so the delay does not depend on the step.
#[test]
fn commands_change_at_samples_only() {
    let mut case = bodies(
        0.0,
        straight(100.0),
        json!([
            { "name": "stand", "mass": 1e9, "inertia": [1e9, 1e9, 1e9], "position": [0.0, 0.0, -1.0] },
            { "name": "body", "mass": 1000.0, "inertia": [500.0, 500.0, 500.0], "position": [0.0, 0.0, -1.0] }
        ]),
    );
    case["actuators"] = json!([{ "name": "actuator", "joint": { "a": "stand", "b": "body", "point": [0.0, 0.0, -1.0] },
        "natural_frequency": 94.0, "damping_ratio": 0.7, "force_max": 2e4, "rate_max": 2e5, "stroke": 0.02,
        "stop_stiffness": 2e7 }]);
    case["control"] = json!({ "sample_time": 1e-3, "measurements": ["stand.s"],
        "blocks": [{ "kind": "sum", "name": "command", "terms": [{ "signal": "stand.s" }] }],
        "commands": [{ "target": "actuator.force", "signal": "command" }] });
    for per_sample in [1, 2, 4] {
        let step = 1e-3 / f64::from(per_sample);
        case["run"] = json!({ "duration": 0.02, "step": step, "record_interval": step, "equilibrium": false });
        let series = run(&case);
        let (s, command) = (channel(&series, "stand.s"), channel(&series, "actuator.command"));
        let every = per_sample as usize;
        for (k, &commanded) in command.iter().enumerate().skip(every) {
            let sampled = (k / every - 1) * every;
            assert_eq!(commanded, s[sampled], "step {step}: at step {k}");
        }
    }
}
