//! Finds what is made further down in a text, for hints about what is used too soon.

use crate::Project;
use crate::reader::Name;
use crate::syntax::{Block, Command, Node, Syntax};

/// The line of the first command after `name` that makes a material of that name in the same file.
pub fn line_of_material(
    syntaxes: &[Syntax],
    project: &Project,
    file: usize,
    name: &Name<'_>,
) -> Option<usize> {
    let syntax = syntaxes.get(file)?;
    let text = &project.files.get(file)?.text;
    let makes = |command: &Command| {
        let item = syntax.items.get(command.items.start);
        command.span.start > name.span.end
            && !command.items.is_empty()
            && command
                .spec
                .is_some_and(|spec| matches!(spec.name, "surface" | "material"))
            && item.is_some_and(|item| &text[item.span()] == name.text)
    };
    let command = find(&syntax.block, &makes)?;
    Some(text[..command.span.start].matches('\n').count() + 1)
}

/// The first command with a property.
fn find<'s>(block: &'s Block, property: &dyn Fn(&Command) -> bool) -> Option<&'s Command> {
    block.iter().find_map(|node| match node {
        Node::Command(command) => property(command).then_some(command),
        Node::For(node) => find(&node.body, property),
        Node::If(node) => find(&node.then, property).or_else(|| find(&node.otherwise, property)),
        Node::Define(node) => find(&node.body, property),
    })
}
