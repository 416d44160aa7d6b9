//! The shapes and objects that a running text has made.
//!
//! An object is a range of shapes. Transforms are applied at once to the shapes of their object,
//! which comes to the same as applying them later: an inner object's before an outer one's. A body
//! is an object whose shapes blend with no others.

use crate::geometry::Transform;
use crate::limits::{CURVE_WEIGHT, MAX_ELEMENTS, MAX_NESTED_OBJECTS, MAX_OBJECTS};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::suggest;
use field::Skeleton;
use field::skeleton::Map;
use glam::DAffine3;
use scene::curves::MOST_FLAT;
use scene::{Body, Contact, Element, Ends, Shape};
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;
use std::rc::Rc;

/// Number of shapes as which a limb counts that ends flat: each is a function of its own.
const FLAT_WEIGHT: usize = MAX_ELEMENTS / MOST_FLAT;

/// Shape and all that the language must remember of it.
#[derive(Clone, Debug)]
pub struct Part {
    /// The shape; its material is an index of the palette.
    pub element: Element,
    /// The depth of influence from which its radius follows, in lengths of its command.
    pub depth: Option<f64>,
    /// The factor by which it has been scaled, which its material's radius must follow.
    pub growth: f64,
    /// The map from the coordinates of its command to those of the world, if they differ. (In a
    /// box, as there may be very many shapes and few of them are moved.)
    pub moved: Option<Box<DAffine3>>,
    /// Whether its command may have made other shapes too.
    pub repeated: bool,
    /// Whether its width varies along it, so that it counts as more than one shape.
    pub tapers: bool,
    /// Number of shapes as which the limbs of a skeleton count; 0 for others.
    pub limbs: usize,
    /// Whether it has been removed.
    pub removed: bool,
    /// The names of a skeleton's nodes.
    pub nodes: Option<Rc<Vec<String>>>,
    /// Whether `motion` has moved it.
    pub moves: bool,
}

impl Part {
    /// Returns the number of shapes as which it counts.
    fn weight(&self) -> usize {
        if self.limbs > 0 {
            return self.limbs;
        }
        let skeleton = self.element.shape.skeleton();
        let bone = self.element.shape.bone();
        if bone.is_some_and(|bone| bone.soft_ends != [Ends::Round; 2]) {
            return FLAT_WEIGHT;
        }
        match (&self.element.shape, skeleton) {
            (_, Some(Skeleton::Polygon { rings })) => rings.iter().map(Vec::len).sum(),
            (_, Some(line)) if line.is_numeric() => CURVE_WEIGHT,
            (Shape::Function(function), _) => function.weight(),
            _ if self.tapers => CURVE_WEIGHT,
            _ => 1,
        }
    }
}

impl Part {
    /// Returns the number of its flat ends that count; a limb by itself counts as one.
    fn flat_ends(&self) -> usize {
        match self.element.shape.bone() {
            Some(bone) => usize::from(bone.soft_ends != [Ends::Round; 2]),
            None => self.element.shape.curves().map_or(0, |own| own.flat.len()),
        }
    }
}

/// The kind of an object, by the command that begins it.
#[derive(Clone, Debug)]
pub enum Group<'a> {
    /// `object`
    Object,
    /// `chain`, with the name of its material.
    Chain(Name<'a>),
    /// `body`
    Body,
}

/// An object that has been begun.
#[derive(Debug)]
struct Object<'a> {
    name: &'a str,
    /// The file and place of its name.
    place: (usize, Range<usize>),
    start: usize,
    group: Group<'a>,
}

/// An object that has been closed.
#[derive(Debug)]
struct Closed {
    /// The shapes.
    range: Range<usize>,
    /// The file and place of its name; none for a copy.
    place: Option<(usize, Range<usize>)>,
    /// Whether a command has named it.
    is_named: Cell<bool>,
}

/// The shapes and objects.
#[derive(Debug, Default)]
pub struct Model<'a> {
    /// The shapes.
    pub parts: Vec<Part>,
    /// Objects and chains that could not be begun, whose `close` is still to come.
    pub refused: usize,
    open: Vec<Object<'a>>,
    closed: HashMap<&'a str, Closed>,
    count: usize,
    /// Weight of the shapes, see [`Part::weight`].
    weight: usize,
    /// Number of flat ends, see [`Part::flat_ends`].
    flat: usize,
    /// The last shape or closed object.
    last: Option<Range<usize>>,
    /// The material of the chain that is open.
    pub chain: Option<Name<'a>>,
    /// The bodies but the one without a name, which is body 0.
    pub bodies: Vec<Body>,
    /// The body that is open; 0 for none.
    open_body: u32,
    /// The pairs of bodies that touch.
    pub contacts: Vec<Contact>,
    /// The file and place of each contact's command.
    pub contact_places: Vec<(usize, Range<usize>)>,
}

impl<'a> Model<'a> {
    /// Adds a shape.
    ///
    /// # Errors
    /// Fatally, if there are too many.
    pub fn push(&mut self, part: Part, span: &Range<usize>) -> Outcome<()> {
        let flat = self.flat + part.flat_ends();
        if flat > MOST_FLAT {
            return Err(Problem::new(
                span,
                format!("stopped here: there are more than {MOST_FLAT} flat ends"),
            )
            .hint("let ends be round where that does not matter")
            .fatal());
        }
        let weight = self.weight + part.weight();
        if weight > MAX_ELEMENTS {
            let hint = if self.parts.len() < MAX_ELEMENTS / 2 {
                format!(
                    "a curve or a limb that tapers counts as {CURVE_WEIGHT} shapes, one that ends \
                     flat as {FLAT_WEIGHT}, a polygon as many as it has corners"
                )
            } else {
                String::from("make fewer shapes, or fewer turns of a loop")
            };
            return Err(Problem::new(
                span,
                format!("stopped here: there are more than {MAX_ELEMENTS} shapes"),
            )
            .hint(hint)
            .fatal());
        }
        (self.weight, self.flat) = (weight, flat);
        self.last = Some(self.parts.len()..self.parts.len() + 1);
        self.parts.push(part);
        Ok(())
    }

    /// Makes all shapes from `first` on one object without a name, which transforms without a name
    /// move.
    pub fn group(&mut self, first: usize) {
        self.last = Some(first..self.parts.len());
    }

    /// Returns the body that shapes made now belong to.
    #[must_use]
    pub fn body(&self) -> u32 {
        self.open_body
    }

    /// Adds a body.
    fn new_body(&mut self, name: &str) -> u32 {
        self.bodies.push(Body {
            name: name.to_owned(),
        });
        self.bodies.len() as u32
    }

    /// Begins an object, a chain of shapes of one material, or a body.
    ///
    /// # Errors
    /// If there are too many, or a body stands in a body.
    pub fn open(&mut self, file: usize, name: &Name<'a>, group: Group<'a>) -> Outcome<()> {
        if self.open.len() >= MAX_NESTED_OBJECTS {
            return Err(Problem::new(
                &name.span,
                format!("objects can stand inside each other {MAX_NESTED_OBJECTS} deep at most"),
            ));
        }
        if self.chain.is_some() {
            let mut problem = Problem::new(&name.span, "a chain holds shapes only, no objects")
                .hint("`close` the chain first");
            if let Some((_, (file, span))) = self.innermost() {
                problem = problem.with_place(Some(*file), span.clone(), "the chain begins here");
            }
            return Err(problem);
        }
        if self.count >= MAX_OBJECTS {
            return Err(Problem::new(
                &name.span,
                format!("there are more than {MAX_OBJECTS} objects"),
            ));
        }
        match &group {
            Group::Object => {}
            Group::Chain(material) => self.chain = Some(material.clone()),
            Group::Body => {
                self.refuse_body_in_body(&name.span)?;
                self.open_body = self.new_body(name.text);
            }
        }
        self.count += 1;
        self.open.push(Object {
            name: name.text,
            place: (file, name.span.clone()),
            start: self.parts.len(),
            group,
        });
        Ok(())
    }

    /// Returns an error if a body is open.
    fn refuse_body_in_body(&self, span: &Range<usize>) -> Outcome<()> {
        let mut open = self.open.iter();
        let Some(outer) = open.find(|object| matches!(object.group, Group::Body)) else {
            return Ok(());
        };
        let (file, place) = outer.place.clone();
        Err(Problem::new(
            span,
            format!("a body cannot stand in another; `{}` is open", outer.name),
        )
        .hint(format!("`close {}` first, or use `object`", outer.name))
        .with_place(Some(file), place, "it begins here"))
    }

    /// Ends the innermost object; returns its name, or `None` if there is none.
    pub fn close(&mut self) -> Option<&'a str> {
        let object = self.open.pop()?;
        match object.group {
            Group::Object => {}
            Group::Chain(_) => self.chain = None,
            Group::Body => self.open_body = 0,
        }
        let range = object.start..self.parts.len();
        self.last = Some(range.clone());
        let closed = Closed {
            range,
            place: Some(object.place),
            is_named: Cell::new(false),
        };
        self.closed.insert(object.name, closed);
        Some(object.name)
    }

    /// Returns the name of the innermost object that is open, and the file and place where it
    /// begins.
    #[must_use]
    pub fn innermost(&self) -> Option<(&'a str, &(usize, Range<usize>))> {
        self.open.last().map(|object| (object.name, &object.place))
    }

    /// Returns the place where an object of this name was begun, if no command has named it since.
    #[must_use]
    pub fn idle_place(&self, name: &str) -> Option<&(usize, Range<usize>)> {
        let object = self.closed.get(name)?;
        object.place.as_ref().filter(|_| !object.is_named.get())
    }

    /// Finds the shapes of an object.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn find(&self, name: &Name<'_>) -> Outcome<Range<usize>> {
        if let Some(object) = self.closed.get(name.text) {
            object.is_named.set(true);
            return Ok(object.range.clone());
        }
        if let Some(object) = self.open.iter().find(|object| object.name == name.text) {
            let (file, span) = object.place.clone();
            return Err(Problem::new(
                &name.span,
                format!("the object `{}` is not complete yet", name.text),
            )
            .hint("put this after its `close`")
            .with_place(Some(file), span, "it begins here"));
        }
        let suggestion = suggest::hint(name.text, self.closed.keys().copied());
        Err(
            Problem::new(&name.span, format!("there is no object `{}`", name.text))
                .maybe_hint(suggestion),
        )
    }

    /// Returns whether a body has a skeleton that is convolved locally.
    pub fn has_local(&self, body: u32) -> bool {
        let elements = self.parts.iter().map(|part| &part.element);
        let mut curves = elements
            .filter(|own| own.body == body)
            .filter_map(|own| own.shape.curves());
        curves.any(|curves| curves.local.is_some())
    }

    /// Finds the number of the last body of a name.
    ///
    /// # Errors
    /// If there is none, or it is still open.
    pub fn find_body(&self, name: &Name<'_>) -> Outcome<u32> {
        if self.open.iter().any(|object| object.name == name.text) {
            self.find(name)?;
        }
        if let Some(index) = self.bodies.iter().rposition(|body| body.name == name.text) {
            if let Some(closed) = self.closed.get(name.text) {
                closed.is_named.set(true);
            }
            return Ok(index as u32 + 1);
        }
        let problem = if self.closed.contains_key(name.text) {
            Problem::new(
                &name.span,
                format!("`{}` is an object, not a body", name.text),
            )
            .hint(format!("begin it with `body {}`", name.text))
        } else {
            let names = self.bodies.iter().map(|body| body.name.as_str());
            Problem::new(&name.span, format!("there is no body `{}`", name.text))
                .maybe_hint(suggest::hint(name.text, names))
        };
        Err(problem)
    }

    /// Returns the last shape or closed object.
    ///
    /// # Errors
    /// If there is none.
    pub fn last(&self, span: &Range<usize>) -> Outcome<Range<usize>> {
        self.last.clone().ok_or_else(|| {
            Problem::new(span, "there is no object yet").hint("make an object or a shape first")
        })
    }

    /// Applies a transform to shapes.
    pub fn transform(&mut self, range: Range<usize>, transform: &Transform) {
        for part in &mut self.parts[range] {
            part.element.shape = part.element.shape.transform(transform);
            part.growth *= transform.growth;
            let before = part.moved.as_deref().copied().unwrap_or_default();
            part.moved = Some(Box::new(transform.affine() * before));
        }
    }

    /// Removes shapes.
    pub fn remove(&mut self, range: Range<usize>) {
        self.closed
            .retain(|_, Closed { range: own, .. }| own.start < range.start || own.end > range.end);
        for part in &mut self.parts[range] {
            part.removed = true;
        }
    }

    /// Copies shapes as a new object, which becomes the last. Inside a body the copies join it;
    /// elsewhere each body among them becomes a new one, which has the copy's name if all copies
    /// are of one body and else keeps its own.
    ///
    /// # Errors
    /// If bodies would stand in a body; fatally, if there are too many shapes.
    pub fn copy(&mut self, range: Range<usize>, name: &Name<'a>) -> Outcome<()> {
        let start = self.parts.len();
        let bodies = self.bodies_of(range.clone(), name)?;
        for index in range {
            self.parts[index].repeated = true;
            let mut part = self.parts[index].clone();
            part.element.body = match self.open_body {
                0 => bodies.get(&part.element.body).copied().unwrap_or(0),
                open => open,
            };
            self.push(part, &name.span)?;
        }
        let range = start..self.parts.len();
        self.last = Some(range.clone());
        let closed = Closed {
            range,
            place: None,
            is_named: Cell::new(false),
        };
        self.closed.insert(name.text, closed);
        Ok(())
    }

    /// Makes bodies for copies of some shapes; returns the number of each by that of the old body.
    fn bodies_of(&mut self, range: Range<usize>, name: &Name<'a>) -> Outcome<BTreeMap<u32, u32>> {
        let parts = self.parts[range].iter();
        let old: BTreeSet<u32> = parts.map(|part| part.element.body).collect();
        let named: Vec<u32> = old.iter().copied().filter(|&body| body != 0).collect();
        if self.open_body != 0 {
            // Pieces of the open body and of no body may be copied into it, another body may not.
            if named.iter().any(|&body| body != self.open_body) {
                self.refuse_body_in_body(&name.span)?;
            }
            return Ok(BTreeMap::new());
        }
        let mut new = BTreeMap::new();
        for body in named {
            let own = match old.len() {
                1 => name.text.to_owned(),
                _ => self.bodies[body as usize - 1].name.clone(),
            };
            new.insert(body, self.new_body(&own));
        }
        Ok(new)
    }

    /// Returns the number of shapes as which they count.
    #[must_use]
    pub fn weight(&self) -> usize {
        self.weight
    }

    /// Returns whether some of these shapes are round, so that only a uniform scale keeps their
    /// kind.
    #[must_use]
    pub fn has_round(&self, range: Range<usize>) -> bool {
        self.parts[range].iter().any(|part| {
            let shape = &part.element.shape;
            let skeleton = shape.skeleton();
            shape.curves().is_some() || skeleton.is_some_and(|bone| bone.dimension() == 1)
        })
    }

    /// Forgets all shapes and objects; objects that are open stay open. Bodies stay: what is open
    /// belongs to one.
    pub fn clear(&mut self) {
        self.parts.clear();
        self.contacts.clear();
        self.contact_places.clear();
        (self.weight, self.flat) = (0, 0);
        self.closed.clear();
        self.last = None;
        for object in &mut self.open {
            object.start = 0;
        }
    }
}
