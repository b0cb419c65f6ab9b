//! Kalker's creepage coefficients C11, C22, C23 and C33 over the ratio of the semi-axes and Poisson's ratio.
//! Source: Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), table E.3 and its asymptotes; C33: CONTACT.

use crate::Scalar;
use core::f64::consts::{LN_2, PI};

/// (a/b, [C11, C22, C23] at Poisson's ratios 0, 0.25 and 0.5, C33 at 0.28).
///
/// The first nine numbers are table E.3. C33 was extrapolated to vanishing spin from runs of CONTACT (40 x 40 elements).
#[rustfmt::skip]
#[allow(clippy::approx_constant)] // 3.14 is Kalker's C22, not pi
const TABLE: [(f64, [[f64; 3]; 3], f64); 19] = [
    (0.1, [[2.51, 3.31, 4.85], [2.51, 2.52, 2.53], [0.334, 0.473, 0.731]], 8.7937),
    (0.2, [[2.59, 3.37, 4.81], [2.59, 2.63, 2.66], [0.483, 0.603, 0.809]], 4.5152),
    (0.3, [[2.68, 3.44, 4.8], [2.68, 2.75, 2.81], [0.607, 0.715, 0.889]], 3.1121),
    (0.4, [[2.78, 3.53, 4.82], [2.78, 2.88, 2.98], [0.72, 0.823, 0.977]], 2.3948),
    (0.5, [[2.88, 3.62, 4.83], [2.88, 3.01, 3.14], [0.827, 0.929, 1.07]], 1.9866),
    (0.6, [[2.98, 3.72, 4.91], [2.98, 3.14, 3.31], [0.93, 1.03, 1.18]], 1.7251),
    (0.7, [[3.09, 3.81, 4.97], [3.09, 3.28, 3.48], [1.03, 1.14, 1.29]], 1.5111),
    (0.8, [[3.19, 3.91, 5.05], [3.19, 3.41, 3.65], [1.13, 1.25, 1.4]], 1.371),
    (0.9, [[3.29, 4.01, 5.12], [3.29, 3.54, 3.82], [1.23, 1.36, 1.51]], 1.2628),
    (1.0, [[3.4, 4.12, 5.2], [3.4, 3.67, 3.98], [1.33, 1.47, 1.63]], 1.1769),
    (1.0 / 0.9, [[3.51, 4.22, 5.3], [3.51, 3.81, 4.16], [1.44, 1.59, 1.77]], 1.1),
    (1.0 / 0.8, [[3.65, 4.36, 5.42], [3.65, 3.99, 4.39], [1.58, 1.75, 1.94]], 1.0236),
    (1.0 / 0.7, [[3.82, 4.54, 5.58], [3.82, 4.21, 4.67], [1.76, 1.95, 2.18]], 0.9478),
    (1.0 / 0.6, [[4.06, 4.78, 5.8], [4.06, 4.5, 5.04], [2.01, 2.23, 2.5]], 0.8795),
    (1.0 / 0.5, [[4.37, 5.1, 6.11], [4.37, 4.9, 5.56], [2.35, 2.62, 2.96]], 0.7974),
    (1.0 / 0.4, [[4.84, 5.57, 6.57], [4.84, 5.48, 6.31], [2.88, 3.24, 3.7]], 0.7256),
    (1.0 / 0.3, [[5.57, 6.34, 7.34], [5.57, 6.4, 7.51], [3.79, 4.32, 5.01]], 0.6567),
    (1.0 / 0.2, [[6.96, 7.78, 8.82], [6.96, 8.14, 9.79], [5.72, 6.63, 7.89]], 0.5885),
    (1.0 / 0.1, [[10.7, 11.7, 12.9], [10.7, 12.8, 16.0], [12.2, 14.6, 18.0]], 0.5479),
];
/// The smooth curves reach from a/b = 1/LIMIT to LIMIT; beyond, the asymptotes are evaluated directly.
const LIMIT: f64 = 1e3;
const INTERVALS: usize = 256;
/// Step of numerical slopes over ln(a/b).
const STEP: f64 = 1e-5;

/// The coefficients of one material as smooth functions of a/b.
///
/// ```
/// use klingel_physics::contact::creep::Kalker;
/// let [c11, c22, c23, _] = Kalker::new(0.25).at(1.0_f64);
/// assert!((c11 - 4.12).abs() < 1e-9 && (c22 - 3.67).abs() < 1e-9 && (c23 - 1.47).abs() < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct Kalker {
    curves: Curves,
    /// Of each interval of ln(a/b): the four cubics, constant term first, in 0 to 1.
    cubics: Vec<[[f64; 4]; 4]>,
}

impl Kalker {
    /// The coefficients for Poisson's ratio `poisson` (0 to 0.5): 1/C is quadratic in it, as in CONTACT.
    pub fn new(poisson: f64) -> Self {
        let curves = Curves::new(poisson);
        let place = |i: usize| (2.0 * i as f64 / INTERVALS as f64 - 1.0) * LIMIT.ln();
        let nodes: Vec<_> = (0..=INTERVALS).map(|i| curves.value_and_slope(place(i))).collect();
        let cubics = nodes
            .windows(2)
            .map(|pair| {
                let ((lo, from), (hi, to)) = (pair[0], pair[1]);
                core::array::from_fn(|k| {
                    let (rise, s0, s1) = (hi[k] - lo[k], from[k] * interval(), to[k] * interval());
                    [lo[k], s0, 3.0 * rise - 2.0 * s0 - s1, s0 + s1 - 2.0 * rise]
                })
            })
            .collect();
        Self { curves, cubics }
    }

    /// [C11, C22, C23, C33] for semi-axes with the ratio a/b.
    #[inline]
    pub fn at<S: Scalar>(&self, a_over_b: S) -> [S; 4] {
        S::lift_n_lazy(
            [a_over_b],
            |[g]| self.read(g).0,
            |[g]| {
                let (values, slopes) = self.read(g);
                (values, slopes.map(|slope| [slope]))
            },
        )
    }

    /// C and dC/d(a/b) of the four coefficients.
    #[inline]
    fn read(&self, g: f64) -> ([f64; 4], [f64; 4]) {
        let x = g.ln();
        let place = (x / LIMIT.ln() + 1.0) * (0.5 * INTERVALS as f64);
        if !(place >= 0.0 && place < INTERVALS as f64) {
            let (c, slope) = self.curves.value_and_slope(x);
            return (c, slope.map(|s| s / g));
        }
        let cubics = &self.cubics[place as usize];
        let (t, scale) = (place.fract(), 1.0 / (interval() * g));
        (
            cubics.map(|[c0, c1, c2, c3]| c0 + t * (c1 + t * (c2 + t * c3))),
            cubics.map(|[_, c1, c2, c3]| (c1 + t * (2.0 * c2 + t * 3.0 * c3)) * scale),
        )
    }
}

/// Width of an interval of ln(a/b).
fn interval() -> f64 {
    2.0 * LIMIT.ln() / INTERVALS as f64
}

/// The table at one Poisson's ratio: ln(a/b), the four ln C and their slopes over ln(a/b).
#[derive(Clone, Debug)]
struct Curves {
    poisson: f64,
    x: Vec<f64>,
    c: Vec<[f64; 4]>,
    slope: Vec<[f64; 4]>,
    /// At the first and the last row: ln(C / asymptote) and its slope over the distance from there.
    joints: [[[f64; 2]; 4]; 2],
}

impl Curves {
    fn new(poisson: f64) -> Self {
        let (x, c): (Vec<f64>, Vec<[f64; 4]>) = (0..TABLE.len()).map(|i| row(i, poisson)).unzip();
        let slope: Vec<[f64; 4]> =
            (0..x.len()).map(|i| core::array::from_fn(|k| parabola_slope(&x, |j| c[j][k], i))).collect();
        let joints = [0, x.len() - 1].map(|end| {
            let at = |x: f64| asymptotes(poisson, x);
            let (joint, up, down) = (at(x[end]), at(x[end] + STEP), at(x[end] - STEP));
            core::array::from_fn(|k| {
                let rise = slope[end][k] - (up[k] / down[k]).ln() / (2.0 * STEP);
                [c[end][k] - joint[k].ln(), rise * x[end].signum()]
            })
        });
        Self { poisson, x, c, slope, joints }
    }

    /// The four coefficients at x = ln(a/b) and their slopes over x.
    fn value_and_slope(&self, x: f64) -> ([f64; 4], [f64; 4]) {
        let (c, up, down) = (self.at(x), self.at(x + STEP), self.at(x - STEP));
        (c, core::array::from_fn(|k| (up[k] - down[k]) / (2.0 * STEP)))
    }

    /// The four coefficients at x = ln(a/b): cubic in ln C within the table, asymptotes joined to it outside.
    fn at(&self, x: f64) -> [f64; 4] {
        let last = self.x.len() - 1;
        if x < self.x[0] || x > self.x[last] {
            return self.beyond(x);
        }
        let k = self.x.partition_point(|&row| row <= x).clamp(1, last) - 1;
        let h = self.x[k + 1] - self.x[k];
        let t = (x - self.x[k]) / h;
        core::array::from_fn(|i| {
            let (rise, s0, s1) = (self.c[k + 1][i] - self.c[k][i], self.slope[k][i] * h, self.slope[k + 1][i] * h);
            let (c2, c3) = (3.0 * rise - 2.0 * s0 - s1, s0 + s1 - 2.0 * rise);
            (self.c[k][i] + t * (s0 + t * (c2 + t * c3))).exp()
        })
    }

    /// The asymptote times a correction that continues value and slope of the table's end and fades beyond it.
    ///
    /// With t the distance to the end in ln(a/b): ln(C / asymptote) = (d + (d' + r d) t) exp(-r t). Rates r of 2 below and
    /// of 1 above: the correction goes with (a/b)^2 and with b/a, about as the table itself nears its asymptotes.
    fn beyond(&self, x: f64) -> [f64; 4] {
        let (rate, end, joint) =
            if x < 0.0 { (2.0, self.x[0], &self.joints[0]) } else { (1.0, self.x[self.x.len() - 1], &self.joints[1]) };
        let (asymptote, t) = (asymptotes(self.poisson, x), (x - end).abs());
        let fade = (-rate * t).exp();
        core::array::from_fn(|k| {
            let [d, slope] = joint[k];
            asymptote[k] * ((d + (slope + rate * d) * t) * fade).exp()
        })
    }
}

/// The table's row `i` at Poisson's ratio `nu`, as logarithms: ln(a/b) and the four ln C.
fn row(i: usize, nu: f64) -> (f64, [f64; 4]) {
    let (ratio, c, c33) = TABLE[i];
    let u = 4.0 * nu;
    let quadratic = |[c0, c1, c2]: [f64; 3]| {
        let (f0, f1, f2) = (1.0 / c0, 1.0 / c1, 1.0 / c2);
        -(0.5 * f0 * (u - 1.0) * (u - 2.0) - f1 * u * (u - 2.0) + 0.5 * f2 * u * (u - 1.0)).ln()
    };
    (f64::ln(ratio), [quadratic(c[0]), quadratic(c[1]), quadratic(c[2]), c33.ln()])
}

/// Slope at point `i` of the parabola through it and its neighbours (through the first or last three at an end).
fn parabola_slope(x: &[f64], f: impl Fn(usize) -> f64, i: usize) -> f64 {
    let m = i.clamp(1, x.len() - 2);
    let left = (f(m) - f(m - 1)) / (x[m] - x[m - 1]);
    let right = (f(m + 1) - f(m)) / (x[m + 1] - x[m]);
    let curvature = (right - left) / (x[m + 1] - x[m - 1]);
    left + curvature * (2.0 * x[i] - x[m - 1] - x[m])
}

/// Kalker's asymptotes for slender ellipses; C33 levels off near 0.5 in its last rows and is taken to stay there.
fn asymptotes(nu: f64, x: f64) -> [f64; 4] {
    if x < 0.0 {
        let g = x.exp();
        let c23 = PI * g.sqrt() / (3.0 * (1.0 - nu)) * (1.0 + nu * ((16.0 / g).ln() - 5.0));
        return [PI * PI / (4.0 * (1.0 - nu)), PI * PI / 4.0, c23, PI * PI / (16.0 * (1.0 - nu) * g)];
    }
    let (g, l) = ((-x).exp(), 16.0_f64.ln() + 2.0 * x);
    let (p, q) = (l - 2.0 * nu, (1.0 - nu) * l + 2.0 * nu);
    let edge = 3.0 - 2.0 * LN_2;
    [
        2.0 * PI / (p * g) * (1.0 + edge / p),
        2.0 * PI / g * (1.0 + (1.0 - nu) * edge / q) / q,
        2.0 * PI / (3.0 * g.powf(1.5) * ((1.0 - nu) * l - 2.0 + 4.0 * nu)),
        0.5,
    ]
}
