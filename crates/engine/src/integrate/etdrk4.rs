//! Exponential Runge-Kutta of fourth order (Cox & Matthews 2002, J. Comput. Phys. 176, eqs 26-29) with a diagonal
//! linear part: where a state's decay rate is zero it is the classical Runge-Kutta scheme, else its pole sets no limit.

/// Coefficients for one step length and one set of decay rates, and the stages' memory.
#[derive(Clone, Debug)]
pub struct Etdrk4 {
    step: f64,
    rates: Vec<f64>,
    coefficients: Vec<Coefficients>,
    at: Vec<f64>,
    f: [Vec<f64>; 4],
}

/// Of one state, with L = -decay rate: e^(hL), e^(hL/2), and the weights of N(u), N(a)+N(b), N(c).
#[derive(Clone, Copy, Debug)]
struct Coefficients {
    whole: f64,
    half: f64,
    stage: f64,
    first: f64,
    middle: f64,
    last: f64,
}

impl Etdrk4 {
    /// `decay` is one rate a state \[1/s\], zero or positive; `step` in seconds.
    pub fn new(step: f64, decay: &[f64]) -> Self {
        let coefficients = decay.iter().map(|&rate| Coefficients::new(step, rate)).collect();
        let n = decay.len();
        Self { step, rates: decay.to_vec(), coefficients, at: vec![0.0; n], f: core::array::from_fn(|_| vec![0.0; n]) }
    }

    pub fn step(&self) -> f64 {
        self.step
    }

    /// Advances `x` by one step. `first` holds x' at `x`; `rhs(time offset, x, x')` gives the other three.
    pub fn advance<E>(
        &mut self,
        x: &mut [f64],
        first: &[f64],
        mut rhs: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let Self { step, rates, coefficients, at, f: [n0, n1, n2, n3] } = self;
        let half = 0.5 * *step;
        for i in 0..x.len() {
            n0[i] = first[i] + rates[i] * x[i];
            at[i] = coefficients[i].half * x[i] + coefficients[i].stage * n0[i];
        }
        rhs(half, at, n1)?;
        for i in 0..x.len() {
            n1[i] += rates[i] * at[i];
            // kept for the third stage, which starts from the first one
            n3[i] = at[i];
            at[i] = coefficients[i].half * x[i] + coefficients[i].stage * n1[i];
        }
        rhs(half, at, n2)?;
        for i in 0..x.len() {
            n2[i] += rates[i] * at[i];
            at[i] = coefficients[i].half * n3[i] + coefficients[i].stage * (2.0 * n2[i] - n0[i]);
        }
        rhs(*step, at, n3)?;
        for i in 0..x.len() {
            let c = &coefficients[i];
            n3[i] += rates[i] * at[i];
            x[i] = c.whole * x[i] + c.first * n0[i] + c.middle * (n1[i] + n2[i]) + c.last * n3[i];
        }
        Ok(())
    }
}

impl Coefficients {
    /// phi_1, phi_2, phi_3 of z = hL: weights h (phi1 - 3 phi2 + 4 phi3), 2h (phi2 - 2 phi3), h (4 phi3 - phi2).
    fn new(step: f64, decay: f64) -> Self {
        let z = -step * decay;
        let [p1, p2, p3] = phi(z);
        let [half_p1, ..] = phi(0.5 * z);
        Self {
            whole: z.exp(),
            half: (0.5 * z).exp(),
            stage: 0.5 * step * half_p1,
            first: step * (p1 - 3.0 * p2 + 4.0 * p3),
            middle: 2.0 * step * (p2 - 2.0 * p3),
            last: step * (4.0 * p3 - p2),
        }
    }
}

/// phi_k(z) = sum of z^j / (j + k)!, by its series near zero and by recurrence elsewhere.
fn phi(z: f64) -> [f64; 3] {
    if z.abs() < 1.0 {
        return [1, 2, 3].map(|k| {
            let mut term = 1.0 / (1..=k).product::<i32>() as f64;
            let mut sum = term;
            for j in 1..20 {
                term *= z / (j + k) as f64;
                sum += term;
            }
            sum
        });
    }
    let p1 = z.exp_m1() / z;
    let p2 = (p1 - 1.0) / z;
    [p1, p2, (p2 - 0.5) / z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;

    /// y' = -p y + cos t with a nonlinear oscillator beside it; returns the end state at t = 1.
    fn run(steps: usize, pole: f64, declared: f64) -> [f64; 3] {
        let h = 1.0 / steps as f64;
        let rhs = |t: f64, x: &[f64], d: &mut [f64]| -> Result<(), Infallible> {
            d[0] = -pole * (x[0] - (3.0 * t).cos() * x[1]);
            d[1] = x[2];
            d[2] = -x[1].sin() * 9.0 + 0.1 * x[0];
            Ok(())
        };
        let mut scheme = Etdrk4::new(h, &[declared, 0.0, 0.0]);
        let (mut x, mut first) = ([0.2, 0.5, 0.0], [0.0; 3]);
        for i in 0..steps {
            let t = i as f64 * h;
            let _ = rhs(t, &x, &mut first);
            let _ = scheme.advance(&mut x, &first, |dt, x, d| rhs(t + dt, x, d));
        }
        x
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn order_is_four_with_and_without_an_exponential_state() {
        for declared in [0.0, 5.0] {
            let exact = run(4096, 5.0, declared);
            let ratio = distance(run(32, 5.0, declared), exact) / distance(run(64, 5.0, declared), exact);
            assert!(ratio.log2() > 3.7 && ratio.log2() < 4.4, "observed order {}", ratio.log2());
        }
    }

    #[test]
    fn a_stiff_linear_state_sets_no_limit() {
        let exact = run(1 << 16, 4000.0, 4000.0);
        assert!(distance(run(1000, 4000.0, 4000.0), exact) < 1e-5);
    }

    #[test]
    fn phi_is_continuous_where_the_formula_changes() {
        for k in 0..3 {
            assert!((phi(-0.999_999_9)[k] - phi(-1.000_000_1)[k]).abs() < 1e-6);
        }
    }
}
