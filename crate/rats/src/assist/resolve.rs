//! Finds what names mean as the evaluator does, but without running anything.
//!
//! Materials, textures, objects, commands and files have one name each for the whole project. Variables
//! are those of the whole project, of a loop, or of a defined command. A variable belongs to whoever runs
//! the text, so where it cannot be told which of two is meant (a command that sets a variable only
//! sometimes, or is called in a loop whose variable it uses), the two count as one; then renaming both
//! keeps the meaning.

use super::grammar::Grammar;
use super::slots::{Slots, Type, What};
use super::symbols::{Entity, Here, Index, Occurrence, Place, SymbolKind};
use super::walk::{self, Event};
use crate::commands::{self, CommandSpec, Names};
use crate::symbol::Symbols;
use crate::syntax::{Block, Command, Datum, Define, Item, Node, Syntax, Takes};
use crate::{Project, colours, functions};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

/// Indexes the parsed files of a project, and looks closer at the command at a place.
pub fn resolve<'p>(
    project: &'p Project,
    syntaxes: &[Syntax],
    symbols: &Symbols<'p>,
    place: Option<(usize, usize)>,
) -> Index<'p> {
    let mut walker = Walker::new(project, syntaxes, symbols, place);
    walker.run();
    walker.finish()
}

/// How many names are compared where files are read again.
const MAX_COMPARED: usize = 200_000;

/// A variable that a call has of its own.
#[derive(Clone, Copy, Debug)]
struct Local {
    entity: usize,
    /// Whether it surely has a value here.
    sure: bool,
    /// How deep the block is that sets it.
    depth: usize,
}

/// The variables of the project, or of a defined command.
#[derive(Debug, Default)]
struct Frame<'p> {
    /// The order of the define; `None` for the project.
    owner: Option<usize>,
    locals: HashMap<&'p str, Local>,
    /// The locals that were set in blocks that are open, with how deep these are.
    set_inside: Vec<(&'p str, usize)>,
    /// The loops that are open, with their variables and numbers.
    loops: Vec<(&'p str, usize, usize)>,
    /// Names used before they were set, with the outermost loop that was open then.
    free: HashMap<&'p str, Option<usize>>,
    types: HashMap<&'p str, Type>,
    /// Blocks open inside of it.
    depth: usize,
    /// For each open object whether it is a chain.
    objects: Vec<bool>,
}

/// What an open structure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Open {
    Loop { leaks: bool },
    Choice,
    Define,
}

struct Walker<'p, 's> {
    project: &'p Project,
    syntaxes: &'s [Syntax],
    symbols: &'s Symbols<'p>,
    place: Option<(usize, usize)>,
    entities: Vec<Entity<'p>>,
    occurrences: Vec<Occurrence>,
    by_name: HashMap<(SymbolKind, &'p str), usize>,
    frames: Vec<Frame<'p>>,
    open: Vec<Open>,
    /// The commands that have been defined so far.
    defines: HashMap<&'p str, Rc<Own<'p>>>,
    /// All commands that are defined anywhere, by file and byte; those that are called before they are
    /// defined in the text, by name.
    all_defines: HashMap<(usize, usize), Rc<Own<'p>>>,
    later: HashMap<&'p str, Rc<Own<'p>>>,
    /// The parameters of all commands, by the names of both.
    parameters: HashMap<(&'p str, &'p str), usize>,
    /// What the commands of the table take, with and without a material.
    grammars: HashMap<(&'static str, bool), Rc<Grammar<'p>>>,
    /// Names used in defined commands without being set there.
    free_in_defines: HashSet<&'p str>,
    /// Loops of the project's own frame that call commands.
    leaky: Vec<(&'p str, usize)>,
    /// Things that are the same if the project has a variable of this name.
    same_as_global: Vec<(usize, &'p str)>,
    /// The places in which files have been read: the file, the call, the loop, its number of variables.
    contexts: HashSet<(usize, Option<usize>, Option<usize>, usize)>,
    /// How many more names may be compared where files are read again.
    work_left: usize,
    /// Parameters that stand for names in files, where something else may have that name.
    stand_ins: HashSet<(usize, SymbolKind, &'p str)>,
    /// The variables that a file's text uses, for when it is read again.
    used_by_file: Vec<HashSet<(&'p str, usize)>>,
    /// The number of frames where the present file begins.
    base: usize,
    read: Vec<bool>,
    here: Option<Here<'p>>,
    loops: usize,
    order: usize,
}

/// A command that the text defines.
#[derive(Debug)]
struct Own<'p> {
    grammar: Rc<Grammar<'p>>,
    in_chain: Rc<Grammar<'p>>,
    parameters: Vec<(&'p str, usize)>,
    place: Place,
}

impl<'p, 's> Walker<'p, 's> {
    fn new(
        project: &'p Project,
        syntaxes: &'s [Syntax],
        symbols: &'s Symbols<'p>,
        place: Option<(usize, usize)>,
    ) -> Self {
        let mut walker = Self {
            project,
            syntaxes,
            symbols,
            place,
            entities: Vec::new(),
            occurrences: Vec::new(),
            by_name: HashMap::new(),
            frames: vec![Frame::default()],
            open: Vec::new(),
            defines: HashMap::new(),
            all_defines: HashMap::new(),
            later: HashMap::new(),
            parameters: HashMap::new(),
            grammars: HashMap::new(),
            free_in_defines: HashSet::new(),
            leaky: Vec::new(),
            same_as_global: Vec::new(),
            contexts: HashSet::new(),
            work_left: MAX_COMPARED,
            stand_ins: HashSet::new(),
            used_by_file: vec![HashSet::new(); syntaxes.len()],
            base: 1,
            read: vec![false; syntaxes.len()],
            here: None,
            loops: 0,
            order: 0,
        };
        for (index, file) in project.files.iter().enumerate() {
            let entity = walker.named(SymbolKind::File, &file.name);
            walker.note(entity, index, 0..0, 0..0, true);
        }
        walker.collect_defines();
        walker
    }

    fn text(&self, file: usize) -> &'p str {
        &self.project.files[file].text
    }

    /// A new thing.
    fn entity(&mut self, kind: SymbolKind, name: &'p str) -> usize {
        let index = self.entities.len();
        self.entities.push(Entity {
            kind,
            name,
            parent: index,
            is_defined: false,
            owner: None,
            value: Type::Any,
            first: None,
        });
        index
    }

    /// The thing of a name that counts for the whole project.
    fn named(&mut self, kind: SymbolKind, name: &'p str) -> usize {
        if let Some(&entity) = self.by_name.get(&(kind, name)) {
            return entity;
        }
        let entity = self.entity(kind, name);
        self.by_name.insert((kind, name), entity);
        entity
    }

    fn root(&mut self, mut entity: usize) -> usize {
        loop {
            let parent = self.entities[entity].parent;
            if parent == entity {
                return entity;
            }
            // Paths get shorter as they are gone.
            self.entities[entity].parent = self.entities[parent].parent;
            entity = parent;
        }
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (first, second) = (a.min(b), a.max(b));
        self.entities[second].parent = first;
    }

    fn note(
        &mut self,
        entity: usize,
        file: usize,
        span: Range<usize>,
        command: Range<usize>,
        is_definition: bool,
    ) {
        self.order += 1;
        let occurrence = Occurrence {
            place: Place { file, span },
            is_definition,
            command,
            order: self.order,
            entity,
        };
        if is_definition {
            let entity = &mut self.entities[entity];
            entity.is_defined = true;
            if entity.first.is_none() {
                entity.first = Some(occurrence.clone());
            }
        }
        self.occurrences.push(occurrence);
    }

    fn frame(&mut self) -> &mut Frame<'p> {
        self.frames.last_mut().expect("the project's own frame")
    }

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

    /// One step; gives the files that it reads, the last one first.
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

    /// Finds all commands that the texts define, since they can be called further up.
    fn collect_defines(&mut self) {
        let syntaxes: &'s [Syntax] = self.syntaxes;
        for (file, syntax) in syntaxes.iter().enumerate() {
            for event in walk::events(&syntax.block) {
                let Event::Define(node) = event else { continue };
                let name = self.symbols.word(node.name);
                let mut parameters = Vec::new();
                for formal in &node.parameters {
                    let parameter = self.symbols.word(formal.name);
                    let entity = self.entity(SymbolKind::Parameter, parameter);
                    self.entities[entity].value = taken(formal.takes);
                    // A call by name can mean each of several commands of one name.
                    let known = self.parameters.entry((name, parameter));
                    let first = *known.or_insert(entity);
                    self.unite(first, entity);
                    parameters.push((parameter, entity));
                }
                let grammar = Grammar::own(node, syntax, self.text(file), self.symbols);
                let own = Rc::new(Own {
                    in_chain: Rc::new(grammar.clone().in_chain()),
                    grammar: Rc::new(grammar),
                    parameters,
                    place: Place {
                        file,
                        span: syntax.items[node.head.items.start].span(),
                    },
                });
                let place = (file, node.head.span.start);
                self.all_defines.insert(place, own.clone());
                self.later.insert(name, own);
            }
        }
    }

    /// What the texts define under a name: so far, else further down.
    fn own(&self, name: &str) -> Option<&Rc<Own<'p>>> {
        self.defines.get(name).or_else(|| self.later.get(name))
    }

    fn begin_define(&mut self, file: usize, node: &'s Define) {
        self.open.push(Open::Define);
        let name = self.symbols.word(node.name);
        let head = &node.head;
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items;
        let command = self.named(SymbolKind::Command, name);
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
            let value = taken(formal.takes);
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

    /// The names in the default of a parameter.
    fn default(&mut self, file: usize, head: &Command, items: Range<usize>) {
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[items];
        if items.is_empty() {
            return;
        }
        let types = |name: &str| self.type_of(name);
        let words = Slots::expression(items, text, &types).words;
        for word in words {
            self.use_variable(file, items[word].span(), head.span.clone());
        }
    }

    /// What is known of a variable that can be seen here.
    fn type_of(&self, name: &str) -> Option<Type> {
        let frame = self.frames.last()?;
        frame
            .types
            .get(name)
            .or_else(|| self.frames[0].types.get(name))
            .copied()
    }

    /// Whether the place that is asked for is in this command.
    fn is_here(&self, file: usize, command: &Command) -> bool {
        let Some((place, byte)) = self.place else {
            return false;
        };
        place == file
            && self.here.is_none()
            && command.span.start <= byte
            && byte <= reach(self.text(file), command)
    }

    fn command(&mut self, file: usize, command: &'s Command) -> Vec<usize> {
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[command.items.clone()];
        let word = self.symbols.word(command.word);
        let own = match command.spec {
            Some(spec) if !spec.is_library() => None,
            _ => self.own(word).cloned(),
        };
        let mut grammar = match (&own, command.spec) {
            (Some(own), _) => own.grammar.clone(),
            (None, Some(spec)) => self.table(spec, false),
            (None, None) => Rc::default(),
        };
        if command.spec.is_none() || own.is_some() {
            let entity = self.named(SymbolKind::Command, word);
            self.note(
                entity,
                file,
                command.word_span.clone(),
                command.span.clone(),
                false,
            );
        }
        if grammar.takes_material() && self.leaves_material_out(items, text) {
            grammar = match (&own, command.spec) {
                (None, Some(spec)) => self.table(spec, true),
                (Some(own), _) => own.in_chain.clone(),
                (None, None) => grammar,
            };
        }
        if self.is_here(file, command) {
            self.look(file, command, &grammar);
        }
        let types = |name: &str| self.type_of(name);
        let read = Slots::read(items, text, &grammar, &types);
        let (slots, words) = (read.slots, read.words);
        let mut reads = Vec::new();
        let mut made = Vec::new();
        let mut value = Type::Any;
        for slot in &slots {
            let span = match items.get(slot.items.clone()) {
                Some([first, .., last]) => first.start as usize..last.end as usize,
                Some([one]) => one.span(),
                _ => continue,
            };
            match slot.what {
                What::Name { of, is_new: true } => made.push((span, of)),
                What::Name { of, is_new: false } => self.known(file, span, of, command),
                What::File => {
                    let written = &text[span.clone()];
                    let bare = written.strip_prefix("./").unwrap_or(written);
                    let files = &self.project.files;
                    let places = crate::places(&files[file].name, written);
                    let find = |place: &String| files.iter().position(|f| f.name == *place);
                    if let Some(read) = places.iter().find_map(find) {
                        let start = span.end - bare.len();
                        let entity = self.named(SymbolKind::File, &self.project.files[read].name);
                        self.note(entity, file, start..span.end, command.span.clone(), false);
                        if walk::name(command) == Some("read") {
                            reads.push(read);
                        }
                    }
                }
                What::Named => {
                    let name = &text[span.clone()];
                    if let Some(&entity) = self.parameters.get(&(word, name)) {
                        self.note(entity, file, span, command.span.clone(), false);
                    }
                }
                What::Triple => value = Type::Triple,
                What::Number(part) => {
                    value = if part == 2 {
                        Type::Triple
                    } else {
                        Type::Number
                    }
                }
                _ => {}
            }
        }
        for word in words {
            self.use_variable(file, items[word].span(), command.span.clone());
        }
        // What is made is there only after the operands have been read.
        for (span, of) in made {
            match kind_of(of) {
                SymbolKind::Variable => {
                    // `var a += 1` reads the one and may set the other.
                    let is_set = slots.iter().any(|slot| matches!(slot.what, What::Lead));
                    if !is_set && walk::name(command) == Some("var") {
                        self.changed(&text[span.clone()]);
                    }
                    self.set_variable(file, span, value, command);
                }
                SymbolKind::Command => {}
                kind => {
                    let entity = self.named(kind, &text[span.clone()]);
                    self.note(entity, file, span, command.span.clone(), true);
                }
            }
        }
        match walk::name(command) {
            Some("chain") => self.frame().objects.push(true),
            Some("object") => self.frame().objects.push(false),
            Some("close") => {
                self.frame().objects.pop();
            }
            _ => {}
        }
        reads.reverse();
        reads
    }

    /// Whether a shape leaves out its material: in a chain, and in a define that is called in one.
    fn leaves_material_out(&self, items: &[Item], text: &str) -> bool {
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
    fn known(&mut self, file: usize, span: Range<usize>, of: Names, command: &Command) {
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
        let entity = self.named(kind, name);
        self.note(entity, file, span, command.span.clone(), false);
    }

    /// A variable is changed without being set: if it is not the call's own, it becomes so now.
    fn changed(&mut self, name: &'p str) {
        let depth = self.frame().depth;
        let owner = self.frame().owner;
        if owner.is_none() {
            return;
        }
        match self.bound(name) {
            Some(entity) => self.same_as_global.push((entity, name)),
            None => {
                let entity = self.entity(SymbolKind::Variable, name);
                self.entities[entity].owner = owner;
                let global = self.named(SymbolKind::Variable, name);
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
    fn set_variable(&mut self, file: usize, span: Range<usize>, value: Type, command: &Command) {
        let name = &self.text(file)[span.clone()];
        let owner = self.frame().owner;
        if walk::name(command) == Some("for") {
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
        let bound = self.bound(name);
        let entity = match (bound, owner) {
            (Some(entity), _) => entity,
            (None, None) => self.named(SymbolKind::Variable, name),
            (None, Some(_)) => {
                let entity = self.entity(SymbolKind::Variable, name);
                self.entities[entity].owner = owner;
                // In a loop the use before it may come after it.
                let frame = self.frame();
                let outermost = frame.loops.first().map(|(_, _, number)| *number);
                if outermost.is_some() && frame.free.get(name) == Some(&outermost) {
                    let global = self.named(SymbolKind::Variable, name);
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

    /// The loop or local variable of a name that can be seen here.
    fn bound(&self, name: &str) -> Option<usize> {
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

    /// Whether a word means a colour or a constant here, as no variable of that name has been set so far. Only
    /// in the first file and outside of loops and commands is that certain.
    fn is_not_set_yet(&self, name: &str) -> bool {
        let is_plain = matches!(&self.frames[..], [frame] if frame.loops.is_empty());
        is_plain
            && self.type_of(name).is_none()
            && (colours::find(name).is_some() || functions::constant(name).is_some())
    }

    fn use_variable(&mut self, file: usize, span: Range<usize>, command: Range<usize>) {
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
        let entity = match self.bound(name) {
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
                self.named(SymbolKind::Variable, name)
            }
        };
        if self.frames.len() == self.base {
            self.used_by_file[file].insert((name, entity));
        }
        self.note(entity, file, span, command, false);
    }

    /// A file that was read before is read again, perhaps where other variables can be seen.
    fn read_again(&mut self, file: usize) {
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
            let other = match self.bound(name) {
                Some(other) => other,
                None => self.named(SymbolKind::Variable, name),
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

    /// A parameter that stands for a name, and what has that name itself, count as one.
    fn stands_for(&mut self, name: &'p str, kind: SymbolKind) {
        if let Some(parameter) = self.bound(name) {
            self.stand_ins.insert((parameter, kind, name));
        }
    }

    /// Keeps what the editor asks about the command at its place.
    fn look(&mut self, file: usize, command: &Command, grammar: &Rc<Grammar<'p>>) {
        let Some((_, byte)) = self.place else { return };
        let text = self.text(file);
        let syntaxes: &'s [Syntax] = self.syntaxes;
        let items = &syntaxes[file].items[command.items.clone()];
        let types = |name: &str| self.type_of(name);
        let all = Slots::read(items, text, grammar, &types);
        // What comes before the word at the place.
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
            Some(spec) if !spec.is_library() => None,
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

    /// The variables that can be seen here, the nearest first.
    fn visible(&self) -> Vec<(&'p str, Type, SymbolKind)> {
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
            names.sort_unstable_by_key(|(name, _)| *name);
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

    /// What a command of the table takes.
    fn table(&mut self, spec: &'static CommandSpec, in_chain: bool) -> Rc<Grammar<'p>> {
        let make = || {
            let grammar = Grammar::of(spec);
            Rc::new(if in_chain {
                grammar.in_chain()
            } else {
                grammar
            })
        };
        let known = self.grammars.entry((spec.name, in_chain));
        known.or_insert_with(make).clone()
    }

    fn finish(mut self) -> Index<'p> {
        let mut shared = HashSet::new();
        for (name, entity) in std::mem::take(&mut self.leaky) {
            if self.free_in_defines.contains(name) {
                let global = self.named(SymbolKind::Variable, name);
                self.unite(entity, global);
                shared.insert(name);
            }
        }
        for (entity, name) in std::mem::take(&mut self.same_as_global) {
            let global = self.named(SymbolKind::Variable, name);
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
        index
            .occurrences
            .sort_by_key(|o| (o.place.file, o.place.span.start, o.place.span.end));
        index
    }
}

fn taken(takes: Takes) -> Type {
    match takes {
        Takes::Number => Type::Number,
        Takes::Triple => Type::Triple,
        Takes::Surface => Type::Name,
    }
}

fn kind_of(names: Names) -> SymbolKind {
    match names {
        Names::Material => SymbolKind::Material,
        Names::Texture => SymbolKind::Texture,
        Names::Object => SymbolKind::Object,
        Names::Variable => SymbolKind::Variable,
        Names::Command => SymbolKind::Command,
    }
}

/// Whether a block calls commands that the text defines, or reads files.
fn calls_others(block: &Block) -> bool {
    block.iter().any(|node| match node {
        Node::Command(command) => command
            .spec
            .is_none_or(|spec| spec.name == "read" || spec.is_library()),
        Node::For(node) => calls_others(&node.body),
        Node::If(node) => calls_others(&node.then) || calls_others(&node.otherwise),
        Node::Define(node) => calls_others(&node.body),
    })
}

/// How far a command reaches: to what ends its line or begins its block.
fn reach(text: &str, command: &Command) -> usize {
    let end = command.span.end;
    let rest = &text[end..];
    end + rest.find(['\n', '#', '{', '}']).unwrap_or(rest.len())
}
