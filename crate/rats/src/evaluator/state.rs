//! The state of a running text, which every command reads and changes.

use super::frozen::Frozen;
use super::image_list::Images;
use super::model::Model;
use super::motion::Moving;
use super::palette::Palette;
use super::shots::Shots;
use super::surroundings::Air;
use super::view_plane::ViewPlane;
use super::watched::Watch;
use crate::compiled::{Deform, HotVariable, Interlude, Output, Preset, Unread};
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::report::Report;
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbol;
use crate::syntax::{Command, Define};
use crate::{Asset, Tool};
use scene::{Camera, Lens, Light, Origin, Settings};
use std::collections::HashMap;
use std::ops::Range;

/// Way in which a run goes on after a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Run the next one.
    Next,
    /// Leave the file or the call.
    Return,
    /// End the run.
    Quit,
}

/// A running text.
#[derive(Debug)]
pub struct Evaluator<'a> {
    pub(super) sources: &'a Sources<'a>,
    pub(super) assets: &'a [Asset],
    /// The moment of the animation, in frames.
    pub(super) moment: f64,
    /// Variables, random numbers, steps.
    pub(super) scope: Scope<'a>,
    pub(super) report: Report,
    pub(super) model: Model<'a>,
    pub(super) palette: Palette<'a>,
    pub(super) lights: Vec<Light>,
    /// The file and place of the first light's size.
    pub(super) sized_light: Option<(usize, Range<usize>)>,
    pub(super) air: Air,
    pub(super) images: Images,
    pub(super) camera: Camera,
    pub(super) lens: Lens,
    /// The share of a frame for which the shutter is open.
    pub(super) shutter: f64,
    /// The shapes that `transform` has frozen, for the other moments of an open shutter.
    pub(super) frozen: Frozen,
    /// The file and place of the last `eyep` or `vrp`.
    pub(super) aimed_at: (usize, Range<usize>),
    /// The camera of `cp`, `vpn` and `window`.
    pub(super) view_plane: ViewPlane,
    /// A vertical angle of view that differs from the horizontal one, and the file and place of it.
    pub(super) vertical: Option<(f64, usize, Range<usize>)>,
    pub(super) settings: Settings,
    /// Whether `sample` has been given.
    pub(super) sampled: bool,
    /// Whether `blobscale` has been given.
    pub(super) scaled: bool,
    /// Evaluations that flesh which is `exact` may still cost.
    pub(super) exact_left: usize,
    /// Solutions for exact flesh.
    pub(super) exact_known: HashMap<String, super::exact::Solution>,
    pub(super) definitions: HashMap<Symbol, (usize, &'a Define)>,
    pub(super) hot: Vec<HotVariable>,
    pub(super) presets: Vec<Preset>,
    pub(super) tools: Vec<Tool>,
    pub(super) interludes: Vec<Interlude>,
    pub(super) tool_origins: Vec<Origin>,
    pub(super) output: Output,
    pub(super) deforms: Vec<Deform>,
    /// Skeletons of files, each once.
    pub(super) skeletons: Vec<Unread>,
    /// Skeletons of files that have not been read.
    pub(super) unread: Vec<Unread>,
    /// Vertices of all deformations so far.
    pub(super) deformed: usize,
    /// Whether a variable changes with every frame.
    pub(super) animated: bool,
    /// The work of `motion`.
    pub(super) moving: Moving,
    /// The file that is being run.
    pub(super) file: usize,
    /// The files that are being read, the innermost last.
    pub(super) reading: Vec<usize>,
    /// The places where the texts of the project use the library, the innermost last: messages
    /// about a text of the library go there.
    pub(super) uses: Vec<(usize, Range<usize>)>,
    /// Files whose mistakes of form have been reported.
    pub(super) reported: Vec<bool>,
    /// Blocks, calls and files inside each other.
    pub(super) depth: usize,
    /// Loops and calls inside each other.
    pub(super) repeating: usize,
    /// The pictures that `shoot` took.
    pub(super) shots: Shots,
    /// The notes of a run that is watched for a command.
    pub(super) watch: Option<Box<Watch<'a>>>,
}

impl<'a> Evaluator<'a> {
    /// Makes the state before anything has run.
    #[must_use]
    pub fn new(
        sources: &'a Sources<'a>,
        assets: &'a [Asset],
        moment: f64,
        scope: Scope<'a>,
    ) -> Self {
        Self {
            sources,
            assets,
            moment,
            scope,
            report: Report::default(),
            model: Model::default(),
            palette: Palette::default(),
            lights: Vec::new(),
            sized_light: None,
            air: Air::default(),
            images: Images::default(),
            camera: Camera::default(),
            lens: Lens::default(),
            shutter: 0.0,
            frozen: Frozen::default(),
            aimed_at: (0, 0..0),
            view_plane: ViewPlane::default(),
            vertical: None,
            settings: Settings::default(),
            sampled: false,
            scaled: false,
            exact_left: super::exact::MOST_EVALUATIONS,
            exact_known: HashMap::new(),
            definitions: HashMap::new(),
            hot: Vec::new(),
            presets: Vec::new(),
            tools: Vec::new(),
            interludes: Vec::new(),
            tool_origins: Vec::new(),
            output: Output::default(),
            deforms: Vec::new(),
            skeletons: Vec::new(),
            unread: Vec::new(),
            deformed: 0,
            animated: false,
            moving: Moving::default(),
            file: 0,
            reading: Vec::new(),
            uses: Vec::new(),
            reported: vec![false; sources.all.len()],
            depth: 0,
            repeating: 0,
            shots: Shots::default(),
            watch: None,
        }
    }

    /// Returns whether the text that is being run is one of the user's.
    pub(super) fn is_own(&self) -> bool {
        self.file < self.sources.own
    }

    /// Goes one level deeper.
    ///
    /// # Errors
    /// Fatally, if that is too deep.
    pub(super) fn enter(&mut self, span: &Range<usize>) -> Outcome<()> {
        if self.depth >= limits::MAX_NESTED {
            return Err(Problem::new(
                span,
                format!(
                    "stopped here: files, blocks and calls are more than {} deep",
                    limits::MAX_NESTED
                ),
            )
            .fatal());
        }
        self.depth += 1;
        Ok(())
    }

    /// Makes the reader of the operands of a command of the present file.
    pub(super) fn reader(&mut self, command: &Command) -> Reader<'_, 'a> {
        let source = &self.sources.all[self.file];
        Reader::new(command, &source.syntax.items, source.text, &mut self.scope)
    }

    /// Returns the origin of an element of this command: a place in the user's text, even if the
    /// library makes it.
    pub(super) fn origin(&self, command: &Command) -> Origin {
        let (file, span) = match self.uses.last() {
            Some((file, span)) if !self.is_own() => (*file, span),
            _ => (self.file, &command.span),
        };
        Origin {
            file: shorten(file),
            start: shorten(span.start),
            end: shorten(span.end),
        }
    }
}

/// Returns a place in a text in fewer bits; the largest number if it does not fit.
fn shorten(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}
