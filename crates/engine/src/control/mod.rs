//! Sampled control as a block diagram: a plain spec goes in, measurements become commands once every sample time.
//! Railway words (strategy, gain schedule) stay in Python; here are only signals and blocks in execution order.
//!
//! ```
//! use klingel_engine::control::{ControlSpec, Controller};
//! let spec: ControlSpec = serde_json::from_str(r#"{
//!     "sample_time": 0.001, "measurements": ["body.speed"],
//!     "blocks": [{"kind": "sum", "name": "error", "terms": [{"signal": "body.speed", "gain": -1.0}], "bias": 30.0}],
//!     "commands": [{"target": "hold.force", "signal": "error"}]}"#).unwrap();
//! let mut controller = Controller::compile(&spec).unwrap();
//! controller.reset(&[30.0]).unwrap();
//! controller.step(&[29.5]).unwrap();
//! assert_eq!(controller.commands(), [0.5]);
//! ```

mod block;
mod compile;
mod controller;
mod diagram;
mod error;
mod external;
mod filter;
mod lookup;
mod noise;
mod spec;

pub use controller::Controller;
pub use diagram::{BlockKink, Diagram, Memory};
pub use error::ControlError;
pub use external::{External, Externals};
pub use spec::{BlockSpec, Command, ControlSpec, Edge, Interpolation, Parameter, Probe, Section, Term};
