use klingel_physics::contact::creep::Exact;
fn main() {
    for (g, r) in [(0.2, [3.5034,2.6378,0.6188]), (0.5, [3.7366,3.0215,0.937]), (1.0, [4.2236,3.7067,1.4849]), (2.0, [5.2242,5.0058,2.6877]), (5.0, [7.9705,8.408,6.8317])] {
        for n in [60, 80] {
            let e = Exact::new(g, 0.28, [n, n]).unwrap();
            let s = 1e-7;
            let x = e.solve([s, 0., 0.]).unwrap(); let y = e.solve([0., s, 0.]).unwrap(); let z = e.solve([0., 0., s]).unwrap();
            println!("{g} {n} C11 {:.4} ({:.4}) C22 {:.4} ({:.4}) C23 {:.4} ({:.4}) C32 {:.4} C33 {:.4}  mv {}", -x.force[0]/s, r[0], -y.force[1]/s, r[1], -z.force[1]/s, r[2], y.force[2]/s, -z.force[2]/s, x.steps+y.steps+z.steps);
        }
    }
}
