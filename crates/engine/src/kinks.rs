//! Elements near a corner of their law, where a linear model holds on one side only.
//! How near is told as a part of the law's own range.

use crate::control::{Diagram, Memory};
use crate::model::{FieldIn, Model};
use crate::pass::Pass;

/// Nearer than this part of its range an element is named.
const NEAR: f64 = 0.02;
/// A patch that carries less than this part of its wheel's load is about to open.
const OPENING: f64 = 0.005;

/// Elements of the plant.
pub fn of_plant(m: &Model, pass: &Pass<f64>) -> Vec<String> {
    let mut found = Vec::new();
    let mut say = |distance: Option<f64>, name: &str, what: &str| {
        if let Some(distance) = distance.filter(|d| d.abs() < NEAR) {
            found.push(format!("{name} is near {what}: {:.2} % of its range off", 100.0 * distance.abs()));
        }
    };
    for e in &m.maxwells {
        let off = e.law.blow_off.map(|b| pass.x[e.state].abs() / b.force - 1.0);
        say(off, &e.name, "its blow-off force");
    }
    for e in &m.stops {
        say(e.law.kink(pass.work.joints[e.joint].u.0[e.axis]), &e.name, "a corner of its stiffness");
    }
    for e in &m.actuators {
        say(Some(pass.inputs[e.input].abs() / e.law.force_max - 1.0), &e.name, "its largest force");
        let stroke = pass.work.joints[e.joint].u.x().abs() / e.law.stroke;
        say(Some(stroke - 1.0), &e.name, "its end stop");
    }
    for e in &m.dc_motors {
        let name = &m.drives[e.drive].name;
        say(Some(pass.inputs[e.input].abs() / e.voltage_max - 1.0), name, "the largest armature voltage");
        if let FieldIn::Moved { voltage_max, input, .. } = e.field {
            say(Some(pass.inputs[input].abs() / voltage_max - 1.0), name, "the largest field voltage");
        }
    }
    for (e, put_out) in m.induction_motors.iter().zip(&pass.work.inverters) {
        let name = &m.drives[e.drive].name;
        let [voltage, current] = [put_out.voltage, e.read(&pass.x).0.current].map(|[d, q]| d.hypot(q));
        say(Some(voltage / e.control.voltage_max - 1.0), name, "the inverter's largest voltage");
        say(Some(current / e.control.current_max - 1.0), name, "the largest stator current");
        let speed = pass.x[m.drives[e.drive].state].abs() * e.control.model.pole_pairs;
        say(Some(speed / e.control.weakening_speed() - 1.0), name, "the speed of field weakening");
    }
    for (wheel, state) in m.wheels.iter().zip(&pass.work.wheels) {
        let load: f64 = state.normal.iter().sum();
        let opening = |n: &f64| *n > 0.0 && *n < OPENING * load;
        if state.normal.iter().any(opening) {
            found.push(format!("{}: a contact patch is about to open", wheel.name));
        }
        if load <= 0.0 {
            found.push(format!("{}: it is off its rail", wheel.name));
        }
    }
    found
}

/// Blocks of the controllers.
pub fn of_controller(diagram: &Diagram, memory: &Memory<f64>) -> Vec<String> {
    let kinks = diagram.kinks(memory, NEAR);
    let say = |k: &crate::control::BlockKink| {
        format!("control block {} is near a limit or corner: {:.2} % of its range off", k.block, 100.0 * k.distance)
    };
    kinks.iter().map(say).collect()
}
