//! The engine against closed forms: bodies, rotors, joints, wheels and tracks whose motion is known exactly.
//! Whole vehicles are tested in `tests/physics` through the Python package.

mod accounts;
mod along_track;
mod bogie;
mod common;
mod drives;
mod energy;
mod flange;
mod frames;
mod gyroscope;
mod hunting;
mod limits;
mod linear;
mod sampling;
mod scalars;
mod wheelset;
