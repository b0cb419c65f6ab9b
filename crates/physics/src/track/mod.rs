//! The track: its centre line at top of rail, with curvature and cant.

mod alignment;
mod uniform;

pub use alignment::{Alignment, AlignmentError, Segment, TrackFrame};
pub use uniform::UniformTrack;
