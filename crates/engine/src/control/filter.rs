//! Discrete linear filters: a chain of second-order sections, and a state space of several inputs and outputs.
//! Their memory is the caller's; both know their steady state, so that a run starts without a jolt.

use super::spec::Section;
use klingel_physics::Scalar;
use nalgebra::{DMatrix, DVector};

/// Second-order sections in the transposed direct form II: two states a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections(Vec<Section>);

impl Sections {
    pub fn new(sections: Vec<Section>) -> Self {
        Self(sections)
    }

    pub fn states(&self) -> usize {
        2 * self.0.len()
    }

    /// The steady state for a constant input; returns the output there.
    pub fn reset<S: Scalar>(&self, memory: &mut [S], input: S) -> S {
        self.0.iter().zip(memory.chunks_exact_mut(2)).fold(input, |u, (s, x)| {
            let y = u * (s.b.iter().sum::<f64>() / (1.0 + s.a[0] + s.a[1]));
            x[1] = u * s.b[2] - y * s.a[1];
            x[0] = u * s.b[1] - y * s.a[0] + x[1];
            y
        })
    }

    pub fn step<S: Scalar>(&self, memory: &mut [S], input: S) -> S {
        self.0.iter().zip(memory.chunks_exact_mut(2)).fold(input, |u, (s, x)| {
            let y = u * s.b[0] + x[0];
            x[0] = u * s.b[1] - y * s.a[0] + x[1];
            x[1] = u * s.b[2] - y * s.a[1];
            y
        })
    }
}

/// x\[k+1\] = A x\[k\] + B u\[k\], y\[k\] = C x\[k\] + D u\[k\], matrices by rows in one piece each.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// States, inputs, outputs.
    sizes: [usize; 3],
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    d: Vec<f64>,
    /// States over inputs in a steady state, by rows; none for a filter with a pole at z = 1.
    steady: Option<Vec<f64>>,
}

impl StateSpace {
    pub fn new(sizes: [usize; 3], [a, b, c, d]: [Vec<f64>; 4]) -> Self {
        let steady = steady(&a, &b, sizes[0], sizes[1]);
        Self { sizes, a, b, c, d, steady }
    }

    pub fn states(&self) -> usize {
        self.sizes[0]
    }

    pub fn outputs(&self) -> usize {
        self.sizes[2]
    }

    /// Whether it stays somewhere for constant inputs: false with a pole at z = 1.
    pub fn settles(&self) -> bool {
        self.steady.is_some()
    }

    /// Goes to the steady state and writes the outputs there.
    pub fn reset<S: Scalar>(&self, memory: &mut [S], inputs: &[S], out: &mut [S]) {
        if let Some(steady) = &self.steady {
            multiply(memory, [(steady, inputs)]);
        }
        multiply(out, [(&self.c, memory), (&self.d, inputs)]);
    }

    /// `next` is written over; it is as long as the memory.
    pub fn step<S: Scalar>(&self, state: &mut [S], inputs: &[S], next: &mut [S], out: &mut [S]) {
        multiply(out, [(&self.c, state), (&self.d, inputs)]);
        multiply(next, [(&self.a, state), (&self.b, inputs)]);
        state.copy_from_slice(next);
    }
}

/// A sum of matrices (by rows) times vectors.
fn multiply<S: Scalar, const N: usize>(into: &mut [S], terms: [(&[f64], &[S]); N]) {
    for (i, y) in into.iter_mut().enumerate() {
        let row = |(matrix, x): &(&[f64], &[S])| dot(&matrix[i * x.len()..][..x.len()], x);
        *y = terms.iter().fold(S::zero(), |sum, term| sum + row(term));
    }
}

/// (1 - A)^-1 B, if A has no eigenvalue one.
fn steady(a: &[f64], b: &[f64], n: usize, m: usize) -> Option<Vec<f64>> {
    if n == 0 {
        return Some(Vec::new());
    }
    let lu = (DMatrix::identity(n, n) - DMatrix::from_row_slice(n, n, a)).full_piv_lu();
    let pivots = lu.u().diagonal().abs();
    if pivots.min() < 1e-12 * pivots.max() {
        return None;
    }
    let columns = (0..m).map(|k| lu.solve(&DVector::from_fn(n, |i, _| b[i * m + k]))).collect::<Option<Vec<_>>>()?;
    Some((0..n).flat_map(|i| columns.iter().map(move |c| c[i])).collect())
}

fn dot<S: Scalar>(a: &[f64], b: &[S]) -> S {
    a.iter().zip(b).fold(S::zero(), |sum, (&a, &b)| sum + b * a)
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
        let (f, mut x) = (Sections::new(vec![lag(ts, t)]), [0.0; 2]);
        assert_eq!(f.reset(&mut x, 0.0), 0.0);
        let mut y = 0.0;
        // The trapezoidal rule sees the step as a ramp over the sample before it: half a sample early.
        for _ in 0..=200 {
            y = f.step(&mut x, 1.0);
        }
        assert!((y - (1.0 - (-0.2005f64 / t).exp())).abs() < 1e-5, "{y}");
    }

    #[test]
    fn reset_is_the_steady_state_of_a_chain() {
        let f = Sections::new(vec![lag(1e-3, 0.1), Section { b: [2.0, -1.0, 0.5], a: [-0.4, 0.2] }]);
        let mut x = [0.0; 4];
        let y = f.reset(&mut x, 3.0);
        for _ in 0..5 {
            assert!((f.step(&mut x, 3.0) - y).abs() < 1e-12);
        }
    }

    #[test]
    fn the_state_space_equals_the_sections_and_starts_steady() {
        // The same section in controller form: H = b0 + (c1 z + c2)/(z^2 + a1 z + a2).
        let (b, a) = ([0.2, 0.3, -0.1], [-1.1, 0.4]);
        let (sections, mut x) = (Sections::new(vec![Section { b, a }]), [0.0; 2]);
        let c = vec![b[1] - b[0] * a[0], b[2] - b[0] * a[1]];
        let matrices = [vec![-a[0], -a[1], 1.0, 0.0], vec![1.0, 0.0], c, vec![b[0]]];
        let space = StateSpace::new([2, 1, 1], matrices);
        let (mut z, mut next, mut y) = ([0.0; 2], [0.0; 2], [0.0]);
        space.reset(&mut z, &[0.7], &mut y);
        assert!((sections.reset(&mut x, 0.7) - y[0]).abs() < 1e-12);
        for k in 0..50 {
            let u = (0.3 * f64::from(k)).sin();
            space.step(&mut z, &[u], &mut next, &mut y);
            assert!((sections.step(&mut x, u) - y[0]).abs() < 1e-12);
        }
    }

    #[test]
    fn several_outputs_of_several_inputs_by_hand() {
        // x+ = 0.5 x + u - v, y = (x, 2 x + 3 v)
        let space = StateSpace::new([1, 2, 2], [vec![0.5], vec![1.0, -1.0], vec![1.0, 2.0], vec![0.0, 0.0, 0.0, 3.0]]);
        let (mut x, mut next, mut y) = ([0.0], [0.0], [0.0; 2]);
        space.reset(&mut x, &[4.0, 1.0], &mut y);
        assert_eq!((x, y), ([6.0], [6.0, 15.0]));
        space.step(&mut x, &[0.0, 1.0], &mut next, &mut y);
        assert_eq!((x, y), ([2.0], [6.0, 15.0]));
        space.step(&mut x, &[0.0, 0.0], &mut next, &mut y);
        assert_eq!(y, [2.0, 4.0]);
    }

    #[test]
    fn without_states_it_is_a_matrix_of_gains() {
        let space = StateSpace::new([0, 2, 1], [vec![], vec![], vec![], vec![2.0, -1.0]]);
        let mut y = [0.0];
        space.reset(&mut [], &[3.0, 1.0], &mut y);
        assert_eq!(y, [5.0]);
    }

    #[test]
    fn an_integrator_has_no_steady_state() {
        assert!(!StateSpace::new([1, 1, 1], [vec![1.0], vec![1e-3], vec![1.0], vec![0.0]]).settles());
    }
}
