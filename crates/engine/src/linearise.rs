//! The linear model of a vehicle about a steady state: exact Jacobians of the same equations that runs integrate.
//! The plant is continuous, with held inputs; its controllers are sampled; whoever needs one model of both joins them.

use crate::control::{ControlError, Memory};
use crate::error::{EngineError, Fault};
use crate::kinks;
use crate::model::Model;
use crate::pass::{DIRECTIONS, Pass};
use crate::steady::Steady;
use crate::wiring::Wiring;
use crate::{channels, inputs};
use klingel_physics::Dual;

/// x' = a x + b u, y = c x + d u of small departures; matrices by rows.
#[derive(Clone, Debug)]
pub struct LinearModel {
    /// Name and unit each.
    pub states: Vec<(String, String)>,
    pub inputs: Vec<(String, String)>,
    pub outputs: Vec<(String, String)>,
    pub a: Vec<f64>,
    pub b: Vec<f64>,
    pub c: Vec<f64>,
    pub d: Vec<f64>,
    /// Values that departures are counted from.
    pub x: Vec<f64>,
    pub u: Vec<f64>,
    pub y: Vec<f64>,
    pub control: Option<LinearControl>,
    /// What is near a corner of its law, in words.
    pub kinks: Vec<String>,
    /// Newton steps to the steady state.
    pub iterations: usize,
}

/// z+ = a z + b y, commands = c z + d y of the measured outputs, once every sample.
#[derive(Clone, Debug)]
pub struct LinearControl {
    /// \[s\]
    pub sample_time: f64,
    pub states: Vec<String>,
    /// Places of the measured outputs and of the commanded inputs.
    pub measured: Vec<usize>,
    pub driven: Vec<usize>,
    pub a: Vec<f64>,
    pub b: Vec<f64>,
    pub c: Vec<f64>,
    pub d: Vec<f64>,
    pub z: Vec<f64>,
}

type Wide = Dual<DIRECTIONS>;

/// Of a controller, whose matrix then takes 200 MB.
const STATES_MOST: usize = 5000;

/// A value that is the variable of direction `place - first` where that is one.
fn seed(value: f64, place: usize, first: usize) -> Wide {
    Dual { value, slope: core::array::from_fn(|d| f64::from(u8::from(first + d == place))) }
}

/// Whether a controller is small enough for a linear model, before its steady state is looked for.
///
/// # Errors
/// A controller of more than `STATES_MOST` states.
pub fn linearisable(wiring: &Wiring) -> Result<(), EngineError> {
    match wiring.diagram.memory::<f64>().states.len() {
        states if states > STATES_MOST => Err(ControlError::Large { states, most: STATES_MOST }.into()),
        _ => Ok(()),
    }
}

/// Linearises about a steady state.
///
/// # Errors
/// A state at which a wheel is off its rail or a controller fails; as `linearisable`.
pub fn linearise(m: &Model, wiring: Option<&Wiring>, at: &Steady) -> Result<LinearModel, EngineError> {
    let failed = |fault: Fault| EngineError::Linear { fault };
    wiring.map_or(Ok(()), linearisable)?;
    let plant = plant(m, at).map_err(failed)?;
    let mut pass = Pass::<f64>::new(m, wiring);
    pass.x.copy_from_slice(&at.x);
    pass.inputs.copy_from_slice(&at.inputs);
    pass.integrals.copy_from_slice(&at.integrals);
    pass.evaluate(m, wiring).map_err(failed)?;
    let mut kinks = kinks::of_plant(m, &pass);
    let control = match (wiring, &pass.memory) {
        (Some(wiring), Some(memory)) => {
            kinks.extend(kinks::of_controller(&wiring.diagram, memory));
            Some(control(wiring, memory, pass.measured()).map_err(failed)?)
        }
        _ => None,
    };
    let named = |list: Vec<(String, &'static str)>| list.into_iter().map(|(n, u)| (n, u.to_string())).collect();
    let states = m.state_names.iter().cloned().zip(m.state_units.iter().copied()).collect();
    let [a, b, c, d] = plant;
    Ok(LinearModel {
        states: named(states),
        inputs: named(inputs::list(m)),
        outputs: named(channels::list(m)),
        a,
        b,
        c,
        d,
        x: at.x.clone(),
        u: at.inputs.clone(),
        y: pass.row,
        control,
        kinks,
        iterations: at.iterations,
    })
}

/// a, b, c, d of the plant.
fn plant(m: &Model, at: &Steady) -> Result<[Vec<f64>; 4], Fault> {
    let (n, inputs) = (at.x.len(), at.inputs.len());
    let mut pass = Pass::<Wide>::new(m, None);
    let rows = pass.row.len();
    let mut jacobian = [vec![0.0; n * n], vec![0.0; n * inputs], vec![0.0; rows * n], vec![0.0; rows * inputs]];
    for first in (0..n + inputs).step_by(DIRECTIONS) {
        for (i, (to, &x)) in pass.x.iter_mut().zip(&at.x).enumerate() {
            *to = seed(x, i, first);
        }
        for (i, (to, &u)) in pass.inputs.iter_mut().zip(&at.inputs).enumerate() {
            *to = seed(u, n + i, first);
        }
        pass.evaluate(m, None)?;
        let [a, b, c, d] = &mut jacobian;
        spread(&pass.dx, first, [(a, n), (b, inputs)]);
        spread(&pass.row, first, [(c, n), (d, inputs)]);
    }
    Ok(jacobian)
}

/// The slopes of one pass into two matrices side by side, each given with its columns.
fn spread(values: &[Wide], first: usize, [(left, n), (right, m)]: [(&mut Vec<f64>, usize); 2]) {
    for (row, value) in values.iter().enumerate() {
        for (place, &slope) in (first..n + m).zip(&value.slope) {
            if place < n {
                left[row * n + place] = slope;
            } else {
                right[row * m + place - n] = slope;
            }
        }
    }
}

/// The controllers about their settled memory.
fn control(wiring: &Wiring, settled: &Memory<f64>, measured: &[f64]) -> Result<LinearControl, Fault> {
    let diagram = &wiring.diagram;
    let (n, inputs, commands) = (settled.states.len(), measured.len(), wiring.driven.len());
    let mut memory = diagram.memory::<Wide>();
    memory.linear = true;
    let mut given = vec![Wide::default(); inputs];
    let mut a = vec![0.0; n * n];
    let (mut b, mut c, mut d) = (vec![0.0; n * inputs], vec![0.0; commands * n], vec![0.0; commands * inputs]);
    for first in (0..n + inputs).step_by(DIRECTIONS) {
        for (i, (to, &z)) in memory.states.iter_mut().zip(&settled.states).enumerate() {
            *to = seed(z, i, first);
        }
        for (i, (to, &y)) in given.iter_mut().zip(measured).enumerate() {
            *to = seed(y, n + i, first);
        }
        diagram.step(&mut memory, &given).map_err(|e| Fault::Control(e.to_string()))?;
        spread(&memory.states, first, [(&mut a, n), (&mut b, inputs)]);
        let put_out: Vec<Wide> = diagram.commands(&memory).collect();
        spread(&put_out, first, [(&mut c, n), (&mut d, inputs)]);
    }
    Ok(LinearControl {
        sample_time: diagram.sample_time,
        states: diagram.state_names(),
        measured: wiring.measured.clone(),
        driven: wiring.driven.clone(),
        a,
        b,
        c,
        d,
        z: settled.states.clone(),
    })
}
