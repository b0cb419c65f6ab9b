//! Spec to model: names become indices, design points become body-fixed points, numbers are checked.
//! Order of the states: bodies, rotors, dampers' forces, actuators, drives, speed hold.

use crate::error::EngineError;
use crate::model::{ActuatorIn, Body, Drive, Hold, Joint, MaxwellIn, Model, Rotor, Wheel};
use crate::spec::{BodySpec, JointSpec, PairSpec, ProfileSpec, RunSpec, Side, Spec};
use klingel_physics::contact::{ContactError, ContactTable, CreepForce, CreepLaw, Material, PairGeometry, Profile};
use klingel_physics::drives::{self, Actuator};
use klingel_physics::elements::{BlowOff, Bushing, Maxwell, Stop};
use klingel_physics::track::{Alignment, Segment};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// \[m\], EN 13715.
const FLANGE_BACK_TO_TAPE_CIRCLE: f64 = 0.070;

/// Compiles a spec.
///
/// # Errors
/// Everything that `EngineError` lists before `Equilibrium`.
pub fn compile(spec: &Spec) -> Result<Model, EngineError> {
    let segments: Vec<Segment> = spec
        .track
        .segments
        .iter()
        .map(|s| Segment { length: s.length, curvature: s.curvature, cant: s.cant })
        .collect();
    let track = Alignment::new(&segments, positive("track", "cant_base", spec.track.cant_base)?)?;
    check_run(spec, &track)?;

    let mut states = States::default();
    let bodies = spec.bodies.iter().map(|b| body(b, &mut states)).collect::<Result<Vec<_>, _>>()?;
    let mut c = Compiler { spec, bodies, rotors: Vec::new(), joints: Vec::new(), joint_specs: Vec::new(), states };
    c.rotors()?;
    let bushings = c.bushings()?;
    let maxwells = c.maxwells()?;
    let stops = c.stops()?;
    let mut inputs: Vec<f64> = spec.drives.iter().map(|d| d.armature_voltage).collect();
    let actuators = c.actuators(&mut inputs)?;
    let drives = c.drives()?;
    let drag =
        spec.drag.as_ref().map(|d| Ok::<_, EngineError>((c.body("drag", &d.body)?, d.coefficients))).transpose()?;
    let hold = c.hold()?;
    let material = Material::STEEL;
    let wheels = c.wheels(&material)?;
    let Compiler { bodies, rotors, joints, states, .. } = c;
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
        drag,
        hold,
        creep: creep_law(spec, &material)?,
        contact_dissipation: spec.creep.contact_dissipation,
        poles: states.poles,
        state_names: states.names,
        inputs,
        run: spec.run.clone(),
    })
}

/// Names and decay rates of the states, in order.
#[derive(Default)]
struct States {
    names: Vec<String>,
    poles: Vec<f64>,
}

impl States {
    fn add(&mut self, name: String, pole: f64) -> usize {
        self.names.push(name);
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

fn check_run(spec: &Spec, track: &Alignment) -> Result<(), EngineError> {
    let RunSpec { duration, step, record_interval, .. } = spec.run;
    positive("run", "duration", duration)?;
    positive("run", "step", step)?;
    if !whole(record_interval / step) {
        return Err(value("run.record_interval", record_interval, "make it a multiple of the step"));
    }
    if let Some(control) = &spec.control
        && !whole(control.sample_time / step)
    {
        return Err(value("control.sample_time", control.sample_time, "make it a multiple of the step"));
    }
    let front = spec.bodies.iter().map(|b| b.position[0]).fold(f64::MIN, f64::max);
    let rear = spec.bodies.iter().map(|b| b.position[0]).fold(f64::MAX, f64::min);
    let end = spec.track.start + front + spec.speed * duration;
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
    let names: &[&str] = if b.pitches {
        &["s", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "wx", "wy", "wz"]
    } else {
        &["s", "y", "z", "roll", "yaw", "vx", "vy", "vz", "wx", "wz"]
    };
    let first = states.names.len();
    for name in names {
        states.add(format!("{}.{name}", b.name), 0.0);
    }
    Ok(Body {
        name: b.name.clone(),
        mass: b.mass,
        inertia: b.inertia,
        position: b.position,
        pitches: b.pitches,
        state: first,
    })
}

struct Compiler<'a> {
    spec: &'a Spec,
    bodies: Vec<Body>,
    rotors: Vec<Rotor>,
    joints: Vec<Joint>,
    joint_specs: Vec<&'a JointSpec>,
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
                let state = self.states.add(format!("{}.{}.spin_speed", b.name, r.name), 0.0);
                self.rotors.push(Rotor { name: r.name.clone(), body, inertia: r.inertia, state });
            }
        }
        Ok(())
    }

    fn bushings(&mut self) -> Result<Vec<(usize, Bushing)>, EngineError> {
        let mut bushings = Vec::new();
        for b in &self.spec.bushings {
            let law = Bushing {
                stiffness: b.stiffness,
                damping: b.damping,
                rotational_stiffness: b.rotational_stiffness,
                rotational_damping: b.rotational_damping,
                preload: b.preload,
            };
            for x in b.stiffness.iter().chain(&b.damping).chain(&b.rotational_stiffness).chain(&b.rotational_damping) {
                if !(*x >= 0.0 && x.is_finite()) {
                    return Err(value(&b.name, x, "stiffness and damping must be zero or positive"));
                }
            }
            let joint = self.joint(&b.name, &b.joint)?;
            self.joints[joint].turns |= law.turns();
            bushings.push((joint, law));
        }
        Ok(bushings)
    }

    fn maxwells(&mut self) -> Result<Vec<MaxwellIn>, EngineError> {
        let mut maxwells = Vec::new();
        for e in &self.spec.maxwells {
            let law = Maxwell {
                stiffness: positive(&e.name, "stiffness", e.stiffness)?,
                damping: positive(&e.name, "damping", e.damping)?,
                blow_off: match &e.blow_off {
                    None => None,
                    Some(b) => Some(BlowOff {
                        force: positive(&e.name, "blow_off.force", b.force)?,
                        damping: positive(&e.name, "blow_off.damping", b.damping)?,
                    }),
                },
            };
            let joint = self.joint(&e.name, &e.joint)?;
            let state = self.states.add(format!("{}.force", e.name), law.pole());
            maxwells.push(MaxwellIn { name: e.name.clone(), joint, axis: e.axis.index(), law, state });
        }
        Ok(maxwells)
    }

    fn stops(&mut self) -> Result<Vec<(usize, usize, Stop)>, EngineError> {
        let mut stops = Vec::new();
        for s in &self.spec.stops {
            let law = Stop::new(&s.deflection, &s.force)
                .map_err(|source| EngineError::Stop { name: s.name.clone(), source })?;
            stops.push((self.joint(&s.name, &s.joint)?, s.axis.index(), law));
        }
        Ok(stops)
    }

    fn actuators(&mut self, inputs: &mut Vec<f64>) -> Result<Vec<ActuatorIn>, EngineError> {
        let mut actuators = Vec::new();
        for a in &self.spec.actuators {
            let law = Actuator {
                natural_frequency: positive(&a.name, "natural_frequency", a.natural_frequency)?,
                damping_ratio: positive(&a.name, "damping_ratio", a.damping_ratio)?,
                force_max: positive(&a.name, "force_max", a.force_max)?,
                rate_max: positive(&a.name, "rate_max", a.rate_max)?,
                stroke: positive(&a.name, "stroke", a.stroke)?,
                stop_stiffness: positive(&a.name, "stop_stiffness", a.stop_stiffness)?,
            };
            let joint = self.joint(&a.name, &a.joint)?;
            let state = self.states.add(format!("{}.force", a.name), 0.0);
            self.states.add(format!("{}.force_rate", a.name), 0.0);
            inputs.push(0.0);
            actuators.push(ActuatorIn { name: a.name.clone(), joint, law, state, input: inputs.len() - 1 });
        }
        Ok(actuators)
    }

    fn drives(&mut self) -> Result<Vec<Drive>, EngineError> {
        let mut drives = Vec::new();
        for (input, d) in self.spec.drives.iter().enumerate() {
            let body = self.body(&d.name, &d.body)?;
            let rotor = self.rotor(&d.name, body, &d.rotor)?;
            if !self.bodies[body].pitches {
                return Err(value(&d.name, &d.body, "a drive needs a body that pitches, to take its reaction"));
            }
            let law = drives::Drive {
                armature_resistance: positive(&d.name, "armature_resistance", d.armature_resistance)?,
                armature_inductance: positive(&d.name, "armature_inductance", d.armature_inductance)?,
                emf_constant: positive(&d.name, "emf_constant", d.emf_constant)?,
                field_current: positive(&d.name, "field_current", d.field_current)?,
                gear_ratio: positive(&d.name, "gear_ratio", d.gear_ratio)?,
                rotor_inertia: positive(&d.name, "rotor_inertia", d.rotor_inertia)?,
                rotor_damping: d.rotor_damping,
                transmission_stiffness: positive(&d.name, "transmission_stiffness", d.transmission_stiffness)?,
                transmission_damping: d.transmission_damping,
            };
            let state = self.states.add(format!("{}.armature_current", d.name), 0.0);
            self.states.add(format!("{}.motor_speed", d.name), 0.0);
            self.states.add(format!("{}.shaft_twist", d.name), 0.0);
            drives.push(Drive {
                name: d.name.clone(),
                body,
                rotor,
                law,
                gear_sense: d.gear_sense.signum(),
                voltage_max: positive(&d.name, "armature_voltage_max", d.armature_voltage_max)?,
                state,
                input,
            });
        }
        Ok(drives)
    }

    fn hold(&mut self) -> Result<Option<Hold>, EngineError> {
        let Some(h) = &self.spec.hold else { return Ok(None) };
        let body = self.body("hold", &h.body)?;
        let state = self.states.add("hold.integral".into(), 0.0);
        Ok(Some(Hold {
            body,
            proportional: positive("hold", "proportional", h.proportional)?,
            integral: positive("hold", "integral", h.integral)?,
            state,
        }))
    }

    fn wheels(&self, material: &Material) -> Result<Vec<Wheel>, EngineError> {
        let tables = self
            .spec
            .contact_pairs
            .iter()
            .enumerate()
            .map(|(index, pair)| contact_table(index, pair, material))
            .collect::<Result<Vec<_>, _>>()?;
        let mut wheels = Vec::new();
        for w in &self.spec.wheels {
            let body = self.body(&w.name, &w.body)?;
            let pair = self
                .spec
                .contact_pairs
                .get(w.pair)
                .ok_or_else(|| value(format!("{}.pair", w.name), w.pair, "give the index of a contact pair"))?;
            let half_tape_distance = 0.5 * pair.flange_back + FLANGE_BACK_TO_TAPE_CIRCLE;
            let sign = if w.side == Side::Right { 1.0 } else { -1.0 };
            wheels.push(Wheel {
                name: w.name.clone(),
                body,
                rotor: self.rotor(&w.name, body, &w.rotor)?,
                sign,
                table: Arc::clone(&tables[w.pair]),
                friction: positive(&w.name, "friction", w.friction)?,
                half_tape_distance,
                radius: pair.radius,
                centre: [0.0, sign * half_tape_distance, -pair.radius - self.bodies[body].position[2]],
            });
        }
        Ok(wheels)
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

fn creep_law(spec: &Spec, material: &Material) -> Result<CreepForce, EngineError> {
    let [nx, ny] = spec.creep.elements;
    let law = match spec.creep.law.as_str() {
        "linear" => CreepLaw::Linear,
        "polach" => CreepLaw::Polach,
        "fastsim" => CreepLaw::Fastsim { nx, ny },
        other => return Err(value("creep.law", other, "choose linear, polach or fastsim")),
    };
    CreepForce::new(law, material).map_err(|e| value("creep", e, "change the creep law's settings"))
}

/// Tables live as long as the process: runs of a study share them.
static TABLES: Mutex<Option<HashMap<String, Arc<ContactTable>>>> = Mutex::new(None);

fn contact_table(index: usize, pair: &PairSpec, material: &Material) -> Result<Arc<ContactTable>, EngineError> {
    let refused = |source| EngineError::Contact { index, source };
    let key = format!("{pair:?}");
    let mut tables = TABLES.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let tables = tables.get_or_insert_with(HashMap::new);
    if let Some(table) = tables.get(&key) {
        return Ok(Arc::clone(table));
    }
    let geometry = PairGeometry {
        wheel: profile(&format!("contact_pairs[{index}].wheel"), &pair.wheel)?.map_err(refused)?,
        rail: profile(&format!("contact_pairs[{index}].rail"), &pair.rail)?.map_err(refused)?,
        rail_inclination: pair.rail_inclination,
        gauge: pair.gauge,
        flange_back: pair.flange_back,
        radius: pair.radius,
    };
    let table = Arc::new(ContactTable::build(&geometry, material).map_err(refused)?);
    tables.insert(key, Arc::clone(&table));
    Ok(table)
}

fn profile(place: &str, spec: &ProfileSpec) -> Result<Result<Profile, ContactError>, EngineError> {
    Ok(match spec {
        ProfileSpec::Named(name) => Ok(named_profile(place, name)?),
        ProfileSpec::Cone(slope) => Profile::cone(*slope),
        ProfileSpec::Points { y, z } => Profile::from_points(y, z, place),
    })
}

/// A standard profile by its name.
///
/// # Errors
/// `EngineError::Value` for a name that is not known.
pub fn named_profile(place: &str, name: &str) -> Result<Profile, EngineError> {
    match name {
        "s1002" => Ok(Profile::s1002()),
        "60e1" => Ok(Profile::rail_60e1()),
        "uic60" => Ok(Profile::rail_uic60()),
        other => Err(value(place, other, "choose s1002, 60e1 or uic60, or give points")),
    }
}
