//! The start of a run: every body at rest relative to the others while the vehicle rolls at its speed.
//! Newton's method on the rates of the model itself, with the exact Jacobian from dual numbers.

use crate::error::EngineError;
use crate::model::Model;
use crate::rates::{Workspace, rates};
use klingel_physics::Dual;
use nalgebra::{DMatrix, DVector};

const DIRECTIONS: usize = 32;
const MAX_ITERATIONS: usize = 60;
/// The Newton step, relative to 1 + |x|, at which the equilibrium is found.
const TOLERANCE: f64 = 1e-10;
/// A wheel may move so far in one iteration \[m\], which keeps it on the rail.
const WHEEL_STEP: f64 = 4e-5;

/// The states in the design position at the initial speed, wheels rolling.
pub fn design_state(m: &Model) -> Vec<f64> {
    let mut x = vec![0.0; m.state_count()];
    for body in &m.bodies {
        let q = &mut x[body.state..];
        let s = m.start + body.position[0];
        let turn = m.track.at(s).turn();
        (q[0], q[1], q[2]) = (s, body.position[1], body.position[2]);
        if body.pitches {
            q[6] = m.speed;
            q[9..12].copy_from_slice(&turn.0.map(|o| o * m.speed));
        } else {
            q[5] = m.speed;
            (q[8], q[9]) = (turn.x() * m.speed, turn.z() * m.speed);
        }
    }
    for wheel in &m.wheels {
        x[m.rotors[wheel.rotor].state] = m.speed / wheel.radius;
    }
    for drive in &m.drives {
        x[drive.state + 1] = x[m.rotors[drive.rotor].state] / drive.law.gear_ratio;
    }
    x
}

/// The static equilibrium at `m.speed` near the design position, under the inputs of the model.
///
/// # Errors
/// `EngineError::Equilibrium` when Newton's method does not converge.
pub fn equilibrium(m: &Model) -> Result<Vec<f64>, EngineError> {
    let n = m.state_count();
    let mut x = design_state(m);
    settle_on_rails(m, &mut x);
    let reference = &m.bodies[m.hold.as_ref().map_or(0, |h| h.body)];
    let (s_ref, v_ref) = (reference.state, reference.state + if reference.pitches { 6 } else { 5 });
    // the place along the track is free; without a speed hold the speed of the reference body is given instead
    let mut free: Vec<usize> = (0..n).filter(|&i| i != s_ref).collect();
    if m.hold.is_none() {
        free.retain(|&i| i != v_ref);
    }

    let mut jacobian = DMatrix::zeros(n, n);
    let mut worst = (f64::INFINITY, 0);
    for iteration in 0..MAX_ITERATIONS {
        let residual = linearise(m, &x, s_ref, &mut jacobian).map_err(|_| failed(m, iteration, worst))?;
        let a = DMatrix::from_fn(free.len(), free.len(), |i, j| jacobian[(free[i], free[j])]);
        let b = DVector::from_fn(free.len(), |i, _| -residual[free[i]]);
        worst = free.iter().map(|&i| (residual[i].abs(), i)).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        let step = a.lu().solve(&b).ok_or_else(|| failed(m, iteration, worst))?;
        if !step.iter().all(|d| d.is_finite()) {
            return Err(failed(m, iteration, worst));
        }
        let largest_wheel_step = m
            .wheels
            .iter()
            .map(|w| m.bodies[w.body].state)
            .flat_map(|i| [(i + 2, 1.0), (i + 3, 1.0)])
            .filter_map(|(i, scale)| free.iter().position(|&f| f == i).map(|j| step[j].abs() * scale))
            .fold(0.0, f64::max);
        let share = (WHEEL_STEP / largest_wheel_step).min(1.0);
        let mut size: f64 = 0.0;
        for (j, &i) in free.iter().enumerate() {
            size = size.max(step[j].abs() / (1.0 + x[i].abs()));
            x[i] += share * step[j];
        }
        if size < TOLERANCE {
            return Ok(x);
        }
    }
    Err(failed(m, MAX_ITERATIONS, worst))
}

fn failed(m: &Model, iterations: usize, (residual, i): (f64, usize)) -> EngineError {
    EngineError::Equilibrium { speed: m.speed, iterations, residual, state: m.state_names[i].clone() }
}

/// Lets the whole vehicle sink until the wheels carry its weight on average: within reach of Newton.
fn settle_on_rails(m: &Model, x: &mut [f64]) {
    if m.wheels.is_empty() {
        return;
    }
    let weight = m.gravity * m.bodies.iter().map(|b| b.mass).sum::<f64>();
    let load = |sink: f64| -> f64 {
        let on = |w: &crate::model::Wheel| {
            w.table
                .patches(0.0, sink, 0.0, 0.0)
                .map_or(f64::INFINITY, |p| p.iter().map(|p| p.normal_force * p.angle.cos()).sum())
        };
        m.wheels.iter().map(on).sum()
    };
    // a wheel pressed in deeper than its table reaches counts as carrying everything
    let (mut low, mut high) = (-5e-3, 5e-3);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if load(middle) < weight { low = middle } else { high = middle }
    }
    for body in &m.bodies {
        x[body.state + 2] += low;
    }
}

/// Rates relative to those of the reference body along the track, and their Jacobian.
fn linearise(m: &Model, x: &[f64], s_ref: usize, jacobian: &mut DMatrix<f64>) -> Result<Vec<f64>, crate::Fault> {
    let n = x.len();
    let mut w = Workspace::<Dual<DIRECTIONS>>::new(m);
    let mut dual: Vec<Dual<DIRECTIONS>> = vec![Dual::default(); n];
    let mut dx = dual.clone();
    for first in (0..n).step_by(DIRECTIONS) {
        for i in 0..n {
            dual[i] = Dual { value: x[i], slope: core::array::from_fn(|d| f64::from(u8::from(first + d == i))) };
        }
        rates(m, &dual, &m.inputs, &mut w, &mut dx)?;
        for body in &m.bodies {
            if body.state != s_ref {
                dx[body.state] = dx[body.state] - dx[s_ref];
            }
        }
        for d in 0..DIRECTIONS.min(n - first) {
            for i in 0..n {
                jacobian[(i, first + d)] = dx[i].slope[d];
            }
        }
    }
    Ok(dx.iter().map(|d| d.value).collect())
}
