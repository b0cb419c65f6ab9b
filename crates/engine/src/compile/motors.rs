//! Drives of a spec as the laws of `klingel_physics`: motors, their transmissions, the inputs that command them.
//! States of one drive stand together: those of the motor, then motor speed and shaft twist.

use super::{Compiler, positive, value};
use crate::error::EngineError;
use crate::model::{DcMotorIn, Drive, FieldIn, InductionMotorIn};
use crate::spec::{DriveSpec, FieldSpec, InductionMotorSpec, Spec, TransmissionSpec};
use klingel_physics::drives::{DcField, DcMotor, FieldOriented, InductionMotor, Transmission};

/// What the motors are given while no controller commands them: armature voltages, field voltages, torques.
pub(super) fn motor_inputs(spec: &Spec) -> Vec<f64> {
    let armatures = spec.drives.iter().map(|d| d.armature_voltage);
    let fields = spec.drives.iter().filter_map(|d| Some(d.field.as_ref()?.resistance * d.field_current));
    armatures.chain(fields).chain(spec.induction_drives.iter().map(|d| d.torque_command)).collect()
}

impl Compiler<'_> {
    pub(super) fn dc_motors(&mut self) -> Result<Vec<DcMotorIn>, EngineError> {
        let mut motors = Vec::new();
        let mut field_input = self.spec.drives.len();
        for (input, d) in self.spec.drives.iter().enumerate() {
            let law = DcMotor {
                armature_resistance: positive(&d.name, "armature_resistance", d.armature_resistance)?,
                armature_inductance: positive(&d.name, "armature_inductance", d.armature_inductance)?,
                emf_constant: positive(&d.name, "emf_constant", d.emf_constant)?,
            };
            let voltage_max = positive(&d.name, "armature_voltage_max", d.armature_voltage_max)?;
            let state = self.states.add(format!("{}.armature_current", d.name), "A", 0.0);
            let field = self.field(d, &mut field_input)?;
            let transmission = TransmissionSpec {
                gear_ratio: d.gear_ratio,
                gear_sense: d.gear_sense,
                rotor_inertia: d.rotor_inertia,
                rotor_damping: d.rotor_damping,
                transmission_stiffness: d.transmission_stiffness,
                transmission_damping: d.transmission_damping,
            };
            let drive = self.drive(&d.name, &d.body, &d.rotor, &transmission)?;
            motors.push(DcMotorIn { drive, law, voltage_max, field, state, input });
        }
        Ok(motors)
    }

    fn field(&mut self, d: &DriveSpec, input: &mut usize) -> Result<FieldIn, EngineError> {
        let current = positive(&d.name, "field_current", d.field_current)?;
        let Some(FieldSpec { resistance, inductance, voltage_max }) = d.field else {
            return Ok(FieldIn::Held(current));
        };
        let law = DcField {
            resistance: positive(&d.name, "field.resistance", resistance)?,
            inductance: positive(&d.name, "field.inductance", inductance)?,
        };
        let voltage_max = positive(&d.name, "field.voltage_max", voltage_max)?;
        let state = self.states.add(format!("{}.field_current", d.name), "A", 0.0);
        *input += 1;
        Ok(FieldIn::Moved { law, voltage_max, state, input: *input - 1 })
    }

    pub(super) fn induction_motors(&mut self) -> Result<Vec<InductionMotorIn>, EngineError> {
        let mut motors = Vec::new();
        let first = motor_inputs(self.spec).len() - self.spec.induction_drives.len();
        for (i, d) in self.spec.induction_drives.iter().enumerate() {
            let law = induction_motor(&d.name, "motor", &d.motor)?;
            let of = |key: &str, x: f64| positive(&format!("{}.control", d.name), key, x);
            let control = FieldOriented {
                model: induction_motor(&d.name, "control.model", d.control.model.as_ref().unwrap_or(&d.motor))?,
                torque_bandwidth: of("torque_bandwidth", d.control.torque_bandwidth)?,
                flux_bandwidth: of("flux_bandwidth", d.control.flux_bandwidth)?,
                flux_rated: of("flux_rated", d.control.flux_rated)?,
                current_max: of("current_max", d.control.current_max)?,
                voltage_max: of("voltage_max", d.control.voltage_max)?,
                flux_share: of("flux_share", d.control.flux_share)?,
            };
            if control.flux_share >= 1.0 {
                let place = format!("{}.control.flux_share", d.name);
                return Err(value(place, control.flux_share, "give less than one, currents need voltage too"));
            }
            let state = self.states.names.len();
            for (name, unit) in InductionMotorIn::STATES {
                self.states.add(format!("{}.{name}", d.name), unit, 0.0);
            }
            let drive = self.drive(&d.name, &d.body, &d.rotor, &d.transmission)?;
            motors.push(InductionMotorIn { drive, law, control, state, input: first + i });
        }
        Ok(motors)
    }

    /// Rotor, gearbox and shaft of one motor; its place among the drives.
    fn drive(&mut self, name: &str, body: &str, rotor: &str, t: &TransmissionSpec) -> Result<usize, EngineError> {
        let on = self.body(name, body)?;
        let rotor = self.rotor(name, on, rotor)?;
        if !self.bodies[on].pitches {
            return Err(value(name, body, "a drive needs a body that pitches, to take its reaction"));
        }
        let law = Transmission {
            gear_ratio: positive(name, "gear_ratio", t.gear_ratio)?,
            rotor_inertia: positive(name, "rotor_inertia", t.rotor_inertia)?,
            rotor_damping: t.rotor_damping,
            stiffness: positive(name, "transmission_stiffness", t.transmission_stiffness)?,
            damping: t.transmission_damping,
        };
        let state = self.states.add(format!("{name}.motor_speed"), "rad/s", 0.0);
        self.states.add(format!("{name}.shaft_twist"), "rad", 0.0);
        let gear_sense = t.gear_sense.signum();
        self.drives.push(Drive { name: name.into(), body: on, rotor, law, gear_sense, state });
        Ok(self.drives.len() - 1)
    }
}

fn induction_motor(name: &str, part: &str, m: &InductionMotorSpec) -> Result<InductionMotor, EngineError> {
    let of = |key: &str, x: f64| positive(&format!("{name}.{part}"), key, x);
    Ok(InductionMotor {
        stator_resistance: of("stator_resistance", m.stator_resistance)?,
        rotor_resistance: of("rotor_resistance", m.rotor_resistance)?,
        stator_leakage: of("stator_leakage", m.stator_leakage)?,
        rotor_leakage: of("rotor_leakage", m.rotor_leakage)?,
        magnetizing_inductance: of("magnetizing_inductance", m.magnetizing_inductance)?,
        pole_pairs: of("pole_pairs", m.pole_pairs)?,
    })
}
