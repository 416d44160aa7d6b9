//! 3MF: a zip archive with a description in XML of objects, and of where they are.
//!
//! Triangles of all objects that are to be built are read, each where its item and its components
//! put it, in millimetres; of the materials base materials and groups of colours. Textures, slices,
//! beams and support are passed over.

use super::xml::{Tag, Tags};
use crate::color::linear_from_srgb;
use crate::error::{Error, fail};
use crate::limits::{MAX_MATERIALS, MAX_TRIANGLES, MAX_VERTICES, MAX_XML};
use crate::triangle_mesh::{Group, Material, TriangleMesh};
use archive::Archive;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{BTreeMap, HashMap};

/// Members of an archive that are looked at.
const MAX_MEMBERS: usize = 10_000;

/// Property of a corner: a resource's number and an index into it.
type Property = (u32, u32);

#[derive(Default)]
struct Object {
    name: String,
    property: Option<Property>,
    positions: Vec<DVec3>,
    /// Vertices, and the properties of the three corners.
    triangles: Vec<([u32; 3], [Option<Property>; 3])>,
    components: Vec<(u32, DAffine3)>,
}

#[derive(Default)]
struct Model {
    scale: f64,
    materials: BTreeMap<u32, Vec<Material>>,
    colors: BTreeMap<u32, Vec<[f32; 3]>>,
    objects: BTreeMap<u32, Object>,
    items: Vec<(u32, DAffine3)>,
    /// Vertices, triangles, colours and the like so far.
    counts: [usize; 4],
}

pub(super) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let archive = Archive::open(bytes, MAX_MEMBERS).map_err(unread)?;
    let main = main_part(&archive)?;
    let Some(text) = member(&archive, &main)? else {
        return fail("this zip archive has no 3MF model");
    };
    let text = String::from_utf8_lossy(&text);
    Model::read(&text)?.mesh()
}

/// The content of a member; `None` if there is none of this name.
fn member(archive: &Archive<'_>, name: &str) -> Result<Option<Vec<u8>>, Error> {
    let entry = archive.entry(name);
    let content = entry.map(|entry| archive.read(entry, MAX_XML));
    content.transpose().map_err(unread)
}

fn unread(error: archive::Error) -> Error {
    Error(format!("this 3MF file {error}"))
}

/// The name of the member that describes the model.
fn main_part(archive: &Archive<'_>) -> Result<String, Error> {
    let relations = member(archive, "_rels/.rels")?.unwrap_or_default();
    let text = String::from_utf8_lossy(&relations);
    let mut tags = Tags::new(&text);
    while let Some(tag) = tags.next()? {
        let is_model = tag
            .get("Type")
            .is_some_and(|kind| kind.ends_with("/3dmodel"));
        if let Some(target) = tag.get("Target").filter(|_| is_model) {
            return Ok(target.trim_start_matches('/').into());
        }
    }
    Ok("3D/3dmodel.model".into())
}

/// The value of an attribute as a number.
fn number<T: core::str::FromStr>(tag: &Tag<'_>, name: &str) -> Result<T, Error> {
    let value = tag.get(name).and_then(|text| text.trim().parse().ok());
    value.ok_or_else(|| {
        Error(format!(
            "a `{}` of this 3MF file has no number `{name}`",
            tag.name
        ))
    })
}

/// The value of an attribute that may be left out.
fn optional(tag: &Tag<'_>, name: &str) -> Result<Option<u32>, Error> {
    match tag.get(name) {
        Some(_) => number(tag, name).map(Some),
        None => Ok(None),
    }
}

/// Twelve numbers: three rows of a matrix, then a shift, for row vectors.
fn transform(tag: &Tag<'_>) -> Result<DAffine3, Error> {
    let Some(text) = tag.get("transform") else {
        return Ok(DAffine3::IDENTITY);
    };
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    let Ok(m) = <[f64; 12]>::try_from(numbers) else {
        return fail("a transform in this 3MF file has not twelve numbers");
    };
    let [x, y, z, shift] = [0, 3, 6, 9].map(|i| DVec3::new(m[i], m[i + 1], m[i + 2]));
    Ok(DAffine3::from_mat3_translation(
        DMat3::from_cols(x, y, z),
        shift,
    ))
}

/// `#RRGGBB` or `#RRGGBBAA`, of which the opacity is passed over.
fn color(tag: &Tag<'_>, name: &str) -> Result<[f32; 3], Error> {
    let text = tag.get(name).unwrap_or_default();
    let channels = [0, 2, 4].map(|i| {
        let digits = text.strip_prefix('#')?.get(i..i + 2)?;
        u8::from_str_radix(digits, 16).ok()
    });
    match channels {
        [Some(r), Some(g), Some(b)] => Ok([r, g, b].map(linear_from_srgb)),
        _ => fail(format!(
            "`{name}` of a `{}` in this 3MF file is no colour",
            tag.name
        )),
    }
}

impl Model {
    fn read(text: &str) -> Result<Self, Error> {
        let mut model = Self {
            scale: 1.0,
            ..Self::default()
        };
        let mut tags = Tags::new(text);
        // The resource or object whose tag is open.
        let mut open = 0;
        let mut object: Option<Object> = None;
        while let Some(tag) = tags.next()? {
            if tag.is_start {
                model.start(&tag, &mut open, &mut object)?;
            }
            if tag.is_end
                && tag.name == "object"
                && let Some(object) = object.take()
            {
                model.objects.insert(open, object);
            }
        }
        Ok(model)
    }

    /// Counts what takes memory.
    fn count(&mut self, kind: usize, most: usize, what: &str) -> Result<(), Error> {
        self.counts[kind] += 1;
        if self.counts[kind] > most {
            return fail(format!("this 3MF file has more than {most} {what}"));
        }
        Ok(())
    }

    fn start(
        &mut self,
        tag: &Tag<'_>,
        open: &mut u32,
        object: &mut Option<Object>,
    ) -> Result<(), Error> {
        match (tag.name, object) {
            ("model", _) => {
                self.scale = match tag.get("unit").as_deref() {
                    None | Some("millimeter") => 1.0,
                    Some("micron") => 0.001,
                    Some("centimeter") => 10.0,
                    Some("inch") => 25.4,
                    Some("foot") => 304.8,
                    Some("meter") => 1000.0,
                    Some(_) => return fail("this 3MF file has an unknown unit"),
                };
            }
            ("basematerials" | "colorgroup", _) => *open = number(tag, "id")?,
            ("base", _) => {
                self.count(2, MAX_MATERIALS, "materials")?;
                let material = Material {
                    name: tag.get("name").unwrap_or_default().into(),
                    color: color(tag, "displaycolor")?,
                    ..Material::default()
                };
                self.materials.entry(*open).or_default().push(material);
            }
            ("color", _) => {
                self.count(3, MAX_VERTICES, "colours")?;
                self.colors
                    .entry(*open)
                    .or_default()
                    .push(color(tag, "color")?);
            }
            ("object", object) => {
                self.count(2, MAX_MATERIALS, "objects")?;
                *open = number(tag, "id")?;
                let property = optional(tag, "pid")?.zip(optional(tag, "pindex")?.or(Some(0)));
                *object = Some(Object {
                    name: tag.get("name").unwrap_or_default().into(),
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
                let first = optional(tag, "p1")?;
                let property = |index: Option<u32>| match (group, index) {
                    (Some(group), Some(index)) => Some((group, index)),
                    _ => object.property,
                };
                let corner = |name: &str| Ok(property(optional(tag, name)?.or(first)));
                let properties = [property(first), corner("p2")?, corner("p3")?];
                object.triangles.push((vertices, properties));
            }
            ("component", Some(object)) => {
                self.count(2, MAX_MATERIALS, "components")?;
                let id = number(tag, "objectid")?;
                // So that nothing can contain itself.
                if !self.objects.contains_key(&id) {
                    return fail(format!("this 3MF file has no object {id} before its use"));
                }
                object.components.push((id, transform(tag)?));
            }
            ("item", _) => {
                self.count(2, MAX_MATERIALS, "items")?;
                self.items.push((number(tag, "objectid")?, transform(tag)?));
            }
            _ => {}
        }
        Ok(())
    }

    /// The mesh of all items.
    fn mesh(&self) -> Result<TriangleMesh, Error> {
        let has_colors = self.objects.values().any(|object| {
            let properties = object.triangles.iter().flat_map(|(_, p)| p).flatten();
            properties
                .into_iter()
                .any(|(group, _)| self.colors.contains_key(group))
        });
        let mut mesh = TriangleMesh {
            colors: has_colors.then(Vec::new),
            ..TriangleMesh::default()
        };
        let mut open: Vec<(u32, DAffine3)> = self.items.iter().rev().copied().collect();
        let mut tally = 0;
        while let Some((id, place)) = open.pop() {
            // Objects in objects may be many.
            tally += 1;
            if tally > MAX_TRIANGLES {
                return fail(format!("this 3MF file has more than {MAX_TRIANGLES} parts"));
            }
            let object = self.objects.get(&id);
            let object =
                object.ok_or_else(|| Error(format!("this 3MF file has no object {id}")))?;
            self.add(object, &place, &mut mesh)?;
            let parts = object.components.iter().rev();
            open.extend(parts.map(|(id, within)| (*id, place * *within)));
        }
        Ok(mesh)
    }

    /// Adds the triangles of an object.
    fn add(&self, object: &Object, place: &DAffine3, mesh: &mut TriangleMesh) -> Result<(), Error> {
        let is_mirrored = place.matrix3.determinant() < 0.0;
        // A vertex becomes one for each colour it has.
        let mut vertices: HashMap<(u32, Option<Property>), u32> = HashMap::new();
        let mut group: Option<(Option<&Material>, u32)> = None;
        for (corners, properties) in &object.triangles {
            let material = properties[0].and_then(|(id, index)| {
                self.materials
                    .get(&id)
                    .and_then(|list| list.get(index as usize))
            });
            let start = mesh.triangles.len() as u32;
            if let Some((own, since)) = group
                && own != material
            {
                mesh.groups.push(new_group(object, own, since..start));
                group = None;
            }
            group = group.or(Some((material, start)));
            let mut triangle = [0; 3];
            for (own, (corner, property)) in triangle.iter_mut().zip(corners.iter().zip(properties))
            {
                let property = property.filter(|(id, _)| self.colors.contains_key(id));
                if let Some(known) = vertices.get(&(*corner, property)) {
                    *own = *known;
                    continue;
                }
                let Some(position) = object.positions.get(*corner as usize) else {
                    return fail(format!(
                        "a triangle of this 3MF file has vertex {corner} (from 0) of {}",
                        object.positions.len()
                    ));
                };
                *own = mesh.add_vertex(place.transform_point3(*position) * self.scale)?;
                if let Some(colors) = &mut mesh.colors {
                    colors.push(self.color_of(property, material));
                }
                vertices.insert((*corner, property), *own);
            }
            if is_mirrored {
                triangle.swap(1, 2);
            }
            mesh.add_triangle(triangle)?;
        }
        if let Some((own, since)) = group {
            mesh.groups
                .push(new_group(object, own, since..mesh.triangles.len() as u32));
        }
        if mesh.groups.len() > MAX_MATERIALS {
            return fail(format!(
                "this 3MF file has more than {MAX_MATERIALS} groups"
            ));
        }
        Ok(())
    }

    fn color_of(&self, property: Option<Property>, material: Option<&Material>) -> [f32; 3] {
        let own = property.and_then(|(id, i)| self.colors.get(&id)?.get(i as usize));
        own.copied()
            .or(material.map(|m| m.color))
            .unwrap_or([1.0; 3])
    }
}

fn new_group(
    object: &Object,
    material: Option<&Material>,
    triangles: core::ops::Range<u32>,
) -> Group {
    Group {
        name: object.name.clone(),
        material: material.cloned(),
        triangles,
    }
}
