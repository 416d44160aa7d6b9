//! Wishes about the model as a mesh.

/// Wishes about the model as a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshWish {
    /// Write the mesh on show to files.
    Save,
}
