//! The hunting of an elastically guided wheelset against its characteristic equation.
//! The derivation is in docs/theory/wheelset.md; the guide is a body too heavy to move, gravity is a preload.

use crate::common::{Plant, bisect, bodies, channel, cone, run, straight, wheels};
use klingel_physics::contact::Material;
use klingel_physics::contact::creep::Kalker;
use serde_json::{Value, json};

const MASS: f64 = 1813.0;
const INERTIA: f64 = 1120.0;
/// Weight on the axle \[N\], lateral \[N/m\] and yaw stiffness \[N m/rad\] of the guide.
const WEIGHT: f64 = 112e3;
const LATERAL: f64 = 1e6;
const YAW: f64 = 1e6;
/// Slope of the cone and of the rail's axis, and radius of the rail head's middle arc \[m\].
const CONE: f64 = 0.025;
const RAIL: f64 = 0.3;

fn guided(spin_inertia: f64, speed: f64) -> Value {
    let mut case = bodies(
        0.0,
        straight(300.0),
        json!([
            { "name": "guide", "mass": 1e12, "inertia": [1e12, 1e12, 1e12], "position": [0.0, 0.0, -0.46] },
            { "name": "wheelset", "mass": MASS, "inertia": [INERTIA, 0.0, INERTIA], "position": [0.0, 0.0, -0.46],
              "pitches": false, "rotors": [{ "name": "spin", "inertia": spin_inertia }] }
        ]),
    );
    case["speed"] = json!(speed);
    case["contact_pairs"] = json!([{ "wheel": cone(CONE), "rail": { "named": "60e1" }, "rail_inclination": CONE,
        "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }]);
    case["wheels"] = wheels("wheelset", ["spin", "spin"]);
    case["creep"] = json!({ "law": "linear", "elements": [1, 1], "contact_dissipation": 3.0 });
    case["bushings"] = json!([{ "name": "guide", "joint": { "a": "guide", "b": "wheelset", "point": [0.0, 0.0, -0.46] },
        "stiffness": [1e7, LATERAL, 0.0], "rotational_stiffness": [0.0, 0.0, YAW], "preload": [0.0, 0.0, WEIGHT] }]);
    case
}

/// On its rails under the weight, rolling without longitudinal creep.
fn rolling(plant: &Plant) -> Vec<f64> {
    let depth = plant.depth_under(0.5 * WEIGHT);
    let mut x = plant.design_state();
    x[plant.state("wheelset.z")] += depth;
    let patch = plant.model.wheels[1].table.patches(0.0, depth, 0.0, 0.0).expect("contact")[0];
    x[plant.state("wheelset.spin.spin_speed")] = plant.model.speed / patch.radius;
    x
}

/// Largest growth rate \[1/s\] of the oscillations faster than 1 rad/s; slower ones are the guide's.
fn growth(spin_inertia: f64, speed: f64) -> f64 {
    let plant = Plant::new(&guided(spin_inertia, speed));
    let x = rolling(&plant);
    let eigenvalues = plant.jacobian(&x).complex_eigenvalues();
    eigenvalues.iter().filter(|e| e.im.abs() > 1.0).map(|e| e.re).fold(f64::MIN, f64::max)
}

/// What the theory needs, from the contact table and Kalker's coefficients at the static load.
struct Theory {
    f: [f64; 4],
    /// Half distance of the contacts, rolling radius \[m\].
    b: f64,
    r0: f64,
    spin_inertia: f64,
}

impl Theory {
    fn new(spin_inertia: f64) -> Self {
        let plant = Plant::new(&guided(spin_inertia, 10.0));
        let wheel = &plant.model.wheels[1];
        let p = wheel.table.patches(0.0, plant.depth_under(0.5 * WEIGHT), 0.0, 0.0).expect("contact")[0];
        let c = Kalker::new(Material::STEEL.poisson).at(p.a / p.b);
        let (area, g) = (p.a * p.b, Material::STEEL.shear_modulus());
        let f = [g * area * c[0], g * area * c[1], g * area.powf(1.5) * c[2], g * area * area * c[3]];
        Self { f, b: wheel.half_tape_distance + p.y_wheel, r0: p.radius, spin_inertia }
    }

    /// Roll per shift Gamma, lateral slip per lateral velocity kappa, conicity lambda.
    fn geometry(&self) -> [f64; 3] {
        let arm = self.b - self.r0 * CONE;
        [CONE / arm, self.b / arm, CONE * (self.b + RAIL * CONE) / arm]
    }

    /// The critical speed in closed form, without gyroscope and spin creepage.
    fn closed_form(&self) -> f64 {
        let ([_, kappa, lambda], [f11, f22, ..]) = (self.geometry(), self.f);
        let (c1, c2) = (2.0 * f22 * kappa * kappa, 2.0 * f11 * self.b * self.b);
        let a0 = LATERAL * YAW + 4.0 * f11 * f22 * kappa * self.b * lambda / self.r0;
        let (a1, a3) = (c1 * YAW + c2 * LATERAL, MASS * c2 + INERTIA * c1);
        let rest = a1 * MASS * INERTIA / a3 + a3 * a0 / a1 - MASS * YAW - INERTIA * LATERAL;
        (c1 * c2 / rest).sqrt()
    }

    /// Coefficients of s^0 to s^4 with gyroscope, spin creepage and the unstable yaw of the load.
    fn quartic(&self, speed: f64) -> [f64; 5] {
        let ([gamma, kappa, lambda], [f11, f22, f23, f33]) = (self.geometry(), self.f);
        let c1 = 2.0 * f22 * kappa * kappa / speed;
        let c2 = 2.0 * (f11 * self.b * self.b + f33) / speed;
        let yaw = YAW + 2.0 * f23 - WEIGHT * self.b * CONE;
        let cross = 2.0 * f23 * kappa / speed - self.spin_inertia * speed / self.r0 * gamma;
        let (steer, centre) = (2.0 * f22 * kappa, 2.0 * f11 * self.b * lambda / self.r0);
        [
            LATERAL * yaw + steer * centre,
            c1 * yaw + c2 * LATERAL - (steer + centre) * cross,
            MASS * yaw + INERTIA * LATERAL + c1 * c2 + cross * cross,
            MASS * c2 + INERTIA * c1,
            MASS * INERTIA,
        ]
    }

    /// Where Routh's determinant of the quartic changes its sign.
    fn critical_speed(&self) -> f64 {
        bisect(20.0, 200.0, |speed| {
            let [a0, a1, a2, a3, a4] = self.quartic(speed);
            a1 * a1 * a4 + a3 * a3 * a0 - a1 * a2 * a3
        })
    }
}

/// 0.2 %: what stays out are the small lateral stiffness of the load and the change of the spin force with it.
#[test]
fn the_critical_speed_is_that_of_the_characteristic_equation() {
    for spin_inertia in [112.0, 10.0] {
        let engine = bisect(20.0, 200.0, |speed| growth(spin_inertia, speed));
        let theory = Theory::new(spin_inertia).critical_speed();
        assert!((engine / theory - 1.0).abs() < 0.002, "{engine} m/s, expected {theory} m/s");
    }
}

/// 0.2 %: with a light axle the gyroscope is small, and the two effects of spin creepage cancel.
#[test]
fn the_critical_speed_is_the_closed_form() {
    let engine = bisect(20.0, 200.0, |speed| growth(1.0, speed));
    let theory = Theory::new(1.0).closed_form();
    assert!((engine / theory - 1.0).abs() < 0.002, "{engine} m/s, expected {theory} m/s");
}

/// What the eigenvalues say is what a run does: the kicked wheelset calms down below the critical speed, not above.
#[test]
fn runs_decay_below_the_critical_speed_and_grow_above() {
    let critical = Theory::new(112.0).critical_speed();
    for (share, grows) in [(0.95, false), (1.05, true)] {
        let speed = share * critical;
        let plant = Plant::new(&guided(112.0, speed));
        let mut case = guided(112.0, speed);
        let sunk = plant.depth_under(0.5 * WEIGHT);
        let (duration, step) = (2.4, 5e-4);
        case["run"] = json!({ "duration": duration, "step": step, "record_interval": step, "equilibrium": false,
            "kicks": [{ "body": "wheelset", "displacement": [0.0, 0.0, sunk], "rotation": [0.0, 0.0, 1e-5] }] });
        let y = channel(&run(&case), "wheelset.y");
        let largest = |from: f64, to: f64| {
            let at = |t: f64| (t / step) as usize;
            y[at(from)..at(to)].iter().fold(0.0_f64, |m, y| m.max(y.abs()))
        };
        let (early, late) = (largest(0.4, 0.8), largest(2.0, 2.4));
        assert_eq!(late > early, grows, "{early:e} to {late:e} m at {speed} m/s");
        assert!(early > 1e-7 && late < 1e-3);
    }
}
