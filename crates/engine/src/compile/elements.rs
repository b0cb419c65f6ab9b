//! Force elements of a spec as the laws of `klingel_physics`, their states in order.
//! Every number is checked here; a message names the element.

use super::{Compiler, positive, value};
use crate::error::EngineError;
use crate::model::{ActuatorIn, Hold, MaxwellIn, StopIn};
use crate::spec::DragSpec;
use klingel_physics::drives::{Actuator, RunningResistance};
use klingel_physics::elements::{BlowOff, Bushing, Maxwell, Stop};

impl Compiler<'_> {
    pub(super) fn bushings(&mut self) -> Result<Vec<(usize, Bushing)>, EngineError> {
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

    pub(super) fn maxwells(&mut self) -> Result<Vec<MaxwellIn>, EngineError> {
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
            let state = self.states.add(format!("{}.force", e.name), "N", law.pole());
            maxwells.push(MaxwellIn { name: e.name.clone(), joint, axis: e.axis.index(), law, state });
        }
        Ok(maxwells)
    }

    pub(super) fn stops(&mut self) -> Result<Vec<StopIn>, EngineError> {
        let mut stops = Vec::new();
        for s in &self.spec.stops {
            let law = Stop::new(&s.deflection, &s.force)
                .map_err(|source| EngineError::Stop { name: s.name.clone(), source })?;
            let joint = self.joint(&s.name, &s.joint)?;
            stops.push(StopIn { name: s.name.clone(), joint, axis: s.axis.index(), law });
        }
        Ok(stops)
    }

    pub(super) fn actuators(&mut self, inputs: &mut Vec<f64>) -> Result<Vec<ActuatorIn>, EngineError> {
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
            let state = self.states.add(format!("{}.force", a.name), "N", 0.0);
            self.states.add(format!("{}.force_rate", a.name), "N/s", 0.0);
            inputs.push(0.0);
            actuators.push(ActuatorIn { name: a.name.clone(), joint, law, state, input: inputs.len() - 1 });
        }
        Ok(actuators)
    }

    pub(super) fn drag(&self) -> Result<Option<(usize, RunningResistance)>, EngineError> {
        let Some(DragSpec { body, coefficients: [constant, linear, quadratic], headwind }) = &self.spec.drag else {
            return Ok(None);
        };
        if !headwind.is_finite() {
            return Err(value("drag.headwind", headwind, "give a finite speed"));
        }
        let law =
            RunningResistance { constant: *constant, linear: *linear, quadratic: *quadratic, headwind: *headwind };
        Ok(Some((self.body("drag", body)?, law)))
    }

    pub(super) fn hold(&mut self) -> Result<Option<Hold>, EngineError> {
        let Some(h) = &self.spec.hold else { return Ok(None) };
        let body = self.body("hold", &h.body)?;
        let state = self.states.add("hold.integral".into(), "N", 0.0);
        Ok(Some(Hold {
            body,
            proportional: positive("hold", "proportional", h.proportional)?,
            integral: positive("hold", "integral", h.integral)?,
            acceleration: h.acceleration,
            state,
        }))
    }
}
