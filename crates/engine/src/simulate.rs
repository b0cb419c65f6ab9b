//! One run: equilibrium, then fixed steps with sampled controllers in between, and rows of channels.
//! A command is put out at the sample after the one that made it, whatever the step, and held for a sample.

use crate::channels;
use crate::compile::compile;
use crate::control::{ControlError, Controller, Externals};
use crate::energy::Energy;
use crate::equilibrium::{design_state, equilibrium, start};
use crate::error::{EngineError, Fault};
use crate::excitation::Excitation;
use crate::model::{Course, Model, Wheel};
use crate::pass::Pass;
use crate::rates::{Workspace, rates};
use crate::spec::Spec;
use crate::steady::Steady;
use crate::stepper::Stepper;
use crate::wiring::Wiring;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How far a run is, and the wish to end it; shared with whoever watches.
#[derive(Debug, Default)]
pub struct Progress {
    fraction: AtomicU64,
    cancelled: AtomicBool,
}

impl Progress {
    /// 0 to 1.
    pub fn fraction(&self) -> f64 {
        f64::from_bits(self.fraction.load(Ordering::Relaxed))
    }
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
    fn set(&self, fraction: f64) {
        self.fraction.store(fraction.to_bits(), Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// The outcome of a run.
#[derive(Clone, Debug)]
pub struct TimeSeries {
    /// Name and unit of each column.
    pub channels: Vec<(String, String)>,
    /// \[s\]
    pub time: Vec<f64>,
    /// One row a time, row after row.
    pub rows: Vec<f64>,
    /// Why and when the motion ended before its time.
    pub fault: Option<(f64, Fault)>,
    /// Vertical load of each wheel in the equilibrium \[N\].
    pub static_wheel_loads: Vec<(String, f64)>,
    /// CPU time of the stepping thread \[s\], and right-hand sides evaluated.
    pub cpu_time: f64,
    pub evaluations: u64,
}

/// Samples between two looks at the cancel flag.
const POLL: usize = 200;

/// Compiles and runs a spec; `externals` are its controllers outside the core by the names of their blocks.
///
/// # Errors
/// Those of `compile`, no equilibrium, or a cancelled run. A derailment is not an error but `TimeSeries::fault`, nor is a
/// controller that fails.
pub fn simulate(spec: &Spec, externals: Externals, progress: &Progress) -> Result<TimeSeries, EngineError> {
    let model = compile(spec)?;
    let controller = match (&spec.control, externals.keys().min()) {
        (Some(control), _) => Some(Controller::with(control, externals)?),
        (None, Some(name)) => Err(ControlError::ExternalUnknown { name: name.clone() })?,
        (None, None) => None,
    };
    run(&model, controller, progress)
}

/// States and held inputs at the start.
fn begin(m: &Model, wired: Option<&mut Wired>) -> Result<(Vec<f64>, Vec<f64>), EngineError> {
    if m.run.settled {
        let wiring = wired.as_ref().map(|w| Wiring::of(m, w.controller.diagram().clone())).transpose()?;
        let Steady { x, inputs, integrals, .. } = start(m, wiring.as_ref())?;
        if let Some(wired) = wired {
            // settled before anything excites the vehicle, so that the first sample is a step like every other
            let mut pass = Pass::<f64>::new(m, None);
            pass.x.copy_from_slice(&x);
            pass.inputs.copy_from_slice(&inputs);
            pass.evaluate(m, None).map_err(|fault| EngineError::Linear { fault })?;
            wired.controller.start_with(&integrals);
            wired.sample(&mut pass.row, true).map_err(|fault| EngineError::Linear { fault })?;
            wired.controller.before_start();
            wired.settled = true;
        }
        return Ok((x, inputs));
    }
    let x = if m.run.equilibrium { equilibrium(m)? } else { design_state(m) };
    Ok((x, m.inputs.clone()))
}

/// A controller with its wires: which channels it measures and which inputs it drives.
struct Wired {
    controller: Controller,
    measured: Vec<usize>,
    driven: Vec<usize>,
    values: Vec<f64>,
    every: usize,
    /// Whether it has its steady state already.
    settled: bool,
}

/// Runs a compiled model.
///
/// # Errors
/// No equilibrium, a controller wired to unknown channels, or a cancelled run.
pub fn run(m: &Model, controller: Option<Controller>, progress: &Progress) -> Result<TimeSeries, EngineError> {
    let start = cpu_time::ThreadTime::now();
    let mut channels = channels::list(m);
    let mut wired = controller.map(|c| Wired::new(m, c)).transpose()?;
    let (mut x, mut held) = begin(m, wired.as_mut())?;
    let probes = wired.as_ref().map_or(0, |w| w.controller.probe_channels().len());
    let mut energy = m.run.energy.then(|| Energy::new(m));
    let (own, states) = (channels.len(), x.len());
    channels.extend(energy.iter().flat_map(Energy::list));
    let booked = channels.len();
    let width = booked + probes;

    let step = m.run.step;
    let steps = (m.run.duration / step).round() as usize;
    let record_every = (m.run.record_interval / step).round() as usize;
    let mut series = TimeSeries {
        channels: channels.into_iter().map(|(name, unit)| (name, unit.to_string())).collect(),
        time: Vec::with_capacity(steps / record_every + 1),
        rows: Vec::with_capacity((steps / record_every + 1) * width),
        fault: None,
        static_wheel_loads: Vec::new(),
        cpu_time: 0.0,
        evaluations: 0,
    };
    if let Some(w) = &wired {
        series.channels.extend(w.controller.probe_channels().iter().cloned());
    }

    let excitation = Excitation::new(m)?;
    let moves = excitation.moves();
    let mut inputs = held.clone();
    let mut w = Workspace::<f64>::new(m);
    let mut row = vec![0.0; width];
    kick(m, &mut x)?;
    // the accounts are states behind those of the model
    let mut poles = m.poles.clone();
    if energy.is_some() {
        x.resize(states + Energy::STATES, 0.0);
        poles.resize(x.len(), 0.0);
    }
    let mut first = vec![0.0; x.len()];
    let mut stepper = Stepper::new(m, &poles)?;
    for k in 0..=steps {
        let time = k as f64 * step;
        let sampled = wired.as_ref().is_some_and(|c| k % c.every == 0);
        if let (Some(c), true) = (&wired, sampled && k > 0) {
            c.drive(&mut held);
        }
        excitation.apply(k, 0.0, &held, &mut inputs);
        let evaluated = rates_and_powers(m, energy.as_ref(), &x, &inputs, &mut w, &mut first).and_then(|()| {
            if let (Some(energy), 0) = (&mut energy, k) {
                energy.begin(m, &x, &w);
            }
            if k % record_every == 0 || sampled {
                channels::fill(m, &x, &inputs, &w, &mut row);
            }
            if let (Some(energy), true) = (&energy, k % record_every == 0) {
                energy.fill(m, &x, &w, &x[states..], &mut row[own..booked]);
            }
            match &mut wired {
                Some(c) if sampled => c.sample(&mut row, k == 0 && !c.settled),
                _ => Ok(()),
            }
        });
        if k == 0 {
            series.static_wheel_loads =
                m.wheels.iter().zip(&w.wheels).map(|(w, s)| (w.name.clone(), -s.force_T.z())).collect();
        }
        if evaluated.is_ok() && k % record_every == 0 {
            series.time.push(time);
            series.rows.extend_from_slice(&row);
        }
        let advanced = evaluated.and_then(|()| {
            if k == steps {
                return Ok(());
            }
            if sampled || wired.is_none() {
                stepper.choose(m, &x);
            }
            stepper.advance(m, &mut x, &first, &mut inputs, |later, at, inputs, f| {
                if moves {
                    excitation.apply(k, later / step, &held, inputs);
                }
                rates_and_powers(m, energy.as_ref(), at, inputs, &mut w, f)
            })?;
            finite(m, &x).and_then(|()| on_track(m, &x))
        });
        series.evaluations += stepper.evaluations();
        if let Err(fault) = advanced {
            series.fault = Some((time, fault));
            break;
        }
        if k % POLL == 0 {
            progress.set(time / m.run.duration);
            if progress.is_cancelled() {
                return Err(EngineError::Cancelled { time });
            }
        }
    }
    progress.set(1.0);
    series.cpu_time = start.elapsed().as_secs_f64();
    Ok(series)
}

impl Wired {
    fn new(m: &Model, controller: Controller) -> Result<Self, EngineError> {
        let Wiring { measured, driven, .. } = Wiring::of(m, controller.diagram().clone())?;
        let every = (controller.sample_time() / m.run.step).round() as usize;
        Ok(Self { values: vec![0.0; measured.len()], controller, measured, driven, every, settled: false })
    }

    /// Measures, steps the controller and writes its probes behind the channels of the row.
    fn sample(&mut self, row: &mut [f64], first: bool) -> Result<(), Fault> {
        for (value, &i) in self.values.iter_mut().zip(&self.measured) {
            *value = row[i];
        }
        let stepped = if first { self.controller.reset(&self.values) } else { self.controller.step(&self.values) };
        stepped.map_err(|e| Fault::Control(e.to_string()))?;
        let probes = self.controller.probes();
        let at = row.len() - probes.len();
        row[at..].copy_from_slice(probes);
        Ok(())
    }

    fn drive(&self, inputs: &mut [f64]) {
        for (&i, &command) in self.driven.iter().zip(self.controller.commands()) {
            inputs[i] = command;
        }
    }
}

/// Rates of the model's states, and of the accounts behind them.
fn rates_and_powers(
    m: &Model,
    energy: Option<&Energy>,
    x: &[f64],
    inputs: &[f64],
    w: &mut Workspace<f64>,
    dx: &mut [f64],
) -> Result<(), Fault> {
    let (dx, powers) = dx.split_at_mut(m.state_count());
    rates(m, x, inputs, w, dx)?;
    if let Some(energy) = energy {
        energy.powers(m, x, inputs, w, dx, powers);
    }
    Ok(())
}

fn kick(m: &Model, x: &mut [f64]) -> Result<(), EngineError> {
    for kick in &m.run.kicks {
        let body = m.bodies.iter().find(|b| b.name == kick.body).ok_or_else(|| EngineError::Unknown {
            place: "run.kicks".into(),
            what: "body",
            name: kick.body.clone(),
            known: m.bodies.iter().map(|b| b.name.as_str()).collect::<Vec<_>>().join(", "),
        })?;
        let q = &mut x[body.state..];
        let [roll, pitch, yaw] = kick.rotation;
        let [wx, wy, wz] = kick.angular_velocity;
        let add = if body.pitches {
            vec![roll, pitch, yaw, kick.velocity[0], kick.velocity[1], kick.velocity[2], wx, wy, wz]
        } else {
            vec![roll, yaw, kick.velocity[0], kick.velocity[1], kick.velocity[2], wx, wz]
        };
        for (value, extra) in q.iter_mut().zip(kick.displacement.iter().chain(&add)) {
            *value += extra;
        }
    }
    Ok(())
}

/// A vehicle that drives itself may come to the end of its track.
fn on_track(m: &Model, x: &[f64]) -> Result<(), Fault> {
    let Course::Laid(alignment) = &m.track else { return Ok(()) };
    let length = alignment.length();
    let beyond = |w: &&Wheel| m.hold.is_none() && x[m.bodies[w.body].state] > length;
    match m.wheels.iter().find(beyond) {
        Some(wheel) => Err(Fault::EndOfTrack { body: m.bodies[wheel.body].name.clone(), length }),
        None => Ok(()),
    }
}

fn finite(m: &Model, x: &[f64]) -> Result<(), Fault> {
    match x[..m.state_count()].iter().position(|v| !v.is_finite()) {
        Some(i) => Err(Fault::Unstable { state: m.state_names[i].clone() }),
        None => Ok(()),
    }
}
