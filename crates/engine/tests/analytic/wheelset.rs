//! A single wheelset without suspension: its weight, Klingel's wave, the free rolling line of a curve.
//! The derivations are in docs/theory/wheelset.md.

use crate::common::{Plant, channel, cone, run, spec, straight, track, wheelset};
use klingel_engine::compile;
use serde_json::{Value, json};

/// Slope of the coned wheel; the rail leans in by as much, so it is touched on its 300 mm arc.
const CONE: f64 = 0.05;
/// Radius of the middle arc of a 60E1 head \[m\].
const RAIL: f64 = 0.3;

fn coned(track: Value, speed: f64, duration: f64) -> Value {
    let mut case = wheelset(cone(CONE), CONE, track, speed, duration);
    // brings the tape circles over the middle of the rails
    case["contact_pairs"][0]["flange_back"] = json!(1.379);
    case
}

/// Half distance of the contacts and rolling radius of the centred wheelset \[m\].
fn contacts(plant: &Plant) -> (f64, f64) {
    let wheel = &plant.model.wheels[1];
    let depth = plant.depth_under(0.5 * 1813.0 * 9.81);
    let patch = wheel.table.patches(0.0, depth, 0.0, 0.0).expect("contact")[0];
    (wheel.half_tape_distance + patch.y_wheel, patch.radius)
}

#[test]
fn static_loads_are_the_weight() {
    let series = run(&wheelset(json!({ "named": "s1002" }), 0.025, straight(100.0), 10.0, 0.05));
    assert!(series.fault.is_none(), "{:?}", series.fault);
    let total: f64 = series.static_wheel_loads.iter().map(|l| l.1).sum();
    assert!((total - 1813.0 * 9.81).abs() < 1e-3, "{total}");
    let y = channel(&series, "wheelset.y");
    assert!(y.iter().all(|y| y.abs() < 1e-9), "starts without a jolt");
}

/// L = 2 pi sqrt(b r0 / gamma), gamma = cone (1 + RAIL cone / b), as the speed goes to zero.
///
/// 2e-4: at 5 m/s inertia shortens or lengthens the wave by some 1e-5; the tilt of the loads and the spin forces, which
/// nearly cancel each other, stay below 1e-4 of the creep forces.
#[test]
fn klingels_wave_has_its_length() {
    let mut case = coned(straight(80.0), 5.0, 14.0);
    case["run"]["kicks"] = json!([{ "body": "wheelset", "rotation": [0.0, 0.0, 0.0005] }]);
    let (b, r0) = contacts(&Plant::new(&case));
    let conicity = CONE * (1.0 + RAIL * CONE / b);
    let expected = 2.0 * core::f64::consts::PI * (b * r0 / conicity).sqrt();
    for law in ["linear", "fastsim", "table"] {
        case["creep"]["law"] = json!(law);
        let series = run(&case);
        let (s, y) = (channel(&series, "wheelset.s"), channel(&series, "wheelset.y"));
        let crossings: Vec<f64> = (1..y.len())
            .filter(|&i| y[i] * y[i - 1] < 0.0 && s[i] > 7.0)
            .map(|i| s[i - 1] + (s[i] - s[i - 1]) * y[i - 1] / (y[i - 1] - y[i]))
            .collect();
        let waves = (crossings.len() - 1) as f64 / 2.0;
        let length = (crossings[crossings.len() - 1] - crossings[0]) / waves;
        assert!(waves >= 3.0, "{waves}");
        assert!((length / expected - 1.0).abs() < 2e-4, "{law}: {length} m, expected {expected} m");
    }
}

/// y = b r0 / (lambda R) outwards, lambda = cone (b + RAIL cone)/(b - r0 cone) over the shift of the axle's middle.
///
/// 5e-4: the patches are not points, and the spin forces of outer and inner wheel differ.
#[test]
fn a_wheelset_rolls_freely_on_its_line_in_a_curve() {
    let (radius, speed) = (3000.0_f64, 20.0_f64);
    for hand in [1.0, -1.0] {
        let cant = hand * 1.5 * (speed * speed / (radius * 9.81)).atan().sin();
        let case = coned(track(100.0, [hand / radius; 2], [cant; 2]), speed, 0.01);
        let mut plant = Plant::new(&case);
        let (b, r0) = contacts(&plant);
        let conicity = CONE * (b + RAIL * CONE) / (b - r0 * CONE);
        let expected = -hand * b * r0 / (conicity * radius);
        let x = plant.equilibrium();
        let y = x[plant.state("wheelset.y")];
        assert!((y / expected - 1.0).abs() < 5e-4, "{y} m, expected {expected} m");
        plant.rates(&x);
        for wheel in &plant.work.wheels {
            // a wheel held 1 mm off its line would pull with some 300 N
            assert!(wheel.force_T.x().abs() < 3.0, "{:?}", wheel.force_T);
        }
    }
}

/// y = -dr/(2 cone) with a level axle: so far to the side the cones of unequal wheels, dr right minus left, are equally
/// large where they touch, and touch where those of a centred wheelset do. Not the conicity of a curve, in which the
/// axle rolls.
///
/// 2e-4: the tape circles move by 2 mm, over which the slope of the table is that of the cone to 1e-4.
#[test]
fn unequal_wheels_roll_where_they_are_equally_large() {
    for dr in [2e-4, -2e-4] {
        let mut case = coned(straight(100.0), 20.0, 0.01);
        case["wheels"][0]["radius_offset"] = json!(-0.5 * dr);
        case["wheels"][1]["radius_offset"] = json!(0.5 * dr);
        let mut plant = Plant::new(&case);
        let x = plant.equilibrium();
        let (y, roll) = (x[plant.state("wheelset.y")], x[plant.state("wheelset.roll")]);
        assert!((y / (-dr / (2.0 * CONE)) - 1.0).abs() < 2e-4, "{y} m");
        assert!(roll.abs() < 1e-7, "{roll} rad");
        plant.rates(&x);
        assert!(plant.work.wheels.iter().all(|wheel| wheel.force_T.x().abs() < 3.0));
    }
}

/// Wheels that are larger than their table by dr run as those of a table made for r0 + dr.
///
/// 1e-4 of the load in all forces: the table's patches are longer by half of dr/r0 = 2e-3 in one direction.
#[test]
fn larger_wheels_are_those_of_a_larger_table() {
    let dr = 1e-3;
    let curve = || track(100.0, [1.0 / 1000.0; 2], [0.05; 2]);
    let mut offset = coned(curve(), 20.0, 0.01);
    for wheel in 0..2 {
        offset["wheels"][wheel]["radius_offset"] = json!(dr);
    }
    let mut larger = coned(curve(), 20.0, 0.01);
    larger["contact_pairs"][0]["radius"] = json!(0.46 + dr);
    larger["bodies"][0]["position"][2] = json!(-0.46 - dr);
    let settled = |case: &Value| {
        let mut plant = Plant::new(case);
        let x = plant.equilibrium();
        plant.rates(&x);
        let names = ["wheelset.y", "wheelset.z", "wheelset.yaw", "wheelset.spin.spin_speed"];
        (names.map(|name| x[plant.state(name)]), [0, 1].map(|side| plant.work.wheels[side].force_T.0))
    };
    let ((x, forces), (wanted_x, wanted_forces)) = (settled(&offset), settled(&larger));
    for (value, wanted) in x.into_iter().zip(wanted_x) {
        assert!((value - wanted).abs() < 1e-3 * wanted.abs() + 1e-9, "{value}, expected {wanted}");
    }
    for (force, wanted) in forces.into_iter().flatten().zip(wanted_forces.into_iter().flatten()) {
        assert!((force - wanted).abs() < 1e-4 * 8900.0, "{force} N, expected {wanted} N");
    }
}

#[test]
fn far_too_large_wheels_are_refused() {
    let mut case = coned(straight(100.0), 20.0, 0.01);
    case["wheels"][1]["radius_offset"] = json!(0.46);
    let message = compile(&spec(&case)).expect_err("no such wheel").to_string();
    assert!(message.contains("wheelset.right.radius_offset") && message.contains("0.005"), "{message}");
}
