//! Finds what names mean as the evaluator does, but without running anything.
//!
//! Materials, textures, objects, commands and files have one name each for the whole project.
//! Variables are those of the whole project, of a loop, or of a defined command. A variable belongs
//! to whoever runs the text, so where it cannot be told which of two is meant (a command that sets
//! a variable only sometimes, or is called in a loop whose variable it uses), the two count as one;
//! then renaming both keeps the meaning.

mod command;
mod here;
mod state;
mod variables;

use crate::index::{Index, SymbolKind};
use crate::walk::{self, Event};
use rats::Project;
use rats::parser::parse;
use rats::symbol::Symbols;
use rats::syntax::{Block, Node, Syntax};
use state::{Open, Resolver};
use std::collections::HashSet;

impl<'p> Index<'p> {
    /// Indexes a project.
    #[must_use]
    pub fn of(project: &'p Project) -> Self {
        Self::at(project, None)
    }

    /// Indexes a project and looks closer at the command at a place.
    pub(crate) fn at(project: &'p Project, place: Option<(usize, usize)>) -> Self {
        let mut symbols = Symbols::default();
        let syntaxes: Vec<Syntax> = project
            .files
            .iter()
            .map(|file| parse(&file.text, &mut symbols))
            .collect();
        let mut index = resolve(project, &syntaxes, &symbols, place);
        let mistakes = syntaxes.iter().enumerate();
        index.mistake = index
            .mistake
            .or(mistakes.into_iter().find_map(|(file, syntax)| {
                let (span, message) = syntax.mistake()?;
                Some((file, span.start, message.to_owned()))
            }));
        index
    }
}

/// Indexes the parsed files of a project, and looks closer at the command at a place.
fn resolve<'p>(
    project: &'p Project,
    syntaxes: &[Syntax],
    symbols: &Symbols<'p>,
    place: Option<(usize, usize)>,
) -> Index<'p> {
    let mut resolver = Resolver::new(project, syntaxes, symbols, place);
    resolver.run();
    resolver.finish()
}

impl<'p, 's> Resolver<'p, 's> {
    /// Runs through all files: the first with what it reads, then those that are not read.
    fn run(&mut self) {
        let syntaxes: &'s [Syntax] = self.syntaxes;
        for first in 0..syntaxes.len() {
            if self.read[first] {
                continue;
            }
            self.read[first] = true;
            let mut files = vec![(first, walk::events(&syntaxes[first].block), 0, 1)];
            while let Some((file, events, at, base)) = files.last_mut() {
                self.base = *base;
                let (file, Some(event)) = (*file, events.get(*at).copied()) else {
                    files.pop();
                    continue;
                };
                *at += 1;
                for wanted in self.event(file, event) {
                    if !std::mem::replace(&mut self.read[wanted], true) {
                        files.push((
                            wanted,
                            walk::events(&syntaxes[wanted].block),
                            0,
                            self.frames.len(),
                        ));
                    } else {
                        self.read_again(wanted);
                    }
                }
            }
        }
    }

    /// Takes one step; returns the files that it reads, the last one first.
    fn event(&mut self, file: usize, event: Event<'s>) -> Vec<usize> {
        match event {
            Event::Command(command) => return self.command(file, command),
            Event::For(node) => {
                let loops = self.frame().loops.len();
                self.command(file, &node.head);
                if self.frame().loops.len() == loops {
                    // A loop without a variable.
                    self.frame().loops.push(("", 0, 0));
                }
                self.open.push(Open::Loop {
                    leaks: calls_others(&node.body),
                });
                self.frame().depth += 1;
            }
            Event::If(node) => {
                self.command(file, &node.head);
            }
            Event::Branch => {
                self.open.push(Open::Choice);
                self.frame().depth += 1;
            }
            Event::Define(node) => self.begin_define(file, node),
            Event::End => self.end(),
        }
        Vec::new()
    }

    /// Ends the structure or branch that began last.
    fn end(&mut self) {
        let Some(open) = self.open.pop() else { return };
        if open == Open::Define {
            self.frames.pop();
            return;
        }
        let is_project = self.frames.len() == 1;
        let frame = self.frame();
        frame.depth -= 1;
        let depth = frame.depth;
        while let Some((name, _)) = frame.set_inside.pop_if(|(_, set)| *set > depth) {
            if let Some(local) = frame.locals.get_mut(name).filter(|l| l.depth > depth) {
                local.sure = false;
            }
        }
        if let Open::Loop { leaks } = open
            && let Some((name, entity, _)) = frame.loops.pop()
            && is_project
            && leaks
            && !name.is_empty()
        {
            self.leaky.push((name, entity));
        }
    }

    /// Unites what counts as one, and makes the index.
    fn finish(mut self) -> Index<'p> {
        let mut shared = HashSet::new();
        for (name, entity) in std::mem::take(&mut self.leaky) {
            if self.free_in_defines.contains(name) {
                let global = self.entity_of(SymbolKind::Variable, name);
                self.unite(entity, global);
                shared.insert(name);
            }
        }
        for (entity, name) in std::mem::take(&mut self.same_as_global) {
            let global = self.entity_of(SymbolKind::Variable, name);
            if shared.contains(name) || self.entities[global].is_defined {
                self.unite(entity, global);
            }
        }
        for (entity, kind, name) in std::mem::take(&mut self.stand_ins) {
            if let Some(&named) = self.by_name.get(&(kind, name)) {
                self.unite(entity, named);
            }
        }
        // The parent of every thing becomes its root; what is defined anywhere is defined for all.
        let mut defined = vec![false; self.entities.len()];
        for entity in 0..self.entities.len() {
            let root = self.root(entity);
            self.entities[entity].parent = root;
            defined[root] |= self.entities[entity].is_defined;
        }
        let mut index = Index {
            project: self.project,
            entities: self.entities,
            occurrences: self.occurrences,
            here: self.here,
            mistake: (self.work_left == 0).then(|| {
                let message = "files are read again too often to tell their names apart";
                (0, 0, String::from(message))
            }),
        };
        let entities = &index.entities;
        index
            .occurrences
            .retain(|o| defined[entities[o.entity].parent]);
        field::heap_sort(&mut index.occurrences, |a, b| a.sort_key() < b.sort_key());
        index
    }
}

/// Returns whether a block calls commands that the text defines, or reads files.
fn calls_others(block: &Block) -> bool {
    block.iter().any(|node| match node {
        Node::Command(command) => command
            .spec
            .is_none_or(|spec| spec.includes || spec.yields()),
        Node::For(node) => calls_others(&node.body),
        Node::If(node) => calls_others(&node.then) || calls_others(&node.otherwise),
        Node::Define(node) => calls_others(&node.body),
    })
}
