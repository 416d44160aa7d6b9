//! Samples of pixels, and the test whether a pixel needs more than one.
use glam::Vec3;

/// The result of one ray of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The colour, each channel within 0 … 1.
    pub colour: Vec3,
    /// Key of the surface and of the lights that reach it: differs across silhouettes and edges of
    /// shadows.
    pub key: u32,
    /// Distance of the hit; infinite for the background.
    pub depth: f32,
    /// The work done, see [`map`](crate::map).
    pub cost: f32,
}

impl Sample {
    /// A black sample, far away, in the place of one that has not been taken yet.
    pub const BLANK: Self = Self {
        colour: Vec3::ZERO,
        key: 0,
        depth: f32::INFINITY,
        cost: 0.0,
    };
}

/// Difference of colours, as a part of full brightness, from which steps are visible, about.
const VISIBLE: f32 = 4.0 / 255.0;

/// Whether the pixels of two neighbouring samples need further rays between them.
///
/// They do where a channel differs by more than its contrast times the sum of both values (the
/// contrast of Mitchell), or times one where the sum is larger; and, so that outlines are smooth
/// however weak their contrast, where the two see different things and the difference is visible.
/// `jump` is the difference of distance that neighbours on one surface stay below unless the
/// surface is seen edge-on.
#[must_use]
pub fn differ(a: &Sample, b: &Sample, contrast: Vec3, jump: f32) -> bool {
    let difference = (a.colour - b.colour).abs();
    let largest = difference.max_element();
    if largest <= VISIBLE {
        return false;
    }
    let allowed = contrast * (a.colour + b.colour).min(Vec3::ONE);
    // Two misses are at the same, infinite, distance.
    let apart = a.depth != b.depth && (a.depth - b.depth).abs() > jump;
    difference.cmpgt(allowed).any() || a.key != b.key || apart
}
