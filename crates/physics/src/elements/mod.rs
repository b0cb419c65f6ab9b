//! Laws of the suspension: one law a file, each a function of deflection and its rate.

mod bushing;
mod maxwell;
mod stop;

pub use bushing::Bushing;
pub use maxwell::{BlowOff, Maxwell};
pub use stop::{Stop, StopError};
