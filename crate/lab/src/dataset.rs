//! The dataset that is open in the editor.

use scene::{Camera, Scene};

/// The open dataset as lessons see it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dataset<'a> {
    /// A number that changes with the scene or the camera.
    pub generation: u64,
    /// The scene; `None` before anything was compiled.
    pub scene: Option<&'a Scene>,
    /// The camera in use, which may have been chosen by hand.
    pub camera: Camera,
}
