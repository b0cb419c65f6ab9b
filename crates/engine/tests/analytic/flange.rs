//! The creepage of a yawed wheel on its flange: a wheel rolling straight at the attack angle psi slips across its
//! contact plane by -psi/cos(delta), because its contact runs ahead and moves down the flank.

use crate::common::{Plant, straight, wheelset};
use klingel_physics::math::Vec3;
use serde_json::json;

/// The right wheel alone on one patch of the wanted zone: shift \[m\] and depth \[m\].
fn alone_on(plant: &Plant, zone: usize, pressed: f64) -> (f64, f64) {
    let table = &plant.model.wheels[0].table;
    for i in 0..1390 {
        let shift = 1e-5 * f64::from(i);
        let lifted = table.patches(shift, -0.02, 0.0, 0.0).expect("a place in the table");
        let depth = -0.02 - lifted[zone].penetration + pressed;
        if let Ok(patches) = table.patches(shift, depth, 0.0, 0.0)
            && (0..3).all(|z| patches[z].active == (z == zone))
        {
            return (shift, depth);
        }
    }
    panic!("no place where zone {zone} touches alone");
}

/// 0.1 %: the small angles psi and the second-order drop of the contact.
#[test]
fn lateral_creepage_of_a_yawed_wheel_grows_with_one_over_the_cosine() {
    let mut case = wheelset(json!({ "named": "s1002" }), 0.025, straight(50.0), 20.0, 0.01);
    case["creep"] = json!({ "law": "linear", "elements": [1, 1], "contact_dissipation": 0.0 });
    case["wheels"] = json!([case["wheels"][1]]);
    let mut plant = Plant::new(&case);
    let (y, z, yaw) = (plant.state("wheelset.y"), plant.state("wheelset.z"), plant.state("wheelset.yaw"));
    let spin = plant.state("wheelset.spin.spin_speed");
    for (zone, least_angle) in [(0, 0.0), (1, 0.2), (2, 1.0)] {
        let (shift, depth) = alone_on(&plant, zone, 1e-4);
        let mut x = plant.design_state();
        x[y] += shift;
        x[z] += depth;
        // (force along, force across, angle, T-gamma) of the right wheel
        let mut wheel = |x: &[f64]| {
            plant.rates(x);
            let w = &plant.work.wheels[0];
            let (sin, cos) = w.contact_angle.sin_cos();
            (w.force_T.x(), w.force_T.dot(Vec3::new(0.0, cos, -sin)), w.contact_angle, w.t_gamma)
        };
        // without longitudinal creepage T-gamma is |Fy eta|: its quotient with the force is the creepage, whatever the law
        for psi in [2e-3, -2e-3] {
            x[yaw] = psi;
            // the secant method for the spin speed without longitudinal creepage
            let (mut last, mut speed) = (43.0, 44.0);
            for _ in 0..3 {
                let [first, second] = [last, speed].map(|speed| {
                    x[spin] = speed;
                    wheel(&x).0
                });
                (last, speed) = (speed, speed - second * (speed - last) / (second - first));
            }
            x[spin] = speed;
            let (along, across, angle, t_gamma) = wheel(&x);
            assert!(angle >= least_angle, "{angle}");
            let creepage = t_gamma / across.abs();
            // without longitudinal slip the rolling speed is V, and with it the reference speed of the creepages
            let expected = psi.abs() / angle.cos();
            assert!(along.abs() < 1e-6 * across.abs(), "{along} beside {across}");
            assert!((creepage / expected - 1.0).abs() < 1e-3, "zone {zone}: {creepage} for {expected}");
        }
    }
}
