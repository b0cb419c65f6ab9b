//! A track of the same curvature and cant everywhere: steady curving is a relative equilibrium on it.
//! Frames are told by how far they are ahead of a place that travels with the vehicle, so that nothing grows with time.

use super::TrackFrame;
use crate::Scalar;

/// Endless track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformTrack<S> {
    /// \[1/m\], positive in a right-hand curve.
    pub curvature: S,
    /// \[m\], positive where the left rail is higher.
    pub cant: S,
    /// Lateral distance over which cant is measured \[m\].
    pub cant_base: f64,
}

/// Terms of the series below; with |curvature x distance| up to 1 the first one left out is below 1e-16.
const TERMS: i32 = 9;

impl<S: Scalar> UniformTrack<S> {
    /// The frame at `ahead` \[m\] of the place where the world frame lies: x = sin(t)/rho, y = (1 - cos t)/rho with
    /// t = rho ahead, by series that do not mind a straight.
    ///
    /// ```
    /// use klingel_physics::track::UniformTrack;
    /// let frame = UniformTrack { curvature: 0.01, cant: 0.15, cant_base: 1.5 }.at(20.0);
    /// assert!((frame.x - 100.0 * 0.2_f64.sin()).abs() < 1e-13);
    /// assert!((frame.cant_angle - 0.1_f64.asin()).abs() < 1e-15);
    /// ```
    pub fn at(&self, ahead: S) -> TrackFrame<S> {
        let heading = self.curvature * ahead;
        let square = heading.square();
        let (mut sinc, mut cosc) = (S::zero(), S::zero());
        for k in (0..TERMS).rev() {
            // 1 - t^2/(2 3) (1 - t^2/(4 5) (...)) and the same with one higher
            let n = f64::from(2 * k);
            sinc = S::one() - square * sinc / ((n + 2.0) * (n + 3.0));
            cosc = S::one() - square * cosc / ((n + 3.0) * (n + 4.0));
        }
        let slope = self.cant / self.cant_base;
        TrackFrame {
            x: ahead * sinc,
            y: ahead * heading * cosc * 0.5,
            heading,
            curvature: self.curvature,
            cant_angle: slope.lift(|h| (h.asin(), 1.0 / (1.0 - h * h).sqrt())),
            twist: S::zero(),
            grade: S::zero(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::{Alignment, Segment};

    #[test]
    fn it_is_the_arc_of_an_alignment() {
        let (rho, cant) = (-1.0 / 300.0, -0.16);
        let arc = Segment { length: 60.0, curvature: [rho; 2], cant: [cant; 2], grade: [0.0; 2] };
        let alignment = Alignment::new(&[arc], 1.5).unwrap();
        for ahead in [0.0, 7.3, 55.0] {
            let (a, b) = (alignment.at(ahead), UniformTrack { curvature: rho, cant, cant_base: 1.5 }.at(ahead));
            for (a, b) in [(a.x, b.x), (a.y, b.y), (a.heading, b.heading), (a.cant_angle, b.cant_angle)] {
                assert!((a - b).abs() < 1e-12, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_straight_is_no_exception() {
        let frame = UniformTrack { curvature: 0.0, cant: 0.0, cant_base: 1.5 }.at(-12.0);
        assert_eq!((frame.x, frame.y, frame.heading, frame.cant_angle), (-12.0, 0.0, 0.0, 0.0));
    }
}
