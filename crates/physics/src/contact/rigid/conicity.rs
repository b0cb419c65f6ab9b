//! Equivalent conicity: the cone whose wheelset would swing with the same wavelength (EN 15302).
//! The lateral motion without slip is integrated over the rolling radius difference, whatever its shape.

use super::super::ContactError;
use super::RigidWheelset;
use core::f64::consts::PI;
use rayon::prelude::*;

/// Steps of shift at which the rolling radii are taken, m.
const STEP: f64 = 5e-5;
/// Largest amplitude, and how far the middle of the swing may lie from the middle of the track, m.
const AMPLITUDE: f64 = 0.015;
const OFFSET: f64 = 0.010;
/// Points of the integral over half a wave.
const POINTS: usize = 800;

impl RigidWheelset {
    /// Equivalent conicity (slope) at an `amplitude` (m) of the free lateral motion, integrated as EN 15302 has it.
    ///
    /// Rolling without slip turns the wheelset by its difference of rolling radii and carries its contacts along its yaw, so
    /// y'' = -(difference) / (e r0) with y the shift at rail level, the roll of the axle included, and e the distance of the
    /// tape circles. The conicity is that of the cone with the same wavelength. With unequal wheels the motion swings about
    /// the place where the wheelset runs straight; the amplitude is half the width of the swing. Zero where no difference or
    /// a negative one keeps the wheelset from swinging back: the wave is infinitely long.
    ///
    /// # Errors
    /// An amplitude that is not positive or above 15 mm; no rail below a wheel; wheels so unequal that the wheelset finds no
    /// place within 10 mm to run straight.
    pub fn equivalent_conicity(&self, amplitude: f64) -> Result<f64, ContactError> {
        Ok(self.equivalent_conicities(&[amplitude])?[0])
    }

    /// [`equivalent_conicity`](Self::equivalent_conicity) at many amplitudes (m), for the price of the largest one.
    ///
    /// # Errors
    /// As there, for the first amplitude that is refused.
    pub fn equivalent_conicities(&self, amplitudes: &[f64]) -> Result<Vec<f64>, ContactError> {
        if let Some(&value) = amplitudes.iter().find(|a| !(**a > 0.0 && **a <= AMPLITUDE)) {
            let (what, remedy) = ("amplitude".into(), "give it in metres such as 0.003".into());
            return Err(ContactError::OutOfRange { what, value, least: 0.0, most: AMPLITUDE, remedy });
        }
        let largest = amplitudes.iter().fold(0.0, |m: f64, &a| m.max(a));
        // Equal wheels swing about the middle of the track; only for unequal ones more of the way is needed.
        let mut offset = 0.0;
        while offset <= OFFSET {
            let slope = Slope::new(largest + offset, |y| Ok(self.at_rail_level(y)?.rolling_radius_difference()))?;
            if let Some(found) = amplitudes.iter().map(|&a| slope.conicity(a)).collect() {
                return Ok(found);
            }
            offset += 2e-3;
        }
        let value = self.rolling_radius_difference(0.0)?;
        let (what, remedy) = ("difference of the rolling radii".into(), "give wheels that are less unequal".into());
        Err(ContactError::OutOfRange { what, value, least: -OFFSET, most: OFFSET, remedy })
    }
}

/// The rolling radius difference over the shift, and its integral: the potential in which the wheelset swings.
struct Slope {
    least: f64,
    step: f64,
    difference: Vec<f64>,
    potential: Vec<f64>,
}

impl Slope {
    /// Samples `difference` from -`reach` to `reach`, m.
    fn new(reach: f64, difference: impl Fn(f64) -> Result<f64, ContactError> + Sync) -> Result<Self, ContactError> {
        let half = (reach / STEP).ceil().max(20.0) as usize;
        let step = reach / half as f64;
        let difference = (0..=2 * half)
            .into_par_iter()
            .map(|i| difference(step * (i as f64 - half as f64)))
            .collect::<Result<Vec<f64>, ContactError>>()?;
        // From the middle outwards, so that equal wheels give exactly equal halves.
        let mut potential = vec![0.0; 2 * half + 1];
        for k in 0..half {
            let area = |i: usize| 0.5 * step * (difference[i] + difference[i + 1]);
            potential[half + k + 1] = potential[half + k] + area(half + k);
            potential[half - k - 1] = potential[half - k] - area(half - k - 1);
        }
        Ok(Self { least: -reach, step, difference, potential })
    }

    /// The potential at `y`, exact for a difference that is linear between its samples.
    fn at(&self, y: f64) -> f64 {
        let place = (y - self.least) / self.step;
        let k = (place as usize).min(self.difference.len() - 2);
        let (t, d) = (place - k as f64, &self.difference);
        self.potential[k] + self.step * t * (d[k] + 0.5 * t * (d[k + 1] - d[k]))
    }

    /// The conicity of the swing that is `2 amplitude` wide; none if it does not fit into what was sampled.
    fn conicity(&self, amplitude: f64) -> Option<f64> {
        // The wheelset turns back at both ends, so the potentials there are equal. Seen from the middle of the swing:
        let uneven = |middle: f64| self.at(middle + amplitude) - self.at(middle - amplitude);
        let room = -self.least - amplitude;
        let (mut low, mut high) = (-room, room);
        // Equal wheels leave only rounding errors.
        let even = 1e-12 * self.potential.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
        if uneven(low) > even || uneven(high) < -even {
            return None;
        }
        let mut middle = 0.0;
        for _ in 0..100 {
            let here = uneven(middle);
            if here.abs() <= even {
                break;
            }
            *if here < 0.0 { &mut low } else { &mut high } = middle;
            middle = 0.5 * (low + high);
        }
        let top = self.at(middle + amplitude).max(self.at(middle - amplitude));
        // Half a wavelength with y = middle + amplitude sin(theta), in units of sqrt(e r0).
        let mut half_wave = 0.0;
        for i in 0..POINTS {
            let theta = PI * ((i as f64 + 0.5) / POINTS as f64 - 0.5);
            let speed2 = 2.0 * (top - self.at(middle + amplitude * theta.sin()));
            if speed2 <= 0.0 {
                return Some(0.0);
            }
            half_wave += amplitude * theta.cos() / speed2.sqrt() * PI / POINTS as f64;
        }
        Some(0.5 * (PI / half_wave).powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{PairGeometry, Profile};
    use super::*;

    fn pair(wheel: Profile, rail: Profile) -> PairGeometry {
        PairGeometry { wheel, rail, rail_inclination: 0.025, gauge: 1.435, flange_back: 1.36, radius: 0.46 }
    }

    fn swing(difference: impl Fn(f64) -> f64 + Sync, reach: f64, amplitude: f64) -> Option<f64> {
        Slope::new(reach, |y| Ok(difference(y))).unwrap().conicity(amplitude)
    }

    #[test]
    fn known_differences_have_their_known_conicities() {
        // A cone, a cone about a shifted middle, a step (quarter wave sqrt(2 A / d)), nothing, a difference that drives outwards.
        let gamma = swing(|y| 2.0 * 0.1 * y, 3e-3, 3e-3).unwrap();
        assert!((gamma - 0.1).abs() < 1e-6, "{gamma}");
        let shifted = swing(|y| 2.0 * 0.1 * (y - 1e-3), 5e-3, 3e-3).unwrap();
        assert!((shifted - 0.1).abs() < 1e-6, "{shifted}");
        let step = swing(|y| 1e-3 * if y == 0.0 { 0.0 } else { y.signum() }, 3e-3, 3e-3).unwrap();
        assert!((step / (PI * PI / 16.0 / 3.0) - 1.0).abs() < 5e-3, "{step}");
        assert_eq!(swing(|_| 0.0, 3e-3, 3e-3), Some(0.0));
        assert_eq!(swing(|y| -0.1 * y, 3e-3, 3e-3), Some(0.0));
        assert_eq!(swing(|y| 0.2 * (y - 5e-3), 3e-3, 3e-3), None);
    }

    #[test]
    fn a_cone_on_round_rails_has_its_slope_and_that_of_its_roll() {
        // The roll -slope y / b0 carries the contact R times that further along a rail of radius R = 0.3 m.
        let cone = RigidWheelset::new(&pair(Profile::cone(0.05).unwrap(), Profile::rail_60e1())).unwrap();
        let expected = 0.05 * (1.0 + 0.3 * 0.05 / 0.75);
        for conicity in cone.equivalent_conicities(&[1e-3, 3e-3, 5e-3]).unwrap() {
            assert!((conicity - expected).abs() < 3e-4, "{conicity}");
        }
    }

    #[test]
    fn standard_pairs_have_the_conicity_of_a_second_program() {
        // Amplitudes 2, 3, 4 mm; computed with another contact search and another integral, linear between the steps.
        for (rail, expected) in
            [(Profile::rail_60e1(), [0.2188, 0.1749, 0.1557]), (Profile::rail_uic60(), [0.2270, 0.1806, 0.1616])]
        {
            let rigid = RigidWheelset::new(&pair(Profile::s1002(), rail)).unwrap();
            let found = rigid.equivalent_conicities(&[2e-3, 3e-3, 4e-3]).unwrap();
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1.5e-3, "{found} {expected}");
            }
        }
    }

    #[test]
    fn unequal_wheels_swing_about_another_middle_and_mirror() {
        let right = pair(Profile::s1002(), Profile::rail_60e1());
        let left = PairGeometry { radius: 0.459, wheel: Profile::cone(0.05).unwrap(), ..right.clone() };
        let one = RigidWheelset::of_wheels(&left, &right).unwrap().equivalent_conicities(&[1e-3, 3e-3]).unwrap();
        let other = RigidWheelset::of_wheels(&right, &left).unwrap().equivalent_conicities(&[1e-3, 3e-3]).unwrap();
        for (one, other) in one.into_iter().zip(other) {
            assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
        }
        let same = RigidWheelset::of_wheels(&right, &right).unwrap().equivalent_conicity(3e-3).unwrap();
        assert_eq!(same, RigidWheelset::new(&right).unwrap().equivalent_conicity(3e-3).unwrap());
    }

    #[test]
    fn what_cannot_swing_is_refused() {
        let right = pair(Profile::s1002(), Profile::rail_60e1());
        let wheelset = RigidWheelset::new(&right).unwrap();
        for amplitude in [0.0, -1e-3, 3.0, f64::NAN] {
            assert!(wheelset.equivalent_conicity(amplitude).unwrap_err().to_string().contains("such as 0.003"));
        }
        let wide = PairGeometry { gauge: 1.45, ..right.clone() };
        assert!(RigidWheelset::of_wheels(&wide, &right).unwrap_err().to_string().contains("gauge of the left side"));
    }
}
