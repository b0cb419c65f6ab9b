//! Cost of the contact of one wheel: building the table and reading it, in f64 and with derivatives.
//! Run with `cargo bench -p klingel-physics`.

use divan::{Bencher, black_box};
use klingel_physics::Dual;
use klingel_physics::contact::{ContactTable, Material, NormalContact, PairGeometry, Profile};
use std::sync::LazyLock;

fn main() {
    divan::main();
}

fn pair() -> PairGeometry {
    PairGeometry {
        wheel: Profile::s1002(),
        rail: Profile::rail_60e1(),
        rail_inclination: 0.025,
        gauge: 1.435,
        flange_back: 1.36,
        radius: 0.46,
    }
}

static TABLE: LazyLock<ContactTable> = LazyLock::new(|| {
    ContactTable::build(&pair(), &Material::STEEL, NormalContact::Hertz).expect("S1002 on 60E1 is a valid pair")
});

/// The height w that presses the tread in by 0.07 mm at a shift.
fn pressed(shift: f64) -> f64 {
    let patches = TABLE.patches(shift, 0.0, 0.0, 0.0).expect("within the table");
    7e-5 - patches[0].penetration
}

#[divan::bench(sample_count = 3)]
fn build() -> ContactTable {
    ContactTable::build(&pair(), &Material::STEEL, NormalContact::Hertz).expect("S1002 on 60E1 is a valid pair")
}

/// Tread alone, and tread with root.
#[divan::bench(args = [0.001, 0.0047])]
fn table_f64(bencher: Bencher, shift: f64) {
    let w = pressed(shift);
    bencher.bench(|| TABLE.patches(black_box(shift), black_box(w), black_box(1e-4), black_box(1e-3)));
}

#[divan::bench(args = [0.001, 0.0047])]
fn table_dual4(bencher: Bencher, shift: f64) {
    let w = pressed(shift);
    bencher.bench(|| {
        let d = |x, i| Dual::<4>::variable(black_box(x), i);
        TABLE.patches(d(shift, 0), d(w, 1), d(1e-4, 2), d(1e-3, 3))
    });
}
