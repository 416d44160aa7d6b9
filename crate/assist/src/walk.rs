//! Goes through the commands of a parsed text in the order of the text.

use rats::syntax::{Block, Command, Define, For, If, Node};

/// An event of a walk through a text.
#[derive(Clone, Copy, Debug)]
pub enum Event<'s> {
    /// A plain command.
    Command(&'s Command),
    /// A loop begins; its body follows.
    For(&'s For),
    /// A choice; its branches follow.
    If(&'s If),
    /// A branch of a choice begins.
    Branch,
    /// The definition of a command begins; its body follows.
    Define(&'s Define),
    /// The structure or branch that began last ends.
    End,
}

impl<'s> Event<'s> {
    /// Returns the command, or the head of the structure.
    pub fn command(self) -> Option<&'s Command> {
        match self {
            Self::Command(command) => Some(command),
            Self::For(node) => Some(&node.head),
            Self::If(node) => Some(&node.head),
            Self::Define(node) => Some(&node.head),
            Self::Branch | Self::End => None,
        }
    }
}

/// Returns the events of a walk through a block.
pub fn events(block: &Block) -> Vec<Event<'_>> {
    let mut events = Vec::new();
    collect(block, &mut events);
    events
}

fn collect<'s>(block: &'s Block, events: &mut Vec<Event<'s>>) {
    for node in block {
        match node {
            Node::Command(command) => events.push(Event::Command(command)),
            Node::For(node) => {
                events.push(Event::For(node));
                collect(&node.body, events);
                events.push(Event::End);
            }
            Node::If(node) => {
                events.push(Event::If(node));
                for branch in [&node.then, &node.otherwise] {
                    events.push(Event::Branch);
                    collect(branch, events);
                    events.push(Event::End);
                }
            }
            Node::Define(node) => {
                events.push(Event::Define(node));
                collect(&node.body, events);
                events.push(Event::End);
            }
        }
    }
}

/// Calls `visit` for every command and every head of a structure, in the order of the text.
pub fn commands<'s>(block: &'s Block, visit: &mut impl FnMut(&'s Command)) {
    for event in events(block) {
        event.command().into_iter().for_each(&mut *visit);
    }
}
