//! Which files a text asks for, so that whoever keeps files can fetch them before compiling.

use crate::parser::parse;
use crate::symbol::Symbols;
use crate::syntax::{Block, Command, Datum, Node, Syntax};
use std::ops::Range;

/// The file names after every `read` of a text, in order, wherever it stands. Nothing is run, so
/// a `read` that a condition would skip is listed too.
#[must_use]
pub fn reads(text: &str) -> Vec<String> {
    let mut symbols = Symbols::default();
    let syntax = parse(text, &mut symbols);
    let mut names = Vec::new();
    collect(&syntax.block, &syntax, text, &mut names);
    names
}

fn collect(block: &Block, syntax: &Syntax, text: &str, names: &mut Vec<String>) {
    for node in block {
        match node {
            Node::Command(command) => names_of(command, syntax, text, names),
            Node::For(each) => collect(&each.body, syntax, text, names),
            Node::If(choice) => {
                collect(&choice.then, syntax, text, names);
                collect(&choice.otherwise, syntax, text, names);
            }
            Node::Define(define) => collect(&define.body, syntax, text, names),
        }
    }
}

fn names_of(command: &Command, syntax: &Syntax, text: &str, names: &mut Vec<String>) {
    if command.spec.is_none_or(|spec| spec.name != "read") {
        return;
    }
    // As `Reader::file_name`: a name goes on as long as nothing separates its parts.
    let mut open: Option<Range<usize>> = None;
    for item in &syntax.items[command.items.clone()] {
        let separator = matches!(item.datum, Datum::Sign(b',' | b'<' | b'>'));
        match &mut open {
            Some(range) if !item.spaced && !separator => {
                *range = Range {
                    start: range.start,
                    end: item.span().end,
                }
            }
            _ => {
                names.extend(open.take().map(|range| text[range].to_owned()));
                open = (!separator).then(|| item.span());
            }
        }
    }
    names.extend(open.map(|range| text[range].to_owned()));
}

#[cfg(test)]
mod tests {
    use super::reads;

    #[test]
    fn names_are_found_wherever_read_stands() {
        let text = "read a.rat, sub/b-2.rat # not c.rat\nif 1 {\n  @READ d.rat\n}\nfor i = 1 to 2 {\n read e.rat\n}\nreadx f.rat\n";
        assert_eq!(reads(text), ["a.rat", "sub/b-2.rat", "d.rat", "e.rat"]);
    }
}
