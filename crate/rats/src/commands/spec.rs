//! A row of the table of commands. Rows are plain data: [`Routine`] names what runs a command, and the
//! evaluator's `dispatch` maps each name to its function.

use super::parameter::{OptionSpec, Parameter, join};
use crate::{library, limits};

/// The groups of appendix C of the thesis, and ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Running texts.
    Run,
    /// The camera.
    Camera,
    /// Materials and textures.
    Materials,
    /// Shapes.
    Primitives,
    /// Objects made of shapes.
    Objects,
    /// Settings.
    Options,
    /// Lights, background, the picture.
    Scene,
    /// Pictures and films.
    Tools,
    /// Commands that the original language did not have.
    Extensions,
}

/// The routine of the evaluator that runs a command. A command and its synonyms share one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Routine {
    Pause,
    Return,
    Info,
    Help,
    Man,
    Var,
    Quit,
    Aperture,
    Focus,
    Shutter,
    Vrp,
    Vup,
    Cp,
    Vpn,
    Window,
    Eyep,
    Fov,
    Surface,
    Texture,
    Arc,
    Arch,
    Box,
    Brick,
    Cone,
    Cylinder,
    Pipe,
    Dot,
    Gauss,
    Line,
    Sphere,
    Triangle,
    Triad,
    Plane,
    Polygon,
    Patch,
    Torus,
    Quadric,
    Terra,
    Chain,
    Object,
    Body,
    Close,
    Instance,
    Translate,
    Rotate,
    Scale,
    Explode,
    Transform,
    Deform,
    SilentSwitch,
    Warning,
    Verbose,
    Soft,
    Double,
    Map,
    Nosave,
    Gamma,
    Framesize,
    Filename,
    Format,
    Digger,
    Contrast,
    Fragile,
    Sample,
    Mesh,
    Penumbra,
    Epsilon,
    Vanish,
    Maxdepth,
    Tone,
    Light,
    Fog,
    Background,
    Cloud,
    Sky,
    Ground,
    Remove,
    Report,
    Reset,
    Shoot,
    Animate,
    Play,
    Split,
    Collage,
    Fli,
    Convert,
    Resize,
    Diff,
    And,
    Xor,
    Show,
    Colors,
    Rats,
    Table,
    Blobscale,
    Skeleton,
    Motion,
    Contact,
    Influence,
    Curve,
    Seed,
}

/// How a command is carried out.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Action {
    /// By a routine, fully or as far as the routine itself says.
    Run(Routine),
    /// By running other files (`read`).
    Read,
    /// By running the example of a command (`test`).
    Test,
    /// The parser makes it part of the tree.
    Structure,
    /// A file of the library defines it.
    Library,
    /// It never changes the picture, for the reason given.
    NoEffect(&'static str),
}

/// A command.
pub struct CommandSpec {
    /// Its opcode.
    pub name: &'static str,
    /// Its operands, in order. Those of a command of the library stand in its file (see
    /// [`crate::library`]).
    pub parameters: &'static [Parameter],
    /// Its option words, which follow the operands in any order.
    pub options: &'static [OptionSpec],
    /// Its meaning, one line.
    pub meaning: &'static str,
    /// More about it; empty if there is no more.
    pub details: &'static str,
    /// The value without the command; empty if there is none.
    pub default: &'static str,
    /// A small text that uses it, complete and without mistakes.
    pub example: &'static str,
    /// Whether it is newer than the first published texts.
    pub(crate) is_newer: bool,
    /// How it is carried out.
    pub(crate) action: Action,
}

impl std::fmt::Debug for CommandSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CommandSpec")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl CommandSpec {
    /// How it is written, as a hint.
    #[must_use]
    pub fn usage(&self) -> String {
        format!("it is written `{}`", self.synopsis())
    }

    /// Its opcode and operands.
    #[must_use]
    pub fn synopsis(&self) -> String {
        if matches!(self.action, Action::Library) {
            return library::synopsis(self.name);
        }
        let mut synopsis = join(self.name, self.parameters);
        if self.options.len() <= 3 {
            for option in self.options {
                synopsis += &format!(" [{}]", option.synopsis());
            }
        } else {
            synopsis += " [option …]";
        }
        synopsis
    }

    /// Whether it is carried out: `None` if it is, else the reason why it changes nothing.
    #[must_use]
    pub fn idle(&self) -> Option<&'static str> {
        match self.action {
            Action::Run(_) | Action::Read | Action::Test | Action::Structure | Action::Library => {
                None
            }
            Action::NoEffect(reason) => Some(reason),
        }
    }

    /// Whether a command of the same name that a text defines hides it, so that texts from before it still run: those of the
    /// library, and those that are newer than the first published texts.
    #[must_use]
    pub fn yields(&self) -> bool {
        self.is_newer || self.is_library()
    }

    /// Words, numbers and signs that may stand behind it at most.
    pub(crate) fn most_operands(&self) -> usize {
        match self.action {
            Action::Run(Routine::Deform) => limits::MAX_CONTROL_OPERANDS,
            _ => limits::MAX_OPERANDS,
        }
    }

    /// Whether a file of the library defines it.
    #[must_use]
    pub fn is_library(&self) -> bool {
        matches!(self.action, Action::Library)
    }
}
