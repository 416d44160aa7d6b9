//! The texts of one run: those of the project, and what they use of the library and of the examples
//! in the table of commands.

use crate::commands;
use crate::library;
use crate::parser;
use crate::project::Project;
use crate::symbol::Symbols;
use crate::syntax::{Block, Command, Datum, Node, Syntax};
use std::collections::HashSet;

/// A text of the run.
#[derive(Debug)]
pub struct Source<'a> {
    /// The file's name, or `test NAME` for an example.
    pub name: String,
    /// The text.
    pub text: &'a str,
    /// The commands.
    pub syntax: Syntax,
}

/// The texts of a run; the project's come first.
#[derive(Debug)]
pub struct Sources<'a> {
    /// The texts.
    pub all: Vec<Source<'a>>,
    /// The number of them that are the project's.
    pub own: usize,
}

impl<'a> Sources<'a> {
    /// Parses a project and all that it may use.
    pub fn of(project: &'a Project, symbols: &mut Symbols<'a>) -> Self {
        let mut sources = Self {
            all: Vec::new(),
            own: project.files.len(),
        };
        for file in &project.files {
            sources.add(file.name.clone(), &file.text, symbols);
        }
        let mut known = HashSet::new();
        let mut next = 0;
        while next < sources.all.len() {
            let mut wanted = Vec::new();
            let source = &sources.all[next];
            add_names(&source.syntax.block, source, &mut wanted);
            for name in wanted {
                if known.contains(&name) {
                    continue;
                }
                let text = match name.strip_prefix("test ") {
                    Some(command) => commands::find(command).map(|spec| spec.example),
                    None => library::find(&name),
                };
                if let Some(text) = text {
                    sources.add(name.clone(), text, symbols);
                }
                known.insert(name);
            }
            next += 1;
        }
        sources
    }

    fn add(&mut self, name: String, text: &'a str, symbols: &mut Symbols<'a>) {
        let run = if crate::is_strokes(&name) { "" } else { text };
        let syntax = parser::parse(run, symbols);
        self.all.push(Source { name, text, syntax });
    }

    /// Finds the index of a file; one of the project hides one of the library of the same name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<usize> {
        self.all.iter().position(|source| source.name == name)
    }

    /// Finds the index of a file of the library, or of an example (`test NAME`).
    #[must_use]
    pub fn find_built_in(&self, name: &str) -> Option<usize> {
        let mut built_in = self.all[self.own..].iter();
        Some(self.own + built_in.position(|source| source.name == name)?)
    }
}

/// Adds the names of the texts that the commands of a block may use.
fn add_names(block: &Block, source: &Source<'_>, names: &mut Vec<String>) {
    for node in block {
        match node {
            Node::Command(command) => add_names_of(command, source, names),
            Node::For(node) => add_names(&node.body, source, names),
            Node::If(node) => {
                add_names(&node.then, source, names);
                add_names(&node.otherwise, source, names);
            }
            Node::Define(node) => add_names(&node.body, source, names),
        }
    }
}

/// Adds the names of the texts that a command may use.
fn add_names_of(command: &Command, source: &Source<'_>, names: &mut Vec<String>) {
    let Some(spec) = command.spec else { return };
    if spec.is_library() {
        names.push(format!("{}.rat", spec.name));
    }
    if spec.name == "test"
        && let Some(item) = source.syntax.items[command.items.clone()].first()
        && let Datum::Word(_) = item.datum
    {
        let word = source.text[item.span()].to_ascii_lowercase();
        names.push(format!("test {word}"));
    }
    if spec.name == "read" {
        // Few texts read the library by name, so a look at the plain text will do.
        let text = &source.text[command.span.clone()];
        for (file, _) in library::FILES {
            if text.contains(file) {
                names.push((*file).to_owned());
            }
        }
    }
}
