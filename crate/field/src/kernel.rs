//! Kernels h(r).
use serde::{Deserialize, Serialize};

/// A kernel: a function of distance with h(0) = 1 that falls to 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Kernel {
    /// `1/(1+s²r²)²` (thesis, section 2.3.1; after Sherstyuk).
    #[default]
    Cauchy,
}
