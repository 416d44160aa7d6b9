//! The word that is being typed: it is no mistake before it is there.

use rats::Diagnostic;
use std::ops::Range;

/// The word around a caret.
pub(crate) struct Word {
    /// The bytes of it.
    bytes: Range<usize>,
    /// The number of its line, from 1, if nothing follows the caret there: then operands may be
    /// missing, too.
    unfinished: Option<usize>,
}

impl Word {
    /// Finds the word at a byte of a text.
    pub(crate) fn at(text: &str, byte: usize) -> Self {
        let byte = text.floor_char_boundary(byte);
        let (before, after) = text.split_at(byte);
        let start = before.rfind(is_between).map_or(0, |at| {
            at + before[at..].chars().next().map_or(0, char::len_utf8)
        });
        let end = byte + after.find(is_between).unwrap_or(after.len());
        let rest = after.split('\n').next().unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        Self {
            bytes: start..end,
            unfinished: rest.trim().is_empty().then_some(line),
        }
    }

    /// Whether a message of the word's file is about it, or about operands that may follow.
    pub(crate) fn is_meant(&self, message: &Diagnostic) -> bool {
        let Range { start, end } = message.span;
        let touches = start <= self.bytes.end && self.bytes.start <= end;
        touches || message.command.is_some() && self.unfinished == Some(message.line)
    }
}

/// Whether a character stands between words.
fn is_between(letter: char) -> bool {
    letter.is_whitespace() || ",()[]{}<>".contains(letter)
}
