//! Long curves and tapered limbs, cut into pieces for the search for the surface.
//!
//! A convolution surface does not change when a bone is cut in two (superposition), but what is
//! known of a piece without evaluating it is sharper: a short one is nowhere near most rays, and
//! along it the width of a taper hardly varies.

use field::{Shaping, Skeleton, Taper};

/// The most pieces of one bone.
const MOST: usize = 16;
/// Length of a piece, in radii, about.
const LENGTH: f64 = 2.0;
/// Most factor by which radius and blobbiness vary along a piece, until there are [`MOST`] pieces.
const CHANGE: f64 = 1.25;

/// Most factor by which the radius of a limb varies that is evaluated at once
/// ([`Shaping::is_cone`]), and the most pieces of such a limb.
const CHANGE_OF_CONES: f64 = 2.0;
const MOST_CONES: usize = 4;

/// The pieces of a curve or of a tapered segment or arc, each with its part of the taper; any other
/// bone as it is.
#[must_use]
pub fn cut(skeleton: Skeleton, shaping: Shaping) -> Vec<(Skeleton, Shaping)> {
    if !skeleton.is_numeric() && !shaping.varies_along(&skeleton) {
        return vec![(skeleton, shaping)];
    }
    let count = pieces(&skeleton, &shaping);
    cut_into(&skeleton, shaping, count)
}

/// Cuts a segment into pieces no longer than a length, but not into more than `most`; or as [`cut`]
/// does, if that makes more.
#[must_use]
pub(crate) fn cut_short(
    skeleton: &Skeleton,
    shaping: Shaping,
    longest: f64,
    most: usize,
) -> Vec<(Skeleton, Shaping)> {
    let by_length = (skeleton.measure() / longest).ceil().min(most as f64) as usize;
    let by_taper = match shaping.varies_along(skeleton) {
        true => pieces(skeleton, &shaping),
        false => 1,
    };
    cut_into(skeleton, shaping, by_length.max(by_taper))
}

fn cut_into(skeleton: &Skeleton, shaping: Shaping, count: usize) -> Vec<(Skeleton, Shaping)> {
    let bones: Vec<Skeleton> = (0..count)
        .filter_map(|i| skeleton.part(share(i, count), share(i + 1, count)))
        .collect();
    // Tapers vary evenly with length, which the parameter of a curve does not.
    let lengths: Vec<f64> = bones.iter().map(Skeleton::measure).collect();
    let whole: f64 = lengths.iter().sum();
    let mut before = 0.0;
    bones
        .into_iter()
        .zip(lengths)
        .map(|(bone, length)| {
            let [start, end] = [before, before + length].map(|at| shaping.at(at / whole));
            before += length;
            let piece = Shaping {
                taper: shaping.taper.map(|_| Taper {
                    radius: end.radius,
                    blobbiness: end.blobbiness,
                }),
                ..start
            };
            (bone, piece)
        })
        .collect()
}

fn share(i: usize, count: usize) -> f64 {
    i as f64 / count as f64
}

/// Returns the number of pieces into which a bone is cut.
fn pieces(skeleton: &Skeleton, shaping: &Shaping) -> usize {
    let end = shaping.at(1.0);
    if shaping.is_cone(skeleton) {
        let ratio = shaping.radius / end.radius;
        let wanted = libm::log(ratio.max(1.0 / ratio)) / libm::log(CHANGE_OF_CONES);
        return (wanted.ceil() as usize).clamp(1, MOST_CONES);
    }
    let radius = 0.5 * (shaping.radius + end.radius);
    let by_length = skeleton.measure() / (LENGTH * radius);
    let [by_radius, by_blobbiness] = [
        shaping.radius / end.radius,
        shaping.blobbiness / end.blobbiness,
    ]
    .map(|ratio| libm::log(ratio.max(1.0 / ratio)) / libm::log(CHANGE));
    let wanted = by_length.max(by_radius.max(by_blobbiness));
    // A number that is no number, or infinite at a tip of radius 0, is taken for very many.
    if wanted < MOST as f64 {
        (wanted.ceil() as usize).max(1)
    } else {
        MOST
    }
}
