//! Commands that a run does not reach (in a branch not taken, in a defined command that is never
//! called) are looked at all the same: one that is nowhere defined is a mistake. What follows a
//! plain `return` or `quit` is not: published datasets keep notes and programs there.

use super::state::Evaluator;
use crate::Severity;
use crate::commands;
use crate::problem::Problem;
use crate::symbol::Symbol;
use crate::syntax::{Block, Command, Node};
use std::collections::HashSet;

/// Most unknown commands that are reported; a text that is no dataset has thousands.
const MOST: usize = 100;

impl<'a> Evaluator<'a> {
    /// Reports each command of the project's texts that is neither of the language nor defined
    /// anywhere.
    pub(super) fn check_words(&mut self) {
        let mut defined = HashSet::new();
        for source in &self.sources.all {
            definitions(&source.syntax.block, &mut defined);
        }
        let sources = self.sources;
        let mut left = MOST;
        for (file, source) in sources.all[..sources.own].iter().enumerate() {
            let mut unknown: Vec<&'a Command> = Vec::new();
            collect(&source.syntax.block, &defined, &mut unknown);
            for command in unknown {
                let is_new = self
                    .report
                    .is_new(file, Severity::Error, &command.word_span);
                if left == 0 || !is_new {
                    continue;
                }
                left -= 1;
                let word = self.scope.symbols.word(command.word);
                let names = defined
                    .iter()
                    .map(|symbol| self.scope.symbols.word(*symbol));
                let problem =
                    Problem::new(&command.word_span, format!("there is no command `{word}`"))
                        .maybe_hint(commands::suggestion(word, names));
                self.report.add(file, Severity::Error, problem);
            }
        }
    }
}

fn definitions(block: &Block, names: &mut HashSet<Symbol>) {
    for node in block {
        match node {
            Node::Command(_) => {}
            Node::For(node) => definitions(&node.body, names),
            Node::If(node) => {
                definitions(&node.then, names);
                definitions(&node.otherwise, names);
            }
            Node::Define(node) => {
                names.insert(node.name);
                definitions(&node.body, names);
            }
        }
    }
}

fn collect<'a>(block: &'a Block, defined: &HashSet<Symbol>, unknown: &mut Vec<&'a Command>) {
    for node in block {
        match node {
            Node::Command(command) => match command.spec {
                Some(spec) if matches!(spec.name, "return" | "quit") => return,
                None if !defined.contains(&command.word) => unknown.push(command),
                _ => {}
            },
            Node::For(node) => collect(&node.body, defined, unknown),
            Node::If(node) => {
                collect(&node.then, defined, unknown);
                collect(&node.otherwise, defined, unknown);
            }
            Node::Define(node) => collect(&node.body, defined, unknown),
        }
    }
}
