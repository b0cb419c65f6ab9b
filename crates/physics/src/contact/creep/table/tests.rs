use super::*;
#[test]
#[ignore]
fn bootstrap() {
    let m = Maker::new(0.28, [16, 16], [4, 4, 4, 4]).unwrap();
    let parts: Vec<_> = (0..m.parts()).map(|i| m.solve(i).unwrap()).collect();
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/data/creep_table.bin"), m.finish(&parts).unwrap()).unwrap();
}
