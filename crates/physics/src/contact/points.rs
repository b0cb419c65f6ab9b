//! A profile through given points: checks of what was given, and a cubic spline over the chord length.
//! The points are taken as exact; measured ones are smoothed before they come here.

use super::profile::STEP;
use super::{ContactError, Profile};

/// Fewest points of a profile, and the widths a profile of a wheel or a rail can have, m.
const LEAST_POINTS: usize = 10;
const WIDTH: [f64; 2] = [0.02, 1.0];

impl Profile {
    /// The smooth curve through the points (y, z) in metres, y rising or falling steadily.
    ///
    /// ```
    /// use klingel_physics::contact::Profile;
    /// let y: Vec<f64> = (0..80).map(|i| -0.06 + 1.5e-3 * f64::from(i)).collect();
    /// let z: Vec<f64> = y.iter().map(|y| y * y).collect();
    /// let profile = Profile::from_points(&y, &z, "measured wheel").unwrap();
    /// let (height, slope) = profile.at(0.01).unwrap();
    /// assert!((height - 1e-4).abs() < 1e-8 && (slope - 0.02).abs() < 1e-4);
    /// ```
    ///
    /// # Errors
    /// Unequal lengths, fewer than ten points, values that are not finite, y that does not rise or fall steadily, a width
    /// above 1 m (millimetres) or below 20 mm. `what` names the profile in the message.
    pub fn from_points(y: &[f64], z: &[f64], what: &str) -> Result<Self, ContactError> {
        let what = || what.to_owned();
        let (n, least) = (y.len(), LEAST_POINTS);
        if n != z.len() {
            return Err(ContactError::UnequalLengths { what: what(), y: n, z: z.len() });
        }
        if n < least {
            return Err(ContactError::TooFewPoints { what: what(), count: n, least });
        }
        if let Some(index) = (0..n).find(|&i| !y[i].is_finite() || !z[i].is_finite()) {
            return Err(ContactError::NotFinite { what: what(), index, y: y[index], z: z[index] });
        }
        let rising = y[n - 1] > y[0];
        let order = |i: usize| if rising { i } else { n - 1 - i };
        let points: Vec<[f64; 2]> = (0..n).map(|i| [y[order(i)], z[order(i)]]).collect();
        if let Some(i) = (1..n).find(|&i| points[i][0] <= points[i - 1][0]) {
            return Err(ContactError::NotMonotone { what: what(), index: order(i), y: points[i][0] });
        }
        let width = points[n - 1][0] - points[0][0];
        if width > WIDTH[1] {
            return Err(ContactError::WrongUnits { what: what(), width });
        }
        if width < WIDTH[0] {
            let (what, remedy) = (format!("{}: width", what()), "give the whole profile, in metres".to_owned());
            return Err(ContactError::OutOfRange { what, value: width, least: WIDTH[0], most: WIDTH[1], remedy });
        }
        sampled(&points).map_err(|at| ContactError::NotMonotone { what: what(), index: order(at), y: points[at][0] })
    }
}

/// Samples the spline through `points` evenly; the index of a point near which it folds back, if it does.
fn sampled(points: &[[f64; 2]]) -> Result<Profile, usize> {
    let mut chord = vec![0.0];
    for p in points.windows(2) {
        chord.push(chord[chord.len() - 1] + (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
    }
    let column = |c: usize| points.iter().map(|p| p[c]).collect::<Vec<f64>>();
    let (y, z) = (column(0), column(1));
    let (bend_y, bend_z) = (bends(&chord, &y), bends(&chord, &z));
    let length = chord[chord.len() - 1];
    let count = (length / STEP).ceil() as usize;
    let mut profile = Profile { y: vec![], z: vec![], slope: vec![] };
    for i in 0..=count {
        let s = length * i as f64 / count as f64;
        let k = chord.partition_point(|&c| c <= s).clamp(1, chord.len() - 1) - 1;
        let ((y, dy), (z, dz)) = (read(&chord, &y, &bend_y, k, s), read(&chord, &z, &bend_z, k, s));
        if dy <= 0.0 || profile.y.last().is_some_and(|&before| y <= before) {
            return Err(k + 1);
        }
        profile.y.push(y);
        profile.z.push(z);
        profile.slope.push(dz / dy);
    }
    Ok(profile)
}

/// Second derivatives of the natural cubic spline through (x, f), by the Thomas algorithm.
fn bends(x: &[f64], f: &[f64]) -> Vec<f64> {
    let n = x.len();
    let (mut bend, mut upper) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let (h0, h1) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let right = 6.0 * ((f[i + 1] - f[i]) / h1 - (f[i] - f[i - 1]) / h0);
        let pivot = 2.0 * (h0 + h1) - h0 * upper[i - 1];
        upper[i] = h1 / pivot;
        bend[i] = (right - h0 * bend[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        bend[i] -= upper[i] * bend[i + 1];
    }
    bend
}

/// Value and slope of the spline in interval `k`.
fn read(x: &[f64], f: &[f64], bend: &[f64], k: usize, at: f64) -> (f64, f64) {
    let h = x[k + 1] - x[k];
    let (a, b) = ((x[k + 1] - at) / h, (at - x[k]) / h);
    let value = a * f[k] + b * f[k + 1] + ((a.powi(3) - a) * bend[k] + (b.powi(3) - b) * bend[k + 1]) * h * h / 6.0;
    let slope = (f[k + 1] - f[k]) / h + ((3.0 * b * b - 1.0) * bend[k + 1] - (3.0 * a * a - 1.0) * bend[k]) * h / 6.0;
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_profile_give_the_profile_back() {
        let wheel = Profile::s1002();
        // Every 0.4 mm along the arc, without the vertical flange back.
        let pick: Vec<usize> = (0..wheel.y.len()).filter(|&i| i % 8 == 0 && wheel.y[i] > -0.065).collect();
        let y: Vec<f64> = pick.iter().rev().map(|&i| wheel.y[i]).collect();
        let z: Vec<f64> = pick.iter().rev().map(|&i| wheel.z[i]).collect();
        let copy = Profile::from_points(&y, &z, "copy").unwrap();
        for i in 0..200 {
            let at = -0.06 + 5.9e-4 * f64::from(i);
            let ((z0, s0), (z1, s1)) = (wheel.at(at).unwrap(), copy.at(at).unwrap());
            assert!((z0 - z1).abs() < 1e-6 && (s0 - s1).abs() < 5e-3 * (1.0 + s0 * s0), "{at} {z0} {z1} {s0} {s1}");
        }
    }

    #[test]
    fn every_bad_input_is_refused_with_its_own_message() {
        let y: Vec<f64> = (0..50).map(|i| 2e-3 * f64::from(i)).collect();
        let z = vec![0.0; 50];
        let refused = |y: &[f64], z: &[f64]| Profile::from_points(y, z, "rail x").unwrap_err().to_string();
        assert!(refused(&y[..49], &z).contains("y has 49 and z has 50"));
        assert!(refused(&y[..5], &z[..5]).contains("5 points given"));
        let (mut twice, mut holed) = (y.clone(), z.clone());
        twice[7] = twice[6];
        holed[3] = f64::NAN;
        assert!(refused(&twice, &z).contains("point 7"));
        assert!(refused(&y, &holed).contains("point 3"));
        let millimetres: Vec<f64> = y.iter().map(|y| y * 1e3).collect();
        assert!(refused(&millimetres, &z).contains("millimetres were probably meant"));
        let narrow: Vec<f64> = y.iter().map(|y| y * 0.1).collect();
        assert!(refused(&narrow, &z).contains("rail x: width: 0.0098"));
    }
}
