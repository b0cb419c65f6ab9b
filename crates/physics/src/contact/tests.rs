//! Checks of the contact tables and views against CONTACT, direct three-dimensional geometry and themselves.
//! Reference rows: full CONTACT (github.com/eve70a/CONTACT), S1002 on the UIC60 variant, 1:40, right wheel, frictionless.

use super::*;
use crate::{Dual, Lanes};
use std::sync::LazyLock;

fn pair(rail: Profile) -> PairGeometry {
    let wheel = Profile::s1002();
    PairGeometry { wheel, rail, rail_inclination: 0.025, gauge: 1.435, flange_back: 1.36, radius: 0.46 }
}

static UIC60: LazyLock<ContactTable> = LazyLock::new(|| {
    ContactTable::build(&pair(Profile::rail_uic60()), &Material::STEEL, NormalContact::Hertz).unwrap()
});

/// Shift of the right wheel for the wheelset's position and roll.
fn shift(y: f64, roll: f64) -> f64 {
    y - 0.46 * roll.sin() - 0.75 * (1.0 - roll.cos())
}

/// Wheelset y (mm), roll (rad), then CONTACT's y on the wheel (mm), rolling radius (mm), normal force (N), area (mm2).
#[rustfmt::skip]
const CONTACT_1KN: [[f64; 6]; 11] = [
    [-7.0, 0.0063858893, 18.635503, 459.70191, 1000.0193, 4.97],
    [-4.0, 0.00025911833, 11.864791, 459.76767, 1000.0402, 6.27],
    [-1.0, 5.3211708e-05, 6.4880448, 459.83606, 1000.1433, 7.77],
    [1.0, -5.3211708e-05, -9.3574488, 460.47052, 1002.5299, 4.27],
    [2.0, -0.0001155039, -11.148047, 460.60627, 1003.2524, 4.45],
    [3.0, -0.00018312929, -13.110179, 460.77577, 1004.2635, 4.65],
    [4.0, -0.00025911833, -15.381701, 461.00283, 1005.8388, 4.97],
    [5.0, -0.00036779044, -28.614422, 463.44687, 1046.934, 2.11],
    [6.0, -0.00064933361, -31.249688, 464.42431, 1097.3221, 3.13],
    [7.0, -0.0063858893, -41.053486, 478.48802, 2091.3147, 2.48],
    [8.0, -0.0086498747, -42.334929, 480.51538, 1730.6167, 2.06],
];
#[rustfmt::skip]
const CONTACT_50KN: [[f64; 6]; 10] = [
    [-8.0, 0.0084796456, 20.131797, 459.61457, 50001.486, 63.8],
    [-4.0, 0.00025431887, 11.549665, 459.71193, 50002.302, 85.36],
    [-1.0, 5.0377602e-05, 5.6006623, 459.8006, 50009.556, 111.08],
    [0.0, 0.0, 0.47862782, 459.94067, 50029.261, 130.92],
    [1.0, -5.0377602e-05, -6.6140021, 460.2508, 50089.705, 112.84],
    [3.0, -0.00017610699, -13.107824, 460.70806, 50216.274, 63.0],
    [4.0, -0.00025431887, -15.537908, 460.95403, 50302.898, 67.52],
    [6.0, -0.00062819409, -31.348679, 464.38116, 55141.607, 43.2],
    [7.0, -0.0060386386, -40.940684, 478.01363, 106575.14, 33.76],
    [9.0, -0.010048731, -43.3538, 481.64413, 77812.976, 25.64],
];

#[test]
fn rigid_contact_is_where_contact_finds_it_at_1_kn() {
    let rigid = RigidWheelset::new(&pair(Profile::rail_uic60())).unwrap();
    for [y, roll, y_wheel, radius, _, _] in CONTACT_1KN {
        let touch = rigid.wheel(shift(y * 1e-3, roll), roll).unwrap();
        assert!((touch.y_wheel * 1e3 - y_wheel).abs() < 0.07, "y {y}: {touch:?}");
        // CONTACT measures to the rail, 5 to 30 um below the unstrained wheel.
        assert!((touch.radius * 1e3 - radius).abs() < 0.03, "y {y}: {touch:?}");
    }
}

#[test]
fn loaded_contact_has_the_place_force_and_size_of_contact_at_50_kn() {
    for [y, roll, y_wheel, radius, force, area] in CONTACT_50KN {
        let (_, patches) = UIC60.pressed_by(5e4, shift(y * 1e-3, roll), roll, 0.0).unwrap();
        let p = patches.iter().find(|p| p.active).unwrap();
        assert_eq!(patches.iter().filter(|p| p.active).count(), 1, "y {y}");
        assert!((p.y_wheel * 1e3 - y_wheel).abs() < 0.4, "y {y}: {p:?}");
        assert!(((p.radius - p.penetration) * 1e3 - radius).abs() < 0.1, "y {y}: {p:?}");
        assert!((p.normal_force / force - 1.0).abs() < 0.01, "y {y}: {p:?}");
        // Away from the two-humped contact near the centre the ellipse has the area of CONTACT's patch.
        assert!((core::f64::consts::PI * p.a * p.b * 1e6 / area - 1.0).abs() < 0.12, "y {y}: {p:?}");
    }
}

/// Least distance along z of a yawed wheel, as a body of revolution, to the rail: (gap, place along the rail).
fn direct(rail: &Profile, wheel: &Profile, shift: f64, roll: f64, yaw: f64, about: f64) -> (f64, f64) {
    let (r0, mut best) = (0.46, (f64::MAX, 0.0));
    let ((sf, cf), (sy, cy)) = (roll.sin_cos(), yaw.sin_cos());
    for i in -200..=200 {
        let y_w = about + f64::from(i) * 1e-5;
        let radius = r0 + wheel.at(y_w).unwrap().0;
        for k in -200..=200 {
            let angle = f64::from(k) * 4e-4;
            // Point of the wheel, rolled, then yawed about the vertical through the middle of its tape circle.
            let (x, z) = (radius * angle.sin(), radius * angle.cos());
            let (y, z) = (y_w * cf - z * sf, y_w * sf + z * cf);
            let (x, y) = (x * cy - y * sy, x * sy + y * cy);
            if let Some((z_rail, _)) = rail.at(y + shift + r0 * sf) {
                let gap = z_rail - (z - r0 * cf);
                if gap < best.0 {
                    best = (gap, x);
                }
            }
        }
    }
    best
}

#[test]
fn yaw_moves_the_contact_ahead_and_nearer_as_in_three_dimensions() {
    let pair = pair(Profile::rail_60e1());
    let (rail, rigid) = (pair.placed_rail().unwrap(), RigidWheelset::new(&pair).unwrap());
    for (shift, roll) in [(3e-3, 1e-4), (5.8e-3, 5e-4), (8.5e-3, 4e-3)] {
        let touch = rigid.wheel(shift, roll).unwrap();
        let tan = (touch.angle - roll).tan();
        let level = direct(&rail, &pair.wheel, shift, roll, 0.0, touch.y_wheel).0;
        for yaw in [6e-3, -1.2e-2] {
            let (gap, x) = direct(&rail, &pair.wheel, shift, roll, yaw, touch.y_wheel);
            // A positive yaw of the right wheel carries its outer side back: the flange touches ahead for yaw > 0.
            let ahead = touch.radius * tan * yaw;
            assert!((x - ahead).abs() < 0.03 * ahead.abs() + 4e-4, "{shift} {yaw}: {x} {ahead}");
            let nearer = 0.5 * touch.radius * (tan * yaw).powi(2);
            assert!((level - gap - nearer).abs() < 0.05 * nearer + 3e-6, "{shift} {yaw}: {} {nearer}", level - gap);
        }
    }
}

#[test]
fn tables_are_smooth_and_their_slopes_exact() {
    let at = |x: [f64; 4]| UIC60.patches(x[0], x[1], x[2], x[3]).unwrap();
    let mut active = [0; 3];
    for i in 0..400 {
        let t = f64::from(i);
        // Across cell borders at 0.05 mm and 0.5 mrad too; pressed in by up to 0.2 mm in some zone.
        let (shift, roll) = (-8e-3 + 4e-5 * t, 5e-4 * (0.7 * t).sin());
        let free = at([shift, -0.03, roll, 0.0]).map(|p| -0.03 - p.penetration).into_iter().fold(f64::MAX, f64::min);
        let x = [shift, free + 5e-5 * (1.0 + t % 4.0), roll, 2e-3];
        let dual: [Dual<4>; 4] = core::array::from_fn(|m| Dual::variable(x[m], m));
        let (value, dual) = (at(x), UIC60.patches(dual[0], dual[1], dual[2], dual[3]).unwrap());
        let lanes = UIC60.patches(Lanes::from([x[0]; 4]), x[1].into(), x[2].into(), x[3].into()).unwrap();
        for zone in 0..3 {
            let fields = |p: &Patch<f64>| [p.normal_force, p.angle, p.y_wheel, p.radius, p.a, p.b, p.penetration];
            let value = fields(&value[zone]);
            if value[6] < 2e-5 {
                continue;
            }
            active[zone] += 1;
            let p = &dual[zone];
            let slopes = [p.normal_force, p.angle, p.y_wheel, p.radius, p.a, p.b, p.penetration];
            let l = &lanes[zone];
            let lanes = [l.normal_force, l.angle, l.y_wheel, l.radius, l.a, l.b, l.penetration];
            for k in 0..7 {
                assert_eq!(slopes[k].value, value[k]);
                assert_eq!(lanes[k].to_array(), [value[k]; 4]);
            }
            for m in 0..4 {
                // One-sided differences from both sides meet the one slope: no kink.
                for h in [1e-8, -1e-8] {
                    let mut near = x;
                    near[m] += h;
                    let near = fields(&at(near)[zone]);
                    for k in 0..7 {
                        let (difference, slope) = ((near[k] - value[k]) / h, slopes[k].slope[m]);
                        let scale = [1e10, 2e3, 20.0, 20.0, 20.0, 40.0, 1.0][k];
                        assert!(
                            (difference - slope).abs() < 0.01 * scale,
                            "{x:?} {zone} {k} {m}: {difference} {slope}"
                        );
                    }
                }
            }
        }
    }
    assert!(active.iter().all(|&n| n > 30), "{active:?}");
}

#[test]
fn tables_smooth_the_direct_solution_by_little() {
    let pair = pair(Profile::rail_uic60());
    let rail = pair.placed_rail().unwrap();
    let zones = zones::WheelZones::new(&pair, &rail).unwrap();
    // Worst where the contact jumps within a tenth of a millimetre of shift: there 10 % of the load is 5 um of height.
    let (mut force, mut place, mut count) = (0.0_f64, 0.0_f64, 0.0);
    for i in 0..300 {
        let t = f64::from(i);
        let (shift, roll) = (-8e-3 + 5.37e-5 * t, 6e-4 * (0.9 * t).sin());
        let Ok((w, patches)) = UIC60.pressed_by(5e4, shift, roll, 0.0) else { continue };
        for zone in (0..3).filter(|&z| patches[z].normal_force > 1e4) {
            let (strips, patch) = (&zones.strips[zone], &patches[zone]);
            let gaps = PairGeometry::gaps(&rail, strips, shift, roll);
            let penetration: Vec<f64> = gaps.iter().zip(&strips.cos).map(|(g, cos)| (w - g) * cos).collect();
            let modulus = Material::STEEL.pair_modulus();
            let solver = normal::Solver { normal: NormalContact::Hertz, radius: 0.46, pair_modulus: modulus };
            let direct = solver.load(strips, &penetration, &mut normal::Guess::default()).unwrap();
            force += (patch.normal_force / direct.force - 1.0).powi(2);
            place += (patch.y_wheel - direct.y).powi(2);
            count += 1.0;
            assert!((patch.normal_force / direct.force - 1.0).abs() < 0.13, "{shift} {zone} {patch:?} {direct:?}");
            assert!((patch.y_wheel - direct.y).abs() < 4e-4, "{shift} {zone} {patch:?} {direct:?}");
        }
    }
    let (force, place) = ((force / count).sqrt(), (place / count).sqrt());
    assert!(count > 250.0 && force < 0.02 && place < 1.5e-4, "{count} {force} {place}");
}

#[test]
fn nothing_is_extrapolated() {
    assert_eq!(UIC60.patches(0.02, 0.0, 0.0, 0.0).unwrap_err().what, "shift");
    assert_eq!(UIC60.patches(0.0, 0.0, -0.013, 0.0).unwrap_err().what, "roll");
    assert_eq!(UIC60.patches(0.0, 0.003, 0.0, 0.0).unwrap_err().what, "penetration");
    assert_eq!(UIC60.patches(f64::NAN, 0.0, 0.0, 0.0).unwrap_err().what, "shift");
    assert!(UIC60.patches(0.0, -0.5, 0.0, 0.0).unwrap().iter().all(|p| !p.active && p.normal_force == 0.0));
    assert!(UIC60.pressed_by(-1.0, 0.0, 0.0, 0.0).unwrap_err().to_string().contains("wheel load: -1"));
}

#[test]
fn impossible_pairs_are_refused() {
    let bad = |change: fn(&mut PairGeometry)| {
        let mut pair = pair(Profile::rail_60e1());
        change(&mut pair);
        ContactTable::build(&pair, &Material::STEEL, NormalContact::Hertz).unwrap_err().to_string()
    };
    assert!(bad(|p| p.gauge = 1435.0).starts_with("gauge: 1435"));
    assert!(bad(|p| p.flange_back = 1.42).starts_with("flange-back distance: 1.42"));
    assert!(bad(|p| p.radius = -0.4).starts_with("radius: -0.4"));
    assert!(bad(|p| p.rail_inclination = 40.0).starts_with("rail inclination: 40"));
    let flat: Vec<f64> = (0..60).map(|i| -0.03 + 1e-3 * f64::from(i)).collect();
    let mut rail = pair(Profile::from_points(&flat, &vec![0.0; 60], "flat").unwrap());
    assert!(rail.placed_rail().unwrap_err().to_string().contains("14 mm below its top"));
    (rail.rail, rail.wheel) = (Profile::rail_60e1(), Profile::rail_60e1());
    let refused = ContactTable::build(&rail, &Material::STEEL, NormalContact::Hertz).unwrap_err().to_string();
    assert!(refused.contains("give a wheel profile"), "{refused}");
}
