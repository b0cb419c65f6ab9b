//! Time stepping: one fixed-step explicit scheme that takes linear first-order inner states exactly.

mod etdrk4;

pub use etdrk4::Etdrk4;
