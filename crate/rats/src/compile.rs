//! Text to scene.
use crate::{Diagnostic, Project};
use scene::Scene;

/// What a text means.
#[derive(Clone, Debug, PartialEq)]
pub struct Compiled {
    /// The scene, as far as the text could be understood.
    pub scene: Scene,
    /// All that is to be said about the text, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The variables that are marked `hot`.
    pub hot: Vec<HotVariable>,
}

/// A variable that the page shows as a slider.
#[derive(Clone, Debug, PartialEq)]
pub struct HotVariable {
    /// Its name.
    pub name: String,
    /// Its present value.
    pub value: HotValue,
    /// Index of the file in [`Project::files`].
    pub file: usize,
    /// The byte range of the value in that file if it is a plain number, three numbers or a colour name, so that
    /// a slider can replace it; `None` if it comes from an expression.
    pub literal: Option<std::ops::Range<usize>>,
}

/// A value that can be adjusted.
#[derive(Clone, Debug, PartialEq)]
pub enum HotValue {
    /// A number.
    Scalar(f64),
    /// Three numbers.
    Vector([f64; 3]),
    /// A colour.
    Colour([f32; 3]),
}

/// Runs the first file of a project. Never fails, never panics, always ends.
#[must_use]
pub fn compile(project: &Project) -> Compiled {
    let _ = project;
    todo!()
}
