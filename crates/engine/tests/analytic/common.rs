//! Small specs for the analytic cases, and a plant that is integrated from any state.
//! Test bodies move on a track frame but need no wheels; gravity is an argument of the spec.

use klingel_engine::control::Externals;
use klingel_engine::integrate::Etdrk4;
use klingel_engine::rates::Workspace;
use klingel_engine::spec::Spec;
use klingel_engine::{Model, Progress, TimeSeries, compile, equilibrium, rates, simulate};
use klingel_physics::{Dual, Scalar};
use nalgebra::DMatrix;
use serde_json::{Value, json};

/// One segment of track whose curvature \[1/m\] and cant \[m\] run linearly; the vehicle starts 5 m from its start.
pub fn track(length: f64, curvature: [f64; 2], cant: [f64; 2]) -> Value {
    json!({ "segments": [{ "length": length, "curvature": curvature, "cant": cant }], "start": 5.0, "cant_base": 1.5 })
}

pub fn straight(length: f64) -> Value {
    track(length, [0.0; 2], [0.0; 2])
}

/// A spec without wheels: bodies and elements on a track, at 10 m/s.
pub fn bodies(gravity: f64, track: Value, bodies: Value) -> Value {
    json!({ "name": "bodies", "gravity": gravity, "speed": 10.0, "track": track, "bodies": bodies,
            "run": { "duration": 1.0, "step": 0.0005, "record_interval": 0.001, "equilibrium": false } })
}

/// A solid wheelset of the Manchester coach without any suspension, on rails that lean inwards by `inclination`.
pub fn wheelset(wheel: Value, inclination: f64, track: Value, speed: f64, duration: f64) -> Value {
    json!({
        "name": "wheelset", "gravity": 9.81, "speed": speed, "track": track,
        "bodies": [{ "name": "wheelset", "mass": 1813.0, "inertia": [1120.0, 0.0, 1120.0],
                     "position": [0.0, 0.0, -0.46], "pitches": false,
                     "rotors": [{ "name": "spin", "inertia": 112.0 }] }],
        "contact_pairs": [{ "wheel": wheel, "rail": { "named": "60e1" }, "rail_inclination": inclination,
                            "gauge": 1.435, "flange_back": 1.36, "radius": 0.46 }],
        "wheels": wheels("wheelset", ["spin", "spin"]),
        "creep": { "law": "fastsim", "elements": [16, 16], "contact_dissipation": 3.0 },
        "run": { "duration": duration, "step": 0.0005, "record_interval": 0.001, "equilibrium": true }
    })
}

/// A wheel with a coned tread and a flange behind a root so wide that tread, root and flange follow one another on the
/// rail: from the field side along the cone to y = -32 mm, an arc of 25 mm up to 68 degrees, 6 mm of flank, a round tip.
pub fn cone(slope: f64) -> Value {
    let (mut points, mut angle) = (vec![[0.06, -0.06 * slope]], slope.atan());
    let mut go = |length: f64, curvature: f64| {
        let step = length / (length / 2e-4).ceil();
        for _ in 0..(length / step).round() as usize {
            let [y, z] = points[points.len() - 1];
            let middle = angle + 0.5 * step * curvature;
            points.push([y - step * middle.cos(), z + step * middle.sin()]);
            angle += step * curvature;
        }
    };
    let (flank, turned) = (68.0_f64.to_radians(), slope.atan());
    go(0.092 / turned.cos(), 0.0);
    go(0.025 * (flank - turned), 1.0 / 0.025);
    go(0.006, 0.0);
    go(0.012 * (flank + 0.5), -1.0 / 0.012);
    points.reverse();
    let column = |c: usize| points.iter().map(|p| p[c]).collect::<Vec<f64>>();
    json!({ "points": { "y": column(0), "z": column(1) } })
}

/// Left and right wheel of a body.
pub fn wheels(body: &str, rotors: [&str; 2]) -> Value {
    let wheel = |side: &str, rotor: &str| json!({ "name": format!("{body}.{side}"), "body": body, "rotor": rotor, "side": side, "pair": 0, "friction": 0.35 });
    json!([wheel("left", rotors[0]), wheel("right", rotors[1])])
}

pub fn spec(value: &Value) -> Spec {
    serde_json::from_value(value.clone()).expect("a readable spec")
}

pub fn run(value: &Value) -> TimeSeries {
    simulate(&spec(value), Externals::new(), &Progress::default()).expect("a run")
}

/// One channel over time.
pub fn channel(series: &TimeSeries, name: &str) -> Vec<f64> {
    let i = series.channels.iter().position(|c| c.0 == name).unwrap_or_else(|| panic!("no channel {name}"));
    series.rows.chunks(series.channels.len()).map(|row| row[i]).collect()
}

/// A compiled model with its workspace.
pub struct Plant {
    pub model: Model,
    pub work: Workspace<f64>,
}

impl Plant {
    pub fn new(value: &Value) -> Self {
        let model = compile(&spec(value)).expect("a model");
        let work = Workspace::new(&model);
        Self { model, work }
    }

    /// Index of a state by its dotted name.
    pub fn state(&self, name: &str) -> usize {
        self.model.state_names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no state {name}"))
    }

    pub fn design_state(&self) -> Vec<f64> {
        equilibrium::design_state(&self.model)
    }

    pub fn equilibrium(&self) -> Vec<f64> {
        equilibrium::equilibrium(&self.model).expect("an equilibrium")
    }

    pub fn rates(&mut self, x: &[f64]) -> Vec<f64> {
        let mut dx = vec![0.0; x.len()];
        rates(&self.model, x, &self.model.inputs, &mut self.work, &mut dx).expect("wheels on their rails");
        dx
    }

    /// Integrates `x` in place and shows every state on the way, the first one included, to `look`.
    pub fn advance(&mut self, x: &mut [f64], step: f64, steps: usize, mut look: impl FnMut(&mut Self, &[f64])) {
        let mut scheme = Etdrk4::new(step, &self.model.poles);
        let mut first = vec![0.0; x.len()];
        for _ in 0..steps {
            look(self, x);
            let Self { model, work } = self;
            rates(model, x, &model.inputs, work, &mut first).expect("wheels on their rails");
            scheme.advance(x, &first, |_, at, dx| rates(model, at, &model.inputs, work, dx)).expect("a step");
        }
        look(self, x);
    }

    /// Exact slopes of all rates over all states.
    pub fn jacobian(&self, x: &[f64]) -> DMatrix<f64> {
        const WIDE: usize = 8;
        let n = x.len();
        let mut slopes = DMatrix::zeros(n, n);
        let mut work = Workspace::<Dual<WIDE>>::new(&self.model);
        let mut dx = vec![Dual::<WIDE>::default(); n];
        for first in (0..n).step_by(WIDE) {
            let seed = |i: usize| {
                if i >= first && i < first + WIDE { Dual::variable(x[i], i - first) } else { Dual::constant(x[i]) }
            };
            let dual: Vec<_> = (0..n).map(seed).collect();
            rates(&self.model, &dual, &klingel_engine::inputs::nominal(&self.model), &mut work, &mut dx)
                .expect("wheels on their rails");
            for d in 0..WIDE.min(n - first) {
                for i in 0..n {
                    slopes[(i, first + d)] = dx[i].slope[d];
                }
            }
        }
        slopes
    }

    /// Depth of the tape circles under the rails at which a centred wheel carries `load` \[m, N\].
    pub fn depth_under(&self, load: f64) -> f64 {
        let table = &self.model.wheels[0].table;
        let carried = |depth: f64| -> f64 {
            let patches = table.patches(0.0, depth, 0.0, 0.0).expect("a place in the table");
            patches.iter().map(|p| p.normal_force * p.angle.cos()).sum()
        };
        bisect(-1e-3, 3e-4, |depth| carried(depth) - load)
    }
}

/// The root of a rising function between two places.
pub fn bisect(mut low: f64, mut high: f64, rising: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rising(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A reproducible sequence of numbers in -1 to 1 (Numerical Recipes' 64-bit linear congruence).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
