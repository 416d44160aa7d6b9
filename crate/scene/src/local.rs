//! Skeletons whose folds do not blend, as functions.

use crate::{Element, Function, Scene, limbs};
use field::local::{Limb, LocalError};
use field::{Local, Primitive};
use glam::DVec3;
use skeleton::Polyline;

/// Pieces of a skeleton within the reach of local convolution, at least, and the most pieces of a
/// segment.
const PIECES: f64 = 4.0;
const MOST_PIECES: usize = 64;

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

    /// The points and segments of an element's curves that are convolved locally, in the world's
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
        let ends = joints(polyline);
        let segments = self.segments_of(element, function, &flesh);
        let limbs = segments.zip(ends).map(|((skeleton, shaping), ends)| {
            let pieces = limbs::cut_short(&skeleton, shaping, reach / PIECES, MOST_PIECES);
            let pieces = pieces.into_iter().filter_map(|(skeleton, shaping)| {
                let length = skeleton.measure();
                Primitive::new(skeleton, &shaping, None).map(|primitive| (primitive, length))
            });
            Limb {
                ends,
                pieces: pieces.collect(),
            }
        });
        let limbs = limbs.collect();
        Some(Limbs {
            points,
            limbs,
            reach,
        })
    }
}

/// Input of [`Local::new`], which makes a local convolution from it.
#[derive(Clone, Debug)]
pub struct Limbs {
    /// Points of the skeleton.
    pub points: Vec<DVec3>,
    /// Segments between them.
    pub limbs: Vec<Limb>,
    /// The reach D.
    pub reach: f64,
}

/// Returns the ends of the segments of a polyline that have a length. Vertices between which there
/// is no length are one.
fn joints(polyline: &Polyline) -> Vec<[u32; 2]> {
    let mut same: Vec<u32> = (0..polyline.vertices.len() as u32).collect();
    for segment in polyline.segments.iter().filter(|s| s.length <= 0.0) {
        let [a, b] = segment.ends.map(|end| same[end]);
        let (first, other) = (a.min(b), a.max(b));
        same.iter_mut()
            .filter(|own| **own == other)
            .for_each(|own| *own = first);
    }
    let long = polyline.segments.iter().filter(|s| s.length > 0.0);
    long.map(|s| s.ends.map(|end| same[end])).collect()
}
