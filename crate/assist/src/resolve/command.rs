//! Commands and definitions: the names that they use and make.

use super::state::{Frame, Local, Open, Resolver, value_type};
use crate::grammar::Grammar;
use crate::index::SymbolKind;
use crate::slots::{Slot, Slots, Type, What};
use rats::commands::{self, Bracket, CommandSpec, Names};
use rats::syntax::{Command, Datum, Define, Item, Syntax};
use std::ops::Range;
use std::rc::Rc;

impl<'p, 's> Resolver<'p, 's> {
    /// Notes the names that a command uses, then those that it makes. Returns the files that it
    /// reads, the last one first.
    pub(super) fn command(&mut self, file: usize, command: &'s Command) -> Vec<usize> {
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[command.items.clone()];
        let grammar = self.grammar(file, command, items);
        if self.is_here(file, command) {
            self.look(file, command, &grammar);
        }
        let Slots { slots, words, .. } =
            Slots::read(items, text, &grammar, &|name| self.type_of(name));
        let mut reads = Vec::new();
        for slot in &slots {
            if let Some(span) = span_of(slot, items) {
                reads.extend(self.use_operand(file, command, slot, span));
            }
        }
        for word in words {
            self.use_variable(file, items[word].span(), command.span.clone());
        }
        // A name that is made is there only after the operands have been read.
        self.make_names(file, command, items, &slots);
        match command.spec.and_then(|spec| spec.bracket) {
            Some(Bracket::Chain) => self.frame().objects.push(true),
            Some(Bracket::Object) => self.frame().objects.push(false),
            Some(Bracket::Close) => {
                self.frame().objects.pop();
            }
            None => {}
        }
        reads.reverse();
        reads
    }

    /// Returns the operands that a command takes here. Notes the use of a command that the texts
    /// define.
    pub(super) fn grammar(
        &mut self,
        file: usize,
        command: &Command,
        items: &[Item],
    ) -> Rc<Grammar<'p>> {
        let word = self.symbols.word(command.word);
        let own = match command.spec {
            Some(spec) if !spec.yields() => None,
            _ => self.own(word).cloned(),
        };
        if command.spec.is_none() || own.is_some() {
            let entity = self.entity_of(SymbolKind::Command, word);
            let (word, whole) = (command.word_span.clone(), command.span.clone());
            self.note(entity, file, word, whole, false);
        }
        let grammar = match (&own, command.spec) {
            (Some(own), _) => own.grammar.clone(),
            (None, Some(spec)) => self.table(spec, false),
            (None, None) => return Rc::default(),
        };
        if !grammar.takes_material() || !self.leaves_material_out(items, self.text(file)) {
            return grammar;
        }
        match (own, command.spec) {
            (Some(own), _) => own.in_chain.clone(),
            (None, Some(spec)) => self.table(spec, true),
            (None, None) => grammar,
        }
    }

    /// Notes what an operand names: a thing, a file or a parameter. Returns the file that the
    /// command reads there, if it is `read` and the file is one of the project's.
    pub(super) fn use_operand(
        &mut self,
        file: usize,
        command: &Command,
        slot: &Slot<'p>,
        span: Range<usize>,
    ) -> Option<usize> {
        let text = self.text(file);
        match slot.what {
            What::Name { of, is_new: false } => self.use_name(file, span, of, command),
            What::File => {
                let written = &text[span.clone()];
                let bare = written.strip_prefix("./").unwrap_or(written);
                let files = &self.project.files;
                let places = rats::places(&files[file].name, written);
                let read = places
                    .iter()
                    .find_map(|place| files.iter().position(|file| file.name == *place))?;
                let start = span.end - bare.len();
                let entity = self.entity_of(SymbolKind::File, &self.project.files[read].name);
                self.note(entity, file, start..span.end, command.span.clone(), false);
                return command
                    .spec
                    .is_some_and(|spec| spec.includes)
                    .then_some(read);
            }
            What::Named => {
                let word = self.symbols.word(command.word);
                let name = &text[span.clone()];
                if let Some(&entity) = self.parameters.get(&(word, name)) {
                    self.note(entity, file, span, command.span.clone(), false);
                }
            }
            _ => {}
        }
        None
    }

    /// Notes the names that a command makes or sets.
    pub(super) fn make_names(
        &mut self,
        file: usize,
        command: &Command,
        items: &[Item],
        slots: &[Slot<'p>],
    ) {
        let text = self.text(file);
        let value = slots.iter().rev().find_map(|slot| match slot.what {
            What::Triple | What::Number(2) => Some(Type::Triple),
            What::Number(_) => Some(Type::Number),
            _ => None,
        });
        for slot in slots {
            let (What::Name { of, is_new: true }, Some(span)) = (slot.what, span_of(slot, items))
            else {
                continue;
            };
            match kind_of(of) {
                SymbolKind::Variable => {
                    // `var a += 1` reads the one and may set the other.
                    let is_set = slots.iter().any(|slot| matches!(slot.what, What::Lead));
                    if !is_set && command.spec.is_some_and(|spec| !spec.is_structure()) {
                        self.change_variable(&text[span.clone()]);
                    }
                    self.set_variable(file, span, value.unwrap_or(Type::Any), command);
                }
                SymbolKind::Command => {}
                kind => {
                    let entity = self.entity_of(kind, &text[span.clone()]);
                    self.note(entity, file, span, command.span.clone(), true);
                }
            }
        }
    }

    /// Returns whether a shape leaves out its material: in a chain, and in a define that is called
    /// in one.
    pub(super) fn leaves_material_out(&self, items: &[Item], text: &str) -> bool {
        let Some(frame) = self.frames.last() else {
            return false;
        };
        if frame.objects.last() == Some(&true) {
            return true;
        }
        if frame.owner.is_none() {
            return false;
        }
        match items.first() {
            Some(item) => match item.datum {
                Datum::Number(_) | Datum::Sign(_) => true,
                Datum::Word(_) => {
                    let word = &text[item.span()];
                    let is_material = self.by_name.contains_key(&(SymbolKind::Material, word));
                    !is_material && matches!(self.type_of(word), Some(Type::Number | Type::Triple))
                }
                Datum::Unknown => false,
            },
            None => false,
        }
    }

    /// Notes the use of a name.
    pub(super) fn use_name(
        &mut self,
        file: usize,
        span: Range<usize>,
        of: Names,
        command: &Command,
    ) {
        let name = &self.text(file)[span.clone()];
        let kind = kind_of(of);
        if kind == SymbolKind::Command && commands::find(name).is_some() {
            return;
        }
        // A parameter may stand for the name.
        if kind == SymbolKind::Variable || self.type_of(name) == Some(Type::Name) {
            // A file may be read where there is no such parameter, too.
            if self.base > 1 && self.frames.len() == self.base {
                self.stands_for(name, kind);
            }
            return self.use_variable(file, span, command.span.clone());
        }
        let entity = self.entity_of(kind, name);
        self.note(entity, file, span, command.span.clone(), false);
    }

    /// Returns the operands of a command of the table; `in_chain` leaves the material out.
    pub(super) fn table(&mut self, spec: &'static CommandSpec, in_chain: bool) -> Rc<Grammar<'p>> {
        let known = self.grammars.entry((spec.name, in_chain));
        let grammar = known.or_insert_with(|| match (Grammar::of(spec), in_chain) {
            (grammar, true) => Rc::new(grammar.in_chain()),
            (grammar, false) => Rc::new(grammar),
        });
        grammar.clone()
    }

    /// Begins the definition of a command.
    pub(super) fn begin_define(&mut self, file: usize, node: &'s Define) {
        self.open.push(Open::Define);
        let name = self.symbols.word(node.name);
        let head = &node.head;
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items;
        let command = self.entity_of(SymbolKind::Command, name);
        let name_span = items[head.items.start].span();
        self.note(command, file, name_span.clone(), head.span.clone(), true);
        self.order += 1;
        let owner = self.order;
        let mut frame = Frame {
            owner: Some(owner),
            ..Frame::default()
        };
        let Some(own) = self.all_defines.get(&(file, head.span.start)).cloned() else {
            self.frames.push(frame);
            return;
        };
        for (formal, (name, entity)) in node.parameters.iter().zip(&own.parameters) {
            let value = value_type(formal.takes);
            self.entities[*entity].owner = Some(owner);
            self.note(*entity, file, formal.span.clone(), head.span.clone(), true);
            // A default may use the parameters before it.
            self.frames.push(std::mem::take(&mut frame));
            self.default(file, head, formal.default.clone());
            frame = self.frames.pop().unwrap_or_default();
            frame.types.insert(name, value);
            frame.locals.insert(
                name,
                Local {
                    entity: *entity,
                    sure: true,
                    depth: 0,
                },
            );
        }
        if self.is_here(file, head) {
            let grammar = head
                .spec
                .map_or_else(Rc::default, |spec| self.table(spec, false));
            self.look(file, head, &grammar);
        }
        self.defines.insert(name, own);
        self.frames.push(frame);
    }

    /// Notes the names in the default of a parameter.
    pub(super) fn default(&mut self, file: usize, head: &Command, items: Range<usize>) {
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[items];
        if items.is_empty() {
            return;
        }
        let words = Slots::expression(items, text, &|name| self.type_of(name)).words;
        for word in words {
            self.use_variable(file, items[word].span(), head.span.clone());
        }
    }
}

/// Returns the bytes of an operand; `None` if it has no items.
fn span_of(slot: &Slot<'_>, items: &[Item]) -> Option<Range<usize>> {
    let items = items.get(slot.items.clone())?;
    let (first, last) = (items.first()?, items.last()?);
    Some(first.start as usize..last.end as usize)
}

/// Returns the kind of thing that has such names.
fn kind_of(names: Names) -> SymbolKind {
    match names {
        Names::Material => SymbolKind::Material,
        Names::Texture => SymbolKind::Texture,
        Names::Object => SymbolKind::Object,
        Names::Variable => SymbolKind::Variable,
        Names::Command => SymbolKind::Command,
        Names::Node => SymbolKind::Node,
        Names::Preset => SymbolKind::Preset,
    }
}
