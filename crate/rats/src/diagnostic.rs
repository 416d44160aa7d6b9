//! Diagnostics: messages of the compiler about a text.

use crate::TextEdit;
use serde::{Deserialize, Serialize};

/// Severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Information.
    Note,
    /// Understood, but probably not what was meant, or not carried out yet.
    Warning,
    /// The command was dropped; the state before it stays.
    Error,
}

/// Message about one place of the text.
///
/// ```
/// use rats::{Project, Severity, compile};
///
/// let text = "sphere Clay 1, 0 0 0\n";
/// let diagnostics = compile(&Project::single(text)).diagnostics;
/// let first = &diagnostics[0];
/// assert_eq!(first.severity, Severity::Error);
/// assert_eq!((first.line, first.column, &text[first.span.clone()]), (1, 8, "Clay"));
/// assert_eq!(first.command.as_deref(), Some("sphere"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// The severity.
    pub severity: Severity,
    /// The mistake in one sentence.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Byte range in that file.
    pub span: std::ops::Range<usize>,
    /// Line of the start of the span, from 1.
    pub line: usize,
    /// Column of the start of the span in characters, from 1.
    pub column: usize,
    /// Advice, e.g. "did you mean `sphere`?".
    pub hint: Option<String>,
    /// A change of the text that does what the hint says, if one is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fix: Option<TextEdit>,
    /// Places that explain it, such as "it begins here".
    #[serde(default)]
    pub related: Vec<Related>,
    /// The command it is about, whose manual explains more.
    #[serde(default)]
    pub command: Option<String>,
}

/// A place that explains a message.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Related {
    /// Name of the file.
    pub file: String,
    /// Byte range in that file.
    pub span: std::ops::Range<usize>,
    /// Line of the start of the span, from 1.
    pub line: usize,
    /// Column of the start of the span in characters, from 1.
    pub column: usize,
    /// A few words on that place.
    pub message: String,
}
