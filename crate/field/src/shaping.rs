//! From the user's radius, blobbiness and strength to a kernel's width and height.
use crate::Kernel;
use serde::{Deserialize, Serialize};

/// How a blobbiness B is read (`blobscale`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum BlobScale {
    /// Blinn's dimensionless B: `s² = |B|/R²`.
    #[default]
    Relative,
    /// `s² = |B|`, as the published cowrie and seahorse need.
    Absolute,
}

/// What the user says of a soft primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaping {
    /// The kernel.
    pub kernel: Kernel,
    /// Radius in isolation R.
    pub radius: f64,
    /// Blobbiness B; only its magnitude counts.
    pub blobbiness: f64,
    /// How `blobbiness` is read.
    pub blob_scale: BlobScale,
    /// Multiplies the field.
    pub strength: f64,
    /// ε of the depth of influence: the primitive is ignored where its field is below ε·T.
    pub influence: f64,
}
