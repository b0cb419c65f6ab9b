//! Every creep law against its limits, its derivatives, its mirror image and exact theory.
//! Reference rows: full CONTACT (github.com/eve70a/CONTACT), 40 x 40 elements, Hertzian, nu 0.28, G 82 GPa, 80 kN, mu 0.3.

use super::*;
use crate::Dual;

const LAWS: [CreepLaw; 5] = [
    CreepLaw::Linear,
    CreepLaw::Polach,
    CreepLaw::Fastsim { nx: 10, ny: 10 },
    CreepLaw::Fastsim { nx: 16, ny: 16 },
    CreepLaw::Fastsim { nx: 7, ny: 21 },
];

/// a/b, xi, eta, phi (1/m), then Fx and Fy over mu N and Mz over mu N sqrt(ab); a b = 36 mm2.
#[rustfmt::skip]
const CONTACT: [[f64; 7]; 31] = [
    [0.5, 0.00010888, 0.0, 0.0, -0.05028, 0.0, 0.0],
    [0.5, 0.0, 0.0005374143, 0.0, 0.0, -0.192034, 0.051394],
    [0.5, 0.0, 0.0, 0.7180788, 0.0, -0.386477, -0.468372],
    [0.5, 0.003266401, 0.0, 0.0, -0.912956, 0.0, 0.0],
    [0.5, 0.0, 0.008061215, 0.0, 0.0, -0.999523, 0.019472],
    [0.5, 0.0, 0.0, 14.36158, 0.0, -0.086586, -0.638481],
    [0.5, 0.0, -0.0006717679, 0.3590394, 0.0, -0.023517, -0.384098],
    [0.5, 0.0005444002, 0.0, 4.308473, -0.01967, -0.228721, -0.616322],
    [0.5, 0.0, 0.001343536, 4.308473, 0.0, -0.290938, -0.604701],
    [0.5, 0.0, -0.002687072, 1.436158, 0.0, -0.038752, -0.603235],
    [0.5, 0.004355202, 0.0, 0.3590394, -0.94495, -0.150471, -0.060317],
    [0.5, 0.0, 0.01074829, 0.3590394, 0.0, -0.994521, -0.06596],
    [0.5, 0.0, -0.01074829, 4.308473, 0.0, 0.31337, -0.598657],
    [0.5, 0.0008710403, -0.0008061215, 0.7180788, -0.175264, -0.17893, -0.491937],
    [0.5, 0.003484161, 0.003224486, 0.7180788, -0.533339, -0.738501, -0.226518],
    [0.5, 0.006968323, -0.006448972, 2.872315, -0.37243, 0.182608, -0.544481],
    [1.0, 0.000384743, 0.0, 0.0, -0.191573, 0.0, 0.0],
    [1.0, 0.0, 0.001097199, 0.0, 0.0, -0.434433, 0.1171],
    [1.0, 0.0, 0.0, 0.9105744, 0.0, -0.601542, -0.401563],
    [1.0, 0.005771146, 0.0, 0.0, -0.999422, 0.0, 0.0],
    [1.0, 0.0, 0.02194397, 0.0, 0.0, -0.999962, 0.003906],
    [1.0, 0.0, 0.0005485993, 0.2276436, 0.0, -0.458538, -0.099922],
    [1.0, 0.0, -0.0005485993, 2.731723, 0.0, -0.302551, -0.539425],
    [1.0, 0.0009618576, 0.0, 0.9105744, -0.195398, -0.591224, -0.390645],
    [1.0, 0.0, 0.002194397, 0.9105744, 0.0, -0.820025, -0.271699],
    [1.0, 0.0, -0.004388795, 0.2276436, 0.0, 0.894109, -0.149156],
    [1.0, 0.00384743, 0.0, 2.731723, -0.272571, -0.324009, -0.502294],
    [1.0, 0.0, 0.008777589, 2.731723, 0.0, -0.767686, -0.318652],
    [1.0, 0.0007694861, 0.0006583192, 0.4552872, -0.245017, -0.648795, -0.208293],
    [1.0, 0.001538972, -0.001316638, 1.821149, -0.165931, -0.311031, -0.517688],
    [1.0, 0.006155889, 0.005266554, 1.821149, -0.528606, -0.678484, -0.241116],
];

fn law(law: CreepLaw) -> CreepForce {
    CreepForce::new(law, &Material::STEEL).unwrap()
}

/// From rest over partial slip to full slip, with spin, slender and round.
fn patches() -> Vec<RollingContact<f64>> {
    let mut patches = vec![];
    for (a, b) in [(6e-3, 4e-3), (4e-3, 11e-3), (14e-3, 0.7e-3)] {
        for (xi, eta, phi) in [
            (0.0, 0.0, 0.0),
            (1e-5, -2e-5, 1e-3),
            (1e-3, 0.4e-3, 0.2),
            (-0.7e-3, 1.5e-3, -0.4),
            (0.0, -1e-3, 0.9),
            (2e-2, 3e-2, 0.3),
        ] {
            patches.push(RollingContact { a, b, normal_force: 6e4, friction: 0.35, xi, eta, phi });
        }
    }
    patches
}

#[test]
fn dual_value_is_the_f64_value_bitwise_and_its_slope_the_difference_quotient() {
    for kind in LAWS {
        let law = law(kind);
        // Without the state of rest, where Polach has a kink.
        for patch in patches().into_iter().filter(|p| p.eta != 0.0) {
            let x = [patch.a, patch.b, patch.normal_force, patch.friction, patch.xi, patch.eta, patch.phi];
            let contact = |x: [f64; 7]| RollingContact {
                a: x[0],
                b: x[1],
                normal_force: x[2],
                friction: x[3],
                xi: x[4],
                eta: x[5],
                phi: x[6],
            };
            let d: [Dual<7>; 7] = core::array::from_fn(|i| Dual::variable(x[i], i));
            let dual = law.force(&RollingContact {
                a: d[0],
                b: d[1],
                normal_force: d[2],
                friction: d[3],
                xi: d[4],
                eta: d[5],
                phi: d[6],
            });
            let value = law.force(&patch);
            assert_eq!(dual.map(|f| f.value), value, "{kind:?} {patch:?}");
            let steps = [1e-9, 1e-9, 1e-1, 1e-7, 1e-9, 1e-9, 1e-6];
            for m in 0..7 {
                let side = |s: f64| {
                    let mut near = x;
                    near[m] += s * steps[m];
                    law.force(&contact(near))
                };
                let (up, down) = (side(1.0), side(-1.0));
                for k in 0..3 {
                    let difference = (up[k] - down[k]) / (2.0 * steps[m]);
                    // Forces to 1e-9 of mu N, moments to 1e-9 of mu N a.
                    let scale = 2.1e4 * if k == 2 { patch.a.max(patch.b) } else { 1.0 };
                    let tolerance = 1e-4 * difference.abs() + 1e-6 * scale / steps[m] * 1e-2;
                    let slope = dual[k].slope[m];
                    assert!((slope - difference).abs() < tolerance, "{kind:?} {patch:?} {k} {m}: {slope} {difference}");
                }
            }
        }
    }
}

#[test]
fn a_mirrored_contact_gives_the_mirrored_force_bitwise() {
    for kind in LAWS {
        let law = law(kind);
        for patch in patches() {
            let [fx, fy, mz] = law.force(&patch);
            let mirrored = law.force(&RollingContact { eta: -patch.eta, phi: -patch.phi, ..patch });
            assert_eq!(mirrored, [fx, -fy, -mz], "{kind:?} {patch:?}");
        }
    }
}

#[test]
fn friction_bounds_the_force_and_full_slip_reaches_it() {
    for kind in &LAWS[1..] {
        let law = law(*kind);
        for patch in patches() {
            let limit = patch.normal_force * patch.friction;
            let [fx, fy, _] = law.force(&patch);
            assert!(fx.hypot(fy) <= limit * (1.0 + 1e-12), "{kind:?} {patch:?} {fx} {fy}");
            // Three flexibilities turn the slip of FASTSIM a little: by their ratio C11/C22, at most 1.3.
            let [fx, fy, _] = law.force(&RollingContact { xi: 0.3, eta: -0.4, phi: 0.0, ..patch });
            assert!((fx.hypot(fy) / limit - 1.0).abs() < 5e-3, "{kind:?} {fx} {fy}");
            assert!((fx / limit + 0.6).abs() < 0.15 && (fy / limit - 0.8).abs() < 0.15, "{kind:?} {patch:?} {fx} {fy}");
        }
    }
}

#[test]
fn a_patch_without_load_or_friction_carries_nothing() {
    for kind in &LAWS[1..] {
        for (normal_force, friction) in [(0.0, 0.3), (5e4, 0.0)] {
            let force = law(*kind).force(&RollingContact { normal_force, friction, ..patches()[2] });
            assert!(force.iter().all(|f| f.abs() < 1e-8), "{kind:?} {force:?}");
        }
    }
}

#[test]
fn vanishing_creepage_gives_the_linear_law() {
    let linear = law(CreepLaw::Linear);
    for kind in &LAWS[1..] {
        let law = law(*kind);
        for (xi, eta, phi) in [(1e-7, 0.0, 0.0), (0.0, 1e-7, 0.0), (0.0, 0.0, 1e-5)] {
            let patch = RollingContact { xi, eta, phi, ..patches()[0] };
            let ([fx, fy, _], [lx, ly, _]) = (law.force(&patch), linear.force(&patch));
            // Strips miss 1/(2 ny^2) of the ellipse and 1/nx^2 of the spin's parabola: at most 2.2 % on these grids.
            assert!((fx - lx).abs() < 0.022 * lx.abs() + 1e-9 && (fy - ly).abs() < 0.022 * ly.abs() + 1e-9, "{kind:?}");
        }
    }
    // C23 couples both ways: the moment of lateral creepage and the force of spin share one coefficient.
    let patch = patches()[0];
    let moment = linear.force(&RollingContact { eta: 1e-6, ..patch })[2];
    let force = linear.force(&RollingContact { phi: 1e-6, ..patch })[1];
    assert!((moment + force).abs() < 1e-12 * force.abs());
}

#[test]
fn fastsim_is_near_exact_theory() {
    let deviation = |kind: CreepLaw, rows: &[[f64; 7]]| {
        let law = law(kind);
        let sum: f64 = rows
            .iter()
            .map(|&[ratio, xi, eta, phi, fx, fy, _]| {
                let (a, b) = (6e-3 * ratio.sqrt(), 6e-3 / ratio.sqrt());
                let [x, y, _] = law
                    .force(&RollingContact { a, b, normal_force: 8e4, friction: 0.3, xi, eta, phi })
                    .map(|f| f / 2.4e4);
                (x - fx).powi(2) + (y - fy).powi(2)
            })
            .sum();
        (sum / rows.len() as f64).sqrt()
    };
    // Root mean square of the force error over mu N; over all 212 rows, of which these are every seventh, it is 0.036,
    // 0.040 and 0.045: a coarse grid hides part of the error of the converged method.
    for (n, most) in [(10, 0.043), (16, 0.047), (40, 0.052)] {
        let error = deviation(CreepLaw::Fastsim { nx: n, ny: n }, &CONTACT);
        assert!(error < most, "{n}: {error}");
    }
    // Polach without spin.
    let plain: Vec<[f64; 7]> = CONTACT.into_iter().filter(|row| row[3] == 0.0).collect();
    let error = deviation(CreepLaw::Polach, &plain);
    assert!(plain.len() > 5 && error < 0.05, "{error}");
}

#[test]
fn kalker_coefficients_are_smooth_and_join_their_asymptotes() {
    let kalker = Kalker::new(0.28);
    let at = |x: f64| kalker.at(x.exp());
    // Independent extrapolation from CONTACT at nu 0.28: a/b 0.1, 1, 10.
    for (ratio, c) in
        [(0.1, [3.4495, 2.5296, 0.4914]), (1.0, [4.2236, 3.7067, 1.4849]), (10.0, [11.9696, 13.3141, 15.0264])]
    {
        for (own, reference) in kalker.at(ratio).into_iter().zip(c) {
            assert!((own / reference - 1.0).abs() < 0.016, "{ratio}: {own} {reference}");
        }
    }
    for i in 0..2000 {
        let x = -8.0 + 8e-3 * f64::from(i);
        let (low, middle, high) = (at(x - 1e-3), at(x), at(x + 1e-3));
        for k in 0..4 {
            let (left, right) = ((middle[k] / low[k]).ln() / 1e-3, (high[k] / middle[k]).ln() / 1e-3);
            // No jump in ln C over ln(a/b), and no corner but the one to the asymptotes.
            assert!(left.abs() < 2.0 && (right - left).abs() < 0.2, "C{k} at {x}: {left} {right}");
        }
    }
}

#[test]
fn wrong_grids_and_materials_are_refused() {
    let refused = |law, material: &Material| CreepForce::new(law, material).unwrap_err().to_string();
    assert!(refused(CreepLaw::Fastsim { nx: 0, ny: 16 }, &Material::STEEL).contains("FASTSIM elements: 0"));
    assert!(refused(CreepLaw::Fastsim { nx: 16, ny: 41 }, &Material::STEEL).contains("FASTSIM elements: 41"));
    let soft = Material { poisson: 0.7, ..Material::STEEL };
    assert!(refused(CreepLaw::Polach, &soft).contains("Poisson's ratio: 0.7"));
}
