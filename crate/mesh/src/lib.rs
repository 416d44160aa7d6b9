//! Meshes, and files of meshes and heights. Knows neither scenes nor fields.
//!
//! - [`TriangleMesh`]: triangles that share vertices, with sizes and angles; [`Topology`] says
//!   whether one is a closed manifold, [`self_intersections`] whether it cuts itself, with proof.
//! - [`HalfEdgeMesh`]: polygons that know their neighbours, for edits; made of a [`PolygonSoup`].
//! - [`Bvh`]: search among boxes.
//! - [`read`] makes a mesh of the bytes of a file of any [`Format`], [`Export`] writes one.
//! - [`heights`] makes [`Heights`] of a PNG picture, and [`terra`] makes a smooth mesh of those.
//!
//! ```
//! let obj = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let mesh = mesh::read("square.obj", obj)?;
//! assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
//! # Ok::<(), mesh::Error>(())
//! ```
//!
//! Files are untrusted: every count is checked against the bytes that are there and against
//! [`limits`] before memory is allocated for it, and errors are sentences with a position. The
//! readers know the parts of each format that say where triangles and normals are, and as much of
//! colours and materials as the formats have in common; textures and animations are ignored.

mod aabb;
mod bvh;
mod color;
mod error;
mod format;
pub mod formats;
mod half_edge;
mod heights;
mod intersect;
pub mod limits;
mod measure;
mod read;
mod report;
mod simplify;
mod terra;
mod triangle_mesh;
mod write;

pub use aabb::Aabb;
pub use bvh::{Bvh, Ray};
pub use color::{linear_from_srgb, phong_from_roughness, roughness_from_phong, srgb_from_linear};
pub use error::Error;
pub use format::Format;
pub use half_edge::{
    Built, EditError, FaceId, HalfEdgeId, HalfEdgeMesh, ListPatch, MeshPatch, PolygonSoup, Repairs,
    Shell, VertexCopy, VertexId, Violation,
};
pub use heights::{Heights, heights};
pub use intersect::{Intersections, self_intersections};
pub use measure::{closest_point, smallest_angle};
pub use read::{read, read_mtl, read_points, read_with_remarks};
pub use report::Topology;
pub use simplify::{Level, levels_of_detail, simplify, simplify_part};
pub use terra::terra;
pub use triangle_mesh::{Group, Material, TriangleMesh};
pub use write::{Export, ExportedFile, Joint, Part, Pose, Rig, describe_shift, shift_of};
