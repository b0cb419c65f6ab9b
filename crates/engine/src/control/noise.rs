//! White Gaussian noise that repeats: every draw is made from a seed and the number of its sample alone.
//! So a run is the same again bit by bit, and one noise is the same whatever else a diagram has.

/// What SplitMix64 adds from draw to draw: 2^64 over the golden ratio, odd.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64 bits of which every bit of the argument moves every bit of the value with even odds: the output of
/// SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A draw of the standard normal distribution: mean 0, variance 1, independent from sample to sample and from seed to
/// seed. Two uniform numbers make one (Box and Muller, Ann. Math. Statist. 29, 1958).
pub fn normal(seed: u64, sample: i64) -> f64 {
    // seeds next to each other begin far apart
    let start = mix(seed.wrapping_add(GAMMA));
    let place = (sample as u64).wrapping_mul(2);
    // 53 bits, from 0 to just below 1
    let uniform =
        |i: u64| (mix(start.wrapping_add(GAMMA.wrapping_mul(place.wrapping_add(i)))) >> 11) as f64 * 2f64.powi(-53);
    (-2.0 * (1.0 - uniform(1)).ln()).sqrt() * (core::f64::consts::TAU * uniform(2)).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 100_000;

    fn draws(seed: u64) -> Vec<f64> {
        (0..COUNT as i64).map(|k| normal(seed, k)).collect()
    }

    /// Mean of the products, which is the correlation of two noises of variance one; its own spread is 1/sqrt(COUNT).
    fn correlation(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / a.len() as f64
    }

    const FOUR_SIGMA: f64 = 4.0 / 316.0;

    #[test]
    fn mean_variance_and_tails_are_those_of_the_normal_distribution() {
        let x = draws(7);
        let moment = |p: i32| x.iter().map(|x| x.powi(p)).sum::<f64>() / COUNT as f64;
        // spreads of the estimates: 1, sqrt(2), sqrt(15), sqrt(96) over sqrt(COUNT)
        assert!(moment(1).abs() < FOUR_SIGMA, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 1.5 * FOUR_SIGMA, "{}", moment(2));
        assert!(moment(3).abs() < 4.0 * FOUR_SIGMA, "{}", moment(3));
        assert!((moment(4) - 3.0).abs() < 10.0 * FOUR_SIGMA, "{}", moment(4));
        let beyond = x.iter().filter(|x| x.abs() > 2.0).count() as f64 / COUNT as f64;
        assert!((beyond - 0.0455).abs() < 0.003, "{beyond}");
    }

    #[test]
    fn it_is_white_and_every_seed_is_another_noise() {
        let x = draws(7);
        for lag in [1, 2, 3, 10, 1000] {
            let r = correlation(&x[lag..], &x[..COUNT - lag]);
            assert!(r.abs() < FOUR_SIGMA, "{lag}: {r}");
        }
        for other in [0, 6, 8, u64::MAX] {
            let r = correlation(&x, &draws(other));
            assert!(r.abs() < FOUR_SIGMA, "{other}: {r}");
        }
    }

    #[test]
    fn a_draw_depends_on_seed_and_sample_alone() {
        assert_eq!(normal(3, 41).to_bits(), normal(3, 41).to_bits());
        assert_ne!(normal(3, 41), normal(3, 42));
        assert_ne!(normal(3, 41), normal(4, 41));
        assert!((-5..5).all(|k| normal(0, k).is_finite()));
    }
}
