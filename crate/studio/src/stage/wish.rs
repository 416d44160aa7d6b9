//! Wishes about the picture and the camera.

use super::pencil::tool::Tool;
use scene::Camera;

/// Wishes about the picture and the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewWish {
    /// Look at the scene with this camera, or with that of the text if it is `None`.
    SetCamera(Option<Camera>),
    /// Show this picture, a file beside the page, until the first one is traced.
    ShowKept(&'static str),
    /// Bring the whole model into view.
    ShowAll,
    /// Let a mesh of the surface follow the hand, which begins to drag.
    Follow,
    /// Choose no shape.
    LetGo,
    /// Take a tool for drawing in hand, or lay it down.
    SetTool(Option<Tool>),
    /// Stop the picture.
    Cancel,
    /// Trace the picture again.
    Again,
    /// Write the picture to a file.
    Save,
}
