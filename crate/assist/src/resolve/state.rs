//! The state of the search for names: the things found so far, and what can be seen at this point
//! of the texts.

use crate::grammar::Grammar;
use crate::index::{Entity, Here, Occurrence, Place, SymbolKind};
use crate::slots::Type;
use crate::walk::{self, Event};
use rats::Project;
use rats::symbol::Symbols;
use rats::syntax::{Syntax, Takes};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

/// Most names that are compared where files are read again.
pub const MAX_COMPARED: usize = 200_000;

/// A variable that a call has of its own.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    pub entity: usize,
    /// Whether it surely has a value here.
    pub sure: bool,
    /// The depth of the block that sets it.
    pub depth: usize,
}

/// The variables of the project, or of a defined command.
#[derive(Debug, Default)]
pub struct Frame<'p> {
    /// The order of the define; `None` for the project.
    pub owner: Option<usize>,
    pub locals: HashMap<&'p str, Local>,
    /// The locals that were set in blocks that are open, with the depths of these.
    pub set_inside: Vec<(&'p str, usize)>,
    /// The loops that are open, with their variables and numbers.
    pub loops: Vec<(&'p str, usize, usize)>,
    /// Names used before they were set, with the outermost loop that was open then.
    pub free: HashMap<&'p str, Option<usize>>,
    pub types: HashMap<&'p str, Type>,
    /// The number of blocks that are open inside of it.
    pub depth: usize,
    /// The objects that are open: whether each is a chain.
    pub objects: Vec<bool>,
}

/// Kinds of structures that are open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Open {
    Loop { leaks: bool },
    Choice,
    Define,
}

pub struct Resolver<'p, 's> {
    pub project: &'p Project,
    pub syntaxes: &'s [Syntax],
    pub symbols: &'s Symbols<'p>,
    pub place: Option<(usize, usize)>,
    pub entities: Vec<Entity<'p>>,
    pub occurrences: Vec<Occurrence>,
    pub by_name: HashMap<(SymbolKind, &'p str), usize>,
    pub frames: Vec<Frame<'p>>,
    pub open: Vec<Open>,
    /// The commands that have been defined so far.
    pub defines: HashMap<&'p str, Rc<Own<'p>>>,
    /// The commands that are defined anywhere, by file and byte.
    pub all_defines: HashMap<(usize, usize), Rc<Own<'p>>>,
    /// The commands that are defined anywhere, by name.
    pub later: HashMap<&'p str, Rc<Own<'p>>>,
    /// The parameters of all commands, by the names of both.
    pub parameters: HashMap<(&'p str, &'p str), usize>,
    /// The operands of the commands of the table, with and without a material.
    pub grammars: HashMap<(&'static str, bool), Rc<Grammar<'p>>>,
    /// Names used in defined commands without being set there.
    pub free_in_defines: HashSet<&'p str>,
    /// Loops of the project's own frame that call commands.
    pub leaky: Vec<(&'p str, usize)>,
    /// Things that are the same if the project has a variable of this name.
    pub same_as_global: Vec<(usize, &'p str)>,
    /// The places in which files have been read: the file, the call, the loop, its number of
    /// variables.
    pub contexts: HashSet<(usize, Option<usize>, Option<usize>, usize)>,
    /// The number of names that may still be compared where files are read again.
    pub work_left: usize,
    /// Parameters that stand for names in files, where something else may have that name.
    pub stand_ins: HashSet<(usize, SymbolKind, &'p str)>,
    /// The variables that a file's text uses, for when it is read again.
    pub used_by_file: Vec<HashSet<(&'p str, usize)>>,
    /// The number of frames where the present file begins.
    pub base: usize,
    pub read: Vec<bool>,
    pub here: Option<Here<'p>>,
    pub loops: usize,
    pub order: usize,
}

/// A command that the text defines.
#[derive(Debug)]
pub struct Own<'p> {
    pub grammar: Rc<Grammar<'p>>,
    pub in_chain: Rc<Grammar<'p>>,
    pub parameters: Vec<(&'p str, usize)>,
    pub place: Place,
}

impl<'p, 's> Resolver<'p, 's> {
    pub(super) fn new(
        project: &'p Project,
        syntaxes: &'s [Syntax],
        symbols: &'s Symbols<'p>,
        place: Option<(usize, usize)>,
    ) -> Self {
        let mut resolver = Self {
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
            let entity = resolver.entity_of(SymbolKind::File, &file.name);
            resolver.note(entity, index, 0..0, 0..0, true);
        }
        resolver.collect_defines();
        resolver
    }

    pub(super) fn text(&self, file: usize) -> &'p str {
        &self.project.files[file].text
    }

    /// Adds a thing.
    pub(super) fn entity(&mut self, kind: SymbolKind, name: &'p str) -> usize {
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

    /// Returns the thing of a name that counts for the whole project, a new one for a new name.
    pub(super) fn entity_of(&mut self, kind: SymbolKind, name: &'p str) -> usize {
        if let Some(&entity) = self.by_name.get(&(kind, name)) {
            return entity;
        }
        let entity = self.entity(kind, name);
        self.by_name.insert((kind, name), entity);
        entity
    }

    /// Returns the thing that stands for all that are the same as one.
    pub(super) fn root(&mut self, mut entity: usize) -> usize {
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

    /// Makes two things count as one.
    pub(super) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (first, second) = (a.min(b), a.max(b));
        self.entities[second].parent = first;
    }

    /// Notes a place of a name.
    pub(super) fn note(
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

    pub(super) fn frame(&mut self) -> &mut Frame<'p> {
        self.frames.last_mut().expect("the project's own frame")
    }

    /// Finds the command that the texts define under a name: so far, else further down.
    pub(super) fn own(&self, name: &str) -> Option<&Rc<Own<'p>>> {
        self.defines.get(name).or_else(|| self.later.get(name))
    }

    /// Returns the type of a variable that can be seen here; `None` if there is no such variable.
    pub(super) fn type_of(&self, name: &str) -> Option<Type> {
        let frame = self.frames.last()?;
        frame
            .types
            .get(name)
            .or_else(|| self.frames[0].types.get(name))
            .copied()
    }

    /// Finds all commands that the texts define, since they can be called further up.
    pub(super) fn collect_defines(&mut self) {
        let syntaxes: &'s [Syntax] = self.syntaxes;
        for (file, syntax) in syntaxes.iter().enumerate() {
            for event in walk::events(&syntax.block) {
                let Event::Define(node) = event else { continue };
                let name = self.symbols.word(node.name);
                let mut parameters = Vec::new();
                for formal in &node.parameters {
                    let parameter = self.symbols.word(formal.name);
                    let entity = self.entity(SymbolKind::Parameter, parameter);
                    self.entities[entity].value = value_type(formal.takes);
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
}

/// Returns the type of the values that a parameter takes.
pub fn value_type(takes: Takes) -> Type {
    match takes {
        Takes::Number => Type::Number,
        Takes::Triple => Type::Triple,
        Takes::Surface => Type::Name,
    }
}
