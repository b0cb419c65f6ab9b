use klingel_physics::contact::creep::Exact;
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let n: usize = std::env::args().nth(2).map_or(40, |s| s.parse().unwrap());
    let text = std::fs::read_to_string(path).unwrap();
    let (mut sum, mut most, mut count) = (0.0, 0.0f64, 0);
    let mut ell: Option<(f64, Exact)> = None;
    let t0 = std::time::Instant::now();
    let mut msum=[0.0f64;2];
    for line in text.lines().filter(|l| !l.starts_with('#') && !l.starts_with("aob")) {
        let v: Vec<&str> = line.split(',').collect();
        let x: Vec<f64> = v.iter().map(|s| s.parse().unwrap_or(0.0)).collect();
        let (a, b) = (x[2]*1e-3, x[3]*1e-3);
        if ell.as_ref().is_none_or(|e| (e.0/x[0]-1.0).abs()>1e-9) { ell = Some((x[0], Exact::new(x[0], 0.28, [n,n]).unwrap())); }
        let k = 82e9*a*b/(x[7]*x[8]);
        let c = [x[4]*k, x[5]*k, x[6]*1e3*k*(a*b).sqrt()];
        let t = std::time::Instant::now();
        let s = ell.as_ref().unwrap().1.solve(c).unwrap();
        let e = (s.force[0]-x[9]).hypot(s.force[1]-x[10]);
        sum += e*e; most = most.max(e); count += 1; msum[0]+=(s.force[2]-x[11]).powi(2); msum[1]=msum[1].max((s.force[2]-x[11]).abs());
        println!("{} {:11} c {:7.3} {:7.3} {:7.3}  F {:8.5} {:8.5} {:8.5}  err {:8.5} {:8.5} {:8.5}  ad {} {} sl {} {} it {} mv {} ch {:.1e} {:.0} ms", v[0], v[1], c[0],c[1],c[2], s.force[0],s.force[1],s.force[2], s.force[0]-x[9], s.force[1]-x[10], s.force[2]-x[11], s.sticking, v[12], s.slipping, v[13], s.steps, s.steps, s.residual, t.elapsed().as_secs_f64()*1e3);
    }
    println!("rms {:.5} max {:.5} moment rms {:.5} max {:.5}  {:.1} s", (sum/count as f64).sqrt(), most, (msum[0]/count as f64).sqrt(), msum[1], t0.elapsed().as_secs_f64());
}
