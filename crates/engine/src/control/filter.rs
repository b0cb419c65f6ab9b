//! Discrete linear filters with memory: a chain of second-order sections, and a state space of several inputs.
//! Both know their steady state, so that a run starts without a jolt.

use super::spec::Section;
use nalgebra::{DMatrix, DVector};

/// Second-order sections in the transposed direct form II: two states a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    sections: Vec<Section>,
    state: Vec<[f64; 2]>,
}

impl Sections {
    pub fn new(sections: Vec<Section>) -> Self {
        let state = vec![[0.0; 2]; sections.len()];
        Self { sections, state }
    }

    /// The steady state for a constant input; returns the output there.
    pub fn reset(&mut self, input: f64) -> f64 {
        self.sections.iter().zip(&mut self.state).fold(input, |u, (s, x)| {
            let y = u * s.b.iter().sum::<f64>() / (1.0 + s.a[0] + s.a[1]);
            x[1] = s.b[2] * u - s.a[1] * y;
            x[0] = s.b[1] * u - s.a[0] * y + x[1];
            y
        })
    }

    pub fn step(&mut self, input: f64) -> f64 {
        self.sections.iter().zip(&mut self.state).fold(input, |u, (s, x)| {
            let y = s.b[0] * u + x[0];
            x[0] = s.b[1] * u - s.a[0] * y + x[1];
            x[1] = s.b[2] * u - s.a[1] * y;
            y
        })
    }
}

/// x\[k+1\] = A x\[k\] + B u\[k\], y\[k\] = C x\[k\] + D u\[k\], matrices by rows in one piece each.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    d: Vec<f64>,
    state: Vec<f64>,
    next: Vec<f64>,
}

impl StateSpace {
    pub fn new(a: Vec<f64>, b: Vec<f64>, c: Vec<f64>, d: Vec<f64>) -> Self {
        let n = c.len();
        Self { a, b, c, d, state: vec![0.0; n], next: vec![0.0; n] }
    }

    /// The state that stays for constant inputs; `None` where the filter has a pole at z = 1.
    pub fn steady_state(&self, inputs: &[f64]) -> Option<Vec<f64>> {
        let n = self.c.len();
        if n == 0 {
            return Some(Vec::new());
        }
        let lhs = DMatrix::identity(n, n) - DMatrix::from_row_slice(n, n, &self.a);
        let rhs = DVector::from_fn(n, |i, _| dot(row(&self.b, i, inputs.len()), inputs));
        let lu = lhs.full_piv_lu();
        let pivots = lu.u().diagonal().abs();
        if pivots.min() < 1e-12 * pivots.max() {
            return None;
        }
        lu.solve(&rhs).map(|x| x.as_slice().to_vec())
    }

    /// Goes to the steady state and returns the output there.
    pub fn reset(&mut self, inputs: &[f64]) -> f64 {
        if let Some(x) = self.steady_state(inputs) {
            self.state.copy_from_slice(&x);
        }
        self.output(inputs)
    }

    fn output(&self, inputs: &[f64]) -> f64 {
        dot(&self.c, &self.state) + dot(&self.d, inputs)
    }

    pub fn step(&mut self, inputs: &[f64]) -> f64 {
        let y = self.output(inputs);
        let (n, m) = (self.c.len(), self.d.len());
        for i in 0..n {
            self.next[i] = dot(row(&self.a, i, n), &self.state) + dot(row(&self.b, i, m), inputs);
        }
        core::mem::swap(&mut self.state, &mut self.next);
        y
    }
}

fn row(matrix: &[f64], i: usize, columns: usize) -> &[f64] {
    &matrix[i * columns..(i + 1) * columns]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/(1 + T s) by the bilinear rule.
    fn lag(ts: f64, t: f64) -> Section {
        let k = ts / (ts + 2.0 * t);
        Section { b: [k, k, 0.0], a: [(ts - 2.0 * t) / (ts + 2.0 * t), 0.0] }
    }

    #[test]
    fn a_first_order_lag_follows_its_exponential() {
        let (ts, t) = (1e-3, 0.1);
        let mut f = Sections::new(vec![lag(ts, t)]);
        assert_eq!(f.reset(0.0), 0.0);
        let mut y = 0.0;
        // The trapezoidal rule sees the step as a ramp over the sample before it: half a sample early.
        for _ in 0..=200 {
            y = f.step(1.0);
        }
        assert!((y - (1.0 - (-0.2005f64 / t).exp())).abs() < 1e-5, "{y}");
    }

    #[test]
    fn reset_is_the_steady_state_of_a_chain() {
        let mut f = Sections::new(vec![lag(1e-3, 0.1), Section { b: [2.0, -1.0, 0.5], a: [-0.4, 0.2] }]);
        let y = f.reset(3.0);
        for _ in 0..5 {
            assert!((f.step(3.0) - y).abs() < 1e-12);
        }
    }

    #[test]
    fn the_state_space_equals_the_sections_and_starts_steady() {
        // The same section in controller form: H = b0 + (c1 z + c2)/(z^2 + a1 z + a2).
        let (b, a) = ([0.2, 0.3, -0.1], [-1.1, 0.4]);
        let mut sections = Sections::new(vec![Section { b, a }]);
        let c = vec![b[1] - b[0] * a[0], b[2] - b[0] * a[1]];
        let mut space = StateSpace::new(vec![-a[0], -a[1], 1.0, 0.0], vec![1.0, 0.0], c, vec![b[0]]);
        assert!((sections.reset(0.7) - space.reset(&[0.7])).abs() < 1e-12);
        for k in 0..50 {
            let u = (0.3 * f64::from(k)).sin();
            assert!((sections.step(u) - space.step(&[u])).abs() < 1e-12);
        }
    }

    #[test]
    fn an_integrator_has_no_steady_state() {
        assert_eq!(StateSpace::new(vec![1.0], vec![1e-3], vec![1.0], vec![0.0]).steady_state(&[1.0]), None);
    }
}
