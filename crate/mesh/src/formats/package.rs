//! 3MF's packages: a zip archive with descriptions in XML of objects, and of where they are.
//!
//! Objects with their triangles and beam lattices are read, in all parts that items and components
//! name (the production extension), of the materials base materials and groups of colours.
//! Textures, slices and support are passed over.

use super::text;
use super::xml::{Event, Reader, Tag};
use crate::color::linear_from_srgb;
use crate::error::{Error, fail};
use crate::limits::{MAX_BEAMS, MAX_MATERIALS, MAX_TRIANGLES, MAX_VERTICES, MAX_XML};
use crate::triangle_mesh::Material;
use archive::Archive;
use core::str::FromStr;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{BTreeMap, HashMap};

/// Members of an archive that are looked at.
const MAX_MEMBERS: usize = 10_000;
/// Parts with descriptions.
const MAX_PARTS: usize = 10_000;
/// Places of objects.
const MAX_PLACES: usize = 200_000;

/// Property of a corner or a beam: a resource's number and an index into it.
pub type Property = (u32, u32);

/// Object: triangles, beams, or components that are objects themselves.
#[derive(Default)]
pub struct Object {
    /// Name; may be empty.
    pub name: String,
    /// Property of triangles that have none of their own.
    pub property: Option<Property>,
    /// Positions of the vertices, in the unit of the object's part.
    pub positions: Vec<DVec3>,
    /// Vertices, and the properties of the three corners.
    pub triangles: Vec<([u32; 3], [Option<Property>; 3])>,
    /// Lattice between the vertices.
    pub lattice: Option<Lattice>,
    components: Vec<Place>,
}

/// Lattice of beams, with lengths in the unit of its part.
#[derive(Default)]
pub struct Lattice {
    /// The beams.
    pub beams: Vec<Beam>,
    /// Vertices at which balls are, with their radii.
    pub balls: Vec<(u32, f64)>,
    /// Radius of a ball at each vertex of a beam, if there are such.
    pub ball_everywhere: Option<f64>,
    /// Shortest beams that count.
    pub least_length: f64,
    /// Whether the lattice is kept inside of a mesh or outside, and the number of the mesh's object
    /// in the same part.
    pub clip: Option<(bool, u32)>,
    radius: f64,
    ball_radius: f64,
    is_flat: bool,
    property: Option<Property>,
}

/// Beam between two vertices.
pub struct Beam {
    /// Indices of vertices, which may be missing.
    pub ends: [u32; 2],
    /// Radius at either end.
    pub radii: [f64; 2],
    /// Whether it ends in a plane, not in a ball.
    pub is_flat: [bool; 2],
    /// Property of its material.
    pub property: Option<Property>,
}

/// Place of an object in another, or in the world.
struct Place {
    /// Index of the part, and number of the object.
    object: (usize, u32),
    map: DAffine3,
}

/// Description in one file of a package.
#[derive(Default)]
pub struct Part {
    /// Millimetres of its unit.
    pub millimetres: f64,
    /// Base materials, by the number of their resource.
    pub materials: BTreeMap<u32, Vec<Material>>,
    /// Groups of colours, by the number of their resource: linear RGB.
    pub colors: BTreeMap<u32, Vec<[f32; 3]>>,
    /// The objects, by their numbers.
    pub objects: BTreeMap<u32, Object>,
}

/// Content of a 3MF file.
pub struct Package {
    /// The parts; the first is the main one.
    pub parts: Vec<Part>,
    items: Vec<Place>,
}

impl Package {
    /// Reads a package.
    ///
    /// # Errors
    /// If it is broken, over a limit, or has objects that contain themselves.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let archive = Archive::open(bytes, MAX_MEMBERS).map_err(unread)?;
        let mut rest = MAX_XML;
        let main = main_part(&archive, &mut rest)?.to_lowercase();
        let mut loader = Loader {
            names: vec![main.clone()],
            numbers: HashMap::from([(main, 0)]),
            ..Loader::default()
        };
        let mut parts = Vec::new();
        while let Some(name) = loader.names.get(parts.len()).cloned() {
            let Some(text) = member(&archive, &name, &mut rest)? else {
                return match parts.len() {
                    0 => fail("this zip archive has no 3MF model"),
                    _ => fail(format!("this 3MF file has no part `{}`", shorten(&name))),
                };
            };
            let text = text::decode(&text);
            let read = loader.part(&text, parts.len());
            let part = read.map_err(|Error(text)| match parts.len() {
                0 => Error(text),
                _ => Error(format!("`{}`: {text}", shorten(&name))),
            })?;
            parts.push(part);
        }
        let package = Self {
            parts,
            items: loader.items,
        };
        package.check_order()?;
        Ok(package)
    }

    /// Millimetres of the unit in which [`Self::visit`] tells places.
    #[must_use]
    pub fn millimetres(&self) -> f64 {
        self.parts[0].millimetres
    }

    /// Visits each object at each of its places, with its part and the map from its part's unit to
    /// the world, in the main part's unit.
    ///
    /// # Errors
    /// If an object is missing, there are too many places, or `visit` returns an error.
    pub fn visit(
        &self,
        visit: impl FnMut(&Part, &Object, &DAffine3) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut open: Vec<((usize, u32), DAffine3)> = Vec::new();
        self.open(0, &self.items, DAffine3::IDENTITY, &mut open);
        self.walk(open, visit)
    }

    /// Visits an object of a part at a place, and the objects that it is made of at theirs.
    ///
    /// # Errors
    /// Fails as [`Self::visit`] does.
    pub fn visit_object(
        &self,
        part: &Part,
        id: u32,
        place: &DAffine3,
        visit: impl FnMut(&Part, &Object, &DAffine3) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let number = self.parts.iter().position(|own| std::ptr::eq(own, part));
        let open = number.map(|number| ((number, id), *place));
        self.walk(open.into_iter().collect(), visit)
    }

    /// Visits objects at their places, and the objects that they are made of.
    fn walk(
        &self,
        mut open: Vec<((usize, u32), DAffine3)>,
        mut visit: impl FnMut(&Part, &Object, &DAffine3) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut tally = 0;
        while let Some((id, map)) = open.pop() {
            // Objects in objects may be many, and a mesh that clips may contain itself.
            tally += 1;
            if tally + open.len() > MAX_PLACES {
                return fail(format!("this 3MF file has more than {MAX_PLACES} parts"));
            }
            let object = self.object(id)?;
            visit(&self.parts[id.0], object, &map)?;
            self.open(id.0, &object.components, map, &mut open);
        }
        Ok(())
    }

    /// Puts places in a part on top of those that are still to be visited.
    fn open(
        &self,
        part: usize,
        places: &[Place],
        outer: DAffine3,
        open: &mut Vec<((usize, u32), DAffine3)>,
    ) {
        open.extend(places.iter().rev().map(|place| {
            let map = outer * place.map;
            let [own, other] = [part, place.object.0].map(|part| self.parts[part].millimetres);
            let map = match own == other {
                true => map,
                false => map * DAffine3::from_scale(DVec3::splat(other / own)),
            };
            (place.object, map)
        }));
    }

    fn object(&self, (part, id): (usize, u32)) -> Result<&Object, Error> {
        let object = self.parts[part].objects.get(&id);
        object.ok_or_else(|| Error(format!("this 3MF file has no object {id}")))
    }

    /// Checks that no object contains itself.
    fn check_order(&self) -> Result<(), Error> {
        // Whether the objects inside of one are being visited, or have been.
        let mut is_open: HashMap<(usize, u32), bool> = HashMap::new();
        let mut to_do: Vec<((usize, u32), bool)> =
            self.items.iter().map(|item| (item.object, true)).collect();
        while let Some((id, begins)) = to_do.pop() {
            if !begins {
                is_open.insert(id, false);
                continue;
            }
            match is_open.get(&id) {
                Some(true) => {
                    return fail(format!("object {} of this 3MF file contains itself", id.1));
                }
                Some(false) => continue,
                None => is_open.insert(id, true),
            };
            to_do.push((id, false));
            let components = &self.object(id)?.components;
            to_do.extend(components.iter().map(|place| (place.object, true)));
        }
        Ok(())
    }
}

/// Reader of the parts.
#[derive(Default)]
struct Loader {
    /// Names of the parts, and their indices by these.
    names: Vec<String>,
    numbers: HashMap<String, usize>,
    items: Vec<Place>,
    /// Vertices, triangles, other things and colours so far.
    counts: [usize; 4],
}

/// Resource or object whose tag is open.
#[derive(Default)]
struct Open {
    part: Part,
    /// Index of the part.
    index: usize,
    id: u32,
    object: Option<Object>,
}

/// The content of a member; `None` if there is none of this name.
fn member(archive: &Archive<'_>, name: &str, rest: &mut usize) -> Result<Option<Vec<u8>>, Error> {
    let Some(entry) = archive.entry(name) else {
        return Ok(None);
    };
    let content = archive.read(entry, *rest).map_err(unread)?;
    *rest -= content.len();
    Ok(Some(content))
}

fn unread(error: archive::Error) -> Error {
    Error(format!("this 3MF file {error}"))
}

/// Returns the beginning of a name, short enough for a sentence.
fn shorten(name: &str) -> String {
    name.chars().take(60).collect()
}

/// The name of the member that describes the model.
fn main_part(archive: &Archive<'_>, rest: &mut usize) -> Result<String, Error> {
    let relations = member(archive, "_rels/.rels", rest)?.unwrap_or_default();
    let text = text::decode(&relations);
    let mut reader = Reader::new(&text);
    while let Some(event) = reader.next()? {
        let Event::Start(tag) = event else { continue };
        let kind = tag.get("Type")?.unwrap_or_default();
        if let Some(target) = tag.get("Target")?.filter(|_| kind.ends_with("/3dmodel")) {
            return Ok(target.trim_start_matches('/').into());
        }
    }
    Ok("3D/3dmodel.model".into())
}

/// The value of an attribute as a number.
fn number<T: FromStr>(tag: &Tag<'_>, name: &str) -> Result<T, Error> {
    optional(tag, name)?.ok_or_else(|| wrong(tag, name))
}

/// The value of an attribute that may be left out.
fn optional<T: FromStr>(tag: &Tag<'_>, name: &str) -> Result<Option<T>, Error> {
    match tag.get(name)? {
        Some(text) => text.trim().parse().map(Some).map_err(|_| wrong(tag, name)),
        None => Ok(None),
    }
}

fn wrong(tag: &Tag<'_>, name: &str) -> Error {
    Error(format!(
        "line {}: a `{}` of this 3MF file has no number `{name}`",
        tag.line(),
        tag.name()
    ))
}

/// Returns a length above or at 0 that may be left out.
fn length(tag: &Tag<'_>, name: &str) -> Result<Option<f64>, Error> {
    match optional(tag, name)? {
        Some(length) if !(0.0..f64::INFINITY).contains(&length) => Err(wrong(tag, name)),
        other => Ok(other),
    }
}

/// Twelve numbers: three rows of a matrix, then a shift, for row vectors.
fn transform(tag: &Tag<'_>) -> Result<DAffine3, Error> {
    let Some(text) = tag.get("transform")? else {
        return Ok(DAffine3::IDENTITY);
    };
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    let Ok(m) = <[f64; 12]>::try_from(numbers) else {
        return fail(format!(
            "line {}: a transform in this 3MF file has not twelve numbers",
            tag.line()
        ));
    };
    let [x, y, z, shift] = [0, 3, 6, 9].map(|i| DVec3::new(m[i], m[i + 1], m[i + 2]));
    Ok(DAffine3::from_mat3_translation(
        DMat3::from_cols(x, y, z),
        shift,
    ))
}

/// Reads `#RRGGBB` or `#RRGGBBAA`; the opacity is ignored.
fn color(tag: &Tag<'_>, name: &str) -> Result<[f32; 3], Error> {
    let text = tag.get(name)?.unwrap_or_default();
    let channels = [0, 2, 4].map(|i| {
        let digits = text.strip_prefix('#')?.get(i..i + 2)?;
        u8::from_str_radix(digits, 16).ok()
    });
    match channels {
        [Some(r), Some(g), Some(b)] => Ok([r, g, b].map(linear_from_srgb)),
        _ => fail(format!(
            "line {}: `{name}` of a `{}` in this 3MF file is no colour",
            tag.line(),
            tag.name()
        )),
    }
}

/// Whether a beam's end is flat; `None` if its tag does not say so.
fn cap(tag: &Tag<'_>, name: &str) -> Result<Option<bool>, Error> {
    Ok(tag.get(name)?.map(|cap| cap == "butt"))
}

/// Returns the property of a tag: of the group that it names or the default's, and of an index.
fn property(
    tag: &Tag<'_>,
    index: &str,
    otherwise: Option<Property>,
) -> Result<Option<Property>, Error> {
    let group = optional(tag, "pid")?.or(otherwise.map(|(id, _)| id));
    let index = optional(tag, index)?;
    Ok(group.zip(index).or(otherwise))
}

impl Loader {
    fn part(&mut self, text: &str, index: usize) -> Result<Part, Error> {
        let mut open = Open {
            index,
            ..Open::default()
        };
        open.part.millimetres = 1.0;
        let mut reader = Reader::new(text);
        while let Some(event) = reader.next()? {
            match event {
                Event::Start(tag) => self.start(&tag, &mut open)?,
                Event::End(name) if name == "object" => {
                    if let Some(object) = open.object.take() {
                        open.part.objects.insert(open.id, object);
                    }
                }
                Event::End(_) => {}
            }
        }
        if !reader.is_whole() {
            return fail("this 3MF file is cut off: a tag does not end");
        }
        Ok(open.part)
    }

    /// Counts what takes memory.
    fn count(&mut self, kind: usize, most: usize, what: &str) -> Result<(), Error> {
        self.counts[kind] += 1;
        if self.counts[kind] > most {
            return fail(format!("this 3MF file has more than {most} {what}"));
        }
        Ok(())
    }

    /// Reads the place of an object.
    fn place(&mut self, tag: &Tag<'_>, part: usize) -> Result<Place, Error> {
        let id = number(tag, "objectid")?;
        let part = match tag.get("path")? {
            Some(path) => {
                let path = path.trim_start_matches('/').to_lowercase();
                if self.names.len() == MAX_PARTS {
                    return fail(format!("this 3MF file has more than {MAX_PARTS} parts"));
                }
                let next = self.names.len();
                *self.numbers.entry(path).or_insert_with_key(|path| {
                    self.names.push(path.clone());
                    next
                })
            }
            None => part,
        };
        Ok(Place {
            object: (part, id),
            map: transform(tag)?,
        })
    }

    fn start(&mut self, tag: &Tag<'_>, open: &mut Open) -> Result<(), Error> {
        let Open { part, object, .. } = open;
        match (tag.name(), object) {
            ("model", _) => {
                part.millimetres = match tag.get("unit")?.as_deref() {
                    None | Some("millimeter") => 1.0,
                    Some("micron") => 0.001,
                    Some("centimeter") => 10.0,
                    Some("inch") => 25.4,
                    Some("foot") => 304.8,
                    Some("meter") => 1000.0,
                    Some(_) => return fail("this 3MF file has an unknown unit"),
                };
            }
            ("basematerials" | "colorgroup", _) => open.id = number(tag, "id")?,
            ("base", _) => {
                self.count(2, MAX_MATERIALS, "materials")?;
                let material = Material {
                    name: tag.get("name")?.unwrap_or_default().into(),
                    color: color(tag, "displaycolor")?,
                    ..Material::default()
                };
                part.materials.entry(open.id).or_default().push(material);
            }
            ("color", _) => {
                self.count(3, MAX_VERTICES, "colours")?;
                let color = color(tag, "color")?;
                part.colors.entry(open.id).or_default().push(color);
            }
            ("object", object) => {
                self.count(2, MAX_MATERIALS, "objects")?;
                open.id = number(tag, "id")?;
                let property = optional(tag, "pid")?.zip(optional(tag, "pindex")?.or(Some(0)));
                *object = Some(Object {
                    name: tag.get("name")?.unwrap_or_default().into(),
                    property,
                    ..Object::default()
                });
            }
            ("vertex", Some(object)) => {
                self.count(0, MAX_VERTICES, "vertices")?;
                let [x, y, z] = [number(tag, "x")?, number(tag, "y")?, number(tag, "z")?];
                object.positions.push(DVec3::new(x, y, z));
            }
            ("triangle", Some(object)) => {
                self.count(1, MAX_TRIANGLES, "triangles; simplify the mesh first")?;
                let vertices = [number(tag, "v1")?, number(tag, "v2")?, number(tag, "v3")?];
                let group = optional(tag, "pid")?.or(object.property.map(|(id, _)| id));
                let first: Option<u32> = optional(tag, "p1")?;
                let [second, third] = [optional(tag, "p2")?, optional(tag, "p3")?];
                let properties = [first, second.or(first), third.or(first)];
                let properties = properties.map(|index| group.zip(index).or(object.property));
                object.triangles.push((vertices, properties));
            }
            ("component", Some(_)) => {
                self.count(2, MAX_MATERIALS, "components")?;
                let place = self.place(tag, open.index)?;
                let (part, id) = place.object;
                // Objects of the same part come before their use.
                if part == open.index && !open.part.objects.contains_key(&id) {
                    return fail(format!(
                        "line {}: this 3MF file has no object {id} before its use",
                        tag.line()
                    ));
                }
                open.object.get_or_insert_default().components.push(place);
            }
            ("item", _) if open.index == 0 => {
                self.count(2, MAX_MATERIALS, "items")?;
                let place = self.place(tag, 0)?;
                self.items.push(place);
            }
            (_, Some(object)) => self.lattice(tag, object)?,
            _ => {}
        }
        Ok(())
    }

    /// Reads the tags of beam lattices.
    fn lattice(&mut self, tag: &Tag<'_>, object: &mut Object) -> Result<(), Error> {
        match (tag.name(), &mut object.lattice) {
            ("beamlattice", _) => {
                let mode = match tag.get("clippingmode")? {
                    Some(mode) => Some(mode),
                    None => tag.get("clipping")?,
                };
                let is_inside = match mode.as_deref() {
                    Some("inside") => Some(true),
                    Some("outside") => Some(false),
                    _ => None,
                };
                let group: Option<u32> = optional(tag, "pid")?;
                let own = group.zip(optional(tag, "pindex")?.or(Some(0)));
                let ball_radius = length(tag, "ballradius")?.unwrap_or(0.0);
                let is_all = tag.get("ballmode")?.as_deref() == Some("all");
                object.lattice = Some(Lattice {
                    radius: length(tag, "radius")?.unwrap_or(0.0),
                    least_length: length(tag, "minlength")?.unwrap_or(0.0),
                    is_flat: cap(tag, "cap")?.unwrap_or(false),
                    clip: is_inside.zip(optional(tag, "clippingmesh")?),
                    ball_everywhere: is_all.then_some(ball_radius),
                    ball_radius,
                    property: own.or(object.property),
                    ..Lattice::default()
                });
            }
            ("beam", Some(lattice)) => {
                if lattice.beams.len() == MAX_BEAMS {
                    return fail(format!("this 3MF file has more than {MAX_BEAMS} beams"));
                }
                let start = length(tag, "r1")?.unwrap_or(lattice.radius);
                let end = length(tag, "r2")?.unwrap_or(start);
                let [first, second] = [cap(tag, "cap1")?, cap(tag, "cap2")?];
                lattice.beams.push(Beam {
                    ends: [number(tag, "v1")?, number(tag, "v2")?],
                    radii: [start, end],
                    is_flat: [first, second].map(|cap| cap.unwrap_or(lattice.is_flat)),
                    property: property(tag, "p1", lattice.property)?,
                });
            }
            ("ball", Some(lattice)) => {
                if lattice.balls.len() == MAX_BEAMS {
                    return fail(format!("this 3MF file has more than {MAX_BEAMS} balls"));
                }
                let radius = length(tag, "r")?.unwrap_or(lattice.ball_radius);
                lattice.balls.push((number(tag, "vindex")?, radius));
            }
            _ => {}
        }
        Ok(())
    }
}
