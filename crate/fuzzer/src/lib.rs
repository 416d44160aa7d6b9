//! Random texts of the dataset language, and what must hold for each of them: for tests, for the
//! program of this crate, and for the targets of cargo-fuzz in `fuzz/`.

pub mod check;
pub mod generate;
