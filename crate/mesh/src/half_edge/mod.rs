//! Half-edge structure for polygon meshes with and without boundary.

mod build;
mod collapse;
mod connectivity;
mod delete;
mod edit;
mod export;
mod id;
mod patch;
mod shells;
mod soup;
mod triangulate;
mod validate;
mod weld;

pub use build::{Built, Repairs};
pub use connectivity::HalfEdgeMesh;
pub use delete::VertexCopy;
pub use id::{EditError, FaceId, HalfEdgeId, VertexId};
pub use patch::{ListPatch, MeshPatch};
pub use shells::Shell;
pub use soup::PolygonSoup;
pub use validate::Violation;
