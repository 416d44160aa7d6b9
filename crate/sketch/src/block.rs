//! The text of a `skeleton` command: where its nodes and curves are written.

use rats::lexer::{Token, TokenKind, lex};
use std::ops::Range;

/// A `node` of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeText {
    /// Its name.
    pub name: String,
    /// All of it, with its radius.
    pub span: Range<usize>,
    /// Its radius, if it has one of its own.
    pub radius: Option<Range<usize>>,
}

/// A `curve` of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveText {
    /// Names of its nodes.
    pub names: Vec<(String, Range<usize>)>,
    /// All of it.
    pub span: Range<usize>,
}

/// The block of a `skeleton` command. All places are bytes of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Its nodes, in the order of the text.
    pub nodes: Vec<NodeText>,
    /// Its curves, in the order of the text.
    pub curves: Vec<CurveText>,
    /// The `}` at its end.
    pub close: usize,
}

impl Block {
    /// Reads the block of the command at `span` of a file. `None` if there is none, or it is no
    /// `skeleton`.
    #[must_use]
    pub fn read(text: &str, span: Range<usize>) -> Option<Self> {
        let command = text.get(span.clone())?;
        let tokens: Vec<Token> = lex(command)
            .into_iter()
            .map(|token| Token {
                start: token.start + span.start,
                end: token.end + span.start,
                ..token
            })
            .filter(|token| !matches!(token.kind, TokenKind::Space | TokenKind::Newline))
            .filter(|token| token.kind != TokenKind::Comment)
            .collect();
        let word = |token: &Token| &text[token.range()];
        if !word(tokens.first()?).eq_ignore_ascii_case("skeleton") {
            return None;
        }
        let open = tokens.iter().position(|token| word(token) == "{")?;
        let close = tokens.iter().rposition(|token| word(token) == "}")?;
        let inside = tokens.get(open + 1..close)?;
        let mut block = Self {
            nodes: Vec::new(),
            curves: Vec::new(),
            close: tokens[close].start,
        };
        let begins = |token: &Token| {
            let word = word(token);
            let is = |name| word.eq_ignore_ascii_case(name);
            token.kind == TokenKind::Word && (is("node") || is("curve"))
        };
        // No node may be called as such a word.
        let starts: Vec<usize> = (0..inside.len()).filter(|i| begins(&inside[*i])).collect();
        for (i, &start) in starts.iter().enumerate() {
            let end = starts.get(i + 1).copied().unwrap_or(inside.len());
            let item = &inside[start..end];
            let span = item[0].start..item[item.len() - 1].end;
            if word(&item[0]).eq_ignore_ascii_case("node") {
                let own = |t: &&Token| word(t).eq_ignore_ascii_case("radius");
                let at = item.iter().skip(2).position(|t| own(&t)).map(|at| at + 2);
                let radius = at.and_then(|at| Some(item.get(at + 1)?.start..span.end));
                block.nodes.push(NodeText {
                    name: word(item.get(1)?).to_owned(),
                    span,
                    radius,
                });
            } else {
                let names = item[1..].iter().filter(|t| word(t) != ",");
                block.curves.push(CurveText {
                    names: names.map(|t| (word(t).to_owned(), t.range())).collect(),
                    span,
                });
            }
        }
        Some(block)
    }

    /// The index of a node.
    #[must_use]
    pub fn node(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.name == name)
    }
}
