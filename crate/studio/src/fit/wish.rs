//! Wishes about the fit of a mesh.

/// Wishes about the fit of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FitWish {
    /// Show the panel, or hide it.
    Show(bool),
    /// Take in a measured file.
    Take {
        /// The name of the file.
        name: String,
        /// The content of the file.
        bytes: Vec<u8>,
    },
    /// Choose the mesh of a file, if the text shows it.
    Choose(String),
    /// Begin to fit what is chosen.
    Start,
    /// End the fit.
    Stop,
}
