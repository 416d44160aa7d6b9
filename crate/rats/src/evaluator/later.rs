//! Finds materials that are made further down in a text, for hints about materials that are used
//! too soon.

use crate::reader::Name;
use crate::sources::Source;
use crate::syntax::{Block, Command, Node};
use std::ops::Range;

/// Finds the place of the first command after `name` that makes a material of that name in the same
/// file.
pub fn place_of_material(source: &Source<'_>, name: &Name<'_>) -> Option<Range<usize>> {
    let command = find(&source.syntax.block, &|command| {
        let item = source.syntax.items.get(command.items.start);
        command.span.start > name.span.end
            && !command.items.is_empty()
            && command
                .spec
                .is_some_and(|spec| matches!(spec.name, "surface" | "material"))
            && item.is_some_and(|item| &source.text[item.span()] == name.text)
    })?;
    Some(source.syntax.items[command.items.start].span())
}

/// Finds the first command of a block, or of the blocks in it, that has a property.
pub fn find<'s>(block: &'s Block, property: &dyn Fn(&Command) -> bool) -> Option<&'s Command> {
    block.iter().find_map(|node| match node {
        Node::Command(command) => property(command).then_some(command),
        Node::For(node) => find(&node.body, property),
        Node::If(node) => find(&node.then, property).or_else(|| find(&node.otherwise, property)),
        Node::Define(node) => find(&node.body, property),
    })
}
