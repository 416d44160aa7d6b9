//! What the compiler has to say about a text.
use serde::{Deserialize, Serialize};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Said for information.
    Note,
    /// Understood, but probably not what was meant, or not carried out yet.
    Warning,
    /// The command was dropped; the state before it stays.
    Error,
}

/// One message about one place of the text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in one sentence.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Byte range in that file.
    pub span: std::ops::Range<usize>,
    /// Line of the start of the span, from 1.
    pub line: usize,
    /// Column of the start of the span in characters, from 1.
    pub column: usize,
    /// What to do about it, e.g. "did you mean `sphere`?".
    pub hint: Option<String>,
    /// Other places that explain it, such as "it begins here".
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
    /// What is there.
    pub message: String,
}
