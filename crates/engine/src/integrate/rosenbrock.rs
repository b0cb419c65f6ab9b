//! Linearly implicit steps that keep their order with any matrix (a W-method): ROS34PW2 of Rang & Angermann (2005),
//! BIT 45, 761-787, table 4.2: four stages, order three, L-stable and stiffly accurate where the matrix is the Jacobian.

use super::Blocks;

const GAMMA: f64 = 0.435_866_521_508_459;
/// Where the stages take the right-hand side: weights of the stages before.
const ALPHA: [[f64; 3]; 4] = [
    [0.0; 3],
    [0.871_733_043_016_918, 0.0, 0.0],
    [0.844_570_600_153_694_2, -0.112_990_642_363_484_85, 0.0],
    [0.0, 0.0, 1.0],
];
/// What the stages before add under the matrix.
const COUPLING: [[f64; 3]; 4] = [
    [0.0; 3],
    [-0.871_733_043_016_918, 0.0, 0.0],
    [-0.903_380_570_130_440_8, 0.054_180_672_388_095_326, 0.0],
    [0.242_123_807_060_953_46, -1.223_250_583_904_514_7, 0.545_260_255_335_102_1],
];
const WEIGHT: [f64; 4] = [0.242_123_807_060_953_46, -1.223_250_583_904_514_7, 1.545_260_255_335_102, GAMMA];

/// The stages' memory for one step length.
#[derive(Clone, Debug)]
pub struct Rosenbrock {
    step: f64,
    at: Vec<f64>,
    sum: Vec<f64>,
    stages: [Vec<f64>; 4],
}

impl Rosenbrock {
    /// For `states` states; `step` in seconds.
    pub fn new(step: f64, states: usize) -> Self {
        let nil = || vec![0.0; states];
        Self { step, at: nil(), sum: nil(), stages: core::array::from_fn(|_| nil()) }
    }

    /// Advances `x` by one step: (1 - gamma h A) k_i = h f(x + sum alpha_ij k_j) + h A sum gamma_ij k_j, x + sum b_i k_i.
    /// `first` holds x' at `x`; `rhs(time offset, x, x')` gives the other three; `matrix` is A, by no means exact.
    pub fn advance<E>(
        &mut self,
        x: &mut [f64],
        first: &[f64],
        matrix: &mut Blocks,
        mut rhs: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let Self { step, at, sum, stages } = self;
        let h = *step;
        matrix.factor(GAMMA * h);
        for i in 0..4 {
            let (before, rest) = stages.split_at_mut(i);
            let k = &mut rest[0];
            if i == 0 {
                k.copy_from_slice(first);
                k.iter_mut().for_each(|k| *k *= h);
            } else {
                at.copy_from_slice(x);
                combine(at, &ALPHA[i], before);
                rhs(h * ALPHA[i].iter().sum::<f64>(), at, k)?;
                sum.fill(0.0);
                combine(sum, &COUPLING[i], before);
                matrix.multiply(sum, at);
                k.iter_mut().zip(at.iter()).for_each(|(k, a)| *k = h * (*k + a));
            }
            matrix.solve(k);
        }
        combine(x, &WEIGHT, stages);
        Ok(())
    }
}

/// to += sum weight_j k_j.
fn combine(to: &mut [f64], weights: &[f64], stages: &[Vec<f64>]) {
    for (&weight, k) in weights.iter().zip(stages) {
        if weight != 0.0 {
            to.iter_mut().zip(k).for_each(|(to, k)| *to += weight * k);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;

    const STIFF: f64 = 5.0;

    /// A nonlinear oscillator that drives a decaying state, with the time in it.
    fn f(t: f64, x: &[f64], d: &mut [f64]) {
        d[0] = -STIFF * (x[0] - (3.0 * t).cos() * x[1]) - x[0] * x[0];
        d[1] = x[2];
        d[2] = -x[1].sin() * 9.0 + 0.1 * x[0];
    }

    fn exact(t: f64, x: &[f64], matrix: &mut [f64]) {
        let stiff = [-STIFF - 2.0 * x[0], STIFF * (3.0 * t).cos(), 0.0];
        matrix.copy_from_slice(&[stiff, [0.0, 0.0, 1.0], [0.1, -x[1].cos() * 9.0, 0.0]].concat());
    }

    fn nil(_: f64, _: &[f64], matrix: &mut [f64]) {
        matrix.fill(0.0);
    }

    fn wrong(_: f64, x: &[f64], matrix: &mut [f64]) {
        matrix.copy_from_slice(&[-7.0, 2.0, 1.0, 0.5, -3.0, x[0], 4.0, -1.0, 0.3]);
    }

    /// End state at t = 1.
    fn run(steps: usize, jacobian: impl Fn(f64, &[f64], &mut [f64])) -> [f64; 3] {
        let h = 1.0 / steps as f64;
        let mut scheme = Rosenbrock::new(h, 3);
        let mut matrix = Blocks::new(vec![vec![0, 1, 2]], &[0.0; 3]);
        let (mut x, mut first) = ([0.2, 0.5, 0.0], [0.0; 3]);
        for i in 0..steps {
            let t = i as f64 * h;
            f(t, &x, &mut first);
            jacobian(t, &x, matrix.block_mut(0).1);
            let stepped: Result<(), Infallible> = scheme.advance(&mut x, &first, &mut matrix, |dt, x, d| {
                f(t + dt, x, d);
                Ok(())
            });
            stepped.expect("a step");
        }
        x
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn order_is_three_with_the_jacobian_with_none_and_with_a_wrong_one() {
        for (name, jacobian) in [("exact", exact as fn(f64, &[f64], &mut [f64])), ("nil", nil), ("wrong", wrong)] {
            let reference = run(1 << 14, exact);
            let ratio = distance(run(128, jacobian), reference) / distance(run(256, jacobian), reference);
            assert!(ratio.log2() > 2.85 && ratio.log2() < 3.4, "{name}: observed order {}", ratio.log2());
        }
    }

    /// y' = L y: L-stable, so a step far beyond every explicit limit takes y to nil, and never out of bounds.
    #[test]
    fn a_stiff_state_of_a_block_dies_out() {
        for rate in [1e2, 1e4, 1e8] {
            let mut matrix = Blocks::new(vec![vec![0]], &[0.0]);
            matrix.block_mut(0).1[0] = -rate;
            let mut scheme = Rosenbrock::new(1e-3, 1);
            let mut y = [1.0];
            for _ in 0..4 {
                let before = y[0];
                let first = [-rate * y[0]];
                let stepped: Result<(), Infallible> = scheme.advance(&mut y, &first, &mut matrix, |_, y, d| {
                    d[0] = -rate * y[0];
                    Ok(())
                });
                stepped.expect("a step");
                let (z, factor) = (rate * 1e-3, y[0] / before);
                assert!(factor.abs() < 1.0 && (z > 1.0 || (factor - (-z).exp()).abs() < 1e-4), "{rate}: {factor}");
                assert!(z < 1e4 || factor.abs() < 1e-4, "{rate}: {factor}");
            }
        }
    }
}
