//! Models far from their origin: files, whose numbers have 32 bits, hold them about one nearby.

use super::export::Export;
use crate::aabb::Aabb;
use glam::DVec3;

/// Largest coordinate, over the diagonal of the model's box, that needs no shift: rounding moves
/// vertices by less than 10⁻⁵ of the diagonal.
const FAR: f64 = 100.0;

/// Returns the place in a model, in millimetres, that is the origin of its files: 0 unless it is so
/// far from the model's own that numbers of 32 bits would spoil the shape; else the middle of its
/// box, in whole millimetres where these are numbers.
#[must_use]
pub fn shift_of(bounds: &Aabb, millimetres: f64) -> DVec3 {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    if bounds.is_empty() || largest <= FAR * bounds.size().length() {
        return DVec3::ZERO;
    }
    (bounds.center() * millimetres).round()
}

/// Returns a sentence that says how files are shifted; `None` if they are not.
#[must_use]
pub fn describe_shift(shift: DVec3) -> Option<String> {
    let DVec3 { x, y, z } = shift;
    (shift != DVec3::ZERO).then(|| {
        format!(
            "the model is so far from its origin that files could not hold its shape: their origin \
             is at {x} {y} {z} mm of the model's coordinates (the nodes of a GLB file move it back)"
        )
    })
}

impl Export {
    /// Returns the place of the files' origin in the meshes' coordinates, in millimetres:
    /// [`shift_of`] the box of all parts.
    #[must_use]
    pub fn shift(&self) -> DVec3 {
        let bounds = self.parts.iter().map(|part| part.mesh.bounds());
        let all = bounds.fold(Aabb::EMPTY, |all, own| all.union(&own));
        shift_of(&all, self.millimetres)
    }
}
