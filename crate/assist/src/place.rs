//! The place of the caret: the word there, and the part of the command that it is in.

use crate::index::Here;
use crate::slots::{Slot, Want};
use rats::commands::OptionSpec;
use rats::lexer::{Token, TokenKind, lex};
use std::ops::Range;

/// Returns whether a byte is a place in a text, between two characters.
pub fn is_in(text: &str, byte: usize) -> bool {
    text.is_char_boundary(byte)
}

/// Returns whether a byte is in a comment.
pub fn in_comment(text: &str, byte: usize) -> bool {
    let line = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    text[line..byte].contains('#')
}

/// Returns whether a character can be part of a word or number.
fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

/// Finds the word that a byte is in or at the end of; empty if there is none.
pub fn word(text: &str, byte: usize) -> Range<usize> {
    let before = text[..byte].trim_end_matches(is_word).len();
    let after = &text[byte..];
    let length = after.len() - after.trim_start_matches(is_word).len();
    before..byte + length
}

/// Returns whether a command begins at a byte, as far as the text before it shows.
pub fn begins_command(text: &str, byte: usize) -> bool {
    let before = text[..byte]
        .trim_end_matches(|c: char| c == '@' || c == '\u{feff}' || c.is_whitespace() && c != '\n');
    before.is_empty() || before.ends_with(['\n', '{', '}'])
}

impl<'p> Here<'p> {
    /// Finds the operand that a byte is in or at the end of.
    pub fn slot(&self, byte: usize) -> Option<&(Range<usize>, Slot<'p>)> {
        let mut operands = self.operands.iter().rev();
        operands.find(|(span, _)| span.start <= byte && byte <= span.end)
    }

    /// Finds the parameter that a byte belongs to, with its index and option: that of the operand
    /// there, else the one that could come next.
    pub fn active(&self, byte: usize) -> Option<Active> {
        if let Some((_, slot)) = self.slot(byte)
            && slot.parameter.is_some()
        {
            return Some(Active {
                index: slot.index,
                option: slot.option,
            });
        }
        self.wants.iter().find_map(|want| match want {
            Want::Parameter { index, option, .. } => Some(Active {
                index: *index,
                option: *option,
            }),
            // In the middle of an expression: of the operand that it began with.
            Want::Value => {
                let mut before = self.operands.iter().rev();
                let (_, slot) = before.find(|(span, _)| span.end <= byte)?;
                slot.parameter.is_some().then_some(Active {
                    index: slot.index,
                    option: slot.option,
                })
            }
            _ => None,
        })
    }
}

/// The parameter of the command whose turn it is at the caret.
#[derive(Clone, Copy, Debug)]
pub struct Active {
    /// The index of the parameter.
    pub index: usize,
    /// The option it belongs to.
    pub option: Option<&'static OptionSpec>,
}

/// Finds the word or number of a piece of text that a byte is in or at the end of.
pub fn token(text: &str, span: Range<usize>, byte: usize) -> Option<Token> {
    let inside = lex(&text[span.clone()]).into_iter().map(|token| Token {
        kind: token.kind,
        start: token.start + span.start,
        end: token.end + span.start,
    });
    inside
        .filter(|t| matches!(t.kind, TokenKind::Word | TokenKind::Number))
        .rfind(|t| t.start <= byte && byte <= t.end)
}
