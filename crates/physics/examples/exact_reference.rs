//! Reference rows of exact rolling contact: a ladder of creepages on one ellipse, as comma-separated values.
//! Run: cargo run --release -p klingel-physics --example exact_reference -- <a/b> [elements] > reference.csv

use klingel_physics::contact::creep::{Exact, Kalker};

const POISSON: f64 = 0.28;
const SHEAR_MODULUS: f64 = 82e9;
const NORMAL_FORCE: f64 = 80e3;
const FRICTION: f64 = 0.3;
/// Geometric mean of the semi-axes, m.
const MEAN: f64 = 6e-3;

/// Kind and [xi, eta, phi] as parts of the creepages whose linear forces are mu N: 0.05 to 10 alone, then together.
fn ladder() -> Vec<(&'static str, [f64; 3])> {
    let mut rows = vec![];
    for l in [0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0] {
        rows.extend([("xi", [l, 0.0, 0.0]), ("eta", [0.0, l, 0.0]), ("phi", [0.0, 0.0, l])]);
    }
    let steps = [0.25, 0.5, 1.0, 2.0, 4.0];
    for l in steps {
        rows.push(("xi+eta", [l * f64::sqrt(0.5), l * f64::sqrt(0.5), 0.0]));
    }
    for l in steps {
        for p in [0.25, 1.0, 3.0] {
            rows.extend([("eta+phi", [0.0, l, p]), ("eta+phi", [0.0, -l, p]), ("xi+phi", [l, 0.0, p])]);
        }
    }
    for l in steps {
        for p in [0.5, 2.0] {
            rows.extend([0.6, -0.6].map(|part| ("xi+eta+phi", [0.8 * l, part * l, p])));
        }
    }
    rows
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let ratio: f64 = arguments.next().ok_or("give a/b, for example 0.5")?.parse()?;
    let n: usize = arguments.next().map_or(Ok(40), |s| s.parse())?;
    let ellipse = Exact::new(ratio, POISSON, [n, n])?;
    let [c11, c22, c23, _] = Kalker::new(POISSON).at(ratio);
    let (a, b) = (MEAN * ratio.sqrt(), MEAN / ratio.sqrt());
    let scale = SHEAR_MODULUS * MEAN * MEAN / (FRICTION * NORMAL_FORCE);
    println!(
        "# Exact theory, {n}x{n} elements, Hertzian, steady rolling, nu {POISSON}, G {} GPa. Force on the wheel over \
         mu FN, moment over mu FN sqrt(ab); positive creepage gives negative force; a in the rolling direction",
        SHEAR_MODULUS * 1e-9
    );
    println!("aob,kind,a_mm,b_mm,xi,eta,phi_1permm,FN_N,mu,fx_rel,fy_rel,mz_rel_c,n_adh,n_slip");
    for (kind, [xi, eta, phi]) in ladder() {
        let scaled = [xi / c11, eta / c22, phi / c23];
        let found = ellipse.solve(scaled)?;
        let [fx, fy, mz] = found.force;
        let [xi, eta, phi] = scaled.map(|c| c / scale);
        println!(
            "{ratio},{kind},{:.9},{:.9},{xi:.10e},{eta:.10e},{:.10e},{NORMAL_FORCE:?},{FRICTION},\
             {fx:.8},{fy:.8},{mz:.8},{},{}",
            a * 1e3,
            b * 1e3,
            phi / MEAN * 1e-3,
            found.sticking,
            found.slipping
        );
    }
    Ok(())
}
