//! Variables: which of the project's, a loop's and a call's a name means.

use super::state::{Local, Resolver};
use crate::index::SymbolKind;
use crate::slots::Type;
use rats::commands::CommandSpec;
use rats::syntax::Command;
use rats::{colours, functions};
use std::ops::Range;

impl<'p> Resolver<'p, '_> {
    /// Notes that a variable is changed without being set: if it is not the call's own, it becomes
    /// so now.
    pub(super) fn change_variable(&mut self, name: &'p str) {
        let depth = self.frame().depth;
        let owner = self.frame().owner;
        if owner.is_none() {
            return;
        }
        match self.visible_variable(name) {
            Some(entity) => self.same_as_global.push((entity, name)),
            None => {
                let entity = self.entity(SymbolKind::Variable, name);
                self.entities[entity].owner = owner;
                let global = self.entity_of(SymbolKind::Variable, name);
                self.unite(entity, global);
                let local = Local {
                    entity,
                    sure: true,
                    depth,
                };
                self.frame().locals.insert(name, local);
                if depth > 0 {
                    self.frame().set_inside.push((name, depth));
                }
            }
        }
    }

    /// Sets a variable or begins a loop over it.
    pub(super) fn set_variable(
        &mut self,
        file: usize,
        span: Range<usize>,
        value: Type,
        command: &Command,
    ) {
        let name = &self.text(file)[span.clone()];
        let owner = self.frame().owner;
        if command.spec.is_some_and(CommandSpec::is_structure) {
            let entity = self.entity(SymbolKind::Loop, name);
            self.entities[entity].owner = owner;
            self.entities[entity].value = Type::Number;
            self.note(entity, file, span, command.span.clone(), true);
            self.loops += 1;
            let number = self.loops;
            self.frame().loops.push((name, entity, number));
            self.frame().types.insert(name, Type::Number);
            return;
        }
        let bound = self.visible_variable(name);
        let entity = match (bound, owner) {
            (Some(entity), _) => entity,
            (None, None) => self.entity_of(SymbolKind::Variable, name),
            (None, Some(_)) => {
                let entity = self.entity(SymbolKind::Variable, name);
                self.entities[entity].owner = owner;
                // In a loop the use before it may come after it.
                let frame = self.frame();
                let outermost = frame.loops.first().map(|(_, _, number)| *number);
                if outermost.is_some() && frame.free.get(name) == Some(&outermost) {
                    let global = self.entity_of(SymbolKind::Variable, name);
                    self.unite(entity, global);
                }
                entity
            }
        };
        if owner.is_some() {
            let depth = self.frame().depth;
            let is_loop = self
                .frame()
                .loops
                .iter()
                .any(|(bound, _, _)| *bound == name);
            if !is_loop {
                let local = self.frame().locals.entry(name).or_insert(Local {
                    entity,
                    sure: true,
                    depth,
                });
                if !local.sure || depth < local.depth {
                    (local.sure, local.depth) = (true, depth);
                }
                if depth > 0 {
                    self.frame().set_inside.push((name, depth));
                }
            }
        }
        if matches!(value, Type::Number | Type::Triple) {
            self.frame().types.insert(name, value);
            self.entities[entity].value = value;
        } else {
            self.frame().types.entry(name).or_insert(Type::Any);
        }
        if self.frames.len() == self.base {
            self.used_by_file[file].insert((name, entity));
        }
        self.note(entity, file, span, command.span.clone(), true);
    }

    /// Finds the loop or local variable of a name that can be seen here.
    pub(super) fn visible_variable(&self, name: &str) -> Option<usize> {
        let frame = self.frames.last()?;
        let in_loop = frame
            .loops
            .iter()
            .rev()
            .find(|(bound, _, _)| *bound == name);
        in_loop
            .map(|(_, entity, _)| *entity)
            .or_else(|| frame.locals.get(name).map(|local| local.entity))
    }

    /// Returns whether a word means a colour or a constant here, as no variable of that name has
    /// been set so far. Only in the first file and outside of loops and commands is that certain.
    pub(super) fn is_not_set_yet(&self, name: &str) -> bool {
        let is_plain = matches!(&self.frames[..], [frame] if frame.loops.is_empty());
        is_plain
            && self.type_of(name).is_none()
            && (colours::find(name).is_some() || functions::constant(name).is_some())
    }

    pub(super) fn use_variable(&mut self, file: usize, span: Range<usize>, command: Range<usize>) {
        let text = self.text(file);
        let mut name = &text[span.clone()];
        let mut span = span;
        if self.type_of(name).is_none()
            && let Some((triple, component)) = name.rsplit_once('.')
            && !triple.is_empty()
            && ["x", "y", "z", "r", "g", "b"].contains(&component)
        {
            name = triple;
            span.end = span.start + triple.len();
        }
        if file == 0 && self.is_not_set_yet(name) {
            return;
        }
        let entity = match self.visible_variable(name) {
            Some(entity) => {
                let frame = self.frame();
                let in_loop = frame.loops.iter().any(|(bound, _, _)| *bound == name);
                let unsure = frame.locals.get(name).is_some_and(|local| !local.sure);
                if unsure && !in_loop {
                    self.same_as_global.push((entity, name));
                }
                entity
            }
            None => {
                let frame = self.frame();
                if frame.owner.is_some() {
                    let outermost = frame.loops.first().map(|(_, _, number)| *number);
                    frame.free.insert(name, outermost);
                    self.free_in_defines.insert(name);
                }
                self.entity_of(SymbolKind::Variable, name)
            }
        };
        if self.frames.len() == self.base {
            self.used_by_file[file].insert((name, entity));
        }
        self.note(entity, file, span, command, false);
    }

    /// Reads a file again that was read before, perhaps where other variables can be seen.
    pub(super) fn read_again(&mut self, file: usize) {
        let frame = self.frame();
        let last_loop = frame.loops.last().map(|(_, _, number)| *number);
        let context = (file, frame.owner, last_loop, frame.locals.len());
        if !self.contexts.insert(context) {
            return;
        }
        let work = self.used_by_file[file].len() + self.frame().types.len();
        self.work_left = self.work_left.saturating_sub(work);
        if self.work_left == 0 {
            return;
        }
        let names: Vec<(&'p str, usize)> = self.used_by_file[file].iter().copied().collect();
        for (name, entity) in names {
            let other = match self.visible_variable(name) {
                Some(other) => other,
                None => self.entity_of(SymbolKind::Variable, name),
            };
            self.unite(entity, other);
        }
        let types = self.frame().types.iter();
        let names = types.filter(|(_, value)| **value == Type::Name);
        let names: Vec<&'p str> = names.map(|(name, _)| *name).collect();
        for name in names {
            for kind in [
                SymbolKind::Material,
                SymbolKind::Texture,
                SymbolKind::Object,
            ] {
                self.stands_for(name, kind);
            }
        }
    }

    /// Notes that a parameter that stands for a name, and the thing of that name itself, count as
    /// one.
    pub(super) fn stands_for(&mut self, name: &'p str, kind: SymbolKind) {
        if let Some(parameter) = self.visible_variable(name) {
            self.stand_ins.insert((parameter, kind, name));
        }
    }
}
