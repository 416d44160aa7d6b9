//! The result of compiling a text.

use crate::value::Value;
use crate::{Diagnostic, Tool};
use glam::{DAffine3, DVec3};
use limbs::Recipe;
use scene::{Origin, Scene};
use std::mem;
use std::ops::Range;
use std::sync::Arc;

/// Scene of a text, and all else that a run gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compiled {
    /// The scene of the last `shoot` or of the whole text, as far as it could be understood. Shared
    /// by all who draw or mesh it.
    pub scene: Arc<Scene>,
    /// The pictures of the `shoot`s before the last, in order.
    pub earlier: Vec<Picture>,
    /// The way of each element of the scene from its command, for those who move it by hand.
    pub placements: Vec<Placement>,
    /// The messages about the text, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The variables that are marked `hot`.
    pub hot: Vec<HotVariable>,
    /// The sets of values for them that have a name.
    pub presets: Vec<Preset>,
    /// The work on files that the text asks for, in order.
    pub tools: Vec<Tool>,
    /// The things that the program does before, between and behind the pictures, in order.
    pub interludes: Vec<Interlude>,
    /// The places of [`Self::tools`] in the texts.
    pub tool_origins: Vec<Origin>,
    /// The name under which the picture is to be saved.
    pub output: Output,
    /// Whether a variable changes with every frame, or something moves.
    pub animated: bool,
    /// Frames of a second, where a `motion` says so.
    pub rate: Option<f64>,
    /// The deformations that were carried out, in order.
    pub deforms: Vec<Deform>,
    /// Skeletons that have not been read, where compiling does not read them: without them the
    /// scene is not that of the text (see [`crate::Asset::keep_skeleton`]).
    pub unread: Vec<Unread>,
}

impl Compiled {
    /// Puts one of the pictures in the place of the last, counted from 0 in the order of their
    /// `shoot`s; the last one stays if there are no more.
    pub fn choose(&mut self, picture: usize) {
        if let Some(earlier) = self.earlier.get_mut(picture) {
            mem::swap(&mut self.scene, &mut earlier.scene);
            mem::swap(&mut self.placements, &mut earlier.placements);
            mem::swap(&mut self.output, &mut earlier.output);
        }
    }
}

/// Skeleton of a file that is still to be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Unread {
    /// Name of the file among the project's assets.
    pub name: String,
    /// Way to make the skeleton of it.
    pub recipe: Recipe,
}

/// Something that the program does between the pictures of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interlude {
    /// The number of pictures that come before it.
    pub after: usize,
    /// The thing to do.
    pub act: Act,
}

/// The kind of an [`Interlude`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Act {
    /// `pause`: wait for a key, below this message.
    Pause(String),
    /// `log`: write what is said from here on into a file, too; `None`: no more.
    Log(Option<String>),
    /// `stopwatch`: start it, or tell the time since it was started.
    Stopwatch {
        /// Whether it is started.
        starts: bool,
    },
}

/// The picture of a `shoot` before the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The way of each element of the scene from its command.
    pub placements: Vec<Placement>,
    /// The name under which it is to be saved.
    pub output: Output,
    /// The place of the `shoot`.
    pub origin: Origin,
}

/// A `deform` command that was carried out.
#[derive(Clone, Debug, PartialEq)]
pub struct Deform {
    /// The place of the command.
    pub origin: Origin,
    /// Whether it was run in a loop, a defined command or the library, so that its numbers are not
    /// only its own.
    pub repeated: bool,
    /// The commands that made what is deformed.
    pub of: Vec<Origin>,
    /// The control points, in order.
    pub controls: Vec<Control>,
    /// The vertices before the deformation, each once, in the coordinates of the command.
    pub positions: Arc<[DVec3]>,
    /// The triangles between them.
    pub triangles: Arc<[[u32; 3]]>,
}

/// A control point of a [`Deform`].
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// The place before the move.
    pub place: DVec3,
    /// The move.
    pub way: DVec3,
    /// The bytes of its three numbers, with the signs around them.
    pub span: Range<usize>,
    /// The bytes of the three numbers of its move; `None` if it has none.
    pub way_span: Option<Range<usize>>,
    /// Whether the move's numbers are written out, or there is none.
    pub is_literal: bool,
}

/// Way of an element from its command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The map from the coordinates that the command names to those of the world.
    pub to_world: DAffine3,
    /// The factor by which lengths grew on the way.
    pub growth: f64,
    /// Whether its command was run in a loop, a defined command or by `instance`, so that it may
    /// have made more elements than this one.
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
    /// Returns the whole name of the picture's file: a PNG file where the text does not say.
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
    /// The name.
    pub name: String,
    /// The present value.
    pub value: HotValue,
    /// Index of the file in [`Project::files`].
    pub file: usize,
    /// The byte range of the value in that file if it is a plain number, three numbers, a colour's
    /// name or `rgb(…)`, so that a slider can replace it (see [`crate::hot::set`]); `None` if it
    /// comes from an expression.
    pub literal: Option<std::ops::Range<usize>>,
    /// The slider's range, if the text says it.
    pub range: Option<[f64; 2]>,
    /// The slider's step, if the text says it.
    pub step: Option<f64>,
}

/// A set of values for hot variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// The name.
    pub name: String,
    /// Names of variables, each with its value.
    pub values: Vec<(String, HotValue)>,
}

/// A value that can be adjusted.
#[derive(Clone, Debug, PartialEq)]
pub enum HotValue {
    /// A number.
    Scalar(f64),
    /// A vector: three numbers.
    Vector([f64; 3]),
    /// A colour.
    Colour([f32; 3]),
}

impl HotValue {
    /// Returns a variable's value as one that can be adjusted; `None` if it is a name.
    pub(crate) fn of(value: Value) -> Option<Self> {
        Some(match value {
            Value::Scalar(x) => Self::Scalar(x),
            Value::Vector(v) => Self::Vector(v.to_array()),
            Value::Colour(c) => Self::Colour(c.to_array().map(|x| x as f32)),
            Value::Name(_) => return None,
        })
    }
}
