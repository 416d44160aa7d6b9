//! Messages of the evaluator, and where they are shown: those about the library and its examples go
//! to the place of the user's text that uses them.

use super::state::Evaluator;
use crate::Severity;
use crate::commands;
use crate::problem::Problem;
use crate::reader::Name;
use crate::syntax::Command;
use std::ops::Range;

impl Evaluator<'_> {
    /// Adds a message about the present file. One about the library goes to where it was used.
    pub(super) fn tell(&mut self, severity: Severity, mut problem: Box<Problem>) {
        if self.is_own() {
            // An error in a defined command: say also who called it.
            if severity == Severity::Error
                && let Some((file, span)) = self.uses.last()
                && self.scope.calls() > 0
            {
                problem = problem.related(Some(*file), span.clone(), "called here");
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

    /// Adds a message that is no error; it is made only if it is the first about its place.
    pub(super) fn say(
        &mut self,
        severity: Severity,
        span: Range<usize>,
        message: impl FnOnce() -> (String, Option<String>),
    ) {
        if self.is_news(severity, &span) {
            let (message, hint) = message();
            let problem = Problem::new(span, message).maybe_hint(hint);
            self.tell(severity, problem);
        }
    }

    /// Whether a message about this place would be the first, and wanted.
    pub(super) fn is_news(&self, severity: Severity, span: &Range<usize>) -> bool {
        let (file, place) = match self.uses.last() {
            Some((file, place)) if !self.is_own() => (*file, place),
            _ => (self.file, span),
        };
        self.report.is_new(file, severity, place)
    }

    /// Tells that something is made anew under a name, so that what was made `earlier` was in vain.
    /// In a loop, a branch or another file that may be meant, so nothing is said there.
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
            let problem = Problem::new(name.span.clone(), message())
                .hint("give one of them another name, or leave one out")
                .related(None, span, "first made here");
            self.tell(severity, problem);
        }
    }

    /// As [`Self::say`], about another file.
    pub(super) fn say_at(
        &mut self,
        file: usize,
        severity: Severity,
        span: Range<usize>,
        message: impl FnOnce() -> (String, Option<String>),
    ) {
        let before = std::mem::replace(&mut self.file, file);
        self.say(severity, span, message);
        self.file = before;
    }

    pub(super) fn tell_after_shot(&mut self, command: &Command) {
        use commands::Group;
        if self.shot.is_none() || self.told_after_shot {
            return;
        }
        let Some(spec) = command.spec else { return };
        let changes = match spec.group() {
            Group::Run | Group::Tools => spec.is_library() || spec.name == "test",
            Group::Options => matches!(
                spec.name,
                "soft"
                    | "double"
                    | "gamma"
                    | "framesize"
                    | "contrast"
                    | "fragile"
                    | "sample"
                    | "mesh"
                    | "penumbra"
                    | "epsilon"
                    | "vanish"
                    | "maxdepth"
            ),
            Group::Scene => spec.name != "report",
            Group::Extensions => spec.name != "seed",
            _ => true,
        };
        if changes {
            self.told_after_shot = true;
            self.say(Severity::Warning, command.word_span.clone(), || {
                (
                    String::from(
                        "what follows the first `shoot` is not in the picture in this version",
                    ),
                    Some(String::from("put `shoot` last")),
                )
            });
        }
    }
}
