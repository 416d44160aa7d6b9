//! Messages of the evaluator. Those about the library and its examples go to the place of the
//! user's text that uses them.

use super::state::Evaluator;
use crate::Severity;
use crate::commands;
use crate::problem::Problem;
use crate::reader::Name;
use crate::syntax::Command;
use scene::Origin;
use std::fmt::Display;
use std::ops::Range;

/// Options that change the picture.
const SETTINGS: [&str; 15] = [
    "soft",
    "double",
    "gamma",
    "framesize",
    "filename",
    "format",
    "nosave",
    "contrast",
    "fragile",
    "sample",
    "mesh",
    "penumbra",
    "epsilon",
    "vanish",
    "maxdepth",
];

impl Evaluator<'_> {
    /// Adds a message about the present file. One about the library goes to where it was used.
    pub(super) fn tell(&mut self, severity: Severity, mut problem: Box<Problem>) {
        if self.is_own() {
            // An error in a defined command: say also who called it.
            if severity == Severity::Error
                && let Some((file, span)) = self.uses.last()
                && self.scope.calls() > 0
            {
                problem = problem.with_place(Some(*file), span.clone(), "called here");
            }
            self.report.add(self.file, severity, problem);
        } else if let Some((file, span)) = self.uses.last() {
            let name = &self.sources.all[self.file].name;
            problem.message = format!("in {name}: {}", problem.message);
            problem.span = span.clone();
            if problem.fatal {
                problem.hint = Some(String::from("ask for less: smaller counts or depths"));
            }
            problem.related.clear();
            self.report.add(*file, severity, problem);
        }
    }

    /// Warns of something in the present file, if nothing was said of this place; an empty hint is
    /// none.
    pub(super) fn warn(&mut self, span: &Range<usize>, message: impl Display, hint: impl Display) {
        self.say_at(self.file, Severity::Warning, span, message, hint);
    }

    /// Notes something in the present file, as [`Self::warn`] warns of it.
    pub(super) fn note(&mut self, span: &Range<usize>, message: impl Display, hint: impl Display) {
        self.say_at(self.file, Severity::Note, span, message, hint);
    }

    /// Warns of something in the command of an element, as [`Self::warn`] does.
    pub(super) fn warn_of(&mut self, of: Origin, message: impl Display, hint: impl Display) {
        self.say_of(of, Severity::Warning, message, hint);
    }

    /// Says something of the command of an element, as [`Self::say_at`] does.
    pub(super) fn say_of(
        &mut self,
        of: Origin,
        severity: Severity,
        message: impl Display,
        hint: impl Display,
    ) {
        let span = of.start as usize..of.end as usize;
        self.say_at(of.file as usize, severity, &span, message, hint);
    }

    /// Whether a message about this place would be the first, and wanted.
    pub(super) fn is_news(&self, severity: Severity, span: &Range<usize>) -> bool {
        let (file, place) = self.place_of(span);
        self.report.is_new(file, severity, &place)
    }

    /// Returns the file and place in the project's own texts where a message about this place of
    /// the present file goes.
    pub(super) fn place_of(&self, span: &Range<usize>) -> (usize, Range<usize>) {
        match self.uses.last() {
            Some((file, place)) if !self.is_own() => (*file, place.clone()),
            _ => (self.file, span.clone()),
        }
    }

    /// Says that something is made anew under a name, so that it was made in vain at the place
    /// `earlier`. In a loop, a branch or another file that may be meant, so nothing is said there.
    pub(super) fn say_made_twice(
        &mut self,
        severity: Severity,
        name: &Name<'_>,
        (file, span): (usize, Range<usize>),
        message: impl FnOnce() -> String,
    ) {
        let in_block = self.repeating > 0 || self.depth + 1 > self.reading.len();
        let is_here = self.file == file && self.is_own();
        if !in_block && is_here && span != name.span && self.is_news(severity, &name.span) {
            let problem = Problem::new(&name.span, message())
                .hint("give one of them another name, or leave one out")
                .with_place(None, span, "first made here");
            self.tell(severity, problem);
        }
    }

    /// Says something about a place of a file, if nothing as severe was said of it; an empty hint
    /// is none.
    pub(super) fn say_at(
        &mut self,
        file: usize,
        severity: Severity,
        span: &Range<usize>,
        message: impl Display,
        hint: impl Display,
    ) {
        let before = std::mem::replace(&mut self.file, file);
        if self.is_news(severity, span) {
            let hint = Some(hint.to_string()).filter(|hint| !hint.is_empty());
            let problem = Problem::new(span, message.to_string()).maybe_hint(hint);
            self.tell(severity, problem);
        }
        self.file = before;
    }
}

/// Returns whether a command may change the picture.
pub(super) fn changes_picture(command: &Command) -> bool {
    use commands::Group;
    let Some(spec) = command.spec else {
        return false;
    };
    match spec.group() {
        Group::Run | Group::Tools => spec.is_library() || spec.name == "test",
        Group::Options => SETTINGS.contains(&spec.name),
        Group::Scene => !matches!(spec.name, "report" | "shoot" | "preview"),
        Group::Extensions => spec.name != "seed",
        _ => true,
    }
}
