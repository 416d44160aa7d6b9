//! Skeletons of subdivision curves, as soft elements.

use crate::Shape;
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use skeleton::{Polyline, Scheme, Skeleton};
use std::sync::{Arc, OnceLock};

/// The blobbiness of curves whose material has none.
pub const BLOBBINESS: f64 = 2.0;

/// Flat ends of a skeleton that count.
pub const MOST_FLAT: usize = 256;

/// Closed meshes by which limbs are cut when meshes are made of them; pictures show them uncut.
/// Their places are in the coordinates of the curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clip {
    /// Whether what is inside the meshes is kept; else what is outside.
    pub is_inside: bool,
    /// Vertices of each mesh, and its triangles, as numbers of vertices.
    pub meshes: Vec<(Vec<DVec3>, Vec<[u32; 3]>)>,
}

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
    /// Whether meshes have holes in those planes.
    pub is_open: bool,
    /// Meshes by which the limbs are cut.
    pub clip: Option<Arc<Clip>>,
    /// The refined curves, made at first use.
    #[serde(skip)]
    polyline: OnceLock<Option<Polyline>>,
}

impl PartialEq for Curves {
    fn eq(&self, other: &Self) -> bool {
        self.skeleton == other.skeleton
            && (self.scheme, self.levels, self.local) == (other.scheme, other.levels, other.local)
            && (&self.flat, self.is_open) == (&other.flat, other.is_open)
            && self.clip == other.clip
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
            is_open: false,
            clip: None,
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

    /// Returns the curves with planes at free ends, given by their nodes, which meshes may leave
    /// open.
    #[must_use]
    pub fn with_flat(self, flat: Vec<u32>, is_open: bool) -> Self {
        Self {
            flat,
            is_open,
            ..self
        }
    }

    /// Returns the nodes at which exactly one curve ends and none goes on.
    #[must_use]
    pub fn free_nodes(&self) -> Vec<u32> {
        let polyline = self.polyline().into_iter();
        let vertices = polyline.flat_map(|p| (0..).zip(&p.vertices).map(move |(i, v)| (p, i, v)));
        vertices
            .filter(|(p, i, _)| p.around(*i).len() == 1)
            .filter_map(|(.., vertex)| Some(vertex.node? as u32))
            .collect()
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
