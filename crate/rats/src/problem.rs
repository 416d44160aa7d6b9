//! A mistake in one command, before it becomes a [`crate::Diagnostic`].

use crate::TextEdit;
use std::ops::Range;

/// Why a command was dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The place in the file that is being run.
    pub span: Range<usize>,
    /// The mistake in one sentence.
    pub message: String,
    /// Advice.
    pub hint: Option<String>,
    /// A change of the text that does what the hint says.
    pub fix: Option<TextEdit>,
    /// Places that explain it: the file (`None` for the same), the place, what it is.
    pub related: Vec<(Option<usize>, Range<usize>, String)>,
    /// The command it is about.
    pub command: Option<&'static str>,
    /// Whether the run ends here (a limit was met).
    pub fatal: bool,
    /// Whether nothing is said, because an error that was already reported caused this one.
    pub quiet: bool,
}

/// Boxed so that the many results that pass through the reader stay small.
pub type Outcome<T> = Result<T, Box<Problem>>;

impl Problem {
    /// Makes a problem without a hint.
    pub fn new(span: &Range<usize>, message: impl Into<String>) -> Box<Self> {
        Box::new(Self {
            span: span.clone(),
            message: message.into(),
            hint: None,
            fix: None,
            related: Vec::new(),
            command: None,
            fatal: false,
            quiet: false,
        })
    }

    /// Makes the follow-up of an error that was reported already, which is not reported.
    pub fn follow_up(span: &Range<usize>) -> Box<Self> {
        let mut problem = Self::new(span, String::new());
        problem.quiet = true;
        problem
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self: Box<Self>, hint: impl Into<String>) -> Box<Self> {
        self.hint = Some(hint.into());
        self
    }

    /// Adds a hint, if there is one.
    #[must_use]
    pub fn maybe_hint(mut self: Box<Self>, hint: Option<String>) -> Box<Self> {
        self.hint = hint;
        self
    }

    /// Adds a change of the text that does what the hint says.
    #[must_use]
    pub fn fix(mut self: Box<Self>, fix: TextEdit) -> Box<Self> {
        self.fix = Some(fix);
        self
    }

    /// Adds another place that explains it.
    #[must_use]
    pub fn with_place(
        mut self: Box<Self>,
        file: Option<usize>,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> Box<Self> {
        self.related.push((file, span, message.into()));
        self
    }

    /// Makes it end the run.
    #[must_use]
    pub fn fatal(mut self: Box<Self>) -> Box<Self> {
        self.fatal = true;
        self
    }
}
