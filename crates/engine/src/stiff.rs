//! What is stiff at low speed: creep, between the velocities and spins of every body with wheels (and their stick).
//! Its Jacobian, one block a body, from one pass of the rates with dual numbers in which creep forces have secants.

use crate::error::{EngineError, Fault};
use crate::integrate::Blocks;
use crate::model::Model;
use crate::rates::{Workspace, rates};
use klingel_physics::{Dual, Scalar};

/// The states of each block: velocities of a body with wheels, spins of its rotors, transient creepages of its wheels.
pub fn blocks(m: &Model) -> Vec<Vec<usize>> {
    let on = |body: usize| {
        let spins = m.rotors.iter().filter(move |r| r.body == body).map(|r| r.state);
        let sticks = m.wheels.iter().filter(move |w| w.body == body).filter_map(|w| w.stick);
        m.bodies[body].velocities().chain(spins).chain(sticks.flat_map(|first| [first, first + 1])).collect()
    };
    (0..m.bodies.len()).filter(|&b| m.wheels.iter().any(|w| w.body == b)).map(on).collect()
}

/// The pass in as many directions as the largest block needs.
pub enum Stiff {
    Few(Box<Directions<8>>),
    Many(Box<Directions<16>>),
}

impl Stiff {
    /// Errors: `EngineError::Value` for a body with more wheels than the passes have directions.
    pub fn new(m: &Model) -> Result<Self, EngineError> {
        match blocks(m).iter().map(Vec::len).max().unwrap_or(0) {
            0..=8 => Ok(Self::Few(Box::new(Directions::new(m)))),
            9..=16 => Ok(Self::Many(Box::new(Directions::new(m)))),
            most => Err(EngineError::Value {
                place: "run.implicit_below".into(),
                value: m.run.implicit_below.to_string(),
                remedy: format!(
                    "a body has {most} velocities, spins and transient creepages, implicit steps take 16; \
                                 split it or run explicitly, without stick"
                ),
            }),
        }
    }

    /// Writes the Jacobian at `x` into `matrix`, whose blocks are `blocks(m)`.
    ///
    /// # Errors
    /// A wheel that has left its rail.
    pub fn fill(&mut self, m: &Model, x: &[f64], inputs: &[f64], matrix: &mut Blocks) -> Result<(), Fault> {
        match self {
            Self::Few(pass) => pass.fill(m, x, inputs, matrix),
            Self::Many(pass) => pass.fill(m, x, inputs, matrix),
        }
    }
}

/// A pass of the rates in K directions.
pub struct Directions<const K: usize> {
    x: Vec<Dual<K>>,
    inputs: Vec<Dual<K>>,
    dx: Vec<Dual<K>>,
    work: Workspace<Dual<K>>,
}

impl<const K: usize> Directions<K> {
    fn new(m: &Model) -> Self {
        let n = m.state_count();
        Self {
            x: vec![Dual::zero(); n],
            inputs: vec![Dual::zero(); m.places.count],
            dx: vec![Dual::zero(); n],
            work: Workspace { secants: true, ..Workspace::new(m) },
        }
    }

    /// All blocks share their directions: what has wheels acts on the other bodies with wheels through bodies without, so
    /// no slope of one block carries anything of another.
    fn fill(&mut self, m: &Model, x: &[f64], inputs: &[f64], matrix: &mut Blocks) -> Result<(), Fault> {
        self.x.iter_mut().zip(x).for_each(|(to, &x)| *to = Dual::constant(x));
        self.inputs.iter_mut().zip(inputs).for_each(|(to, &u)| *to = Dual::constant(u));
        for b in 0..matrix.len() {
            for (direction, &i) in matrix.states(b).iter().enumerate() {
                self.x[i] = Dual::variable(x[i], direction);
            }
        }
        rates(m, &self.x, &self.inputs, &mut self.work, &mut self.dx)?;
        for b in 0..matrix.len() {
            let (states, block) = matrix.block_mut(b);
            for (row, &i) in block.chunks_exact_mut(states.len()).zip(states) {
                row.copy_from_slice(&self.dx[i].slope[..states.len()]);
            }
        }
        Ok(())
    }
}
