//! The travelling track frame does no work of its own: a force-free body flies straight over curves and ramp kinks,
//! and one on very soft springs keeps its absolute velocity where a cant ramp begins.

use crate::common::{Plant, bodies, wheels};
use klingel_physics::math::Vec3;
use serde_json::{Value, json};

/// Straight, clothoid with cant ramp, arc, and back: four kinks of curvature and twist.
fn kinked() -> Value {
    let segment = |length: f64, curvature: [f64; 2], cant: [f64; 2]| json!({ "length": length, "curvature": curvature, "cant": cant });
    let (k, h) = (1.0 / 300.0, 0.16);
    json!({ "start": 5.0, "cant_base": 1.5, "segments": [
        segment(20.0, [0.0, 0.0], [0.0, 0.0]), segment(40.0, [0.0, k], [0.0, h]), segment(20.0, [k, k], [h, h]),
        segment(40.0, [k, 0.0], [h, 0.0]), segment(60.0, [0.0, 0.0], [0.0, 0.0]) ] })
}

#[test]
fn a_free_body_flies_straight_over_kinks() {
    let case = bodies(
        0.0,
        kinked(),
        json!([{ "name": "stone", "mass": 10.0, "inertia": [2.0, 2.0, 2.0], "position": [0.0, 0.0, -1.0] }]),
    );
    let mut plant = Plant::new(&case);
    let mut x = plant.design_state();
    x[9..12].copy_from_slice(&[0.1, -0.2, 0.15]);
    let (mut time, mut start) = (0.0, None);
    plant.advance(&mut x, 5e-4, 24_000, |plant, x| {
        plant.rates(x);
        let body = &plant.work.motions[0];
        let (p0, v0, w0) = *start.get_or_insert((body.p_W, body.v_W, body.w_W));
        // a step across a kink is of first order only: twist jumps by 3e-3 rad/m, over 5 mm of way
        assert!((body.v_W - v0).norm() < 2e-5, "{:?} at {time} s", body.v_W);
        assert!((body.w_W - w0).norm() < 1e-5, "{:?} at {time} s", body.w_W);
        assert!((body.p_W - (p0 + v0 * time)).norm() < 1e-4, "{:?} at {time} s", body.p_W);
        time += 5e-4;
    });
    let gone = plant.work.motions[0].p_W - Vec3::new(5.0, 0.0, -1.0);
    assert!((gone.x() - 120.0).abs() < 1e-4 && gone.y().abs() < 1e-4, "{gone:?}");
}

/// A body of 30 t on 100 N/m springs rides a wheelset into a 1:250 cant ramp at 30 m/s: track and wheelset begin to roll
/// at twist V = 0.08 rad/s. The body feels only the slowly tilting preload, g twist V t, so it gains g twist V t^2/2 =
/// 0.39 t^2; a formulation by second derivatives of the track would give it 1.8 m x 0.08 rad/s = 0.14 m/s at once.
#[test]
fn a_soft_body_keeps_its_velocity_where_the_cant_begins() {
    let mut case = bodies(
        9.81,
        json!({ "start": 5.0, "cant_base": 1.5, "segments": [
            { "length": 8.0, "curvature": [0.0, 0.0], "cant": [0.0, 0.0] },
            { "length": 40.0, "curvature": [0.0, 0.0], "cant": [0.0, 0.16] } ] }),
        json!([
            { "name": "wheelset", "mass": 1813.0, "inertia": [1120.0, 0.0, 1120.0], "position": [0.0, 0.0, -0.46],
              "pitches": false, "rotors": [{ "name": "spin", "inertia": 112.0 }] },
            { "name": "body", "mass": 30e3, "inertia": [5e4, 1e6, 1e6], "position": [0.0, 0.0, -1.8] }
        ]),
    );
    case["speed"] = json!(30.0);
    case["contact_pairs"] = json!([{ "wheel": { "named": "s1002" }, "rail": { "named": "60e1" },
        "rail_inclination": 0.025, "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }]);
    case["wheels"] = wheels("wheelset", ["spin", "spin"]);
    case["bushings"] = json!([{ "name": "spring", "stiffness": [1e5, 100.0, 100.0],
        "rotational_stiffness": [1e3, 1e3, 1e3], "preload": [0.0, 0.0, -30e3 * 9.81],
        "joint": { "a": "wheelset", "b": "body", "point": [0.0, 0.0, -1.8] } }]);
    let mut plant = Plant::new(&case);
    let mut x = plant.equilibrium();
    let (kink, speed) = (8.0, 30.0);
    let mut before = Vec3::zero();
    plant.advance(&mut x, 2.5e-4, 480, |plant, x| {
        plant.rates(x);
        let body = &plant.work.motions[1];
        let since = (x[plant.model.bodies[1].state] - kink) / speed;
        if since < 0.0 {
            before = body.v_W;
        } else {
            let gained = body.v_W - before;
            assert!(gained.norm() < 0.45 * since * since + 1e-5, "{gained:?} after {since} s");
        }
    });
}
