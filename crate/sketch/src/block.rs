//! The text of a `skeleton` command: where its nodes and curves are written.

use rats::lexer::{Token, TokenKind, lex};
use std::ops::Range;

/// A `node` of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeText {
    /// The name.
    pub name: String,
    /// The whole node, with its radius.
    pub span: Range<usize>,
    /// The radius, if the node has one of its own.
    pub radius: Option<Range<usize>>,
}

/// A `curve` of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveText {
    /// Names of its nodes.
    pub names: Vec<(String, Range<usize>)>,
    /// The whole curve.
    pub span: Range<usize>,
}

/// The block of a `skeleton` command. All places are bytes of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The nodes, in the order of the text.
    pub nodes: Vec<NodeText>,
    /// The curves, in the order of the text.
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
        // No node may have such a word as its name.
        let starts = (0..inside.len()).filter(|i| {
            let (token, word) = (&inside[*i], word(&inside[*i]));
            let begins_item = ["node", "curve"]
                .iter()
                .any(|name| word.eq_ignore_ascii_case(name));
            token.kind == TokenKind::Word && begins_item
        });
        let starts: Vec<usize> = starts.collect();
        for (i, &start) in starts.iter().enumerate() {
            let end = starts.get(i + 1).copied().unwrap_or(inside.len());
            let item = &inside[start..end];
            let span = item[0].start..item[item.len() - 1].end;
            if word(&item[0]).eq_ignore_ascii_case("node") {
                let mut rest = item.iter().skip(2);
                let at = rest.position(|token| word(token).eq_ignore_ascii_case("radius"));
                let radius = at.and_then(|at| Some(item.get(at + 3)?.start..span.end));
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
