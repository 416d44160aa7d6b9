//! Goes through the commands of a parsed text in the order of the text.

use crate::syntax::{Block, Command, Node};

/// Calls `visit` for every command and every head of a structure, in the order of the text.
pub fn commands<'s>(block: &'s Block, visit: &mut impl FnMut(&'s Command)) {
    for node in block {
        match node {
            Node::Command(command) => visit(command),
            Node::For(node) => {
                visit(&node.head);
                commands(&node.body, visit);
            }
            Node::If(node) => {
                visit(&node.head);
                commands(&node.then, visit);
                commands(&node.otherwise, visit);
            }
            Node::Define(node) => {
                visit(&node.head);
                commands(&node.body, visit);
            }
        }
    }
}

/// The name of a command that the language knows, as the table spells it.
pub fn name(command: &Command) -> Option<&'static str> {
    command.spec.map(|spec| spec.name)
}
