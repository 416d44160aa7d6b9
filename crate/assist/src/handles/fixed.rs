//! Handles that cannot be moved, and why.

use super::handle::{Editable, Handle, Kind, Moves};
use rats::Project;
use rats::parser::parse;
use rats::symbol::Symbols;
use rats::syntax::{Block, Node};
use scene::{Origin, Shape};

/// Returns the places of a shape as handles, none of which can be moved.
pub fn plain(shape: &Shape, why: &str) -> Vec<Handle> {
    let handles = shape.landmarks().into_iter().map(|(place, label)| Handle {
        kind: Kind::Point,
        place,
        label: label.to_owned(),
        edit: Editable::Fixed {
            why: why.to_owned(),
        },
        numbers: Vec::new(),
        moves: Moves::Nowhere,
    });
    handles.collect()
}

/// Returns the reason why the numbers of a command that made an element may differ from one element
/// to the next, if they may. Copies by `instance` share theirs.
pub fn why_repeated(project: &Project, origin: Origin) -> Option<String> {
    let file = project.files.get(origin.file as usize)?;
    let mut symbols = Symbols::default();
    let syntax = parse(&file.text, &mut symbols);
    let mut block = &syntax.block;
    let mut why = None;
    let at = origin.start as usize;
    'inner: loop {
        for node in block {
            let (head, inside) = match node {
                Node::Command(command) => {
                    if command.span.start == at
                        && let Some(spec) = command.spec.filter(|spec| spec.is_library())
                    {
                        why = Some(format!("is made by the library's `{}`", spec.name));
                    } else if command.span.start == at
                        && let Some(spec) = command.spec
                        && spec.reads_shape()
                    {
                        why = Some(format!("is made by `{}` from a file", spec.name));
                    } else if command.span.start == at && command.spec.is_none() {
                        why = Some(String::from("is made by a defined command"));
                    }
                    continue;
                }
                Node::For(node) => (&node.head, &node.body),
                Node::If(node) => {
                    let branch = if last_byte(&node.then) >= at {
                        &node.then
                    } else {
                        &node.otherwise
                    };
                    (&node.head, branch)
                }
                Node::Define(node) => (&node.head, &node.body),
            };
            if head.span.start <= at && at < last_byte(inside).max(head.span.end) {
                match node {
                    Node::For(_) => why = Some(String::from("is made in a loop")),
                    Node::Define(node) => {
                        let name = symbols.word(node.name);
                        why = Some(format!("is made by the defined command `{name}`"));
                    }
                    _ => {}
                }
                block = inside;
                continue 'inner;
            }
        }
        return why;
    }
}

/// Returns the end of the last command of a block: one past its last byte.
fn last_byte(block: &Block) -> usize {
    block.last().map_or(0, |node| match node {
        Node::Command(command) => command.span.end,
        Node::For(node) => last_byte(&node.body).max(node.head.span.end),
        Node::Define(node) => last_byte(&node.body).max(node.head.span.end),
        Node::If(node) => last_byte(&node.then)
            .max(last_byte(&node.otherwise))
            .max(node.head.span.end),
    })
}
