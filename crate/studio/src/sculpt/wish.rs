//! Wishes about sculptures.

use modeling::Flesh;

/// A mesh of the model that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The number of faces that it should have.
    pub faces: usize,
    /// The tolerance, as a part of the model's longest side.
    pub tolerance: f64,
    /// The number of attempts that may follow.
    pub left: u32,
    /// Revision of the text that is meshed.
    pub revision: u64,
    /// The mesh of the attempt before.
    pub before: Option<Vec<u8>>,
}

/// Wishes about sculptures.
#[derive(Clone, Debug, PartialEq)]
pub enum SculptWish {
    /// Go on with a sculpture of the work, or ask how to begin one.
    Show,
    /// Ask how to begin a sculpture.
    New,
    /// Open a text of strokes.
    Open(String),
    /// Begin a sculpture.
    Begin {
        /// The line of its text that says what it starts from.
        start: String,
        /// Whether it is a work of its own.
        is_new: bool,
    },
    /// Mesh the model by about so many faces, and sculpt the mesh.
    Model(usize),
    /// Sculpt the mesh of the model, a PLY file, or say why there is none.
    Mesh(Result<Vec<u8>, String>, Attempt),
    /// Replace a text of strokes.
    SetStrokes {
        /// The file's name.
        name: String,
        /// The new text.
        text: String,
        /// The mesh that it makes, if it is known.
        mesh: Option<Box<mesh::TriangleMesh>>,
    },
    /// Show a sculpture as a hard mesh, as flesh or as metaballs.
    Grow {
        /// The name of its text.
        name: String,
        /// The kind of flesh.
        flesh: Flesh,
        /// The mean length of its edges.
        edge: f64,
    },
    /// Leave the sculpting view, to fit the mesh of a sculpture to measured points.
    Fit(String),
    /// Leave the sculpting view for the editor.
    Close,
}
