//! Text to scene.

use crate::evaluator::Evaluator;
use crate::limits::{MAX_FILES, MAX_TEXT};
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbols;
use crate::{Asset, Diagnostic, Project, Severity, Tool};
use glam::DAffine3;
use scene::{Origin, Scene};

/// What a text means.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compiled {
    /// The scene, as far as the text could be understood.
    pub scene: Scene,
    /// How each element of the scene came from its command, for those who move it by hand.
    pub placements: Vec<Placement>,
    /// All that is to be said about the text, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The variables that are marked `hot`.
    pub hot: Vec<HotVariable>,
    /// The work on files that the text asks for, in order.
    pub tools: Vec<Tool>,
    /// Where each of [`Self::tools`] stands in the texts.
    pub tool_origins: Vec<Origin>,
    /// Under what name the picture is to be saved.
    pub output: Output,
    /// Whether a variable changes with every frame.
    pub animated: bool,
}

/// How an element came from its command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// From the coordinates that the command names to those of the world.
    pub to_world: DAffine3,
    /// By how much lengths grew on the way.
    pub growth: f64,
    /// Whether its command was run in a loop, a defined command or by `instance`, so that it may have
    /// made more elements than this one.
    pub repeated: bool,
}

/// The name and format of the picture's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// `filename`, without an ending.
    pub name: String,
    /// `format`; `None` if the text does not say.
    pub format: Option<&'static str>,
    /// Whether the picture is to be saved at all, which `nosave on` denies.
    pub saved: bool,
}

impl Output {
    /// The whole name of the picture's file: a PNG file where the text does not say.
    #[must_use]
    pub fn file(&self) -> String {
        format!("{}.{}", self.name, self.format.unwrap_or("png"))
    }
}

impl Default for Output {
    fn default() -> Self {
        Self {
            name: String::from("scene"),
            format: None,
            saved: true,
        }
    }
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
    /// The slider's range, if the text says it.
    pub range: Option<[f64; 2]>,
    /// The slider's step, if the text says it.
    pub step: Option<f64>,
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
    compile_at(project, &[], 0.0)
}

/// As [`compile`], with images and meshes that the texts may use, at a moment of the animation in frames: between two frames
/// for an exposure that lasts. A variable `+= step` has changed by `step·moment`, one `*= factor` by `factor^moment`.
/// A moment that is negative or not finite is taken for 0.
#[must_use]
pub fn compile_at(project: &Project, assets: &[Asset], moment: f64) -> Compiled {
    if let Some(diagnostic) = too_large(project) {
        return Compiled {
            diagnostics: vec![diagnostic],
            ..Compiled::default()
        };
    }
    let mut symbols = Symbols::default();
    let sources = Sources::of(project, &mut symbols);
    let moment = if moment.is_finite() {
        moment.max(0.0)
    } else {
        0.0
    };
    Evaluator::new(&sources, assets, moment, Scope::new(symbols)).run(project)
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
        related: Vec::new(),
        command: None,
    })
}
