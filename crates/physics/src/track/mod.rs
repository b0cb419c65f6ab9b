//! The track: its centre line at top of rail, with curvature and cant.

mod alignment;

pub use alignment::{Alignment, AlignmentError, Segment, TrackFrame};
