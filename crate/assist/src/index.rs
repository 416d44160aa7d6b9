//! An index of a project: the things that its texts name, and all places of their names.
//!
//! `resolve` fills it; here are its types and the questions that it answers.

use crate::grammar::Grammar;
use crate::slots::{Slot, Type, Want};
use rats::Project;
use rats::commands::CommandSpec;
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

/// Kinds of things that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SymbolKind {
    /// A variable.
    Variable,
    /// The variable of a loop.
    Loop,
    /// A parameter of a defined command.
    Parameter,
    /// A material.
    Material,
    /// A texture.
    Texture,
    /// An object or chain.
    Object,
    /// A command that the text defines.
    Command,
    /// A file of the project.
    File,
    /// A node of a skeleton.
    Node,
    /// A set of values for sliders.
    Preset,
}

impl SymbolKind {
    /// Returns the kind in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Variable => "variable",
            Self::Loop => "loop variable",
            Self::Parameter => "parameter",
            Self::Material => "material",
            Self::Texture => "texture",
            Self::Object => "object",
            Self::Command => "command",
            Self::File => "file",
            Self::Node => "node",
            Self::Preset => "preset",
        }
    }

    /// Returns whether it holds a value.
    #[must_use]
    pub fn is_variable(self) -> bool {
        matches!(self, Self::Variable | Self::Loop | Self::Parameter)
    }
}

/// A place in a project.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The index of the file.
    pub file: usize,
    /// The byte range in it.
    pub span: Range<usize>,
}

/// A place where a name stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The place.
    pub place: Place,
    /// Whether the name is made, set or set anew here.
    pub is_definition: bool,
    /// The whole command in which it stands.
    pub command: Range<usize>,
    /// The turn, roughly as the texts run.
    pub(crate) order: usize,
    pub(crate) entity: usize,
}

impl Occurrence {
    /// Returns what occurrences are sorted by: file, place and turn.
    pub(crate) fn sort_key(&self) -> [usize; 4] {
        let span = &self.place.span;
        [self.place.file, span.start, span.end, self.order]
    }
}

/// A thing that has a name.
#[derive(Clone, Debug)]
pub(crate) struct Entity<'p> {
    pub kind: SymbolKind,
    pub name: &'p str,
    /// The thing itself, or another one that is the same.
    pub parent: usize,
    pub is_defined: bool,
    /// The defined command it is local to, by its order.
    pub owner: Option<usize>,
    /// The type of the value of a parameter or variable, as far as it is known.
    pub value: Type,
    pub first: Option<Occurrence>,
}

/// A name as the editor lists it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// The kind of thing it stands for.
    pub kind: SymbolKind,
    /// The place where it is first made.
    pub place: Place,
}

/// The command at a place, read.
#[derive(Clone, Debug)]
pub(crate) struct Here<'p> {
    pub file: usize,
    /// The command's word as written, and its place.
    pub word: &'p str,
    pub word_span: Range<usize>,
    /// The row in the table; `None` for a command that the text defines, and for a mistake.
    pub spec: Option<&'static CommandSpec>,
    /// The place where the text defines it, if it does.
    pub own: Option<Place>,
    pub grammar: Rc<Grammar<'p>>,
    /// The operands with their byte ranges.
    pub operands: Vec<(Range<usize>, Slot<'p>)>,
    /// Operands and words that could come where the operands before the place end.
    pub wants: Vec<Want<'p>>,
    /// The variables that can be seen here, with their types and kinds.
    pub variables: Vec<(&'p str, Type, SymbolKind)>,
}

/// The index of a project.
///
/// ```
/// use assist::{Index, SymbolKind};
///
/// let text = "surface Clay, diffuse SandyBrown\nfor i = 1 to 3 { sphere Clay 1, i 0 0 }\n";
/// let project = rats::Project::single(text);
/// let index = Index::of(&project);
/// let names: Vec<_> = index.symbols().into_iter().map(|s| (s.kind, s.name)).collect();
/// assert!(names.contains(&(SymbolKind::Material, "Clay".into())));
/// assert!(names.contains(&(SymbolKind::Loop, "i".into())));
/// ```
#[derive(Debug)]
pub struct Index<'p> {
    pub(crate) project: &'p Project,
    pub(crate) entities: Vec<Entity<'p>>,
    /// The places of names, in the order of files and places.
    pub(crate) occurrences: Vec<Occurrence>,
    pub(crate) here: Option<Here<'p>>,
    /// The first mistake of form: file, byte and message. A block that is not closed is not
    /// indexed.
    pub(crate) mistake: Option<(usize, usize, String)>,
}

impl<'p> Index<'p> {
    /// Returns the thing that stands for all that are the same.
    fn root(&self, entity: usize) -> usize {
        self.entities[entity].parent
    }

    /// Finds the place of a name at a byte: one that the byte is in, else one that ends there.
    pub(crate) fn occurrence(&self, file: usize, byte: usize) -> Option<&Occurrence> {
        let end = self
            .occurrences
            .partition_point(|o| (o.place.file, o.place.span.start) <= (file, byte));
        // A byte between two names belongs to the one that begins there, which is the later one.
        let found = self.occurrences.get(end.checked_sub(1)?)?;
        let touches = found.place.file == file && byte <= found.place.span.end;
        // A file as a whole has no place in its text.
        (touches && !found.place.span.is_empty()).then_some(found)
    }

    /// Finds the thing that a name at a byte stands for; `None` if no name is there.
    #[must_use]
    pub fn symbol_at(&self, file: usize, byte: usize) -> Option<Symbol> {
        let occurrence = self.occurrence(file, byte)?;
        let entity = &self.entities[self.root(occurrence.entity)];
        Some(Symbol {
            name: entity.name.to_owned(),
            kind: self.entities[occurrence.entity].kind,
            place: entity.first.as_ref()?.place.clone(),
        })
    }

    /// Returns all places of the same name as at an occurrence.
    pub(crate) fn all_of(&self, occurrence: &Occurrence) -> impl Iterator<Item = &Occurrence> {
        let root = self.root(occurrence.entity);
        let all = self.occurrences.iter();
        all.filter(move |other| self.root(other.entity) == root)
    }

    /// Returns the kind of an occurrence's name.
    pub(crate) fn kind(&self, occurrence: &Occurrence) -> SymbolKind {
        self.entities[occurrence.entity].kind
    }

    /// Returns an occurrence's name.
    pub(crate) fn name(&self, occurrence: &Occurrence) -> &'p str {
        self.entities[occurrence.entity].name
    }

    /// Finds the definition that is in force at an occurrence: itself, else the last one before it,
    /// else the first.
    pub(crate) fn definition(&self, occurrence: &Occurrence) -> Option<&Occurrence> {
        let mut definitions = self.all_of(occurrence).filter(|o| o.is_definition);
        if occurrence.is_definition {
            return definitions.find(|o| o.place == occurrence.place);
        }
        let definitions: Vec<_> = definitions.collect();
        let before = definitions.iter().filter(|o| o.order < occurrence.order);
        before
            .max_by_key(|o| o.order)
            .or_else(|| definitions.iter().min_by_key(|o| o.order))
            .copied()
    }

    /// Returns every name of the project, once, in the order in which they are first made.
    #[must_use]
    pub fn symbols(&self) -> Vec<Symbol> {
        let mut first: Vec<&Occurrence> = Vec::new();
        let mut seen = vec![false; self.entities.len()];
        let mut in_order: Vec<&Occurrence> = self
            .occurrences
            .iter()
            .filter(|o| o.is_definition)
            .collect();
        field::heap_sort(&mut in_order, |a, b| a.order < b.order);
        for occurrence in in_order {
            let root = self.root(occurrence.entity);
            if !std::mem::replace(&mut seen[root], true) {
                first.push(occurrence);
            }
        }
        first
            .into_iter()
            .map(|o| Symbol {
                name: self.name(o).to_owned(),
                kind: self.kind(o),
                place: o.place.clone(),
            })
            .collect()
    }

    /// Returns every place of a name, in the order of files and places: the kind of thing, the
    /// name, the place, and whether it is made there.
    pub fn places(&self) -> impl Iterator<Item = (SymbolKind, &'p str, &Place, bool)> {
        self.occurrences
            .iter()
            .map(|o| (self.kind(o), self.name(o), &o.place, o.is_definition))
    }

    /// Returns the names of a kind, each once, for completions; without those that the command at
    /// the place that is asked for makes itself.
    pub(crate) fn names(&self, kind: SymbolKind) -> Vec<&'p str> {
        let mut names: Vec<&'p str> = self
            .entities
            .iter()
            .filter(|e| e.kind == kind && e.first.as_ref().is_some_and(|o| !self.is_here(o)))
            .map(|e| e.name)
            .collect();
        field::heap_sort(&mut names, |a, b| a < b);
        names.dedup();
        names
    }

    /// Returns whether an occurrence is in the command at the place that is asked for.
    fn is_here(&self, o: &Occurrence) -> bool {
        let here = self.here.as_ref();
        here.is_some_and(|h| h.file == o.place.file && h.word_span.start == o.command.start)
    }

    /// Finds another thing of the same kind that already has a name and could be taken for the one
    /// at an occurrence.
    pub(crate) fn clash(&self, occurrence: &Occurrence, name: &str) -> Option<Place> {
        let root = self.root(occurrence.entity);
        let mine = &self.entities[occurrence.entity];
        self.entities
            .iter()
            .enumerate()
            .filter(|(_, e)| e.name == name && e.is_defined)
            .filter(|(_, e)| {
                if mine.kind.is_variable() {
                    e.kind.is_variable() && e.owner == mine.owner
                } else {
                    e.kind == mine.kind
                }
            })
            .filter(|(i, _)| self.root(*i) != root)
            .find_map(|(_, e)| e.first.as_ref().map(|o| o.place.clone()))
    }

    /// Returns the places that name a file.
    pub(crate) fn uses_of_file(&self, name: &str) -> impl Iterator<Item = &Place> {
        let uses = self.occurrences.iter().filter(move |o| {
            let entity = &self.entities[o.entity];
            !o.is_definition && entity.kind == SymbolKind::File && entity.name == name
        });
        uses.map(|o| &o.place)
    }

    /// Returns for every occurrence, in order, the file, whether it defines, and the number of its
    /// thing, counted from the first. Two texts that name alike have the same shape.
    pub(crate) fn shape(&self) -> Vec<(usize, bool, usize)> {
        let mut numbers = HashMap::new();
        self.occurrences
            .iter()
            .map(|o| {
                let next = numbers.len();
                let number = *numbers.entry(self.root(o.entity)).or_insert(next);
                (o.place.file, o.is_definition, number)
            })
            .collect()
    }
}
