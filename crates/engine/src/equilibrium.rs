//! The start of a run: the design position, and every body at rest relative to the others while the vehicle rolls.

use crate::error::EngineError;
use crate::model::{FieldIn, Model};
use crate::steady::{Steady, steady};
use crate::wiring::Wiring;

/// Speed and least speed of creepages of a vehicle that is about to stand \[m/s\]: so slow that motors turn without voltage
/// and controllers see no speed, yet rolling, so that its wheelsets have found their place.
const CREEPING: [f64; 2] = [1e-4, 1e-6];

/// The states in the design position at the initial speed, wheels rolling.
pub fn design_state(m: &Model) -> Vec<f64> {
    let mut x = vec![0.0; m.state_count()];
    for body in &m.bodies {
        let q = &mut x[body.state..];
        let s = m.start + body.position[0];
        let turn = m.track.at(s, m.start, [0.0; 2]).turn();
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
        x[drive.state] = x[m.rotors[drive.rotor].state] / drive.law.gear_ratio;
    }
    for motor in &m.dc_motors {
        if let FieldIn::Moved { law, state, input, .. } = &motor.field {
            x[*state] = m.inputs[*input] / law.resistance;
        }
    }
    for motor in &m.induction_motors {
        let drive = &m.drives[motor.drive];
        let torque = drive.law.gear_ratio * m.inputs[motor.input];
        let (state, control) = motor.control.steady_state(torque, x[drive.state]);
        motor.write(&state, &control, &mut x);
    }
    x
}

/// The static equilibrium at `m.speed` near the design position, under the inputs of the model.
///
/// # Errors
/// `EngineError::Equilibrium` when Newton's method does not converge.
pub fn equilibrium(m: &Model) -> Result<Vec<f64>, EngineError> {
    Ok(start(m, None)?.x)
}

/// The steady state at `m.speed`, with the controllers settled. Slower than the least speed of the creepages creep alone
/// carries nothing, so there it is the state in which the vehicle came to stand: that of rolling out, with the velocities
/// taken off; wheels that stick keep their forces.
///
/// # Errors
/// `EngineError::Equilibrium` when Newton's method does not converge.
pub fn start(m: &Model, wiring: Option<&Wiring>) -> Result<Steady, EngineError> {
    if m.speed.abs() >= m.creep_floor {
        return steady(m, wiring, None);
    }
    let [speed, creep_floor] = CREEPING;
    // running resistance has its full size only at speed, and none at rest
    let mut rolling = Model { speed, creep_floor, drag: None, ..m.clone() };
    if m.hold.is_some() {
        rolling.inputs[m.places.speed] = speed;
    }
    let mut found = steady(&rolling, wiring, None)?;
    scale_speeds(m, &mut found.x, m.speed / speed);
    if m.hold.is_some() {
        found.inputs[m.places.speed] = m.inputs[m.places.speed];
    }
    Ok(found)
}

/// Scales every velocity: the same way of running, faster or slower.
pub(crate) fn scale_speeds(m: &Model, x: &mut [f64], ratio: f64) {
    for body in &m.bodies {
        x[body.velocities()].iter_mut().for_each(|v| *v *= ratio);
    }
    m.rotors.iter().for_each(|r| x[r.state] *= ratio);
    m.drives.iter().for_each(|d| x[d.state] *= ratio);
}

/// Lets the whole vehicle sink until the wheels carry its weight on average: within reach of Newton.
pub(crate) fn settle_on_rails(m: &Model, x: &mut [f64]) {
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
    lean_on_unequal_wheels(m, x);
    roll_where_they_touch(m, low, x);
}

/// Lifts and rolls the axles of wheels that are not as large as their tables say: on the same rails, the side of the
/// larger wheel stands higher by what it is larger by, which is more than a table is deep.
fn lean_on_unequal_wheels(m: &Model, x: &mut [f64]) {
    for (index, body) in m.bodies.iter().enumerate() {
        let wheels = || m.wheels.iter().filter(|w| w.body == index);
        let count = wheels().count();
        if count > 0 {
            x[body.state + 2] -= wheels().map(|w| w.radius_offset).sum::<f64>() / count as f64;
            let bases: f64 = wheels().map(|w| w.half_tape_distance).sum();
            x[body.state + 3] -= wheels().map(|w| w.sign * w.radius_offset).sum::<f64>() / bases;
        }
    }
}

/// Turns the wheels, and the motors on them, as their radius where they touch wants it: half a per cent of slip saturates
/// the creep forces, and steep cones touch that far from the tape circle.
fn roll_where_they_touch(m: &Model, sink: f64, x: &mut [f64]) {
    for wheel in &m.wheels {
        let Ok(patches) = wheel.table.patches(0.0, sink, 0.0, 0.0) else { continue };
        let load: f64 = patches.iter().map(|p| p.normal_force).sum();
        if load > 0.0 {
            let radius = patches.iter().map(|p| p.normal_force * p.radius).sum::<f64>() / load + wheel.radius_offset;
            x[m.rotors[wheel.rotor].state] = m.speed / radius;
            for drive in m.drives.iter().filter(|d| d.rotor == wheel.rotor) {
                x[drive.state] = m.speed / radius / drive.law.gear_ratio;
            }
        }
    }
}
