//! Laws of what moves and steers a wheelset: motors, the transmission to one wheel, the steering actuator.
//! States in, rates and forces out; the integration and the reactions on the bodies are the engine's.

mod actuator;
mod dc;
mod field_oriented;
mod field_weakening;
mod induction;
mod resistance;
mod transmission;

pub use actuator::{Actuator, ActuatorState};
pub use dc::{DcField, DcMotor};
pub use field_oriented::{Excited, FieldOriented, FieldOrientedState};
pub use field_weakening::{FieldError, field_current, wheel_torque, wheel_torque_max};
pub use induction::{InductionMotor, InductionState};
pub use resistance::RunningResistance;
pub use transmission::{Transmission, TransmissionState};
