//! Colours for the editor.

use rats::colours;
use rats::commands::{self, Kind, OptionSpec, options};
use rats::functions;
use rats::lexer::{Token, TokenKind as Lexeme, lex};
use std::ops::Range;

/// Kinds of pieces of text, for colouring them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A known command word.
    Command,
    /// A known option word.
    Option,
    /// A number.
    Number,
    /// A colour's name.
    Colour,
    /// A user's name or other word.
    Name,
    /// A comment.
    Comment,
    /// Operators, braces and other signs.
    Sign,
}

/// Cuts a text into coloured pieces, in order, without overlaps; gaps are white space.
///
/// A word is judged by its place and spelling alone, nothing is run, so a variable that is called
/// like an option may get the option's colour.
///
/// ```
/// use assist::highlight::{TokenKind, highlight};
///
/// let pieces = highlight("light White # lamp");
/// let kinds: Vec<_> = pieces.into_iter().map(|(_, kind)| kind).collect();
/// assert_eq!(kinds, [TokenKind::Command, TokenKind::Colour, TokenKind::Comment]);
/// ```
#[must_use]
pub fn highlight(text: &str) -> Vec<(Range<usize>, TokenKind)> {
    let tokens = lex(text);
    let mut pieces = Vec::with_capacity(tokens.len());
    let mut state = State::default();
    for token in tokens {
        let kind = match token.kind {
            Lexeme::Space => continue,
            Lexeme::Newline => {
                state.newline();
                continue;
            }
            Lexeme::Comment => TokenKind::Comment,
            Lexeme::Number => {
                state.word_seen = true;
                TokenKind::Number
            }
            Lexeme::Unknown => {
                state.word_seen = true;
                TokenKind::Name
            }
            Lexeme::Sign => {
                state.sign(&text[token.range()]);
                TokenKind::Sign
            }
            Lexeme::Word => state.word(text, token),
        };
        pieces.push((token.range(), kind));
    }
    pieces
}

/// State of the highlighter within a command.
#[derive(Debug, Default)]
struct State {
    /// Whether the command's word has been seen.
    word_seen: bool,
    /// Whether the command begins a block, so that its `{` does.
    is_block: bool,
    /// The braces that are open: whether each is a block of commands.
    braces: Vec<bool>,
    options: &'static [OptionSpec],
}

impl State {
    fn newline(&mut self) {
        // Inside a list the command goes on in the next line.
        if self.braces.last().is_none_or(|is_block| *is_block) {
            self.word_seen = false;
            self.options = &[];
        }
    }

    fn sign(&mut self, sign: &str) {
        match sign {
            "{" => {
                let is_block = self.is_block;
                self.braces.push(is_block);
                if is_block {
                    self.word_seen = false;
                    self.is_block = false;
                }
            }
            // After a block the next command begins; after a list the command goes on.
            "}" if self.braces.pop().unwrap_or(true) => {
                self.word_seen = false;
                self.options = &[];
            }
            _ => {}
        }
    }

    fn word(&mut self, text: &str, token: Token) -> TokenKind {
        let word = &text[token.range()];
        if !self.word_seen {
            self.word_seen = true;
            let Some(spec) = commands::find(word) else {
                self.is_block = false;
                self.options = &[];
                return TokenKind::Name;
            };
            self.is_block = spec.is_structure();
            self.options = spec.options;
            // `else if` is a command after a command.
            let first = spec.parameters.first();
            self.word_seen = first.is_none_or(|first| !matches!(first.kind, Kind::Block));
            return TokenKind::Command;
        }
        // One or two letters are more often a name.
        if word.len() > 2 && is_in(self.options, word) {
            return TokenKind::Option;
        }
        let is_texture = std::ptr::eq(self.options, options::TEXTURE_OPTIONS);
        let methods = [options::TARGETS, options::SOLIDS, options::MAPPINGS];
        if is_texture && methods.into_iter().any(|list| is_in(list, word)) {
            return TokenKind::Option;
        }
        let plain = ["hot", "on", "off", "to", "step", "and", "or", "not", "one"];
        if plain.iter().any(|p| p.eq_ignore_ascii_case(word)) || functions::find(word).is_some() {
            return TokenKind::Option;
        }
        if colours::find(word).is_some() {
            return TokenKind::Colour;
        }
        TokenKind::Name
    }
}

/// Returns whether a word stands for an option of a list, whole or shortened.
fn is_in(list: &[OptionSpec], word: &str) -> bool {
    list.iter().filter(|option| option.begins(word)).count() == 1
        || list.iter().any(|o| o.name.eq_ignore_ascii_case(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(&str, TokenKind)> {
        highlight(text)
            .into_iter()
            .map(|(range, kind)| (&text[range], kind))
            .collect()
    }

    #[test]
    fn a_surface() {
        use TokenKind::*;
        assert_eq!(
            kinds("@surface { s1, diff Red\n rad .5 } # soft"),
            [
                ("@", Sign),
                ("surface", Command),
                ("{", Sign),
                ("s1", Name),
                (",", Sign),
                ("diff", Option),
                ("Red", Colour),
                ("rad", Option),
                (".5", Number),
                ("}", Sign),
                ("# soft", Comment),
            ]
        );
    }

    #[test]
    fn blocks() {
        use TokenKind::*;
        let text = "for i = 1 to 3 {\nif i < 2 { sphere s 1 P } else { quit } }\nsphere";
        let commands: Vec<_> = kinds(text)
            .into_iter()
            .filter(|(_, kind)| *kind == Command)
            .map(|(word, _)| word)
            .collect();
        assert_eq!(commands, ["for", "if", "sphere", "else", "quit", "sphere"]);
    }
}
