//! Laws of railway vehicle dynamics as pure functions of a scalar:
//! no model, no time stepping, no files, no names. SI units; x forward, y right, z down.

pub mod contact;
pub mod drives;
pub mod elements;
pub mod math;
pub mod scalar;
pub mod track;

pub use scalar::{Dual, Lanes, Mask, Scalar};
