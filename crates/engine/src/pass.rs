//! One evaluation of everything that a steady state and a linear model look at: rates, channels, settled controllers.

use crate::channels;
use crate::control::Memory;
use crate::error::Fault;
use crate::inputs::nominal;
use crate::model::Model;
use crate::rates::{Workspace, rates};
use crate::wiring::Wiring;
use klingel_physics::Scalar;

/// Directions of one dual pass.
pub const DIRECTIONS: usize = 16;

/// One evaluation of the plant, its channels and the settled controllers.
pub struct Pass<S> {
    pub x: Vec<S>,
    pub inputs: Vec<S>,
    pub integrals: Vec<S>,
    pub dx: Vec<S>,
    pub row: Vec<S>,
    pub memory: Option<Memory<S>>,
    pub work: Workspace<S>,
    measured: Vec<S>,
}

impl<S: Scalar> Pass<S> {
    pub fn new(m: &Model, wiring: Option<&Wiring>) -> Self {
        let n = m.state_count();
        Self {
            x: vec![S::zero(); n],
            inputs: nominal(m),
            integrals: vec![S::zero(); wiring.map_or(0, |w| w.diagram.integrators())],
            dx: vec![S::zero(); n],
            row: vec![S::zero(); channels::list(m).len()],
            memory: wiring.map(|w| w.diagram.memory()),
            work: Workspace::new(m),
            measured: vec![S::zero(); wiring.map_or(0, |w| w.measured.len())],
        }
    }

    /// Whether limits of the controllers' integrals count.
    pub fn limited(mut self, limited: bool) -> Self {
        self.memory.iter_mut().for_each(|memory| memory.limited = limited);
        self
    }

    /// Rates and channels, and the controllers where constant measurements would lead them.
    ///
    /// # Errors
    /// A wheel that has left its rail; a controller that fails.
    pub fn evaluate(&mut self, m: &Model, wiring: Option<&Wiring>) -> Result<(), Fault> {
        rates(m, &self.x, &self.inputs, &mut self.work, &mut self.dx)?;
        channels::fill(m, &self.x, &self.inputs, &self.work, &mut self.row);
        if let (Some(wiring), Some(memory)) = (wiring, &mut self.memory) {
            self.measured.iter_mut().zip(&wiring.measured).for_each(|(to, &i)| *to = self.row[i]);
            let settled = wiring.diagram.settle(memory, &self.measured, &self.integrals);
            settled.map_err(|e| Fault::Control(e.to_string()))?;
        }
        Ok(())
    }

    /// What the controllers measure.
    pub fn measured(&self) -> &[S] {
        &self.measured
    }
}
