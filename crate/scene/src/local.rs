//! Skeletons whose folds do not blend, as functions.

use crate::{Element, Function, Scene, limbs};
use field::local::{Limb, LimbPiece, LocalError};
use field::{Local, Primitive, Shaping, Skeleton};
use glam::DVec3;
use skeleton::Polyline;

/// Pieces of a skeleton within the reach of local convolution, at least, and the most into which a
/// segment is cut.
const PIECES: f64 = 4.0;
const MOST_PIECES: usize = 64;
/// Pieces of a chain of segments, at least, if it has as many.
const LEAST_PIECES: f64 = 4.0;

impl Scene {
    /// The local convolution of an element's curves, in the world's coordinates; `None` if the
    /// element is no such skeleton.
    ///
    /// # Errors
    /// If there is no such function.
    #[must_use]
    pub fn local(
        &self,
        element: &Element,
        function: &Function,
    ) -> Option<Result<Local, LocalError>> {
        let limbs = self.limbs(element, function)?;
        Some(Local::new(&limbs.points, &limbs.limbs, limbs.reach))
    }

    /// The points and limbs of an element's curves that are convolved locally, in the world's
    /// coordinates, and their reach; `None` if the element is no such skeleton.
    #[must_use]
    pub fn limbs(&self, element: &Element, function: &Function) -> Option<Limbs> {
        let curves = function.curves()?;
        let reach = curves.local? * function.growth();
        let flesh = self.flesh_in_world(element)?;
        let polyline = curves.polyline()?;
        let points = (polyline.vertices.iter())
            .map(|v| function.to_world.transform_point3(v.position))
            .collect();
        let longest = reach / PIECES;
        let mut segments = self.segments_of(element, function, &flesh);
        let limbs = chains(polyline).into_iter().map(|Chain { ends, count }| {
            let bones = segments.by_ref().take(count);
            let bones = bones.flat_map(|(skeleton, shaping)| {
                limbs::cut_short(&skeleton, shaping, longest, MOST_PIECES)
            });
            let pieces = join(bones.collect(), longest);
            Limb { ends, pieces }
        });
        let limbs = limbs.collect();
        Some(Limbs {
            points,
            limbs,
            reach,
        })
    }
}

/// Joins short bones of a chain to pieces that are no longer than a length, than their radius or
/// than a fourth of the chain: so a refined curve has about as many pieces as a coarse one.
fn join(bones: Vec<(Skeleton, Shaping)>, longest: f64) -> Vec<LimbPiece> {
    let lengths: Vec<f64> = bones.iter().map(|(bone, _)| bone.measure()).collect();
    let longest = longest.min(lengths.iter().sum::<f64>() / LEAST_PIECES);
    let mut pieces: Vec<LimbPiece> = Vec::new();
    for ((bone, shaping), length) in bones.into_iter().zip(lengths) {
        let radius = 0.5 * (shaping.radius + shaping.at(1.0).radius);
        let Some(primitive) = Primitive::new(bone, &shaping, None) else {
            continue;
        };
        let open = pieces
            .last_mut()
            .filter(|piece| piece.length + length <= longest.min(radius));
        match open {
            Some(piece) => {
                piece.primitives.push(primitive);
                let before = piece.length;
                piece.length += length;
                piece.radius = (piece.radius * before + radius * length) / piece.length;
            }
            None => pieces.push(LimbPiece {
                primitives: vec![primitive],
                length,
                radius,
            }),
        }
    }
    pieces
}

/// Input of [`Local::new`], which makes a local convolution from it.
#[derive(Clone, Debug)]
pub struct Limbs {
    /// Points of the skeleton.
    pub points: Vec<DVec3>,
    /// Limbs between them.
    pub limbs: Vec<Limb>,
    /// The reach D.
    pub reach: f64,
}

/// Segments one after the other, between which nothing branches.
struct Chain {
    /// The points at its ends.
    ends: [u32; 2],
    /// The number of segments.
    count: usize,
}

/// Returns the chains of the segments of a polyline that have a length, in their order. Vertices
/// between which there is no length are one.
fn chains(polyline: &Polyline) -> Vec<Chain> {
    let mut same: Vec<u32> = (0..polyline.vertices.len() as u32).collect();
    for segment in polyline.segments.iter().filter(|s| s.length <= 0.0) {
        let [a, b] = segment.ends.map(|end| same[end]);
        let (first, other) = (a.min(b), a.max(b));
        same.iter_mut()
            .filter(|own| **own == other)
            .for_each(|own| *own = first);
    }
    let long = polyline.segments.iter().filter(|s| s.length > 0.0);
    let long: Vec<[u32; 2]> = long.map(|s| s.ends.map(|end| same[end])).collect();
    let mut around = vec![0u32; same.len()];
    for end in long.iter().flatten() {
        around[*end as usize] += 1;
    }
    let mut chains: Vec<Chain> = Vec::new();
    for [start, end] in long {
        let before = chains.last_mut().filter(|chain| chain.ends[1] == start);
        match before.filter(|_| around[start as usize] == 2) {
            Some(chain) => {
                chain.ends[1] = end;
                chain.count += 1;
            }
            None => chains.push(Chain {
                ends: [start, end],
                count: 1,
            }),
        }
    }
    chains
}
