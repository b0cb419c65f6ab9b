//! Time stepping with fixed steps: explicit at speed, linearly implicit in blocks where creep is stiff; `stepper` chooses.

mod blocks;
mod etdrk4;
mod rosenbrock;

pub use blocks::Blocks;
pub use etdrk4::Etdrk4;
pub use rosenbrock::Rosenbrock;
