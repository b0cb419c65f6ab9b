//! The exact solver against CONTACT, Kalker's coefficients, its limits and its mirror images.
//! Reference rows: full CONTACT (github.com/eve70a/CONTACT), 40 x 40 elements, Hertzian, nu 0.28, G 82 GPa, mu 0.3.

use super::super::RollingContact;
use super::*;
use crate::contact::Material;

fn ellipse(ratio: f64, n: usize) -> Exact {
    Exact::new(ratio, 0.28, [n, n]).unwrap()
}

/// Creepages from almost none to full sliding.
const CREEPAGES: [[f64; 3]; 7] = [
    [1e-6, -2e-6, 1e-6],
    [0.12, 0.0, 0.0],
    [0.0, -0.2, 0.0],
    [0.0, 0.0, 0.4],
    [0.2, 0.3, -0.4],
    [-0.1, 0.6, 1.7],
    [300.0, -400.0, 20.0],
];

#[test]
fn forces_are_those_of_contact() {
    let (mut sum, mut most) = (0.0, 0.0_f64);
    let scale = 82e9 * 36e-6 / 24e3;
    for (ratio, rows) in CONTACT {
        let creepages = rows.map(|[xi, eta, phi, ..]| [xi * scale, eta * scale, phi * 6e-3 * scale]);
        let forces = ellipse(ratio, 40).forces(&creepages).unwrap();
        for ([xi, eta, phi, fx, fy, mz], f) in rows.into_iter().zip(forces) {
            let error = (f[0] - fx).hypot(f[1] - fy);
            assert!((f[2] - mz).abs() < 0.005, "{ratio} {xi} {eta} {phi}: {f:?}");
            sum += error * error;
            most = most.max(error);
        }
    }
    // Parts of mu N. Over all 212 rows, of which these are every ninth, they are 0.0015 and 0.0029, mostly because
    // CONTACT's elements cover 1.5 % more than the ellipse; with elements that cover 0.6 % more they were 0.0004 and 0.0017.
    let rms = (sum / 24.0).sqrt();
    assert!(rms < 0.002 && most < 0.004, "{rms} {most}");
}

/// C11, C22, C23 and C32, forces per creepage when it vanishes: the limit of 20 and 40 elements.
fn coefficients(ratio: f64, poisson: f64) -> [f64; 4] {
    let small = 1e-7;
    let [coarse, fine] = [20, 40].map(|n| {
        let ellipse = Exact::new(ratio, poisson, [n, n]).unwrap();
        let forces = ellipse.forces(&[[small, 0.0, 0.0], [0.0, small, 0.0], [0.0, 0.0, small]]).unwrap();
        [-forces[0][0], -forces[1][1], -forces[2][1], forces[1][2]].map(|f| f / small)
    });
    core::array::from_fn(|k| 2.0 * fine[k] - coarse[k])
}

#[test]
fn vanishing_creepage_gives_the_coefficients_of_kalker() {
    // At nu = 0.28 extrapolated from CONTACT by others; from 40 and 80 elements all are within 0.8 %. The others are
    // Kalker's own, table E.3 of his book.
    for (ratio, poisson, reference) in [
        (0.2, 0.28, [3.5034, 2.6378, 0.6188]),
        (1.0, 0.28, [4.2236, 3.7067, 1.4849]),
        (5.0, 0.28, [7.9705, 8.408, 6.8317]),
        (1.0, 0.0, [3.4, 3.4, 1.33]),
        (1.0, 0.5, [5.2, 3.98, 1.63]),
    ] {
        let limit = coefficients(ratio, poisson);
        for (own, reference) in limit.into_iter().zip(reference) {
            assert!((own / reference - 1.0).abs() < 0.015, "{ratio} {poisson}: {limit:?}");
        }
        // The force of spin and the moment of lateral creepage are two sides of one coefficient.
        assert!((limit[3] / limit[2] - 1.0).abs() < 2e-3, "{ratio} {poisson}: {limit:?}");
    }
}

#[test]
fn force_stays_proportional_down_to_the_least_creepage() {
    let ellipse = ellipse(1.0, 12);
    let [fx, fy, mz] = ellipse.solve([1e-5, 2e-5, -1e-5]).unwrap().force;
    for part in [1e-4, 1e-15, 1e-60] {
        let f = ellipse.solve([1e-5 * part, 2e-5 * part, -1e-5 * part]).unwrap().force;
        for (least, little) in [(f[0], fx), (f[1], fy), (f[2], mz)] {
            assert!((least / part - little).abs() < 1e-3 * little.abs(), "{part}: {f:?}");
        }
    }
}

#[test]
fn mirrored_and_reversed_creepages_give_the_mirrored_force() {
    let ellipse = ellipse(1.7, 14);
    for [xi, eta, phi] in CREEPAGES {
        let [fx, fy, mz] = ellipse.solve([xi, eta, phi]).unwrap().force;
        let tolerance = 1e-6 * (fx.abs() + fy.abs() + mz.abs());
        // Across the plane y = 0, and with the sign of everything.
        let images = [([xi, -eta, -phi], [fx, -fy, -mz]), ([-xi, -eta, -phi], [-fx, -fy, -mz])];
        for (creepage, image) in images {
            let f = ellipse.solve(creepage).unwrap().force;
            assert!(f.iter().zip(image).all(|(f, i)| (f - i).abs() <= tolerance), "{creepage:?}: {f:?} {image:?}");
        }
    }
}

#[test]
fn friction_bounds_the_force_and_full_sliding_reaches_it() {
    for ratio in [0.05, 0.5, 3.0, 25.0] {
        let ellipse = ellipse(ratio, 16);
        for creepage in CREEPAGES {
            let s = ellipse.solve(creepage).unwrap();
            assert!(s.force[0].hypot(s.force[1]) <= 1.0 + 1e-6 && s.residual <= TOLERANCE && s.steps <= 20, "{s:?}");
        }
        let s = ellipse.solve([300.0, -400.0, 0.0]).unwrap();
        assert!((s.force[0] + 0.6).abs() < 1e-4 && (s.force[1] - 0.8).abs() < 1e-4 && s.sticking == 0, "{ratio}");
        let s = ellipse.solve([0.0; 3]).unwrap();
        assert!(s.force == [0.0; 3] && s.slipping == 0);
    }
}

#[test]
fn a_wide_patch_follows_carter() {
    // In a patch that is wide across, every strip rolls like Carter's cylinder (plane strain): with its half length l
    // and the peak q of its bound, it slides all over from the creepage full = 2 (1 - nu) q/G on, and before that
    // carries the part 1 - (1 - xi/full)^2 of full sliding. l and q both go with sqrt(1 - y^2/b^2).
    let (nu, ratio, n) = (0.28, 0.02, 4000);
    let [coarse, fine] = [20, 40].map(|nx| Exact::new(ratio, nu, [nx, 20]).unwrap());
    let peak = 1.5 / core::f64::consts::PI;
    for xi in [0.02, 0.1, 0.15] {
        let strip = |i: i32| {
            let l = (1.0 - ((f64::from(i) + 0.5) / f64::from(n)).powi(2)).sqrt();
            let rest = (1.0 - xi / (2.0 * (1.0 - nu) * peak * l)).max(0.0);
            1.5 * l * l * (1.0 - rest * rest) / f64::from(n)
        };
        let carter: f64 = (0..n).map(strip).sum();
        // The error halves with twice the elements along; what stays comes from the ends of the patch.
        let [coarse, fine] = [&coarse, &fine].map(|e| -e.solve([xi, 0.0, 0.0]).unwrap().force[0]);
        assert!((fine / carter - 1.0).abs() < 0.015 && (coarse / carter - 1.0).abs() < 0.03, "{xi}: {fine} {carter}");
        assert!(((2.0 * fine - coarse) / carter - 1.0).abs() < 3e-3, "{xi}: {coarse} {fine} {carter}");
    }
}

#[test]
fn slopes_are_difference_quotients() {
    let ellipse = ellipse(1.3, 14);
    for creepage in CREEPAGES {
        let slopes = ellipse.slopes(creepage, &ellipse.solve(creepage).unwrap());
        for j in 0..3 {
            let h = 1e-3 * (0.02 + creepage[j].abs());
            let [up, down] = [h, -h].map(|h| {
                let mut c = creepage;
                c[j] += h;
                ellipse.solve(c).unwrap().force
            });
            for i in 0..3 {
                let difference = (up[i] - down[i]) / (2.0 * h);
                // Elements that begin to slip within the difference bend it a little.
                let tolerance = 0.01 * difference.abs() + 2e-3;
                assert!((slopes[i][j] - difference).abs() < tolerance, "{creepage:?} {i} {j}: {slopes:?} {difference}");
            }
        }
    }
}

#[test]
fn a_start_nearby_saves_steps_and_changes_nothing() {
    let ellipse = ellipse(0.8, 20);
    let first = ellipse.solve([0.15, 0.1, 0.2]).unwrap();
    let cold = ellipse.solve([0.16, 0.1, 0.2]).unwrap();
    let warm = ellipse.solve_from([0.16, 0.1, 0.2], Some(&first)).unwrap();
    assert!(warm.steps <= cold.steps && cold.steps <= 8, "{} {}", warm.steps, cold.steps);
    assert!(warm.force.iter().zip(cold.force).all(|(w, c)| (w - c).abs() < 1e-6));
    assert_eq!(ellipse.solve_from([0.15, 0.1, 0.2], Some(&first)).unwrap().steps, 0);
}

#[test]
fn one_contact_in_its_own_units() {
    let c = RollingContact { a: 4e-3, b: 8e-3, normal_force: 5e4, friction: 0.4, xi: 1e-3, eta: -5e-4, phi: 0.3 };
    let force = exact_force(&c, &Material::STEEL, [16, 16]).unwrap();
    // Twice the lengths and four times the load is the same contact, with half the spin.
    let large =
        RollingContact { a: 2.0 * c.a, b: 2.0 * c.b, normal_force: 4.0 * c.normal_force, phi: 0.5 * c.phi, ..c };
    let [fx, fy, mz] = exact_force(&large, &Material::STEEL, [16, 16]).unwrap();
    for (large, own) in [(fx / 4.0, force[0]), (fy / 4.0, force[1]), (mz / 8.0, force[2])] {
        assert!((large - own).abs() < 1e-6 * own.abs());
    }
    assert_eq!(exact_force(&RollingContact { friction: 0.0, ..c }, &Material::STEEL, [8, 8]).unwrap(), [0.0; 3]);
}

#[test]
fn many_contacts_are_each_as_alone() {
    let wide = RollingContact { a: 4e-3, b: 8e-3, normal_force: 5e4, friction: 0.4, xi: 1e-3, eta: -5e-4, phi: 0.3 };
    let long = RollingContact { a: 8e-3, b: 4e-3, ..wide };
    let contacts = [wide, long, RollingContact { xi: 2e-3, ..long }, RollingContact { friction: 0.0, ..wide }, wide];
    let alone = contacts.map(|c| exact_force(&c, &Material::STEEL, [10, 12]).unwrap());
    assert_eq!(exact_forces(&contacts, &Material::STEEL, [10, 12]).unwrap(), alone);
    let line = RollingContact { a: 1.0, ..wide };
    let (index, error) = exact_forces(&[wide, long, line], &Material::STEEL, [10, 12]).unwrap_err();
    assert!(index == 2 && error.to_string().contains("a/b: 125 is outside"), "{index} {error}");
}

#[test]
fn what_makes_no_contact_is_refused_in_plain_words() {
    let refused = |result: Result<Exact, CreepError>| result.unwrap_err().to_string();
    assert!(refused(Exact::new(0.0, 0.28, [8, 8])).contains("a/b: 0 is outside"));
    assert!(refused(Exact::new(f64::NAN, 0.28, [8, 8])).contains("a/b: NaN"));
    assert!(refused(Exact::new(1.0, 0.6, [8, 8])).contains("Poisson's ratio: 0.6"));
    assert!(refused(Exact::new(1.0, 0.28, [8, 3])).contains("elements: 3"));
    assert!(refused(Exact::new(1.0, 0.28, [81, 8])).contains("elements: 81"));
    let error = ellipse(1.0, 8).solve([0.0, f64::INFINITY, 0.0]).unwrap_err();
    assert!(error.to_string().contains("lateral creepage: inf"));
    let contact = RollingContact { a: 6e-3, b: 6e-3, normal_force: -1.0, friction: 0.3, ..Default::default() };
    let error = exact_force(&contact, &Material::STEEL, [8, 8]).unwrap_err();
    assert!(error.to_string().contains("normal force: -1"));
}

/// a/b and rows of xi, eta, phi (1/m), then Fx and Fy over mu N and Mz over mu N sqrt(ab); a b = 36 mm2.
#[rustfmt::skip]
const CONTACT: [(f64, [[f64; 6]; 12]); 2] = [
    (0.5, [
        [0.0, 0.00026870716, 0.0, 0.0, -0.099014046, 0.028365868],
        [0.0, 0.0013435358, 0.0, 0.0, -0.43613834, 0.093633205],
        [0.0, 0.0040306073, 0.0, 0.0, -0.90741894, 0.069096289],
        [0.0, 0.013435358, 0.0, 0.0, -0.99983942, 0.011319041],
        [0.0061591853, 0.0076001861, 0.0, -0.64370624, -0.76462007, 0.0080815441],
        [0.00054440021, 0.0, 4.3084725, -0.019670494, -0.22872058, -0.6163222],
        [0.0010888004, 0.0, 4.3084725, -0.040199454, -0.22848623, -0.6157311],
        [0.0021776008, 0.0, 4.3084725, -0.079557346, -0.22809613, -0.61329189],
        [0.0043552017, 0.0, 4.3084725, -0.1591724, -0.22558188, -0.60372892],
        [0.0087104034, 0.0, 4.3084725, -0.31524161, -0.21645471, -0.56593689],
        [0.0017420807, 0.0016122429, 0.71807875, -0.32357212, -0.67556861, -0.35816276],
        [0.0069683227, -0.0064489717, 0.71807875, -0.75110863, 0.61334249, -0.11536748],
    ]),
    (1.0, [
        [0.00038474303, 0.0, 0.0, -0.19157319, 0.0, 0.0],
        [0.0014427864, 0.0, 0.0, -0.59941989, 0.0, 0.0],
        [0.0038474303, 0.0, 0.0, -0.98557186, 0.0, 0.0],
        [0.019237152, 0.0, 0.0, -0.99995061, 0.0, 0.0],
        [0.0, -0.00054859933, 0.22764361, 0.0, -0.022093962, -0.2318405],
        [0.0, -0.0010971987, 0.22764361, 0.0, 0.18279385, -0.27054156],
        [0.0, -0.0021943973, 0.22764361, 0.0, 0.51683252, -0.27403968],
        [0.0, -0.0043887946, 0.22764361, 0.0, 0.89410908, -0.14915607],
        [0.0, -0.0087775892, 0.22764361, 0.0, 0.99514641, -0.044016165],
        [0.00038474303, -0.0003291596, 0.45528722, -0.12753152, -0.33320517, -0.29870134],
        [0.0015389721, 0.0013166384, 1.8211489, -0.1601775, -0.53730994, -0.43907472],
        [0.0061558886, -0.0052665535, 1.8211489, -0.61102275, 0.15155314, -0.39974874],
    ]),
];
