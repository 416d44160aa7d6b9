//! Handles, and why an edit is refused.

use core::fmt;

/// Stands for no half-edge, face or vertex.
pub(super) const NONE: u32 = u32::MAX;

macro_rules! id {
    ($name:ident, $text:literal) => {
        #[doc = $text]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// The handle as an index of arrays that are kept beside the mesh.
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    VertexId,
    "Number of a vertex. Stays the same until the vertex is removed; then a new vertex may get it."
);
id!(
    HalfEdgeId,
    "Number of a half-edge. The opposite half-edge of number h is h ^ 1."
);
id!(
    FaceId,
    "Number of a face. Stays the same until the face is removed; then a new face may get it."
);

/// Why an edit was refused. The mesh is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditError {
    /// The handle names nothing that is in the mesh.
    Missing,
    /// The half-edge belongs to a face, and a boundary half-edge is needed; or the other way round.
    WrongSide,
    /// The operation needs triangles.
    NoTriangle,
    /// The result would join two vertices by two edges, or a vertex with itself.
    DoubleEdge,
    /// The result would have a face with a vertex twice, or with fewer than three vertices.
    DegenerateFace,
    /// Sheets that are apart would share a vertex.
    Pinch,
    /// The position has a coordinate that is not finite.
    NotFinite,
    /// The mesh is at one of the [`crate::limits`].
    Full,
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Missing => "there is no such vertex, edge or face",
            Self::WrongSide => "the half-edge is on the wrong side of the boundary",
            Self::NoTriangle => "both faces at the edge must be triangles",
            Self::DoubleEdge => "two vertices would be joined by two edges",
            Self::DegenerateFace => "a face would have a vertex twice",
            Self::Pinch => "two sheets of the mesh would touch in a vertex",
            Self::NotFinite => "a position must be finite",
            Self::Full => "the mesh has as many elements as it may have",
        })
    }
}

impl core::error::Error for EditError {}
