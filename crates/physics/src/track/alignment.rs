//! Plan alignment with cant: straights, circular arcs and clothoids with linear cant ramps.
//! The cant turns the track about the centre line at top of rail, so that line stays in the horizontal plane; a grade
//! tilts gravity against it and leaves its vertical curvature out.

use crate::Scalar;
use crate::math::{Rotation, Vec3};
use thiserror::Error;

/// A piece in which curvature \[1/m\], cant \[m\] and grade \[-\] run linearly from the first to the second value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub length: f64,
    pub curvature: [f64; 2],
    pub cant: [f64; 2],
    pub grade: [f64; 2],
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum AlignmentError {
    #[error("the track has no segment; give at least one")]
    Empty,
    #[error("track segment {index}: length {length} m must be positive and finite")]
    Length { index: usize, length: f64 },
    #[error("track segment {index}: {what} {value} is beyond {limit} ({unit}); this is no railway curve")]
    Range { index: usize, what: &'static str, value: f64, limit: f64, unit: &'static str },
}

/// A point of the centre line: quintic Hermite data, at most `SPACING` apart.
#[derive(Clone, Copy, Debug)]
struct Node {
    x: f64,
    y: f64,
    /// Tangent and curvature there.
    sin: f64,
    cos: f64,
    curvature: f64,
}

#[derive(Clone, Debug)]
struct Piece {
    start: f64,
    segment: Segment,
    heading: f64,
    nodes: Vec<Node>,
    spacing: f64,
}

/// Distance of the interpolation nodes \[m\]; at R = 150 m the quintic is then exact to 1e-14 m.
const SPACING: f64 = 2.0;

/// The compiled centre line.
#[derive(Clone, Debug)]
pub struct Alignment {
    pieces: Vec<Piece>,
    cant_base: f64,
    length: f64,
}

/// The track frame at one arc length: T in world W. World: x and y horizontal, z down.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackFrame<S> {
    /// Origin in the world \[m\] (z = 0).
    pub x: S,
    pub y: S,
    /// Of the tangent, positive to the right \[rad\].
    pub heading: S,
    /// \[1/m\], positive in a right-hand curve.
    pub curvature: S,
    /// Roll of the track plane, positive where the right rail is lower \[rad\].
    pub cant_angle: S,
    /// Its derivative along the arc \[rad/m\].
    pub twist: S,
    /// Rise over way, positive uphill \[-\]: tangent of the angle between the track and the level.
    pub grade: S,
}

impl<S: Scalar> TrackFrame<S> {
    /// R_WT: resolves in the world what was resolved in the track frame.
    pub fn rotation(&self) -> Rotation<S> {
        Rotation::yaw_roll(self.heading, self.cant_angle)
    }
    /// Turn of the frame per metre of arc, resolved in the frame \[rad/m\]: (phi', rho sin phi, rho cos phi).
    pub fn turn(&self) -> Vec3<S> {
        let (s, c) = self.cant_angle.sin_cos();
        Vec3::new(self.twist, self.curvature * s, self.curvature * c)
    }
    /// Gravity of size one as it acts along the track and at right angles to the plane of its centre line:
    /// (-sin, cos) of the angle that the grade is the tangent of.
    pub fn gravity(&self) -> (S, S) {
        let across = (self.grade.square() + 1.0).sqrt().recip();
        (-(self.grade * across), across)
    }
}

impl Alignment {
    /// Compiles the segments; `cant_base` is the lateral distance over which cant is measured \[m\].
    ///
    /// ```
    /// use klingel_physics::track::{Alignment, Segment};
    /// let arc = Segment { length: 100.0, curvature: [0.01; 2], cant: [0.0; 2], grade: [0.0; 2] };
    /// let frame = Alignment::new(&[arc], 1.5).unwrap().at(100.0_f64);
    /// assert!((frame.x - 100.0 * 1.0_f64.sin()).abs() < 1e-12 && (frame.heading - 1.0).abs() < 1e-15);
    /// ```
    pub fn new(segments: &[Segment], cant_base: f64) -> Result<Self, AlignmentError> {
        if segments.is_empty() {
            return Err(AlignmentError::Empty);
        }
        let (mut pieces, mut start, mut heading, mut at) = (Vec::new(), 0.0, 0.0, (0.0, 0.0));
        for (index, &segment) in segments.iter().enumerate() {
            let length = segment.length;
            if !(length > 0.0 && length.is_finite()) {
                return Err(AlignmentError::Length { index, length });
            }
            for value in segment.curvature {
                in_range(index, "curvature", value, 0.02, "1/m")?;
            }
            for value in segment.cant {
                in_range(index, "cant", value, 0.3, "m")?;
            }
            for value in segment.grade {
                in_range(index, "grade", value, 0.1, "-")?;
            }
            let count = (length / SPACING).ceil().max(1.0);
            let spacing = length / count;
            let mut piece = Piece { start, segment, heading, nodes: Vec::new(), spacing };
            piece.nodes.push(piece.node(at, 0.0));
            for i in 0..count as usize {
                let (dx, dy) = piece.chord(i as f64 * spacing, spacing);
                at = (at.0 + dx, at.1 + dy);
                piece.nodes.push(piece.node(at, (i + 1) as f64 * spacing));
            }
            heading = piece.heading_at(length);
            start += length;
            pieces.push(piece);
        }
        Ok(Self { pieces, cant_base, length: start })
    }

    /// \[m\]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Whether any piece has a grade.
    pub fn climbs(&self) -> bool {
        self.pieces.iter().any(|p| p.segment.grade != [0.0; 2])
    }

    /// The frame at arc length `s`; beyond the ends the centre line goes on straight, with the last cant and grade.
    pub fn at<S: Scalar>(&self, s: S) -> TrackFrame<S> {
        let [x, y, heading, curvature, cant_angle, twist, grade] = S::lift_n([s], |[s]| self.evaluate(s));
        TrackFrame { x, y, heading, curvature, cant_angle, twist, grade }
    }

    /// Values and derivatives of (x, y, heading, curvature, cant angle, twist, grade).
    fn evaluate(&self, s: f64) -> ([f64; 7], [[f64; 1]; 7]) {
        if s < 0.0 || s > self.length {
            return self.beyond(s);
        }
        let i = self.pieces.iter().rposition(|p| s >= p.start).unwrap_or(0);
        let p = &self.pieces[i];
        let u = s - p.start;
        let Segment { length, curvature: [k0, k1], cant: [h0, h1], grade: [g0, g1] } = p.segment;
        let [dk, dh, dg] = [k1 - k0, h1 - h0, g1 - g0].map(|change| change / length);
        let heading = p.heading_at(u);
        let (curvature, h) = (k0 + dk * u, (h0 + dh * u) / self.cant_base);
        let cos_cant = (1.0 - h * h).sqrt();
        let twist = dh / self.cant_base / cos_cant;
        let (x, y) = p.position(u);
        let (sin, cos) = heading.sin_cos();
        (
            [x, y, heading, curvature, h.asin(), twist, g0 + dg * u],
            [[cos], [sin], [curvature], [dk], [twist], [twist * twist * h / cos_cant], [dg]],
        )
    }

    fn beyond(&self, s: f64) -> ([f64; 7], [[f64; 1]; 7]) {
        let end = s.clamp(0.0, self.length);
        let ([x, y, heading, _, cant, _, grade], _) = self.evaluate(end);
        let ((sin, cos), ds) = (heading.sin_cos(), s - end);
        let values = [x + cos * ds, y + sin * ds, heading, 0.0, cant, 0.0, grade];
        (values, [[cos], [sin], [0.0], [0.0], [0.0], [0.0], [0.0]])
    }
}

fn in_range(
    index: usize,
    what: &'static str,
    value: f64,
    limit: f64,
    unit: &'static str,
) -> Result<(), AlignmentError> {
    if value.abs() <= limit { Ok(()) } else { Err(AlignmentError::Range { index, what, value, limit, unit }) }
}

impl Piece {
    fn heading_at(&self, u: f64) -> f64 {
        let [k0, k1] = self.segment.curvature;
        self.heading + k0 * u + 0.5 * (k1 - k0) / self.segment.length * u * u
    }

    fn node(&self, (x, y): (f64, f64), u: f64) -> Node {
        let (sin, cos) = self.heading_at(u).sin_cos();
        Node { x, y, sin, cos, curvature: self.curvature_at(u) }
    }

    fn curvature_at(&self, u: f64) -> f64 {
        let [k0, k1] = self.segment.curvature;
        k0 + (k1 - k0) / self.segment.length * u
    }

    /// Integral of (cos, sin) of the heading over \[u, u + h\] by five-point Gauss-Legendre.
    fn chord(&self, u: f64, h: f64) -> (f64, f64) {
        const POINT: [f64; 3] = [0.0, 0.538_469_310_105_683, 0.906_179_845_938_664];
        const WEIGHT: [f64; 3] = [0.568_888_888_888_889, 0.478_628_670_499_366_5, 0.236_926_885_056_189_1];
        let (mut x, mut y) = (0.0, 0.0);
        for i in 0..3 {
            for sign in if i == 0 { &[1.0][..] } else { &[-1.0, 1.0][..] } {
                let (s, c) = self.heading_at(u + 0.5 * h * (1.0 + sign * POINT[i])).sin_cos();
                x += 0.5 * h * WEIGHT[i] * c;
                y += 0.5 * h * WEIGHT[i] * s;
            }
        }
        (x, y)
    }

    /// Quintic Hermite interpolation: position, tangent and curvature vector agree at the nodes.
    fn position(&self, u: f64) -> (f64, f64) {
        let h = self.spacing;
        let i = ((u / h) as usize).min(self.nodes.len() - 2);
        let t = u / h - i as f64;
        let (a, b) = (self.nodes[i], self.nodes[i + 1]);
        let blend = |p0: f64, v0: f64, w0: f64, p1: f64, v1: f64, w1: f64| {
            let (t2, t3) = (t * t, t * t * t);
            let (t4, t5) = (t2 * t2, t2 * t3);
            // written about p0 so that no large coordinates cancel
            p0 + (p1 - p0) * (10.0 * t3 - 15.0 * t4 + 6.0 * t5)
                + h * v0 * (t - 6.0 * t3 + 8.0 * t4 - 3.0 * t5)
                + h * v1 * (-4.0 * t3 + 7.0 * t4 - 3.0 * t5)
                + h * h * w0 * 0.5 * (t2 - 3.0 * t3 + 3.0 * t4 - t5)
                + h * h * w1 * 0.5 * (t3 - 2.0 * t4 + t5)
        };
        (
            blend(a.x, a.cos, -a.curvature * a.sin, b.x, b.cos, -b.curvature * b.sin),
            blend(a.y, a.sin, a.curvature * a.cos, b.y, b.sin, b.curvature * b.cos),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    fn curve(sign: f64) -> Alignment {
        let (r, h) = (sign / 300.0, sign * 0.16);
        Alignment::new(
            &[
                Segment { length: 90.0, curvature: [0.0; 2], cant: [0.0; 2], grade: [0.0; 2] },
                Segment { length: 120.0, curvature: [0.0, r], cant: [0.0, h], grade: [0.0, 0.02] },
                Segment { length: 180.0, curvature: [r; 2], cant: [h; 2], grade: [0.02; 2] },
            ],
            1.5,
        )
        .unwrap()
    }

    #[test]
    fn circle_closes_on_its_exact_points() {
        let arc = Alignment::new(
            &[Segment { length: 900.0, curvature: [1.0 / 300.0; 2], cant: [0.0; 2], grade: [0.0; 2] }],
            1.5,
        )
        .unwrap();
        for s in [0.3, 1.7, 333.3, 899.9] {
            let f = arc.at(s);
            let (sin, cos) = (s / 300.0_f64).sin_cos();
            assert!((f.x - 300.0 * sin).abs() < 1e-11 && (f.y - 300.0 * (1.0 - cos)).abs() < 1e-11);
        }
    }

    #[test]
    fn dual_slopes_are_difference_quotients_and_the_frame_turns_as_it_says() {
        let track = curve(1.0);
        for s in [45.0, 150.0, 250.0] {
            let d = track.at(Dual::<1>::variable(s, 0));
            let h = 1e-4;
            let (a, b) = (track.at(s - h), track.at(s + h));
            for (slope, lo, hi) in [
                (d.x, a.x, b.x),
                (d.y, a.y, b.y),
                (d.heading, a.heading, b.heading),
                (d.curvature, a.curvature, b.curvature),
                (d.cant_angle, a.cant_angle, b.cant_angle),
                (d.twist, a.twist, b.twist),
                (d.grade, a.grade, b.grade),
            ] {
                assert!((slope.slope[0] - (hi - lo) / (2.0 * h)).abs() < 1e-9);
            }
            // R' = R turn~ : the frame's columns move with its own turn
            let (ra, rb, turn) = (a.rotation(), b.rotation(), track.at(s).turn());
            for e in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::constant) {
                let moved = (rb.apply(e) - ra.apply(e)) * (0.5 / h);
                let expected = track.at(s).rotation().apply(turn.cross(e));
                assert!((moved - expected).norm() < 1e-8);
            }
        }
    }

    #[test]
    fn a_left_curve_is_the_mirror_image_of_a_right_curve() {
        let (right, left) = (curve(1.0), curve(-1.0));
        for s in [30.0, 133.0, 222.0, 388.0] {
            let (r, l) = (right.at(s), left.at(s));
            assert_eq!((r.x, r.y, r.heading, r.cant_angle), (l.x, -l.y, -l.heading, -l.cant_angle));
        }
    }

    #[test]
    fn bad_segments_are_named() {
        let bad = Segment { length: -1.0, curvature: [0.0; 2], cant: [0.0; 2], grade: [0.0; 2] };
        assert_eq!(Alignment::new(&[bad], 1.5).unwrap_err(), AlignmentError::Length { index: 0, length: -1.0 });
        let tight = Segment { length: 10.0, curvature: [0.1; 2], cant: [0.0; 2], grade: [0.0; 2] };
        assert!(Alignment::new(&[tight], 1.5).unwrap_err().to_string().contains("curvature 0.1"));
        let steep = Segment { length: 10.0, curvature: [0.0; 2], cant: [0.0; 2], grade: [0.0, 0.2] };
        assert!(Alignment::new(&[steep], 1.5).unwrap_err().to_string().contains("grade 0.2"));
    }

    #[test]
    fn a_grade_turns_gravity_and_keeps_its_size() {
        let track = curve(1.0);
        let (along, across) = track.at(250.0).gravity();
        assert!((along / across + 0.02).abs() < 1e-15 && (along * along + across * across - 1.0).abs() < 1e-15);
        assert_eq!(track.at(10.0).gravity(), (0.0, 1.0));
    }
}
