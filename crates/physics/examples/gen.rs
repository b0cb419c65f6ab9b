use klingel_physics::contact::creep::{Exact, Kalker};
use std::io::Write;
fn main() {
    let g: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let path = std::env::args().nth(2).unwrap();
    let n: usize = std::env::args().nth(3).map_or(40, |s| s.parse().unwrap());
    let e = Exact::new(g, 0.28, [n, n]).unwrap();
    let [c11, c22, c23, _] = Kalker::new(0.28).at(g);
    let mut rows: Vec<(&str, [f64; 3])> = vec![];
    for l in [0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0] {
        rows.push(("xi", [l, 0., 0.])); rows.push(("eta", [0., l, 0.])); rows.push(("phi", [0., 0., l]));
    }
    for l in [0.25, 0.5, 1.0, 2.0, 4.0] { let h = l / 2f64.sqrt(); rows.push(("xi+eta", [h, h, 0.])); }
    for l in [0.25, 0.5, 1.0, 2.0, 4.0] { for p in [0.25, 1.0, 3.0] { rows.push(("eta+phi", [0., l, p])); rows.push(("eta+phi", [0., -l, p])); rows.push(("xi+phi", [l, 0., p])); } }
    for l in [1.0, 2.0, 4.0, 8.0, 16.0] { for p in [0.5, 2.0] { rows.push(("xi+eta+phi", [0.2 * l, 0.15 * l, p])); rows.push(("xi+eta+phi", [0.2 * l, -0.15 * l, p])); } }
    let mut out = std::fs::File::create(path).unwrap();
    writeln!(out, "# Exact rolling contact (Klingel's own solver, {n}x{n} elements, Hertzian, steady rolling, nu 0.28, G 82 GPa). Columns, signs and units as in creep_force.csv").unwrap();
    writeln!(out, "aob,kind,a_mm,b_mm,xi,eta,phi_1permm,FN_N,mu,fx_rel,fy_rel,mz_rel_c,n_adh,n_slip").unwrap();
    let (a, b) = (6e-3 * g.sqrt(), 6e-3 / g.sqrt());
    let k = 82e9 * a * b / 24e3;
    let mut worst = 0.0f64; let t = std::time::Instant::now(); let mut mv = 0;
    for (kind, l) in rows {
        let c = [l[0] / c11, l[1] / c22, l[2] / c23];
        let s = e.solve(c).unwrap(); worst = worst.max(s.residual); mv += s.steps;
        if s.residual > 1e-6 { eprintln!("NOT CONVERGED {kind} {l:?} {}", s.residual); }
        let [x, y, z] = s.force.map(|f| if f.abs() < 1e-9 { 0.0 } else { f });
        writeln!(out, "{g},{kind},{:.9},{:.9},{:.10},{:.10},{:.10e},80000.0,0.3,{x:.8},{y:.8},{z:.8},{},{}", a * 1e3, b * 1e3, c[0] / k, c[1] / k, c[2] / k / (a * b).sqrt() * 1e-3, s.sticking, s.slipping).unwrap();
    }
    println!("{g}: worst residual {worst:.1e}, {mv} matvecs, {:.1} s", t.elapsed().as_secs_f64());
}
