//! The command at the place that the editor asks about.

use super::state::Resolver;
use crate::grammar::Grammar;
use crate::index::{Here, SymbolKind};
use crate::slots::{Slots, Type};
use rats::syntax::{Command, Datum, Syntax};
use std::collections::HashSet;
use std::rc::Rc;

impl<'p, 's> Resolver<'p, 's> {
    /// Returns whether the place that is asked for is in this command.
    pub(super) fn is_here(&self, file: usize, command: &Command) -> bool {
        let Some((place, byte)) = self.place else {
            return false;
        };
        place == file
            && self.here.is_none()
            && command.span.start <= byte
            && byte <= reach(self.text(file), command)
    }

    /// Keeps what the editor asks about the command at its place.
    pub(super) fn look(&mut self, file: usize, command: &Command, grammar: &Rc<Grammar<'p>>) {
        let Some((_, byte)) = self.place else { return };
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[command.items.clone()];
        let types = |name: &str| self.type_of(name);
        let all = Slots::read(items, text, grammar, &types);
        // The text before the word at the place.
        let before = items.partition_point(|item| (item.end as usize) < byte);
        let glued = items.get(before).is_some_and(|item| {
            (item.start as usize) < byte && matches!(item.datum, Datum::Sign(_))
        });
        let before = before + usize::from(glued);
        let wants = Slots::read(&items[..before], text, grammar, &types).wants;
        let operands = all
            .slots
            .into_iter()
            .filter_map(|slot| {
                let first = items.get(slot.items.start)?;
                let last = items.get(slot.items.end.checked_sub(1)?)?;
                Some((first.start as usize..last.end as usize, slot))
            })
            .collect();
        let word = self.symbols.word(command.word);
        let own = match command.spec {
            Some(spec) if !spec.yields() => None,
            _ => self.own(word).map(|own| own.place.clone()),
        };
        self.here = Some(Here {
            file,
            word,
            word_span: command.word_span.clone(),
            spec: command.spec,
            own,
            grammar: grammar.clone(),
            operands,
            wants,
            variables: self.visible(),
        });
    }

    /// Returns the variables that can be seen here, the nearest first.
    pub(super) fn visible(&self) -> Vec<(&'p str, Type, SymbolKind)> {
        let mut seen = Vec::new();
        let mut frames = vec![self.frames.last()];
        if self.frames.len() > 1 {
            frames.push(self.frames.first());
        }
        for frame in frames.into_iter().flatten() {
            let mut names: Vec<_> = frame
                .types
                .iter()
                .map(|(name, kind)| (*name, *kind))
                .collect();
            field::heap_sort(&mut names, |a, b| a.0 < b.0);
            for (name, value) in names {
                let is_loop = frame.loops.iter().any(|(bound, _, _)| *bound == name);
                let kind = if is_loop {
                    SymbolKind::Loop
                } else {
                    frame
                        .locals
                        .get(name)
                        .map_or(SymbolKind::Variable, |local| {
                            self.entities[local.entity].kind
                        })
                };
                seen.push((name, value, kind));
            }
        }
        let mut known = HashSet::new();
        seen.retain(|(name, _, _)| known.insert(*name));
        seen
    }
}

/// Returns the end of a command: the byte that ends its line or begins its block.
fn reach(text: &str, command: &Command) -> usize {
    let end = command.span.end;
    let rest = &text[end..];
    end + rest.find(['\n', '#', '{', '}']).unwrap_or(rest.len())
}
