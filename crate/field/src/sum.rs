//! The whole field: a sum of primitives.
use crate::{Jet, Primitive};
use glam::DVec3;

/// F(r) = Σ fᵢ(r).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// The terms.
    pub primitives: Vec<Primitive>,
}

impl Field {
    /// Value and gradient, in double precision, of all terms (nothing is cut off).
    #[must_use]
    pub fn jet(&self, point: DVec3) -> Jet<f64> {
        let _ = point;
        todo!()
    }
}
