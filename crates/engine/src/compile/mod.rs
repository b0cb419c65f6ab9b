//! Spec to model: names become indices, design points become body-fixed points, numbers are checked.
//! Order of the states: bodies, rotors, dampers' forces, actuators, drives, speed hold, stick of the wheels.

mod elements;
mod motors;
mod wheels;

use crate::error::EngineError;
use crate::inputs::Places;
use crate::model::{Body, Course, Drive, Joint, Model, Rotor};
use crate::spec::{BodySpec, JointSpec, RunSpec, SegmentSpec, Spec, TrackSpec, UniformSpec};
use klingel_physics::contact::Material;
use klingel_physics::track::{Adhesion, Alignment, Segment, UniformTrack};

use motors::motor_inputs;
pub use wheels::{named_profile, pair_geometry, prepare};

/// Speed v0 that keeps creepages finite at standstill \[m/s\].
const CREEP_FLOOR: f64 = 0.1;

/// Compiles a spec.
///
/// # Errors
/// Everything that `EngineError` lists before `Equilibrium`.
pub fn compile(spec: &Spec) -> Result<Model, EngineError> {
    let track = course(&spec.track)?;
    check_run(spec, &track)?;

    let mut states = States::default();
    let bodies = spec.bodies.iter().map(|b| body(b, &mut states)).collect::<Result<Vec<_>, _>>()?;
    let mut c = Compiler {
        spec,
        bodies,
        rotors: Vec::new(),
        joints: Vec::new(),
        joint_specs: Vec::new(),
        drives: Vec::new(),
        states,
    };
    c.rotors()?;
    let bushings = c.bushings()?;
    let maxwells = c.maxwells()?;
    let stops = c.stops()?;
    let mut inputs = motor_inputs(spec);
    let actuators = c.actuators(&mut inputs)?;
    let dc_motors = c.dc_motors()?;
    let induction_motors = c.induction_motors()?;
    let drag = c.drag()?;
    let hold = c.hold()?;
    let adhesion = spec.adhesion.as_ref().map(|a| Adhesion::new(&a.s, &a.left, &a.right)).transpose()?;
    let material = Material::STEEL;
    let wheels = c.wheels(&material)?;
    let (creep, falling_friction) = wheels::creep_law(&spec.creep, &material)?;
    let Compiler { bodies, rotors, joints, drives, states, .. } = c;
    let places = Places::new(inputs.len(), wheels.len(), hold.is_some());
    inputs.resize(places.count, 0.0);
    if hold.is_some() {
        inputs[places.speed] = spec.speed;
    }
    let joint_pairs = mirror_partners(&joints);
    Ok(Model {
        track,
        cant_base: spec.track.cant_base,
        gravity: spec.gravity,
        speed: spec.speed,
        start: spec.track.start,
        bodies,
        rotors,
        joints,
        joint_pairs,
        bushings,
        maxwells,
        stops,
        actuators,
        wheels,
        drives,
        dc_motors,
        induction_motors,
        drag,
        hold,
        adhesion,
        creep,
        falling_friction,
        creep_floor: CREEP_FLOOR,
        contact_dissipation: spec.creep.contact_dissipation,
        poles: states.poles,
        state_names: states.names,
        state_units: states.units,
        inputs,
        places,
        run: spec.run.clone(),
    })
}

fn course(track: &TrackSpec) -> Result<Course, EngineError> {
    let cant_base = positive("track", "cant_base", track.cant_base)?;
    if let Some(UniformSpec { curvature, cant }) = track.uniform {
        if !track.segments.is_empty() {
            return Err(value("track.segments", track.segments.len(), "leave them out on a uniform track"));
        }
        // the limits of a laid track hold as well
        Alignment::new(
            &[Segment { length: 1.0, curvature: [curvature; 2], cant: [cant; 2], grade: [0.0; 2] }],
            cant_base,
        )?;
        return Ok(Course::Uniform(UniformTrack { curvature, cant, cant_base }));
    }
    let segment = |s: &SegmentSpec| Segment { length: s.length, curvature: s.curvature, cant: s.cant, grade: s.grade };
    let segments: Vec<Segment> = track.segments.iter().map(segment).collect();
    Ok(Course::Laid(Alignment::new(&segments, cant_base)?))
}

/// Names and decay rates of the states, in order.
#[derive(Default)]
struct States {
    names: Vec<String>,
    units: Vec<&'static str>,
    poles: Vec<f64>,
}

impl States {
    fn add(&mut self, name: String, unit: &'static str, pole: f64) -> usize {
        self.names.push(name);
        self.units.push(unit);
        self.poles.push(pole);
        self.names.len() - 1
    }
}

fn value(place: impl Into<String>, value: impl ToString, remedy: &str) -> EngineError {
    EngineError::Value { place: place.into(), value: value.to_string(), remedy: remedy.into() }
}

fn positive(place: &str, key: &str, x: f64) -> Result<f64, EngineError> {
    if x > 0.0 && x.is_finite() { Ok(x) } else { Err(value(format!("{place}.{key}"), x, "give a positive number")) }
}

fn check_run(spec: &Spec, track: &Course) -> Result<(), EngineError> {
    let RunSpec { duration, step, record_interval, .. } = spec.run;
    positive("run", "duration", duration)?;
    positive("run", "step", step)?;
    if spec.run.implicit_below < 0.0 || spec.run.implicit_below.is_nan() {
        return Err(value("run.implicit_below", spec.run.implicit_below, "give a speed, or 0 for explicit steps only"));
    }
    if !whole(record_interval / step) {
        return Err(value("run.record_interval", record_interval, "make it a multiple of the step"));
    }
    if let Some(control) = &spec.control
        && !whole(control.sample_time / step)
    {
        return Err(value("control.sample_time", control.sample_time, "make it a multiple of the step"));
    }
    let bent = match track {
        Course::Laid(_) => spec.track.segments.iter().any(|s| s.curvature != [0.0; 2] || s.cant != [0.0; 2]),
        Course::Uniform(track) => track.curvature != 0.0 || track.cant != 0.0,
    };
    if let Some(b) = spec.bodies.iter().find(|b| bent && !b.guided.is_empty()) {
        return Err(value(format!("{}.guided", b.name), b.guided.join(", "), "guide bodies on straight level track"));
    }
    let Course::Laid(track) = track else { return Ok(()) };
    let front = spec.bodies.iter().map(|b| b.position[0]).fold(f64::MIN, f64::max);
    let rear = spec.bodies.iter().map(|b| b.position[0]).fold(f64::MAX, f64::min);
    let acceleration = spec.hold.as_ref().map_or(0.0, |h| h.acceleration);
    let way = spec.speed * duration + 0.5 * acceleration * duration * duration;
    let end = spec.track.start + front + way;
    if spec.track.start + rear < 0.0 || end > track.length() + 1e-6 * track.length() {
        return Err(value(
            "run.duration",
            duration,
            &format!(
                "the vehicle would run from {:.1} to {end:.1} m on a track of 0 to {:.1} m; lengthen the track's ends",
                spec.track.start + rear,
                track.length()
            ),
        ));
    }
    Ok(())
}

fn whole(ratio: f64) -> bool {
    ratio >= 1.0 - 1e-9 && (ratio - ratio.round()).abs() < 1e-6
}

fn body(b: &BodySpec, states: &mut States) -> Result<Body, EngineError> {
    positive(&b.name, "mass", b.mass)?;
    for (axis, inertia) in b.inertia.iter().enumerate() {
        if b.pitches || axis != 1 {
            positive(&b.name, "inertia", *inertia)?;
        }
    }
    let names = ["s", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "wx", "wy", "wz"];
    let first = states.names.len();
    for name in names.iter().filter(|name| b.pitches || !["pitch", "wy"].contains(name)) {
        let unit = match name.as_bytes() {
            [b'v', _] => "m/s",
            [b'w', _] => "rad/s",
            [_] => "m",
            _ => "rad",
        };
        states.add(format!("{}.{name}", b.name), unit, 0.0);
    }
    Ok(Body {
        name: b.name.clone(),
        mass: b.mass,
        inertia: b.inertia,
        position: b.position,
        pitches: b.pitches,
        guided: guided(b)?,
        state: first,
    })
}

/// The coordinates that a guide keeps.
fn guided(b: &BodySpec) -> Result<[bool; 6], EngineError> {
    let mut kept = [false; 6];
    for word in &b.guided {
        let at = ["x", "y", "z", "roll", "pitch", "yaw"].iter().position(|known| known == word);
        let at = at.filter(|&c| c != 4 || b.pitches);
        kept[at.ok_or_else(|| value(format!("{}.guided", b.name), word, "name motions that the body has"))?] = true;
    }
    Ok(kept)
}

struct Compiler<'a> {
    spec: &'a Spec,
    bodies: Vec<Body>,
    rotors: Vec<Rotor>,
    joints: Vec<Joint>,
    joint_specs: Vec<&'a JointSpec>,
    drives: Vec<Drive>,
    states: States,
}

impl<'a> Compiler<'a> {
    fn body(&self, place: &str, name: &str) -> Result<usize, EngineError> {
        self.bodies.iter().position(|b| b.name == name).ok_or_else(|| EngineError::Unknown {
            place: place.into(),
            what: "body",
            name: name.into(),
            known: self.bodies.iter().map(|b| b.name.as_str()).collect::<Vec<_>>().join(", "),
        })
    }

    fn rotor(&self, place: &str, body: usize, name: &str) -> Result<usize, EngineError> {
        self.rotors.iter().position(|r| r.body == body && r.name == name).ok_or_else(|| EngineError::Unknown {
            place: place.into(),
            what: "rotor",
            name: name.into(),
            known: self
                .rotors
                .iter()
                .filter(|r| r.body == body)
                .map(|r| r.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })
    }

    /// Elements that share their joint share its kinematics.
    fn joint(&mut self, place: &str, j: &'a JointSpec) -> Result<usize, EngineError> {
        if let Some(i) = self.joint_specs.iter().position(|known| *known == j) {
            return Ok(i);
        }
        let (a, b) = (self.body(place, &j.a)?, self.body(place, &j.b)?);
        if a == b {
            return Err(value(place, &j.a, "join two different bodies"));
        }
        let local = |body: usize| core::array::from_fn(|i| j.point[i] - self.bodies[body].position[i]);
        self.joints.push(Joint { a, b, point_a: local(a), point_b: local(b), turns: false });
        self.joint_specs.push(j);
        Ok(self.joints.len() - 1)
    }

    fn rotors(&mut self) -> Result<(), EngineError> {
        for (body, b) in self.spec.bodies.iter().enumerate() {
            for r in &b.rotors {
                positive(&b.name, "rotors.inertia", r.inertia)?;
                let state = self.states.add(format!("{}.{}.spin_speed", b.name, r.name), "rad/s", 0.0);
                self.rotors.push(Rotor { name: r.name.clone(), body, inertia: r.inertia, state });
            }
        }
        Ok(())
    }
}

/// Joints of the same bodies at mirrored points, together; the others alone.
fn mirror_partners(joints: &[Joint]) -> Vec<(usize, Option<usize>)> {
    let mirrored = |j: &Joint, k: &Joint| {
        let flip = |[x, y, z]: [f64; 3]| [x, -y, z];
        (j.a, j.b) == (k.a, k.b) && j.point_a == flip(k.point_a) && j.point_b == flip(k.point_b)
    };
    let partner = |i: usize| (0..joints.len()).find(|&k| k != i && mirrored(&joints[i], &joints[k]));
    (0..joints.len()).map(|i| (i, partner(i))).filter(|&(i, partner)| partner.is_none_or(|k| i < k)).collect()
}
