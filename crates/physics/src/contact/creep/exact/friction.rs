//! Coulomb's law in one element: the traction that stops its slip or, where that is too much, opposes it.
//! Its derivative is what Newton's method needs.

/// Traction, and its derivative by the slip: [x by x, the mixed one, y by y].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Traction {
    pub value: [f64; 2],
    pub slope: [f64; 3],
    pub slips: bool,
}

/// The traction p with |p| <= bound that solves  s + own p = -lambda p,  lambda >= 0, lambda = 0 within the bound.
///
/// s is the slip that everything else causes, `own` the positive slip by a unit of p along each axis, so s + own p is
/// the slip itself: zero in adhesion, against p in sliding.
pub(super) fn traction(s: [f64; 2], own: [f64; 2], bound: f64) -> Traction {
    let sticking = [-s[0] / own[0], -s[1] / own[1]];
    if sticking[0].hypot(sticking[1]) <= bound {
        return Traction { value: sticking, slope: [-1.0 / own[0], 0.0, -1.0 / own[1]], slips: false };
    }
    // 1/|p| is concave and almost linear in lambda; from below, Newton's steps never pass the root.
    let mut lambda = (s[0].hypot(s[1]) / bound - own[0].max(own[1])).max(0.0);
    let (mut m, mut p) = ([0.0; 2], [0.0; 2]);
    for _ in 0..50 {
        m = [1.0 / (own[0] + lambda), 1.0 / (own[1] + lambda)];
        p = [-s[0] * m[0], -s[1] * m[1]];
        let size = p[0].hypot(p[1]);
        if (size / bound - 1.0).abs() < 1e-13 {
            break;
        }
        lambda += (size / bound - 1.0) * size * size / (p[0] * p[0] * m[0] + p[1] * p[1] * m[1]);
    }
    // dp = -m (ds + p dlambda) with p . dp = 0.
    let v = [m[0] * p[0], m[1] * p[1]];
    let e = p[0] * v[0] + p[1] * v[1];
    let slope = [v[0] * v[0] / e - m[0], v[0] * v[1] / e, v[1] * v[1] / e - m[1]];
    Traction { value: p, slope, slips: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: [f64; 2] = [0.8, 0.5];
    const CASES: [[f64; 2]; 5] = [[0.1, 0.2], [3.0, 0.0], [0.7, -0.6], [-40.0, 30.0], [1e6, -1e6]];

    #[test]
    fn sticks_or_slides_against_the_traction() {
        for s in CASES {
            let t = traction(s, OWN, 1.0);
            let slip = [s[0] + OWN[0] * t.value[0], s[1] + OWN[1] * t.value[1]];
            let (size, rest) = (t.value[0].hypot(t.value[1]), slip[0].hypot(slip[1]));
            let work = slip[0] * t.value[0] + slip[1] * t.value[1];
            assert_eq!(t.slips, rest > 1e-12);
            if t.slips {
                assert!((size - 1.0).abs() < 1e-12 && (work + size * rest).abs() < 1e-11 * rest, "{s:?} {t:?}");
            } else {
                assert!(size <= 1.0);
            }
        }
    }

    #[test]
    fn slope_is_the_difference_quotient() {
        for s in CASES {
            let h = 1e-6 * (1.0 + s[0].abs());
            let at = |i: usize, h: f64| {
                let mut s = s;
                s[i] += h;
                traction(s, OWN, 1.0).value
            };
            let [x, y] = [0, 1].map(|i| [0, 1].map(|k| (at(i, h)[k] - at(i, -h)[k]) / (2.0 * h)));
            let [xx, xy, yy] = traction(s, OWN, 1.0).slope;
            for (own, difference) in [(xx, x[0]), (xy, x[1]), (xy, y[0]), (yy, y[1])] {
                assert!((own - difference).abs() < 1e-6 * (1.0 + s[0].abs()).recip(), "{s:?}: {own} {difference}");
            }
        }
    }
}
