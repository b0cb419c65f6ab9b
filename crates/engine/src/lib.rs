//! From a spec to motion: `spec` -> `compile` -> `Model` -> `rates` (the page to read first) -> `simulate`.
//! Multibody words only: bodies, rotors, joints, elements, wheels, drives, blocks.

pub mod channels;
pub mod compile;
pub mod control;
pub mod energy;
pub mod equilibrium;
pub mod error;
pub mod excitation;
pub mod inputs;
pub mod integrate;
pub mod kinks;
pub mod linearise;
pub mod model;
pub mod motion;
pub mod newton_euler;
pub mod pass;
pub mod rates;
pub mod simulate;
pub mod spec;
pub mod steady;
pub mod stepper;
pub mod stiff;
pub mod suspension;
pub mod tables;
pub mod traction;
pub mod wheel_rail;
pub mod wiring;

pub use compile::{compile, named_profile, pair_geometry, prepare};
pub use error::{EngineError, Fault};
pub use linearise::{LinearControl, LinearModel, linearisable, linearise};
pub use model::Model;
pub use rates::rates;
pub use simulate::{Progress, TimeSeries, simulate};
pub use spec::Spec;
pub use steady::{Steady, steady};
pub use wiring::Wiring;
