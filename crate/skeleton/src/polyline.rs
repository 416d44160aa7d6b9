//! The refined skeleton: a graph of segments.
use crate::Skeleton;
use crate::scheme::Refined;
use glam::{DVec3, DVec4};

/// Point of a polyline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Place in space.
    pub position: DVec3,
    /// The radius there.
    pub radius: f64,
    /// The skeleton's node that it is at, if any. Curves that pass through the same node have one
    /// vertex there.
    pub node: Option<usize>,
}

/// Piece of a polyline between two vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The indices of its vertices, in the direction of its curve.
    pub ends: [usize; 2],
    /// Index of the curve.
    pub curve: usize,
    /// Place in the control polygon: the segment comes from between the curve's nodes of this
    /// number and the next.
    pub span: usize,
    /// Arc length of the curve up to it.
    pub start: f64,
    /// Length of the segment. 0 where nodes coincide.
    pub length: f64,
}

/// Graph of segments, curve by curve and along each.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// The segments. None joins a vertex to itself.
    pub segments: Vec<Segment>,
    /// Arc length of each curve's polyline.
    pub lengths: Vec<f64>,
    /// Start of each vertex's segments in `incident`, and the end of all.
    first: Vec<usize>,
    incident: Vec<usize>,
}

impl Polyline {
    pub(crate) fn new(skeleton: &Skeleton, curves: Vec<Refined>) -> Self {
        let mut vertices = Vec::new();
        let mut segments = Vec::new();
        let mut lengths = Vec::with_capacity(curves.len());
        let mut of_node = vec![None; skeleton.nodes.len()];
        for (number, (curve, nodes)) in curves.iter().zip(&skeleton.curves).enumerate() {
            let mut node_at = vec![None; curve.points.len()];
            for (&node, at) in nodes.iter().zip(&curve.at_nodes) {
                if let Some(at) = at {
                    node_at[*at] = Some(node);
                }
            }
            let mut vertex = |point: DVec4, node: Option<usize>| {
                if let Some(known) = node.and_then(|node: usize| of_node[node]) {
                    return known;
                }
                vertices.push(Vertex {
                    position: point.truncate(),
                    radius: point.w,
                    node,
                });
                let index = vertices.len() - 1;
                if let Some(node) = node {
                    of_node[node] = Some(index);
                }
                index
            };
            let mut length = 0.0;
            let mut before = vertex(curve.points[0], node_at[0]);
            for (i, &span) in curve.spans.iter().enumerate() {
                let here = vertex(curve.points[i + 1], node_at[i + 1]);
                if here != before {
                    let own = (curve.points[i + 1] - curve.points[i]).truncate().length();
                    segments.push(Segment {
                        ends: [before, here],
                        curve: number,
                        span,
                        start: length,
                        length: own,
                    });
                    length += own;
                }
                before = here;
            }
            lengths.push(length);
        }
        let (first, incident) = incidence(vertices.len(), &segments);
        Self {
            vertices,
            segments,
            lengths,
            first,
            incident,
        }
    }

    /// Returns the segments that end at a vertex, in increasing order. Their number is the vertex's
    /// valence: 1 at a free end, 2 along a curve, 3 or more at a branch, 0 at no vertex.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn around(&self, vertex: usize) -> &[usize] {
        &self.incident[self.first[vertex]..self.first[vertex + 1]]
    }

    /// The segments that share the vertex `ends[end]` of a segment with it.
    ///
    /// # Panics
    /// If there is no such segment, or `end` is not 0 or 1.
    pub fn neighbours(&self, segment: usize, end: usize) -> impl Iterator<Item = usize> + '_ {
        self.around(self.segments[segment].ends[end])
            .iter()
            .copied()
            .filter(move |&other| other != segment)
    }
}

/// Lists the segments of each vertex, one list after the other, and the start of each list.
fn incidence(vertices: usize, segments: &[Segment]) -> (Vec<usize>, Vec<usize>) {
    let mut first = vec![0; vertices + 1];
    for end in segments.iter().flat_map(|segment| segment.ends) {
        first[end + 1] += 1;
    }
    for i in 0..vertices {
        first[i + 1] += first[i];
    }
    let mut next = first.clone();
    let mut incident = vec![0; 2 * segments.len()];
    for (index, segment) in segments.iter().enumerate() {
        for end in segment.ends {
            incident[next[end]] = index;
            next[end] += 1;
        }
    }
    (first, incident)
}
