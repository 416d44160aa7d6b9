//! Text to scene.

use crate::evaluator::Evaluator;
use crate::limits::{MAX_FILES, MAX_TEXT};
use crate::parser;
use crate::scope::Scope;
use crate::symbol::Symbols;
use crate::{Diagnostic, Project, Severity};
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
    /// The byte range of the value in that file if it is a plain number, three numbers, a colour's name or
    /// `rgb(…)`, so that a slider can replace it (see [`crate::hot::set`]); `None` if it comes from an
    /// expression.
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

/// Runs the first file of a project. Never fails, never panics, always ends: the limits are in
/// [`crate::limits`].
#[must_use]
pub fn compile(project: &Project) -> Compiled {
    if let Some(diagnostic) = too_large(project) {
        return Compiled {
            scene: Scene::default(),
            diagnostics: vec![diagnostic],
            hot: Vec::new(),
        };
    }
    let mut symbols = Symbols::default();
    let syntaxes: Vec<_> = project
        .files
        .iter()
        .map(|file| parser::parse(&file.text, &mut symbols))
        .collect();
    let (scene, diagnostics, hot) = Evaluator::new(project, &syntaxes, Scope::new(symbols)).run();
    Compiled {
        scene,
        diagnostics,
        hot,
    }
}

fn too_large(project: &Project) -> Option<Diagnostic> {
    let length: usize = project.files.iter().map(|file| file.text.len()).sum();
    let message = if project.files.len() > MAX_FILES {
        format!(
            "the project has {} files; {MAX_FILES} is the limit",
            project.files.len()
        )
    } else if length > MAX_TEXT {
        format!("the text has {length} bytes; {MAX_TEXT} is the limit")
    } else {
        return None;
    };
    Some(Diagnostic {
        severity: Severity::Error,
        message,
        file: project.files[0].name.clone(),
        span: 0..0,
        line: 1,
        column: 1,
        hint: Some(String::from("use loops instead of long lists of shapes")),
    })
}
