//! The pictures that `shoot` takes, and what the commands behind the last one mean for it.
//!
//! Each `shoot` takes a picture of what stands before it. What follows the last one is in its
//! picture, too, so that a shape that is added at the end of a text is seen; behind a `reset` it
//! is not, as a text that clears up after its picture would lose it.

use super::model::Part;
use super::state::Evaluator;
use super::{messages, pattern};
use crate::Severity;
use crate::compiled::{Output, Placement};
use crate::limits::{MAX_SHOT_WEIGHT, MAX_SHOTS};
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use scene::{Origin, Scene};
use std::ops::Range;

/// A picture that `shoot` took.
#[derive(Debug)]
pub struct Shot {
    /// The scene.
    pub scene: Scene,
    /// The ways of its elements from their commands.
    pub placements: Vec<Placement>,
    /// The name under which it is saved.
    pub output: Output,
    /// The share of a frame for which the shutter is open.
    pub shutter: f64,
    /// The place of its `shoot`.
    pub origin: Origin,
}

/// Commands behind the last `shoot`, as far as they matter to its picture.
#[derive(Debug, Default)]
enum Later {
    /// Nothing follows.
    #[default]
    Nothing,
    /// Changes of it; the file and place of the first command that makes one.
    Changes(usize, Range<usize>),
    /// A `reset`, so that the picture stays as it is; the file and place of the first command
    /// behind it that may change a picture.
    Reset(Option<(usize, Range<usize>)>),
}

/// The pictures taken so far.
#[derive(Debug, Default)]
pub struct Shots {
    /// The pictures, in order.
    pub taken: Vec<Shot>,
    /// Shapes, materials and lights of all of them together.
    weight: usize,
    later: Later,
}

impl<'a> Evaluator<'a> {
    /// Takes a picture of what there is.
    ///
    /// # Errors
    /// If there are too many, or they hold too much together.
    pub(super) fn shoot(&mut self, command: &'a Command) -> Outcome<()> {
        let weight = self.weight_of_picture();
        let taken = &self.shots.taken;
        if taken.len() >= MAX_SHOTS {
            let message = format!("there are more than {MAX_SHOTS} pictures");
            return Err(Problem::new(&command.span, message));
        }
        if !taken.is_empty() {
            if self.shots.weight + weight > MAX_SHOT_WEIGHT {
                let message = format!(
                    "the pictures hold more than {MAX_SHOT_WEIGHT} shapes, materials and lights \
                     together"
                );
                return Err(Problem::new(&command.span, message)
                    .hint("take this picture in a text of its own"));
            }
            self.scope.step(1 + weight as u64, &command.word_span)?;
            self.say_of_second_shot(command);
        }
        let parts = self.model.parts.clone();
        let shot = self.shot(parts, self.origin(command));
        self.shots.weight += weight;
        self.shots.taken.push(shot);
        self.shots.later = Later::Nothing;
        self.palette.mark_shown();
        Ok(())
    }

    /// Returns the number of shapes, materials, lights and so on that a picture would hold.
    fn weight_of_picture(&self) -> usize {
        let model = &self.model;
        let air = self.lights.len() + self.air.clouds.len();
        let objects = model.bodies.len() + model.contacts.len();
        // Bones are cut when the picture is made.
        let patterned = model.parts.iter().map(|part| &part.element);
        let patterned = patterned.filter(|element| self.pattern_of(element).is_some());
        let pieces: usize = patterned.filter_map(pattern::count).sum();
        let pieces = pieces.min(pattern::MOST_OF_ALL);
        model.parts.len() + pieces + self.palette.surfaces.len() + objects + air
    }

    /// Says how several pictures are seen in the page, and that one is written over.
    fn say_of_second_shot(&mut self, command: &'a Command) {
        if let [_] = self.shots.taken[..] {
            let message = "the page shows these pictures as frames to choose from; the program \
                           writes each";
            self.note(&command.span, message, "");
        }
        let name = self.output.file();
        let mut earlier = self.shots.taken.iter().map(|shot| &shot.output);
        if self.output.saved && earlier.any(|output| output.saved && output.file() == name) {
            let message = format_args!("an earlier picture is called `{name}`, too, and is lost");
            let hint = "give each picture a `filename` before its `shoot`";
            self.warn(&command.span, message, hint);
        }
    }

    /// Makes the picture of some shapes with all else as it is now.
    fn shot(&mut self, parts: Vec<Part>, origin: Origin) -> Shot {
        let (scene, placements) = self.picture(parts);
        Shot {
            scene,
            placements,
            output: self.output.clone(),
            shutter: self.shutter,
            origin,
        }
    }

    /// Notes that a command runs, which may change the picture of the `shoot` before it.
    pub(super) fn note_after_shot(&mut self, command: &Command) {
        if self.shots.taken.is_empty() {
            return;
        }
        match self.shots.later {
            _ if command.spec.is_some_and(|spec| spec.name == "reset") => {
                self.shots.later = Later::Reset(None);
            }
            Later::Nothing if messages::changes_picture(command) => {
                let (file, span) = self.place_of(&command.word_span);
                self.shots.later = Later::Changes(file, span);
            }
            Later::Reset(None) if messages::changes_picture(command) => {
                self.shots.later = Later::Reset(Some(self.place_of(&command.word_span)));
            }
            _ => {}
        }
    }

    /// Returns all pictures at the end of the text, at least one.
    pub(super) fn finish_shots(&mut self) -> Vec<Shot> {
        let mut shots = std::mem::take(&mut self.shots.taken);
        let later = std::mem::take(&mut self.shots.later);
        let origin = match (shots.last(), later) {
            (Some(_), Later::Nothing) => return shots,
            (Some(_), Later::Reset(place)) => {
                if let Some((file, span)) = place.filter(|_| !self.model.parts.is_empty()) {
                    let message = "what follows the `reset` behind the last `shoot` is in no \
                                   picture";
                    self.say_at(file, Severity::Warning, &span, message, "add a `shoot`");
                }
                return shots;
            }
            (Some(last), Later::Changes(file, span)) => {
                let origin = last.origin;
                let message = "what follows the last `shoot` is in its picture, too";
                let hint = "put `shoot` last, or another one behind it for a picture of its own";
                self.say_at(file, Severity::Note, &span, message, hint);
                shots.pop();
                origin
            }
            (None, _) => Origin::default(),
        };
        let parts = std::mem::take(&mut self.model.parts);
        let last = self.shot(parts, origin);
        shots.push(last);
        shots
    }
}
