//! A single wheelset against what is known of it in closed form.

mod common;
use common::{channel, run, straight, wheelset};
use serde_json::json;

#[test]
fn static_loads_are_the_weight() {
    let series = run(&wheelset(json!({ "named": "s1002" }), straight(100.0), 10.0, 0.05));
    assert!(series.fault.is_none(), "{:?}", series.fault);
    let total: f64 = series.static_wheel_loads.iter().map(|l| l.1).sum();
    assert!((total - 1813.0 * 9.81).abs() < 1e-3, "{total}");
    let y = channel(&series, "wheelset.y");
    assert!(y.iter().all(|y| y.abs() < 1e-9), "starts without a jolt");
}
