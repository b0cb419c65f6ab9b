//! The track: its centre line at top of rail with curvature, cant and grade, and the friction of its rails.

mod adhesion;
mod alignment;
mod uniform;

pub use adhesion::{Adhesion, AdhesionError};
pub use alignment::{Alignment, AlignmentError, Segment, TrackFrame};
pub use uniform::UniformTrack;
