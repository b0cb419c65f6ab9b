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

static KIK_PIOTROWSKI: LazyLock<ContactTable> = LazyLock::new(|| {
    ContactTable::build(&pair(Profile::rail_uic60()), &Material::STEEL, NormalContact::KikPiotrowski).unwrap()
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
/// At 50 kN outside |y| of 4.4-5.6 and 6.3-7.1 mm, where CONTACT merges patches: y of the wheelset, CONTACT's places on
/// wheel and rail (mm), rolling radius (mm), normal force (N), area (mm2), largest pressure (MPa).
#[rustfmt::skip]
const CONTACT_50KN: [[f64; 7]; 17] = [
    [-10.0, 22.372643, -3.3809942, 459.57134, 50003.153, 60.24, 1265.1931],
    [-9.0, 21.370303, -2.8194426, 459.59242, 50002.244, 61.92, 1233.7294],
    [-8.0, 20.131797, -2.3257707, 459.61457, 50001.486, 63.8, 1192.6105],
    [-6.0, 14.152266, -2.6692142, 459.68557, 50001.49, 77.72, 986.15365],
    [-4.0, 11.549665, -3.0998305, 459.71193, 50002.302, 85.36, 899.99961],
    [-3.0, 10.030518, -3.5830133, 459.72955, 50003.575, 90.24, 851.78579],
    [-2.0, 8.1729002, -4.4090385, 459.75509, 50005.415, 97.24, 795.16904],
    [-1.0, 5.6006623, -5.9550601, 459.8006, 50009.556, 111.08, 720.73903],
    [0.0, 0.47862782, -10.05393, 459.94067, 50029.261, 130.92, 733.87827],
    [1.0, -6.6140021, -16.123374, 460.2508, 50089.705, 112.84, 1096.0174],
    [2.0, -10.680046, -19.163151, 460.50291, 50155.075, 72.24, 1246.0331],
    [3.0, -13.107824, -20.559259, 460.70806, 50216.274, 63.0, 1229.229],
    [4.0, -15.537908, -21.95326, 460.95403, 50302.898, 67.52, 1145.5233],
    [6.0, -31.348679, -35.589657, 464.38116, 55141.607, 43.2, 2059.4782],
    [8.0, -42.275248, -40.7611, 480.23216, 87034.353, 27.88, 4877.8792],
    [9.0, -43.3538, -40.082204, 481.64413, 77812.976, 25.64, 4805.6751],
    [10.0, -44.325186, -39.469739, 482.72089, 71948.815, 24.2, 4756.1508],
];
/// The same at 1 kN.
#[rustfmt::skip]
const LIGHT: [[f64; 7]; 7] = [
    [-8.0, 20.316586, -2.2208963, 459.67799, 1000.0256, 4.67, 324.48358],
    [-4.0, 11.864791, -2.7869269, 459.76767, 1000.0402, 6.27, 243.91885],
    [-1.0, 6.4880448, -5.0689827, 459.83606, 1000.1433, 7.77, 196.5244],
    [1.0, -9.3574488, -18.865505, 460.47052, 1002.5299, 4.27, 358.04028],
    [3.0, -13.110179, -20.558368, 460.77577, 1004.2635, 4.65, 334.00982],
    [6.0, -31.249688, -35.480831, 464.42431, 1097.3221, 3.13, 531.69435],
    [8.0, -42.334929, -40.737614, 480.51538, 1730.6167, 2.06, 1351.6784],
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

/// Largest errors of places (mm), radius (mm), force, area and pressure (relative) of a table against rows of CONTACT.
fn errors(table: &ContactTable, rows: &[[f64; 7]], load: f64) -> [f64; 6] {
    let mut worst = [0.0_f64; 6];
    for &[y, y_wheel, y_rail, radius, force, area, pressure] in rows {
        let [_, right] = table.contact(&pair(Profile::rail_uic60()), y * 1e-3, 0.0, load).unwrap().wheels;
        assert_eq!(right.len(), 1, "y {y}");
        let p = &right[0];
        let errors = [
            p.y_wheel * 1e3 - y_wheel,
            p.y_rail * 1e3 - y_rail,
            p.radius * 1e3 - radius,
            p.normal_force / force - 1.0,
            p.area * 1e6 / area - 1.0,
            p.pressure / 1e6 / pressure - 1.0,
        ];
        worst.iter_mut().zip(errors).for_each(|(w, e)| *w = w.max(e.abs()));
    }
    worst
}

#[test]
fn loaded_contact_has_the_place_force_size_and_pressure_of_contact() {
    let within = |errors: [f64; 6], most: [f64; 6]| {
        assert!(errors.iter().zip(most).all(|(e, m)| *e < m), "{errors:?} {most:?}");
    };
    // The weighted middle of CONTACT is that of the undeformed overlap; two humps at y = 0 make the most of it.
    within(errors(&KIK_PIOTROWSKI, &CONTACT_50KN, 5e4), [0.3, 0.3, 0.09, 0.01, 0.09, 0.03]);
    within(errors(&KIK_PIOTROWSKI, &LIGHT, 1e3), [0.03, 0.03, 0.02, 0.002, 0.09, 0.03]);
    // Hertz: one ellipse for two humps has a third less pressure.
    within(errors(&UIC60, &CONTACT_50KN, 5e4), [0.4, 0.4, 0.09, 0.01, 0.13, 0.4]);
    within(errors(&UIC60, &LIGHT, 1e3), [0.03, 0.03, 0.02, 0.002, 0.09, 0.08]);
}

#[test]
fn forces_and_their_slopes_are_continuous_along_y() {
    let geometry = pair(Profile::rail_uic60());
    for table in [&*UIC60, &*KIK_PIOTROWSKI] {
        let force = |y: f64| -> f64 {
            let state = table.wheelset_at(&geometry, y, 0.0, 5e4).unwrap();
            state.wheels[1].iter().map(|p| p.normal_force * p.angle.sin()).sum()
        };
        // Place and size of the largest second difference.
        let sharpest = |middle: f64, half: i32, step: f64| {
            let f: Vec<f64> = (-half..=half).map(|i| force(middle + f64::from(i) * step)).collect();
            let bends = f.windows(3).enumerate().map(|(i, f)| (i, (f[0] - 2.0 * f[1] + f[2]).abs()));
            let (i, bend) = bends.max_by(|p, q| p.1.total_cmp(&q.1)).unwrap();
            (middle + f64::from(i as i32 + 1 - half) * step, bend)
        };
        // Halving the step quarters the second difference of a smooth curve, halves it at a kink, leaves it at a jump.
        // The mean over many halvings does not depend on where the steps fall.
        let (mut place, coarse) = sharpest(0.0, 400, 2e-5);
        let (mut step, mut bend, halvings) = (2e-5, coarse, 7);
        for _ in 0..halvings {
            step *= 0.5;
            (place, bend) = sharpest(place, 8, step);
        }
        let ratio = (coarse / bend).powf(1.0 / f64::from(halvings));
        assert!(ratio > 2.3, "{ratio} at {place}: {bend} N in {step} m");
    }
}

#[test]
fn bytes_give_the_table_back() {
    let bytes = UIC60.to_bytes();
    let back = ContactTable::from_bytes(&bytes).unwrap();
    assert!(bytes.len() < 40_000_000 && back.to_bytes() == bytes);
    let place = [3e-3, -2e-4, 1e-4, 5e-3];
    let read = |t: &ContactTable| format!("{:?}", t.patches(place[0], place[1], place[2], place[3]).unwrap());
    assert_eq!(read(&back), read(&UIC60));
    assert!(ContactTable::from_bytes(&bytes[..bytes.len() - 8]).is_none());
    assert!(ContactTable::from_bytes(&[bytes.as_slice(), &[0; 8]].concat()).is_none());
    assert!(ContactTable::from_bytes(&bytes[8..]).is_none() && ContactTable::from_bytes(b"").is_none());
}

/// Least distance along z of a yawed wheel, as a body of revolution, to the rail: (gap, place along the rail, on the wheel).
fn direct(rail: &Profile, wheel: &Profile, shift: f64, roll: f64, yaw: f64, about: f64) -> (f64, f64, f64) {
    let (r0, mut best) = (0.46, (f64::MAX, 0.0, 0.0));
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
                    best = (gap, x, y_w);
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
    let table = ContactTable::build(&pair, &Material::STEEL, NormalContact::Hertz).unwrap();
    for (shift, roll) in [(3e-3, 1e-4), (5.8e-3, 5e-4), (8.5e-3, 4e-3)] {
        let touch = rigid.wheel(shift, roll).unwrap();
        let tan = (touch.angle - roll).tan();
        let (level, _, y_level) = direct(&rail, &pair.wheel, shift, roll, 0.0, touch.y_wheel);
        for yaw in [6e-3, -1.2e-2] {
            let (gap, x, y_wheel) = direct(&rail, &pair.wheel, shift, roll, yaw, touch.y_wheel);
            // A positive yaw of the right wheel carries its outer side back: the flange touches ahead for yaw > 0.
            let ahead = touch.radius * tan * yaw;
            assert!((x - ahead).abs() < 0.03 * ahead.abs() + 4e-4, "{shift} {yaw}: {x} {ahead}");
            let nearer = 0.5 * touch.radius * (tan * yaw).powi(2);
            assert!((level - gap - nearer).abs() < 0.05 * nearer + 3e-6, "{shift} {yaw}: {} {nearer}", level - gap);
            // The tables know where on the wheel, to the spacing of the direct search.
            let place = |yaw: f64| {
                let zone = |w: f64| {
                    let patches = table.patches(shift, w, roll, yaw).unwrap();
                    patches.into_iter().max_by(|p, q| p.penetration.total_cmp(&q.penetration)).unwrap()
                };
                zone(5e-6 - 1.0 - zone(-1.0).penetration).y_wheel
            };
            let (moved, drift) = (y_wheel - y_level, place(yaw) - place(0.0));
            assert!((moved - drift).abs() < 0.1 * moved.abs() + 2e-5, "{shift} {yaw}: {moved} {drift}");
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
            let normals = PairGeometry::normals(&rail, strips, shift, roll);
            let penetration: Vec<f64> = gaps.iter().zip(&normals).map(|(g, n)| n.penetration(w - g)).collect();
            let mut strips = strips.clone();
            for (j, n) in normals.iter().enumerate() {
                [strips.sin[j], strips.cos[j]] = n.strained(penetration[j]);
            }
            let modulus = Material::STEEL.pair_modulus();
            let solver = normal::Solver { normal: NormalContact::Hertz, radius: 0.46, pair_modulus: modulus };
            let direct = solver.load(&strips, &penetration, &mut normal::Guess::default()).unwrap();
            force += (patch.normal_force / direct.force - 1.0).powi(2);
            place += (patch.y_wheel - direct.y).powi(2);
            count += 1.0;
            assert!((patch.normal_force / direct.force - 1.0).abs() < 0.25, "{shift} {zone} {patch:?} {direct:?}");
            assert!((patch.y_wheel - direct.y).abs() < 4e-4, "{shift} {zone} {patch:?} {direct:?}");
        }
    }
    let (force, place) = ((force / count).sqrt(), (place / count).sqrt());
    assert!(count > 250.0 && force < 0.025 && place < 1e-4, "{count} {force} {place}");
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
    let refused = |pair: &PairGeometry| {
        let built = ContactTable::build(pair, &Material::STEEL, NormalContact::Hertz);
        built.err().map_or_else(String::new, |e| e.to_string())
    };
    let bad = |change: fn(&mut PairGeometry)| {
        let mut pair = pair(Profile::rail_60e1());
        change(&mut pair);
        refused(&pair)
    };
    assert!(bad(|p| p.gauge = 1435.0).starts_with("gauge: 1435"));
    assert!(bad(|p| p.flange_back = 1.42).starts_with("flange-back distance: 1.42"));
    assert!(bad(|p| p.radius = -0.4).starts_with("radius: -0.4"));
    assert!(bad(|p| p.rail_inclination = 40.0).starts_with("rail inclination: 40"));
    assert!(bad(|p| p.gauge = 1.42).contains("gauge cannot hold this wheelset"));
    assert!(bad(|p| p.gauge = 1.6).contains("gauge cannot hold"));
    assert!(bad(|p| p.gauge = f64::NAN).starts_with("gauge: NaN"));
    let short = |profile: Profile, last: f64| {
        let count = profile.y.iter().filter(|y| **y < last).count();
        Profile::from_points(&profile.y[..count], &profile.z[..count], "short").unwrap()
    };
    let mut cut = pair(Profile::rail_60e1());
    cut.wheel = short(Profile::s1002(), 0.015);
    assert!(refused(&cut).contains("25 mm beyond the tape circle"));
    (cut.wheel, cut.rail) = (Profile::s1002(), short(Profile::rail_60e1(), 0.003));
    assert!(refused(&cut).contains("12 mm beyond its highest point"));
    let flat: Vec<f64> = (0..60).map(|i| -0.03 + 1e-3 * f64::from(i)).collect();
    let mut rail = pair(Profile::from_points(&flat, &vec![0.0; 60], "flat").unwrap());
    assert!(rail.placed_rail().unwrap_err().to_string().contains("14 mm below its top"));
    (rail.rail, rail.wheel) = (Profile::rail_60e1(), Profile::rail_60e1());
    assert!(refused(&rail).contains("give a wheel profile"));
}
