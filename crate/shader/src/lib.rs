//! The chart's formulas as WGSL.
//!
//! Every formula of `field` is generic over the type of number. `Recorded` is such a type, which
//! appends each operation to a list: run once through a cell of the chart it leaves straight-line
//! code, from which `write.rs` makes a function. So no formula is written twice.
//!
//! - Constants of an element are loads; a [`Layout`] gives their order.
//! - Conditions on constants are branches: the formula is run for each outcome.
//! - Loops stay loops, where the formula has them through `Real::add_over`: all steps are recorded
//!   and made one, in which they differ in records of constants or tables of numbers alone.
//! - Functions other than arithmetic are in `shaders/field/math.wgsl`.
//!
//! `cargo xtask shaders` writes `shaders/field/`; a test fails where the folder differs from it.
pub mod cells;
pub mod layout;
mod order;
mod recorded;
mod tape;
mod write;

pub use cells::Cell;
pub use layout::Layout;
