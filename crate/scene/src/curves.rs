//! Skeletons of subdivision curves, as soft elements.

use crate::Shape;
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use skeleton::{Polyline, Scheme, Skeleton};
use std::sync::OnceLock;

/// The blobbiness of curves whose material has none.
pub const BLOBBINESS: f64 = 2.0;

/// Flat ends of a skeleton that count.
pub const MOST_FLAT: usize = 256;

/// Curves on a graph of nodes, refined to a level. Their polyline's segments are convolved, each
/// with radii that vary evenly along it.
///
/// Positions and radii are in coordinates of the element's own
/// ([`Function::to_world`](crate::Function)).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Curves {
    /// Nodes and control polygons.
    pub skeleton: Skeleton,
    /// Rule by which the curves are refined.
    pub scheme: Scheme,
    /// Levels of subdivision.
    pub levels: u32,
    /// Arc length within which the skeleton counts at a point, if not all of it does.
    pub local: Option<f64>,
    /// Nodes at free ends where the surface ends in a plane, unless convolution is local.
    pub flat: Vec<u32>,
    /// The refined curves, made at first use.
    #[serde(skip)]
    polyline: OnceLock<Option<Polyline>>,
}

impl PartialEq for Curves {
    fn eq(&self, other: &Self) -> bool {
        self.skeleton == other.skeleton
            && (self.scheme, self.levels, self.local) == (other.scheme, other.levels, other.local)
            && self.flat == other.flat
    }
}

impl Curves {
    /// The curves of a skeleton, refined some times.
    ///
    /// # Errors
    /// If the skeleton has no polyline.
    pub fn new(skeleton: Skeleton, scheme: Scheme, levels: u32) -> Result<Self, skeleton::Error> {
        let polyline = skeleton.polyline(scheme, levels)?;
        Ok(Self {
            skeleton,
            scheme,
            levels,
            local: None,
            flat: Vec::new(),
            polyline: OnceLock::from(Some(polyline)),
        })
    }

    /// Returns the curves with their nodes at other places.
    ///
    /// # Errors
    /// If places are not usable.
    pub fn moved(&self, places: &[DVec3]) -> Result<Self, skeleton::Error> {
        let mut skeleton = self.skeleton.clone();
        for (node, place) in skeleton.nodes.iter_mut().zip(places) {
            node.position = *place;
        }
        let polyline = skeleton.polyline(self.scheme, self.levels)?;
        Ok(Self {
            skeleton,
            polyline: OnceLock::from(Some(polyline)),
            ..self.clone()
        })
    }

    /// Returns the curves for local convolution: only what is within an arc length of a point's
    /// place counts there.
    #[must_use]
    pub fn within(self, reach: f64) -> Self {
        let local = Some(reach);
        Self { local, ..self }
    }

    /// Returns the curves with planes at free ends, given by their nodes.
    #[must_use]
    pub fn with_flat(self, flat: Vec<u32>) -> Self {
        Self { flat, ..self }
    }

    /// The refined curves; `None` if data from elsewhere are not usable.
    #[must_use]
    pub fn polyline(&self) -> Option<&Polyline> {
        self.polyline
            .get_or_init(|| self.skeleton.polyline(self.scheme, self.levels).ok())
            .as_ref()
    }

    /// Whether the radius varies anywhere.
    #[must_use]
    pub fn tapers(&self) -> bool {
        let mut pieces = self.pieces();
        pieces.any(|[(_, start), (_, end)]| start != end)
    }

    /// The points of the refined curves, each with its radius.
    pub fn points(&self) -> impl Iterator<Item = (DVec3, f64)> + '_ {
        let vertices = self.polyline().map_or(&[][..], |p| &p.vertices);
        vertices.iter().map(|v| (v.position, v.radius))
    }

    /// The segments of the refined curves that have a length, as two points with their radii.
    pub fn pieces(&self) -> impl Iterator<Item = [(DVec3, f64); 2]> + '_ {
        let polyline = self.polyline().into_iter();
        let segments = polyline.flat_map(|p| p.segments.iter().map(move |s| (p, s)));
        segments.filter(|(_, s)| s.length > 0.0).map(|(p, s)| {
            s.ends
                .map(|end| (p.vertices[end].position, p.vertices[end].radius))
        })
    }

    /// Whether a node is a free end that is flat.
    fn is_flat(&self, node: Option<usize>) -> bool {
        node.is_some_and(|node| self.flat.contains(&(node as u32)))
    }

    /// The shapes that stand for the curves in drafts: cones, and balls between them.
    pub(crate) fn draft(&self, to_world: &DAffine3, growth: f64) -> Vec<Shape> {
        let vertices = self.polyline().map_or(&[][..], |p| &p.vertices);
        let balls = vertices
            .iter()
            .filter(|v| v.radius > 0.0 && !self.is_flat(v.node))
            .map(|v| Shape::sphere(to_world.transform_point3(v.position), v.radius * growth));
        let cones = self.pieces().map(|[(base, start), (apex, end)]| {
            let [base, apex] = [base, apex].map(|p| to_world.transform_point3(p));
            Shape::cone(base, start * growth, apex, end * growth)
        });
        balls.chain(cones).collect()
    }
}
