//! The whole field: a sum of primitives.
use crate::{Jet, Primitive, Real};
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
        self.sum(point.to_array())
    }

    /// The same in single precision: the arithmetic that pictures are made with.
    #[must_use]
    pub fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.sum(point)
    }

    /// Each term's value.
    #[must_use]
    pub fn weights(&self, point: DVec3) -> Vec<f64> {
        let point = point.to_array();
        self.primitives.iter().map(|p| p.value(point)).collect()
    }

    fn sum<R: Real>(&self, point: [R; 3]) -> Jet<R> {
        let zero = R::splat(0.0);
        let mut sum = Jet {
            value: zero,
            gradient: [zero; 3],
        };
        for primitive in &self.primitives {
            let term = primitive.jet(point);
            sum.value = sum.value + term.value;
            for (total, part) in sum.gradient.iter_mut().zip(term.gradient) {
                *total = *total + part;
            }
        }
        sum
    }
}
