//! Folding: the ranges of a text that an editor can hide.

use crate::walk;
use rats::commands::Bracket;
use rats::lexer::{TokenKind, lex};
use rats::parser::parse;
use rats::symbol::Symbols;
use std::ops::Range;

/// Finds the ranges of lines, from 0, that can be folded into their first: blocks, lists in braces,
/// objects and chains up to their `close`, and comments of several lines. Each has two lines or
/// more; they begin in different lines, come in the order of the text, and each lies within another
/// or apart from it.
///
/// ```
/// let text = "object PAIR\n  sphere Clay 1, 0 0 0\nclose\nfor i = 1 to 3 {\n}\n";
/// assert_eq!(assist::folds(text), [0..3, 3..5]);
/// ```
#[must_use]
pub fn folds(text: &str) -> Vec<Range<usize>> {
    let lines = Lines::of(text);
    let mut folds = comments(text, &lines);
    folds.extend(braces(text, &lines));
    folds.extend(objects(text, &lines));
    folds.retain(|fold| fold.len() >= 2);
    // Of those that begin in one line the longest counts.
    field::heap_sort(&mut folds, |a, b| {
        (a.start, usize::MAX - a.end) < (b.start, usize::MAX - b.end)
    });
    folds.dedup_by_key(|fold| fold.start);
    nest(folds)
}

/// Shortens ranges that would overlap: the last line of `} else {` belongs to the one that begins
/// there.
fn nest(folds: Vec<Range<usize>>) -> Vec<Range<usize>> {
    let mut kept: Vec<Range<usize>> = Vec::with_capacity(folds.len());
    let mut open: Vec<usize> = Vec::new();
    for fold in folds {
        while let Some(&outer) = open.last() {
            if kept[outer].end >= fold.end {
                break;
            }
            let shorter = kept[outer].end.min(fold.start);
            kept[outer].end = shorter;
            open.pop();
        }
        open.push(kept.len());
        kept.push(fold);
    }
    kept.retain(|fold| fold.len() >= 2);
    kept
}

/// Bytes where lines begin.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        let ends = text.match_indices('\n').map(|(end, _)| end + 1);
        Self(std::iter::once(0).chain(ends).collect())
    }

    /// Returns the line of a byte.
    fn line(&self, byte: usize) -> usize {
        self.0.partition_point(|start| *start <= byte) - 1
    }

    /// Returns the lines from one byte to another.
    fn range(&self, first: usize, last: usize) -> Range<usize> {
        self.line(first)..self.line(last) + 1
    }
}

/// Finds runs of lines that hold a comment and nothing else.
fn comments(text: &str, lines: &Lines) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (line, start) in lines.0.iter().enumerate() {
        if !text[*start..]
            .trim_start_matches([' ', '\t'])
            .starts_with('#')
        {
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.end == line => run.end += 1,
            _ => runs.push(line..line + 1),
        }
    }
    runs
}

/// Finds the lines from `{` to `}`.
fn braces(text: &str, lines: &Lines) -> Vec<Range<usize>> {
    let mut open = Vec::new();
    let mut folds = Vec::new();
    for token in lex(text) {
        if token.kind != TokenKind::Sign {
            continue;
        }
        match &text[token.range()] {
            "{" => open.push(token.start),
            "}" => folds.extend(open.pop().map(|start| lines.range(start, token.start))),
            _ => {}
        }
    }
    folds
}

/// Finds the lines from `object` or `chain` to `close`.
fn objects(text: &str, lines: &Lines) -> Vec<Range<usize>> {
    let mut symbols = Symbols::default();
    let syntax = parse(text, &mut symbols);
    let mut open = Vec::new();
    let mut folds = Vec::new();
    walk::commands(
        &syntax.block,
        &mut |command| match command.spec.and_then(|spec| spec.bracket) {
            Some(Bracket::Object | Bracket::Chain) => open.push(command.span.start),
            Some(Bracket::Close) => {
                let fold = open
                    .pop()
                    .map(|start| lines.range(start, command.span.start));
                folds.extend(fold);
            }
            _ => {}
        },
    );
    folds
}
