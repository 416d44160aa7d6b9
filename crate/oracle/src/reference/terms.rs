//! The terms of a field, and what they and all functions of the reference are evaluated to.
use super::pieces::{Magnitudes, Pieces};
use field::{Primitive, THRESHOLD};
use glam::DVec3;

/// Relative error of the terms of a field.
pub(super) const FIELD_ERROR: f64 = 1e-10;
/// Relative error of coordinates.
pub(super) const ULP: f64 = 4e-16;

/// The function less T at a point, its gradient, and bounds on their rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Evaluation {
    pub excess: f64,
    pub gradient: DVec3,
    /// Bound on the rounding of `excess`.
    pub noise: f64,
    /// Bound on the rounding of `gradient`.
    pub slope_noise: f64,
}

/// The terms of a field.
#[derive(Clone, Debug)]
pub(super) struct FieldTerms {
    pub primitives: Vec<Primitive>,
    pieces: Pieces,
}

impl FieldTerms {
    pub fn new(primitives: Vec<Primitive>) -> Self {
        Self {
            pieces: Pieces::new(&primitives),
            primitives,
        }
    }

    pub fn sample(&self, point: DVec3) -> Evaluation {
        let (mut excess, mut size) = (-THRESHOLD, THRESHOLD);
        let (mut gradient, mut steep) = (DVec3::ZERO, 0.0);
        for primitive in &self.primitives {
            let jet = primitive.jet(point.to_array());
            let slope = DVec3::from_array(jet.gradient);
            excess += jet.value;
            size += jet.value.abs();
            gradient += slope;
            steep += slope.length();
        }
        Evaluation {
            excess,
            gradient,
            noise: FIELD_ERROR * size + ULP * point.abs().max_element() * steep,
            slope_noise: 10.0 * FIELD_ERROR * steep,
        }
    }

    pub fn extent(&mut self, center: DVec3, radius: f64, along: Option<DVec3>) -> Magnitudes {
        self.pieces.extent(&self.primitives, center, radius, along)
    }
}
