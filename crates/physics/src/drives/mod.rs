//! Laws of what moves and steers a wheelset: the traction drive of one wheel and the steering actuator.
//! States in, rates and forces out; the integration and the reactions on the bodies are the engine's.

mod actuator;
mod field;
mod motor;
mod resistance;

pub use actuator::{Actuator, ActuatorState};
pub use field::{FieldError, field_current, wheel_torque, wheel_torque_max};
pub use motor::{Drive, DriveState};
pub use resistance::RunningResistance;
