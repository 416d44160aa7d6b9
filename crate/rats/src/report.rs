//! Collects the messages about a text: each once, and the worst when there are too many.

use crate::diagnostic::Related;
use crate::limits::MAX_DIAGNOSTICS;
use crate::problem::Problem;
use crate::{Diagnostic, Project, Severity};
use std::collections::HashSet;
use std::ops::Range;

/// The messages of one run.
#[derive(Debug, Default)]
pub struct Report {
    messages: Vec<Message>,
    /// The places of messages: a loop meets the same place again and again, and only the first
    /// message of a place counts.
    seen: HashSet<(usize, usize, usize, usize)>,
    /// The number of messages of each severity that were kept.
    kept: [usize; 3],
    /// The number of messages of each severity that were left out.
    dropped: [usize; 3],
    /// Whether warnings are not wanted (`warning off`).
    pub no_warnings: bool,
    /// Whether notes are not wanted (`verbose off`).
    pub no_notes: bool,
}

#[derive(Debug)]
struct Message {
    file: usize,
    severity: Severity,
    problem: Box<Problem>,
}

impl Report {
    /// Adds a message about a file.
    pub fn add(&mut self, file: usize, severity: Severity, problem: Box<Problem>) {
        let rank = severity as usize;
        let place = (file, problem.span.start, problem.span.end, rank);
        if self.is_unwanted(severity)
            || problem.quiet
            || (self.seen.contains(&place) && !problem.fatal)
        {
            return;
        }
        // Places are bounded by the text's length, but a small bound keeps the memory small too.
        if self.kept[rank] >= MAX_DIAGNOSTICS {
            if self.seen.len() < 100_000 {
                self.seen.insert(place);
                self.dropped[rank] += 1;
            }
            return;
        }
        self.seen.insert(place);
        self.kept[rank] += 1;
        self.messages.push(Message {
            file,
            severity,
            problem,
        });
    }

    /// Returns whether messages of this severity are not wanted.
    fn is_unwanted(&self, severity: Severity) -> bool {
        match severity {
            Severity::Note => self.no_notes,
            Severity::Warning => self.no_warnings,
            Severity::Error => false,
        }
    }

    /// Returns whether a message of this severity about this place would say something new.
    #[must_use]
    pub fn is_new(&self, file: usize, severity: Severity, span: &Range<usize>) -> bool {
        let place = (file, span.start, span.end, severity as usize);
        !self.is_unwanted(severity) && !self.seen.contains(&place)
    }

    /// Returns whether the run was stopped before its end.
    #[must_use]
    pub fn is_cut_off(&self) -> bool {
        self.messages.iter().any(|message| message.problem.fatal)
    }

    /// Returns whether there is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.kept[Severity::Error as usize] > 0
    }

    /// Returns the messages in the order of the text: at most [`MAX_DIAGNOSTICS`], of which errors
    /// are kept before warnings, and these before notes.
    #[must_use]
    pub fn finish(mut self, project: &Project) -> Vec<Diagnostic> {
        self.messages.sort_by_key(|m| std::cmp::Reverse(m.severity));
        let mut left_out: usize = self.dropped.iter().sum();
        let mut worst = (0..3).rev().find(|rank| self.dropped[*rank] > 0);
        if left_out > 0 || self.messages.len() > MAX_DIAGNOSTICS {
            for message in self
                .messages
                .drain(MAX_DIAGNOSTICS.min(self.messages.len() + 1) - 1..)
            {
                left_out += 1;
                worst = worst.max(Some(message.severity as usize));
            }
        }
        self.messages
            .sort_by_key(|m| (m.file, m.problem.span.start, m.problem.span.end));
        let mut places = Places::new(project);
        let mut diagnostics: Vec<Diagnostic> = self
            .messages
            .into_iter()
            .map(|message| places.diagnostic(message))
            .collect();
        if left_out > 0 {
            let severity = match worst {
                Some(2) => Severity::Error,
                Some(1) => Severity::Warning,
                _ => Severity::Note,
            };
            let span = 0..0;
            diagnostics.push(places.diagnostic(Message {
                file: 0,
                severity,
                problem: Problem::new(&span, format!("… and {left_out} more messages")),
            }));
        }
        diagnostics
    }
}

/// Turns byte positions into lines and columns, going through each text once.
struct Places<'p> {
    project: &'p Project,
    file: usize,
    byte: usize,
    line: usize,
    line_start: usize,
}

impl<'p> Places<'p> {
    fn new(project: &'p Project) -> Self {
        Self {
            project,
            file: usize::MAX,
            byte: 0,
            line: 1,
            line_start: 0,
        }
    }

    /// Returns a message with its lines and columns.
    fn diagnostic(&mut self, message: Message) -> Diagnostic {
        let Message {
            file,
            severity,
            problem,
        } = message;
        let (name, text) = self.file(file);
        let span = clip(text, &problem.span);
        if file != self.file || span.start < self.byte {
            self.file = file;
            self.byte = 0;
            self.line = 1;
            self.line_start = 0;
        }
        for (index, _) in text[self.byte..span.start].match_indices('\n') {
            self.line += 1;
            self.line_start = self.byte + index + 1;
        }
        self.byte = span.start;
        let related = problem.related.iter().filter_map(|(other, span, message)| {
            let other = other.unwrap_or(file);
            if other >= self.project.files.len() {
                return None;
            }
            let (name, text) = self.file(other);
            let span = clip(text, span);
            let before = &text[..span.start];
            let line_start = before.rfind('\n').map_or(0, |at| at + 1);
            Some(Related {
                file: name.to_owned(),
                line: before.matches('\n').count() + 1,
                column: before[line_start..].chars().count() + 1,
                span,
                message: message.clone(),
            })
        });
        Diagnostic {
            severity,
            related: related.collect(),
            command: problem.command.map(str::to_owned),
            message: problem.message,
            file: name.to_owned(),
            column: text[self.line_start..span.start].chars().count() + 1,
            line: self.line,
            span,
            hint: problem.hint,
            fix: problem.fix,
        }
    }

    /// Returns the name and text of a file.
    fn file(&self, file: usize) -> (&'p str, &'p str) {
        self.project
            .files
            .get(file)
            .map_or(("", ""), |f| (f.name.as_str(), f.text.as_str()))
    }
}

/// Clips a range to the text and widens it to character boundaries.
fn clip(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(span.start.min(text.len()));
    let end = text.ceil_char_boundary(span.end.clamp(start, text.len()));
    start..end
}
