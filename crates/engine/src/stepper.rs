//! Which scheme takes a step: explicit at speed, linearly implicit below `run.implicit_below` and wherever wheels stick.
//! Derived in docs/theory/standstill.md.

use crate::error::{EngineError, Fault};
use crate::integrate::{Blocks, Etdrk4, Rosenbrock};
use crate::model::Model;
use crate::stiff::{self, Stiff};

/// How far above the speed at which steps become implicit they become explicit again.
const HYSTERESIS: f64 = 1.05;

/// Both schemes with their memory; nothing is allocated in a step.
pub struct Stepper {
    explicit: Etdrk4,
    implicit: Option<Implicit>,
    is_implicit: bool,
}

struct Implicit {
    below: f64,
    scheme: Rosenbrock,
    stiff: Stiff,
    matrix: Blocks,
}

impl Stepper {
    /// `poles`: decay rates of the states \[1/s\], those of the model first.
    ///
    /// # Errors
    /// A body with more wheels than implicit steps take.
    pub fn new(m: &Model, poles: &[f64]) -> Result<Self, EngineError> {
        let sticks = m.wheels.iter().any(|w| w.stick.is_some());
        let below = if sticks { f64::INFINITY } else { m.run.implicit_below };
        let implicit = || {
            let (scheme, matrix) = (Rosenbrock::new(m.run.step, poles.len()), Blocks::new(stiff::blocks(m), poles));
            Ok::<_, EngineError>(Implicit { below, scheme, stiff: Stiff::new(m)?, matrix })
        };
        let implicit = (below > 0.0).then(implicit).transpose()?;
        Ok(Self { explicit: Etdrk4::new(m.run.step, poles), implicit, is_implicit: false })
    }

    /// Chooses the scheme of the steps to come by the speed of the reference body.
    pub fn choose(&mut self, m: &Model, x: &[f64]) {
        if let Some(implicit) = &self.implicit {
            let hysteresis = if self.is_implicit { HYSTERESIS } else { 1.0 };
            self.is_implicit = m.reference_speed(x).abs() < implicit.below * hysteresis;
        }
    }

    /// Right-hand sides of a step, the first one and that of the Jacobian included.
    pub fn evaluations(&self) -> u64 {
        if self.is_implicit { 5 } else { 4 }
    }

    /// Advances `x` by one step. `first` holds x' at `x` and `inputs`; `rhs(time offset, x, x')` gives the others.
    ///
    /// # Errors
    /// A wheel that has left its rail.
    pub fn advance(
        &mut self,
        m: &Model,
        x: &mut [f64],
        first: &[f64],
        inputs: &mut [f64],
        mut rhs: impl FnMut(f64, &[f64], &mut [f64], &mut [f64]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        match &mut self.implicit {
            Some(Implicit { scheme, stiff, matrix, .. }) if self.is_implicit => {
                stiff.fill(m, x, inputs, matrix)?;
                scheme.advance(x, first, matrix, |later, at, dx| rhs(later, at, inputs, dx))
            }
            _ => self.explicit.advance(x, first, |later, at, dx| rhs(later, at, inputs, dx)),
        }
    }
}
