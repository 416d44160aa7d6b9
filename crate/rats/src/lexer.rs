//! Cuts a text into tokens, whose ranges cover the text from end to end.
//!
//! The lexer cannot fail; what it does not know becomes [`TokenKind::Unknown`]. It knows nothing of
//! commands either: the parser and the highlighter give the tokens their meaning.

use std::ops::Range;

/// Kinds of tokens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// White space inside a line.
    Space,
    /// The end of a line.
    Newline,
    /// `#` and the rest of the line.
    Comment,
    /// Letters, digits, `_` and `.`, not a number.
    /// (`^` is a sign, since it also is the power; names with `^` are glued together where a name
    /// is wanted.)
    Word,
    /// A decimal number without sign: `1`, `.5`, `2.`, `1e-3`.
    Number,
    /// Sign: `, < > = + - * / ^ ( ) { } @ % !`.
    Sign,
    /// Characters of no other kind.
    Unknown,
}

/// A piece of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// The kind.
    pub kind: TokenKind,
    /// The first byte.
    pub start: usize,
    /// The end: one past the last byte.
    pub end: usize,
}

impl Token {
    /// Returns the byte range.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }
}

/// Cuts a text into tokens.
#[must_use]
pub fn lex(text: &str) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(text.len() / 3);
    let mut start = 0;
    while let Some(first) = text[start..].chars().next() {
        let (kind, length) = one_token(&text[start..], first);
        tokens.push(Token {
            kind,
            start,
            end: start + length,
        });
        start += length;
    }
    tokens
}

/// Returns the length of the characters at the start that are to be kept.
fn length(rest: &str, keep: fn(char) -> bool) -> usize {
    rest.find(|c| !keep(c)).unwrap_or(rest.len())
}

/// Returns the kind and length of the token that `rest` begins with.
fn one_token(rest: &str, first: char) -> (TokenKind, usize) {
    match first {
        '\n' => (TokenKind::Newline, 1),
        '#' => (TokenKind::Comment, length(rest, |c| c != '\n')),
        // U+2212 is the minus of typeset papers, where numbers are copied from.
        ',' | '<' | '>' | '=' | '+' | '-' | '−' | '*' | '/' | '^' | '(' | ')' | '{' | '}' | '@'
        | '%' | '!' => (TokenKind::Sign, first.len_utf8()),
        _ if is_space(first) => (TokenKind::Space, length(rest, is_space)),
        '0'..='9' => number_or_word(rest),
        '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => number_or_word(rest),
        _ if is_word(first) => (TokenKind::Word, length(rest, is_word)),
        _ => (TokenKind::Unknown, length(rest, is_unknown)),
    }
}

/// Returns the kind and length of the token at a digit, or at a dot and a digit: `2nd` is a word,
/// `2` and `2e5` are numbers.
fn number_or_word(rest: &str) -> (TokenKind, usize) {
    let mut length = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
    // `1e-3`: the sign belongs to the number if all before it is a number's mantissa and an `e`.
    let bytes = rest.as_bytes();
    if matches!(bytes[length - 1], b'e' | b'E')
        && matches!(bytes.get(length), Some(b'+' | b'-'))
        && bytes.get(length + 1).is_some_and(u8::is_ascii_digit)
        && is_mantissa(&bytes[..length - 1])
    {
        length += 1;
        length += rest[length..]
            .find(|c| !is_word(c))
            .unwrap_or(rest.len() - length);
    }
    if rest[..length].parse::<f64>().is_ok() {
        (TokenKind::Number, length)
    } else {
        (TokenKind::Word, length)
    }
}

fn is_mantissa(bytes: &[u8]) -> bool {
    bytes.iter().all(|b| b.is_ascii_digit() || *b == b'.')
        && bytes.iter().filter(|b| **b == b'.').count() <= 1
}

fn is_space(c: char) -> bool {
    // A byte order mark at the start of a file is no more than space.
    c != '\n' && (c.is_whitespace() || c == '\u{feff}')
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

fn is_unknown(c: char) -> bool {
    !is_space(c) && !is_word(c) && !"\n#−,<>=+-*/^(){}@%!".contains(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(TokenKind, &str)> {
        lex(text)
            .into_iter()
            .filter(|t| t.kind != TokenKind::Space)
            .map(|t| (t.kind, &text[t.range()]))
            .collect()
    }

    #[test]
    fn numbers_and_words() {
        use TokenKind::*;
        assert_eq!(
            kinds(".034 2. 1e-3 1e5 2nd x.y 1.2.3 1e- e-3"),
            [
                (Number, ".034"),
                (Number, "2."),
                (Number, "1e-3"),
                (Number, "1e5"),
                (Word, "2nd"),
                (Word, "x.y"),
                (Word, "1.2.3"),
                (Word, "1e"),
                (Sign, "-"),
                (Word, "e"),
                (Sign, "-"),
                (Number, "3"),
            ]
        );
    }

    #[test]
    fn comments_end_with_the_line() {
        use TokenKind::*;
        assert_eq!(
            kinds("a # b {\r\n}"),
            [
                (Word, "a"),
                (Comment, "# b {\r"),
                (Newline, "\n"),
                (Sign, "}")
            ]
        );
    }

    #[test]
    fn nothing_is_lost() {
        for text in [
            "",
            "é ü\u{feff}",
            "\"x\" $$ −2",
            "..",
            ".",
            "🐚🐚 sphere",
            "\u{0}\t\n",
        ] {
            let tokens = lex(text);
            let mut end = 0;
            for token in tokens {
                assert_eq!(token.start, end);
                assert!(token.end > token.start);
                end = token.end;
            }
            assert_eq!(end, text.len());
        }
    }
}
